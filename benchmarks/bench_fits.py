"""Whether a description is of a scene: fits the powers that are shipped, and measures how well wrong ones are noticed.

Right pairs are generated tables and photographs (``$DEIXIS_DATA/vrd``) with their own descriptions; wrong ones are
those tables with their things at each other's places, and photographs with another's description. Prints the powers of
:mod:`deixis.reasoning.grounding.hypotheses` as fitted to tables, to photographs, and to both as much; the share of
wrong descriptions noticed at each share of right ones accused, for photographs also in ten folds none of which is
judged by what it taught; and how often ``fits`` is below a half on tables of 12 objects whose kinds are known, 22 facts
and more.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator

import numpy as np
from bench_faults import moved_to, shuffled
from common import data_folder
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.experiments.cross_validation import folds
from deixis.experiments.generated_tables import GeneratedTable, generate
from deixis.experiments.photographs import FOLDER, photographs
from deixis.ontology.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.evidence.evidence import evidence_from
from deixis.reasoning.grounding.fitting.fits import fit_powers
from deixis.reasoning.grounding.hypotheses import (
    AS_IT_STANDS,
    CHANCE_SHARE,
    FACTS_POWER,
    KINDS_POWER,
    STATED_SIDES,
    FitEvidence,
    Side,
    Verdict,
)
from deixis.reasoning.grounding.map_engines import ExactEngine
from deixis.reasoning.grounding.matching.problem import UNMATCHED

Boxes = NDArray[np.float64]
ACCUSED = (0.01, 0.03, 0.05, 0.1, 0.2, 0.3)
NUMBER_OF_FOLDS = 10
DRAWS = 200


def verdict(
    description: RelationGraph, boxes: Boxes, metric: bool = True, sides: tuple[Side, ...] = AS_IT_STANDS
) -> Verdict:
    """Return what the default engine makes of a description beside a scene."""
    ontology = default_ontology()
    scene = scene_relations([f"o{p:04}" for p in range(len(boxes))], boxes, ontology.relations)
    unlabelled = [None] * len(boxes)
    evidence = evidence_from(description, scene, unlabelled, ontology.kinds, ontology.sizes, metric=metric)
    found = ExactEngine(sides).align(evidence, Deadline.after(30.0)).verdict
    assert found is not None
    return found


def displaced(table: GeneratedTable, rng: np.random.Generator) -> Boxes:
    """Return the boxes of a table whose things lie at each other's places, none where one of its kind lay.

    Of so many of a kind that this cannot be, as few as ``DRAWS`` draws find.
    """
    kinds = np.empty(len(table.boxes), dtype=np.int64)
    kinds[:] = -1 - np.arange(len(table.boxes))
    there = table.truth != UNMATCHED
    kinds[table.truth[there]] = table.pieces[there]
    drawn = [rng.permutation(len(kinds)) for _ in range(DRAWS)]
    order = min(drawn, key=lambda places: int((kinds[places] == kinds).sum()))
    return moved_to(table.boxes, order)


def table_pairs(count: int, seed: int) -> Iterator[tuple[FitEvidence, bool]]:
    """Yield the evidence of generated tables of many sizes and noises, right and wrong."""
    for objects in (5, 8, 12):
        for facts_each in (1.2, 1.8, 2.5):
            for off in (0.0, 0.1, 0.2):
                for changed in (0, 1):
                    for number in range(count):
                        drawn = [seed, objects, round(10 * facts_each), round(10 * off), changed, number]
                        first, second = np.random.SeedSequence(drawn).generate_state(2).tolist()
                        table = generate(objects, facts_each, off, changed, changed, seed=first)
                        said = table.description(kinds=True)
                        moved = displaced(table, np.random.default_rng(second))
                        yield verdict(said, table.boxes).evidence, True
                        yield verdict(said, moved).evidence, False


def photograph_pairs() -> list[tuple[FitEvidence, FitEvidence]]:
    """Return for each photograph the evidence with its own description, and with another's."""
    folder = data_folder(FOLDER)
    images = [] if folder is None else [one for one in photographs(folder, default_ontology()) if len(one.boxes) <= 12]
    places = np.arange(len(images))
    return [
        (verdict(said, boxes, False).evidence, verdict(images[other].description, boxes, False).evidence)
        for (said, boxes), other in zip(images, np.roll(places, len(images) // 3), strict=True)
    ]


def curve(right: NDArray[np.float64], wrong: NDArray[np.float64]) -> str:
    """Return the share of wrong descriptions noticed where so many right ones are accused, and the area."""
    told = [f"{(wrong < np.quantile(right, share)).mean():.2f} at {share:g}" for share in ACCUSED]
    area = (right[:, None] > wrong).mean() + (right[:, None] == wrong).mean() / 2
    return f"{', '.join(told)}; area {area:.3f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=4, help="tables of each setting to fit to")
    parser.add_argument("--tables", type=int, default=60, help="tables for each rate of `fits`")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    tables = list(table_pairs(options.count, options.seed))
    images = photograph_pairs()
    seen = [(told, right) for pair in images for told, right in zip(pair, (True, False), strict=True)]
    print(f"shipped: FACTS_POWER {FACTS_POWER}, CHANCE_SHARE {CHANCE_SHARE}, KINDS_POWER {KINDS_POWER}")
    for name, sets in {"tables": [tables], "photographs": [seen], "both": [tables, seen]}.items():
        if all(sets):
            pairs, right = zip(*(one for members in sets for one in members), strict=True)
            share = np.concatenate([np.full(len(members), 1 / len(members)) for members in sets])
            print(
                f"fitted to {name}: {', '.join(f'{power:.3f}' for power in fit_powers(pairs, np.array(right), share))}"
            )
    _print_curves(tables, images, options.seed)
    _print_rates(options.tables, options.seed)


def _print_curves(
    tables: list[tuple[FitEvidence, bool]], images: list[tuple[FitEvidence, FitEvidence]], seed: int
) -> None:
    odds = np.array([told.log_odds for told, _ in tables])
    own = np.array([right for _, right in tables])
    print(f"generated tables, wrong ones noticed: {curve(odds[own], odds[~own])}")
    if not images:
        return
    scores = np.zeros((len(images), 2))
    for test in folds(len(images), NUMBER_OF_FOLDS, seed):
        taught = [images[i] for i in np.setdiff1d(np.arange(len(images)), test)]
        told = [one for pair in taught for one in pair]
        powers = fit_powers(told, np.tile([True, False], len(taught)))
        for i in test.tolist():
            scores[i] = [powers @ (one.facts, -one.most, one.kinds) for one in images[i]]
    print(f"photographs, cross-validated: {curve(scores[:, 0], scores[:, 1])}")
    scores = np.array([[one.log_odds for one in pair] for pair in images])
    print(f"photographs, by what is shipped: {curve(scores[:, 0], scores[:, 1])}")
    facts = np.array([[one.facts for one in pair] for pair in images])
    print(f"photographs, likelihood ratio of the facts alone: {curve(facts[:, 0], facts[:, 1])}")


def _print_rates(count: int, seed: int) -> None:
    """Print how often ``fits`` is below a half on full descriptions of 12 objects whose kinds are known."""
    print("fits below 0.5, 12 objects, kinds known")
    for facts in (22, 30):
        rates = np.zeros(3)
        for number in range(count):
            for place, off in enumerate((0.0, 0.2)):
                table = generate(12, facts / 12, off, seed=5000 * seed + number)
                rates[place] += verdict(table.description(kinds=True), table.boxes, sides=STATED_SIDES).fits < 0.5
            table = generate(12, facts / 12, 0.0, seed=5000 * seed + number)
            moved = shuffled(table, np.random.default_rng([seed, number])).boxes
            rates[2] += verdict(table.description(kinds=True), moved, sides=STATED_SIDES).fits < 0.5
        told = ", ".join(
            f"{name} {rate:.3f}"
            for name, rate in zip(("right", "one fact in five wrong", "shuffled places"), rates / count, strict=True)
        )
        print(f"{facts} facts: {told}, {count} tables each", flush=True)


if __name__ == "__main__":
    main()
