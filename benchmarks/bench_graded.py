"""Graded meaning on what people wrote down about photographs: the cases and the score of ``bench_vrd.py``.

Every image's facts become log-likelihood ratios (:mod:`deixis.reasoning.graded.facts`); the one-to-one map with the
largest sum is found exactly. Share of objects named right, mean over images, each a mean over random node orders.
``shipped`` models know nothing of these images. ``learned`` ones are fitted by cross-validation over images: the test
fold is never seen, and the strength of the prior is chosen by three inner folds of the rest.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence

import numpy as np
from bench_vrd import cases
from common import data_folder
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.relation_models import RelationModels
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.evidence import exact_names
from deixis.reasoning.graded.facts import LITERAL, FactTables, crisp_tables, fact_tables
from deixis.reasoning.graded.fitting import FitSettings, learn_relations
from deixis.reasoning.graded.lessons import SaidPairs, said_pairs
from deixis.reasoning.graded.shipped import shipped_models
from deixis.reasoning.matching.exact import exact
from deixis.reasoning.matching.problem import Problem
from deixis.reasoning.rectangle import perceived_graph

Case = tuple[RelationGraph, NDArray[np.float64]]
STRENGTHS = (1.0, 3.0)
INNER_FOLDS = 3


def share_right(facts: FactTables, count: int, rng: np.random.Generator, orders: int) -> float:
    """The share named right over random orders of both sides; the i-th object is the i-th box."""
    shares = []
    for _ in range(orders):
        rows, columns = rng.permutation(count), rng.permutation(count)
        tables = np.ascontiguousarray(facts.tables[:, columns][:, :, columns])
        ends = np.argsort(rows)[facts.ends]
        problem = Problem(ends, facts.kinds, tables, np.zeros((count, count)), np.full(count, -1e3))
        shares.append(np.mean(columns[exact(problem).assignment] == rows))
    return float(np.mean(shares))


def graded_shares(
    images: Sequence[Case], models: RelationModels, orders: int, saying: bool = True, literal: float = 0.0
) -> NDArray[np.float64]:
    rng = np.random.default_rng(1)
    return np.array(
        [
            share_right(fact_tables(said, boxes, models, saying=saying, literal=literal), len(boxes), rng, orders)
            for said, boxes in images
        ]
    )


def crisp_shares(images: Sequence[Case], orders: int) -> NDArray[np.float64]:
    """Degrees 1, 0.5 and 0: the special case."""
    rng, shares = np.random.default_rng(1), []
    for said, boxes in images:
        names = exact_names(perceived_graph([f"o{i:03}" for i in range(len(boxes))], boxes, said.vocabulary))
        shares.append(share_right(crisp_tables(said, names), len(boxes), rng, orders))
    return np.array(shares)


def folds(count: int, number: int, seed: int) -> list[NDArray[np.int64]]:
    order = np.random.default_rng(seed).permutation(count)
    return [order[start::number] for start in range(number)]


def learned_shares(
    images: Sequence[Case], lessons: Sequence[SaidPairs], number: int, seed: int, orders: int, word_contrast: float
) -> tuple[NDArray[np.float64], list[float]]:
    """Cross-validated shares, and the strength that the inner folds of each fold chose."""
    shares, chosen = np.zeros(len(images)), []
    for test in folds(len(images), number, seed):
        train = np.setdiff1d(np.arange(len(images)), test)
        strength = best_strength(images, lessons, train, seed, word_contrast)
        models = fitted(lessons, train, strength, word_contrast)
        shares[test] = graded_shares([images[i] for i in test], models, orders)
        chosen.append(strength)
        print(f"  fold of {len(test)} images: {shares[test].mean():.3f} (strength {strength:g})", flush=True)
    return shares, chosen


def best_strength(
    images: Sequence[Case], lessons: Sequence[SaidPairs], train: NDArray[np.int64], seed: int, word_contrast: float
) -> float:
    """The strength whose models name most right on inner folds of the training images."""
    found = []
    for strength in STRENGTHS:
        right = []
        for inner in folds(len(train), INNER_FOLDS, seed):
            models = fitted(lessons, np.delete(train, inner), strength, word_contrast)
            right.append(graded_shares([images[i] for i in train[inner]], models, orders=2))
        found.append(float(np.concatenate(right).mean()))
    return STRENGTHS[int(np.argmax(found))]


def fitted(
    lessons: Sequence[SaidPairs], chosen: NDArray[np.int64], strength: float, word_contrast: float
) -> RelationModels:
    settings = FitSettings(strength, word_contrast, iterations=60)
    return learn_relations([lessons[i] for i in chosen], shipped_models(), settings)


def report(name: str, shares: NDArray[np.float64], started: float) -> None:
    error = shares.std(ddof=1) / np.sqrt(len(shares))
    print(
        f"{name:<30} {shares.mean():.3f} (standard error {error:.3f}), {time.perf_counter() - started:.0f} s",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--orders", type=int, default=5, help="random node orders an image")
    parser.add_argument("--folds", type=int, default=10)
    parser.add_argument("--seeds", default="0,1", help="seeds of the split into folds")
    parser.add_argument("--word-contrast", type=float, default=0.0)
    options = parser.parse_args()
    folder = data_folder("vrd")
    if folder is None:
        return
    images = list(cases(folder, default_ontology().relations))
    lessons = [said_pairs(said, boxes, range(len(boxes))) for said, boxes in images]
    print(f"{len(images)} images, {options.orders} node orders, seed 1")
    started = time.perf_counter()
    report("crisp degrees", crisp_shares(images, options.orders), started)
    for name, saying, literal in (
        ("shipped, words alone", False, 0.0),
        ("shipped, none literal", True, 0.0),
        (f"shipped, {LITERAL:g} literal (default)", True, LITERAL),
    ):
        started = time.perf_counter()
        report(name, graded_shares(images, shipped_models(), options.orders, saying, literal), started)
    for seed in map(int, filter(None, options.seeds.split(","))):
        started = time.perf_counter()
        shares, _ = learned_shares(images, lessons, options.folds, seed, options.orders, options.word_contrast)
        report(f"learned, {options.folds} folds, seed {seed}", shares, started)


if __name__ == "__main__":
    main()
