"""Measure how reliable *decided* is for scenes that contradict their descriptions: decided and right matches per fault.

Generated tables of 11 objects, each fully described by 22 facts; the description states their kinds, or words alone.
Then a fault is made: three things have labels, stated as certain, that name other objects; the table is seen from the
other side, or in a mirror; its things are shuffled; two boxes are merged into one; two things are missed. A match is
right if the thing is the object; either of two merged things may be the merged box. Words alone cannot identify
shuffled things: their matches count as right at the described places. ``bench_fits.py`` measures how often such
descriptions are noticed. Intervals are Wilson's (1927), 95 per cent, as if matches of one table were independent.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from records import command_line, recorded, share
from scipy.stats import binomtest

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import GeneratedTable, generate
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.geometry.turning import turned
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import evidence_from
from deixis.reasoning.grounding.evidence.properties.labels import Label
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.grounding.hypotheses.hypotheses import AS_IT_STANDS, STATED_SIDES
from deixis.reasoning.grounding.matching.problem import UNMATCHED

OBJECTS, FACTS = 11, 22
Boxes = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FaultyScene:
    """The perceived boxes (n2, 2, 2), their labels, and the boxes that are right for each object."""

    boxes: Boxes
    truth: tuple[frozenset[int], ...]
    labels: tuple[Label | None, ...]


def untouched(table: GeneratedTable, rng: np.random.Generator) -> FaultyScene:
    """Return the table as it was laid."""
    return _scene(table.boxes, table.truth.tolist())


def labels_wrong(table: GeneratedTable, rng: np.random.Generator, certain: int = 3) -> FaultyScene:
    """Return the table with labels on three things that name three other objects."""
    rows = rng.permutation(len(table.truth))[:certain]
    labels: list[Label | None] = [None] * len(table.boxes)
    for row in rows.tolist():
        other = int(rng.choice(np.delete(np.arange(len(table.truth)), row)))
        labels[int(table.truth[row])] = Label(f"d{other:04}")
    return _scene(table.boxes, table.truth.tolist(), labels)


def other_side(table: GeneratedTable, rng: np.random.Generator) -> FaultyScene:
    """Return the table as seen from the opposite side."""
    return _scene(turned(table.boxes, math.pi), table.truth.tolist())


def mirrored(table: GeneratedTable, rng: np.random.Generator) -> FaultyScene:
    """Return the table with left and right exchanged."""
    return _scene(turned(table.boxes, 0.0, True), table.truth.tolist())


def shuffled(table: GeneratedTable, rng: np.random.Generator) -> FaultyScene:
    """Return the table with its things at each other's places."""
    return _scene(moved_to(table.boxes, rng.permutation(len(table.boxes))), table.truth.tolist())


def by_place(table: GeneratedTable, seen: FaultyScene) -> FaultyScene:
    """Return the scene with each object redefined as the thing at its place."""
    apart = np.linalg.norm(table.boxes.mean(axis=1)[:, None] - seen.boxes.mean(axis=1)[None], axis=2)
    return _scene(seen.boxes, apart.argmin(axis=1)[table.truth].tolist())


def moved_to(boxes: Boxes, places: NDArray[np.int64]) -> Boxes:
    """Return boxes (n, 2, 2) of the same sizes, each at the place of another (n,)."""
    centres, halves = boxes.mean(axis=1)[places], (boxes[:, 1] - boxes[:, 0]) / 2
    return np.stack([centres - halves, centres + halves], axis=1)


def merged(table: GeneratedTable, rng: np.random.Generator) -> FaultyScene:
    """Return the table with two neighbouring boxes seen as one."""
    first = int(rng.integers(len(table.boxes)))
    centres = table.boxes.mean(axis=1)
    apart = np.linalg.norm(centres - centres[first], axis=1)
    apart[first] = np.inf
    second = int(apart.argmin())
    low = np.minimum(table.boxes[first, 0], table.boxes[second, 0])
    high = np.maximum(table.boxes[first, 1], table.boxes[second, 1])
    boxes = table.boxes.copy()
    boxes[first] = np.stack([low, high])
    place = np.arange(len(boxes))
    place[second] = first
    place = np.where(place > second, place - 1, place)
    return _scene(np.delete(boxes, second, axis=0), [int(place[p]) for p in table.truth])


def missed(table: GeneratedTable, rng: np.random.Generator, count: int = 2) -> FaultyScene:
    """Return the table without two of its things."""
    gone = rng.permutation(len(table.boxes))[:count]
    place = np.full(len(table.boxes), UNMATCHED)
    kept = np.setdiff1d(np.arange(len(table.boxes)), gone)
    place[kept] = np.arange(len(kept))
    return _scene(table.boxes[kept], place[table.truth].tolist())


