"""Measure how well wrong descriptions of a scene are noticed, and fit the shipped powers.

Right pairs are generated tables and photographs (``$DEIXIS_DATA/vrd``) with their own descriptions; wrong ones are
tables with shuffled things, and photographs with another's description. Prints the powers of
:mod:`deixis.reasoning.grounding.hypotheses.hypotheses` as they are fitted
(:mod:`deixis.reasoning.grounding.fitting.fits`), and the likeliest powers on tables and on photographs alone. Then, on
other tables: the share of wrong descriptions noticed at each rate of false alarms, for photographs also in ten-fold
cross-validation; the decided and the right matches of photographs, with their own descriptions and with others'; and
how often ``fits`` is below a half on tables of 12 objects whose kinds are known, with 22 facts and more.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from bench_faults import moved_to, shuffled
from common import data_folder
from numpy.typing import NDArray
from records import command_line, figure, recorded

from deixis.deadline import Deadline
from deixis.experiments.cross_validation import folds
from deixis.experiments.generated_tables import GeneratedTable, generate
from deixis.experiments.photographs import FOLDER, Photograph, photographs
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.engines.map_engines import ExactEngine
from deixis.reasoning.grounding.evidence.evidence import evidence_from
from deixis.reasoning.grounding.fitting.fits import fit_powers, likeliest_powers
from deixis.reasoning.grounding.hypotheses.hypotheses import (
    ANOTHER_PRIOR,
    AS_IT_STANDS,
    CHANCE_SHARE,
    FACTS_POWER,
    KINDS_POWER,
    STATED_SIDES,
    FitEvidence,
    Side,
    Verdict,
)
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.options import is_decided

Boxes = NDArray[np.float64]
ACCUSED = (0.01, 0.03, 0.05, 0.1, 0.2, 0.3)
NUMBER_OF_FOLDS = 10
RESAMPLES = 100
DRAWS = 200


def verdict(
    description: RelationGraph, boxes: Boxes, metric: bool = True, sides: tuple[Side, ...] = AS_IT_STANDS
) -> Verdict:
    """Return the default engine's verdict on a description beside a scene."""
    ontology = default_ontology()
    scene = scene_relations([f"o{p:04}" for p in range(len(boxes))], boxes, ontology.relations)
    unlabelled = [None] * len(boxes)
    evidence = evidence_from(description, scene, unlabelled, ontology.kinds, ontology.sizes, metric=metric)
    found = ExactEngine(sides).align(evidence, Deadline.after(30.0)).verdict
    assert found is not None
    return found


