"""Measure graded meaning on described photographs (those of ``bench_vrd.py``) and on generated tables.

Every image's facts become log-likelihood ratios (:mod:`deixis.reasoning.grounding.evidence.facts.facts`); the
one-to-one map with the largest sum is found exactly. Prints the share of objects named right, mean over images, each a
mean over random node orders. ``shipped`` words and sizes do not depend on these images;
``anonymous names`` are names that say nothing about the kinds. ``learned`` words, and sizes by
the names in the descriptions, are fitted by cross-validation over images: the test fold is never seen. ``--halves``
adds the shares of two fixed halves of the images, development and confirmation; the last choices of form, and the
strengths of the priors of learned models, were made on the first half alone.

``--tables N`` grounds N generated tables of 12 objects per setting instead: the share right of the best map, beside the
exact Bayes limit given the words only and given also how pairs are drawn; the expected calibration error of the
probabilities of matches; and the precision of the objects that are at least 0.95 probable.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from common import data_folder
from numpy.typing import NDArray
from records import command_line, figure, mean, recorded

from deixis.experiments.cross_validation import learned_meanings
from deixis.experiments.generated_tables import generate
from deixis.experiments.photographs import Photograph, photographs
from deixis.experiments.scoreboard.bayes_limit import bayes_limit
from deixis.ontology.tbox import default_ontology
from deixis.perception.recognition.calibration import expected_calibration_error
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.evidence.facts.facts import FactTables, crisp_tables, fact_tables
from deixis.reasoning.grounding.evidence.properties.labels import classes
from deixis.reasoning.grounding.evidence.properties.unary import UnaryWeights, size_evidence
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED, Meaning
from deixis.reasoning.grounding.fitting.fit import FitSettings
from deixis.reasoning.grounding.matching.posterior.posterior import posterior
from deixis.reasoning.grounding.matching.problem import Problem
from deixis.reasoning.grounding.matching.search.exact import exact

HALVES_SEED = 2016
SETTINGS = ((1.0, 0.0), (1.5, 0.0), (2.5, 0.0), (1.0, 0.1), (2.5, 0.1), (2.5, 0.2))  # facts per object, share off


def share_right(
    facts: FactTables, alone: NDArray[np.float64], count: int, rng: np.random.Generator, orders: int
) -> float:
    """Return the share named right over random orders of both sides; the i-th object is the i-th box."""
    shares = []
    for _ in range(orders):
        rows, columns = rng.permutation(count), rng.permutation(count)
        tables = np.ascontiguousarray(facts.tables[:, columns][:, :, columns])
        ends, unary = np.argsort(rows)[facts.ends], np.ascontiguousarray(alone[rows][:, columns])
        problem = Problem(ends, facts.kinds, tables, unary, np.full(count, -1e3))
        shares.append(np.mean(columns[exact(problem).assignment] == rows))
    return float(np.mean(shares))


def graded_shares(
    images: Sequence[Photograph],
    meanings: Sequence[Meaning],
    orders: int,
    saying: bool = True,
    literal: float | None = None,
) -> NDArray[np.float64]:
    """Return the share named right in each image, each with its own meaning."""
    rng, sizes, shares = np.random.default_rng(1), default_ontology().sizes, []
    for (description, boxes), meaning in zip(images, meanings, strict=True):
        alone = meaning.weights.sizes * size_evidence(classes(description), boxes, sizes, meaning.sizes, metric=False)
        away = np.full(len(boxes), -1e3)
        facts = fact_tables(
            description, boxes, meaning.models, saying=saying, literal=literal, unary=alone, absent=away
        )
        shares.append(share_right(facts, alone, len(boxes), rng, orders))
    return np.array(shares)


def crisp_shares(images: Sequence[Photograph], orders: int) -> NDArray[np.float64]:
    """Return the shares with degrees 1, 0.5 and 0, the crisp special case."""
    rng, shares = np.random.default_rng(1), []
    for description, boxes in images:
        names = scene_relations([f"o{i:03}" for i in range(len(boxes))], boxes, description.vocabulary).names
        nothing = np.zeros((len(boxes), len(boxes)))
        shares.append(share_right(crisp_tables(description, names), nothing, len(boxes), rng, orders))
    return np.array(shares)


def anonymous(image: Photograph) -> Photograph:
    """Return a photograph whose described objects have names that say nothing about their kinds."""
    description, boxes = image
    names = tuple(f"x{number}" for number in range(len(description.nodes)))
    return Photograph(replace(description, nodes=names, kinds=(None,) * len(names)), boxes)


def report(name: str, shares: NDArray[np.float64], started: float, halves: bool) -> None:
    mean(f"{name}: share named right", shares)
    error = shares.std(ddof=1) / np.sqrt(len(shares))
    order = np.random.default_rng(HALVES_SEED).permutation(len(shares))
    parts = [shares[part].mean() for part in np.array_split(order, 2)] if halves else []
    split = "".join(
        f", {half} half {part:.3f}" for half, part in zip(("development", "confirmation"), parts, strict=False)
    )
    taken = time.perf_counter() - started
    print(f"{name:<30} {shares.mean():.3f} (standard error {error:.3f}){split}, {taken:.0f} s", flush=True)


def on_tables(count: int, first: int) -> None:
    """Print shares right and calibration on generated tables of 12 objects, seeds ``first`` and on."""
    print(f"{count} tables of 12 objects per setting, seeds {first} to {first + count - 1}")
    for facts, off in SETTINGS:
        right, probability, hits, limits = [], [], [], []
        for seed in range(first, first + count):
            table = generate(12, facts, off, seed=seed)
            evidence = fact_tables(table.description(), table.boxes)
            problem = Problem(evidence.ends, evidence.kinds, evidence.tables, np.zeros((12, 12)), np.full(12, -1e3))
            right.append(np.mean(exact(problem).assignment == table.truth))
            probability.append(posterior(problem).marginals[:, :12])
            hits.append(table.truth[:, None] == np.arange(12))
            limits.append(bayes_limit(table))
        words, pairs = (np.mean([getattr(one, name) for one in limits]) for name in ("words", "words_and_pairs"))
        error, sure, precision = calibrated(np.concatenate(probability), np.concatenate(hits))
        what = f"{facts:g} facts per object, {off:.0%} of the facts wrong"
        mean(f"{what}: share named right", right)
        figure(f"{what}: Bayes limit of the words", words, "share")
        figure(f"{what}: calibration error", error, "share")
        figure(f"{what}: precision from 0.95 on", precision, "share")
        partly = "" if all(one.complete for one in limits) else " (not all maps listed)"
        print(
            f"{facts:g} facts per object, {off:.0%} of the facts wrong: best map {np.mean(right):.3f} "
            f"(standard error {np.std(right, ddof=1) / np.sqrt(count):.3f}); limit {words:.3f}, with pairs {pairs:.3f}"
            f"{partly}; calibration error {error:.3f}; {sure} of {12 * count} sure, precision {precision:.3f}",
            flush=True,
        )


def calibrated(probability: NDArray[np.float64], hits: NDArray[np.bool_]) -> tuple[float, int, float]:
    """Return the calibration error in ten bins, the number of matches at 0.95 or more, and their share right."""
    sure = probability >= 0.95
    return (
        expected_calibration_error(probability, hits),
        int(sure.sum()),
        float(hits[sure].mean()) if sure.any() else float("nan"),
    )


def on_photographs(options: argparse.Namespace) -> None:
    folder = data_folder("vrd")
    if folder is None:
        return
    images = list(photographs(folder, default_ontology()))
    print(f"{len(images)} images, {options.orders} node orders, seed 1")
    started = time.perf_counter()
    report("crisp degrees", crisp_shares(images, options.orders), started, options.halves)
    no_sizes = Meaning(weights=UnaryWeights(sizes=0.0))
    for name, meaning, saying, literal in (
        ("no sizes, words alone", no_sizes, False, 0.0),
        ("no sizes, none literal", no_sizes, True, 0.0),
        ("no sizes, judged", no_sizes, True, None),
        ("no sizes, 0.9 literal", no_sizes, True, 0.9),
        ("shipped (default)", SHIPPED, True, None),
    ):
        started = time.perf_counter()
        shares = graded_shares(images, [meaning] * len(images), options.orders, saying, literal)
        report(name, shares, started, options.halves)
    started = time.perf_counter()
    shares = graded_shares([anonymous(image) for image in images], [SHIPPED] * len(images), options.orders)
    report("shipped, anonymous names", shares, started, options.halves)
    for seed in map(int, filter(None, options.seeds.split(","))):
        started = time.perf_counter()
        settings = FitSettings(options.strength, options.word_contrast, iterations=60)
        learned = learned_meanings(images, seed, options.folds, settings)
        for name, meanings in (
            ("words, no sizes", [Meaning(one.models, weights=no_sizes.weights) for one in learned]),
            ("words", [Meaning(one.models) for one in learned]),
            ("sizes", [Meaning(sizes=one.sizes) for one in learned]),
            ("words and sizes", learned),
        ):
            shares = graded_shares(images, meanings, options.orders)
            report(f"learned {name}, split {seed}", shares, started, options.halves)


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--orders", type=int, default=5, help="random node orders per image")
    parser.add_argument("--folds", type=int, default=10)
    parser.add_argument("--seeds", default="0,1", help="seeds of the split into folds")
    parser.add_argument("--strength", type=float, default=3.0, help="strength of the prior of learned models")
    parser.add_argument("--word-contrast", type=float, default=0.0)
    parser.add_argument("--halves", action="store_true", help="also the two halves of the images")
    parser.add_argument("--tables", type=int, default=0, help="generated tables per setting, instead of photographs")
    parser.add_argument("--first-table", type=int, default=9000, help="the first table's seed")
    with recorded(parser) as options:
        if options.tables > 0:
            on_tables(options.tables, options.first_table)
        else:
            on_photographs(options)


if __name__ == "__main__":
    main()