FAULTS: dict[str, Callable[[GeneratedTable, np.random.Generator], FaultyScene]] = {
    "untouched": untouched,
    "three labels wrong, said to be certain": labels_wrong,
    "seen from the other side": other_side,
    "mirrored": mirrored,
    "things at shuffled places": shuffled,
    "two boxes merged": merged,
    "two missed": missed,
}


def _scene(boxes: Boxes, truth: list[int], labels: list[Label | None] | None = None) -> FaultyScene:
    right = tuple(frozenset({p} - {UNMATCHED}) for p in truth)
    return FaultyScene(boxes, right, tuple(labels or [None] * len(boxes)))


def grounded(table: GeneratedTable, seen: FaultyScene, kinds: bool) -> Grounding:
    """Return the answer of the default engine."""
    ontology = default_ontology()
    scene = scene_relations([f"o{p:04}" for p in range(len(seen.boxes))], seen.boxes, ontology.relations)
    description = table.description(kinds=kinds)
    evidence = evidence_from(description, scene, seen.labels, ontology.kinds, ontology.sizes)
    return ground(evidence, engine_named("exact"), Deadline.after(30.0))


def decided_and_right(found: Grounding, seen: FaultyScene) -> tuple[int, int]:
    """Return the number of decided matches, and of right ones among them."""
    decided = {name: int(match.perceived[1:]) for name, match in found.matches.items() if match.decided}
    return len(decided), sum(p in seen.truth[int(name[1:])] for name, p in decided.items())


def interval(right: int, decided: int) -> str:
    """Return the right of the decided matches, with the 95 per cent interval of their share."""
    if not decided:
        return "none decided"
    bounds = binomtest(right, decided).proportion_ci(method="wilson")
    return f"{right} of {decided}, {bounds.low:.3f}-{bounds.high:.3f}"


def print_costs(seed: int, repeats: int = 5) -> None:
    """Print the processor time of a grounding in a warm process, with all sides and with one."""
    ontology = default_ontology()
    for objects, facts, known in ((7, 12, "labels"), (7, 12, "kinds"), (12, 24, "labels"), (12, 24, "kinds")):
        taken = np.zeros((repeats, 2))
        for number in range(-1, repeats):  # the first one warms up
            table = generate(objects, facts / objects, 0.0, seed=1000 * seed + number + 1)
            labels: list[Label | None] = [None] * len(table.boxes)
            for i, p in enumerate(table.truth.tolist() if known == "labels" else []):
                labels[p] = Label(f"d{i:04}")
            description, scene = table.description(kinds=True), table.scene()
            for place, sides in enumerate((STATED_SIDES, AS_IT_STANDS)):
                started = time.process_time()
                evidence = evidence_from(description, scene, labels, ontology.kinds, ontology.sizes)
                ground(evidence, engine_named("exact", sides=sides), Deadline.after(30.0))
                taken[max(number, 0), place] = time.process_time() - started
        all_sides, one = 1000 * np.median(taken, axis=0)
        print(f"{objects} objects, {facts} facts, {known}: {all_sides:.0f} processor ms, {one:.0f} with one side")


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--tables", type=int, default=36, help="tables for each fault")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cost", action="store_true", help="print only the processor time of groundings")
    with recorded(parser) as options:
        if options.cost:
            print_costs(options.seed)
            return
        print(f"{options.tables} tables of {OBJECTS} objects, {FACTS} facts: right of decided matches")
        print(f"{'fault':<40}{'kinds':<44}words alone")
        for name, fault in FAULTS.items():
            columns = []
            for kinds in (True, False):
                counts = np.zeros(2, dtype=int)
                for number in range(options.tables):
                    table = generate(OBJECTS, FACTS / OBJECTS, 0.0, seed=1000 * options.seed + number)
                    seen = fault(table, np.random.default_rng([options.seed, number]))
                    if fault is shuffled and not kinds:
                        seen = by_place(table, seen)
                    counts += decided_and_right(grounded(table, seen, kinds), seen)
                decided = counts[0] / (OBJECTS * options.tables)
                what = f"{name}, {'kinds known' if kinds else 'words alone'}"
                share(f"{what}: decided matches that are right", int(counts[1]), int(counts[0]))
                share(f"{what}: objects decided", int(counts[0]), OBJECTS * options.tables)
                columns.append(f"{interval(int(counts[1]), int(counts[0]))} ({decided:.2f} decided)")
            print(f"{name:<40}{columns[0]:<44}{columns[1]}", flush=True)


if __name__ == "__main__":
    main()