def displaced(table: GeneratedTable, rng: np.random.Generator) -> Boxes:
    """Return the boxes of a table with shuffled things, none where one of its kind lay.

    If a kind is too frequent for that, return the draw of ``DRAWS`` with the fewest exceptions.
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
                        description = table.description(kinds=True)
                        moved = displaced(table, np.random.default_rng(second))
                        yield verdict(description, table.boxes).evidence, True
                        yield verdict(description, moved).evidence, False


@dataclass(frozen=True, eq=False)
class PhotographPair:
    """A photograph, another one, and the verdicts on its scene with either description."""

    own: Photograph
    other: Photograph
    found: tuple[Verdict, Verdict]

    @property
    def evidence(self) -> tuple[FitEvidence, FitEvidence]:
        """The evidence on whether its own and the other description are of the photograph."""
        return self.found[0].evidence, self.found[1].evidence


def photograph_pairs() -> list[PhotographPair]:
    """Return the photographs, each with its own description and with another's."""
    folder = data_folder(FOLDER)
    images = [] if folder is None else [one for one in photographs(folder, default_ontology()) if len(one.boxes) <= 12]
    places = np.arange(len(images))
    return [
        PhotographPair(
            own,
            images[other],
            (
                verdict(own.description, own.boxes, False, STATED_SIDES),
                verdict(images[other].description, own.boxes, False, STATED_SIDES),
            ),
        )
        for own, other in zip(images, np.roll(places, len(images) // 3), strict=True)
    ]


def decided_things(found: Verdict) -> dict[int, int]:
    """Return the decided matches, from object to thing."""
    probable = found.posterior
    likeliest = probable.marginals[:, :-1].argmax(axis=1)
    chosen = is_decided(probable.marginals[np.arange(len(likeliest)), likeliest], probable.errors)
    return {int(i): int(likeliest[i]) for i in np.flatnonzero(chosen)}


def curve(right: NDArray[np.float64], wrong: NDArray[np.float64]) -> str:
    """Return the share of wrong descriptions noticed at each rate of false alarms, and the area under the curve."""
    rates = [f"{(wrong < np.quantile(right, share)).mean():.2f} at {share:g}" for share in ACCUSED]
    area = (right[:, None] > wrong).mean() + (right[:, None] == wrong).mean() / 2
    return f"{', '.join(rates)}; area {area:.3f}"


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--count", type=int, default=4, help="tables of each setting to fit to")
    parser.add_argument("--tables", type=int, default=60, help="tables for each rate of `fits`")
    parser.add_argument("--seed", type=int, default=1)
    with recorded(parser) as options:
        tables, images = list(table_pairs(options.count, options.seed)), photograph_pairs()
        _print_powers(tables, images, options.seed)
        _print_curves(list(table_pairs(1, options.seed + 1)), images, options.seed)  # other tables than were fitted to
        if images:
            _print_decided(images)
        _print_rates(options.tables, options.seed)


def _print_powers(tables: list[tuple[FitEvidence, bool]], images: list[PhotographPair], seed: int) -> None:
    """Print the shipped and the fitted powers; pairs of a table are resampled together."""
    print(f"shipped: FACTS_POWER {FACTS_POWER}, CHANCE_SHARE {CHANCE_SHARE}, KINDS_POWER {KINDS_POWER}")
    evidence, right = [one for one, _ in tables], np.array([right for _, right in tables])
    print(f"likeliest powers on tables alone: {_listed(likeliest_powers(evidence, right))}")
    if not images:
        return
    shown, own = [one for pair in images for one in pair.evidence], np.tile([True, False], len(images))
    print(f"likeliest powers on photographs alone: {_listed(likeliest_powers(shown, own))}")
    print(f"fitted: {_listed(fit_powers(evidence, right, shown, own))}")
    rng, drawn = np.random.default_rng(seed), []
    for _ in range(RESAMPLES):
        some, few = (2 * rng.integers(n, size=n)[:, None] + np.arange(2) for n in (len(evidence) // 2, len(images)))
        again = [[pairs[i] for i in places.ravel()] for pairs, places in ((evidence, some), (shown, few))]
        drawn.append(fit_powers(again[0], right[some.ravel()], again[1], own[few.ravel()]))
    low, high = np.quantile(drawn, (0.025, 0.975), axis=0)
    print(f"of {RESAMPLES} resamples 95 per cent are between {_listed(low)} and {_listed(high)}", flush=True)


def _listed(powers: NDArray[np.float64]) -> str:
    return ", ".join(f"{power:.2f}" for power in powers)


def _print_curves(tables: list[tuple[FitEvidence, bool]], images: list[PhotographPair], seed: int) -> None:
    odds = np.array([evidence.log_odds for evidence, _ in tables])
    own = np.array([right for _, right in tables])
    print(f"other generated tables, wrong ones noticed: {curve(odds[own], odds[~own])}")
    least = math.log(ANOTHER_PRIOR / (1 - ANOTHER_PRIOR))
    accused, noticed = (odds[own] < least).mean(), (odds[~own] < least).mean()
    figure("generated tables: own descriptions with fits below 0.5", accused, "share")
    figure("generated tables: wrong descriptions with fits below 0.5", noticed, "share")
    print(f"fits below 0.5 on {accused:.3f} of the right ones and on {noticed:.3f} of the wrong ones")
    if not images:
        return
    scores = np.zeros((len(images), 2))
    for test in folds(len(images), NUMBER_OF_FOLDS, seed):
        learned = [images[i].evidence for i in np.setdiff1d(np.arange(len(images)), test)]
        evidence = [one for pair in learned for one in pair]
        powers = likeliest_powers(evidence, np.tile([True, False], len(learned)))
        for i in test.tolist():
            scores[i] = [powers @ one.terms for one in images[i].evidence]
    print(f"photographs, cross-validated: {curve(scores[:, 0], scores[:, 1])}")
    fits = np.array([[one.fits for one in pair.found] for pair in images])
    print(f"photographs, by `fits`: {curve(fits[:, 0], fits[:, 1])}")
    facts = np.array([[one.facts for one in pair.evidence] for pair in images])
    print(f"photographs, likelihood ratio of the facts alone: {curve(facts[:, 0], facts[:, 1])}")


def _print_decided(images: list[PhotographPair]) -> None:
    """Print the decided matches of photographs with their own descriptions, and with others'."""
    described, decided, right = sum(len(pair.own.boxes) for pair in images), 0, 0
    others, of_kind, touched, unfit = 0, 0, 0, 0
    for pair in images:
        for i, p in decided_things(pair.found[0]).items():
            decided, right = decided + 1, right + (i == p)
        wrong = decided_things(pair.found[1])
        kinds, there = pair.other.description.kinds, pair.own.description.kinds
        others, touched = others + len(wrong), touched + bool(wrong)
        of_kind += sum(kinds[i] is not None and kinds[i] == there[p] for i, p in wrong.items())
        unfit += pair.found[1].fits < 0.5
    print(
        f"{len(images)} photographs, own description: {decided} of {described} objects decided "
        f"({decided / described:.3f}), {right} of them right"
    )
    print(
        f"another's description: {others} decided on {touched} photographs, {of_kind} of them of the kind that was "
        f"said; fits below 0.5 on {unfit}"
    )


def _print_rates(count: int, seed: int) -> None:
    """Print the share of ``fits`` below a half on full descriptions of 12 objects whose kinds are known."""
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
        shares_unfit = ", ".join(
            f"{name} {rate:.3f}"
            for name, rate in zip(("right", "one fact in five wrong", "shuffled places"), rates / count, strict=True)
        )
        print(f"{facts} facts: {shares_unfit}, {count} tables each", flush=True)


if __name__ == "__main__":
    main()
