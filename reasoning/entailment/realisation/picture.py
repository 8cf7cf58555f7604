"""Turn facts into a picture: decide whether the firm facts can hold, fit in the others, and lay out the boxes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.things.sizes import SizeRange
from deixis.reasoning.constraints.difference import DifferenceNetwork
from deixis.reasoning.constraints.minimal import Minimal
from deixis.reasoning.entailment.realisation.composition import Wishes, compose, in_line, within
from deixis.reasoning.entailment.realisation.demands import (
    About,
    Demand,
    apart_demand,
    fact_demands,
    high,
    is_firm,
    low,
    name_demands,
    proper_boxes,
    size_demands,
)
from deixis.reasoning.entailment.realisation.relaxation import Dropped, Relaxed, minimised, relaxed, satisfy
from deixis.reasoning.entailment.realisation.things import Things, things_of
from deixis.reasoning.entailment.realisation.verification import (
    facts_that_are_named,
    facts_that_hold,
    partly_overlapping,
)
from deixis.reasoning.errors import LimitError
from deixis.reasoning.geometry.overlap import overlapping

ROUNDS = 25
"""Maximum number of rounds of moving overlapping objects apart."""


MAX_PICTURED = 500
"""Maximum number of objects in a picture; memory grows with its square, time a little faster."""


@dataclass(frozen=True)
class GivenUp:
    """A fact that is not firm and does not hold, by its edge.

    ``because`` has the edges of the facts, and ``sizes`` the objects whose sizes, that exclude it. Both are empty if
    it was only not found to fit.
    """

    edge: int
    because: tuple[int, ...]
    sizes: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Picture:
    """A box for every object, and the facts that it does not satisfy.

    ``boxes`` (n, 2, 2) are minimum and maximum corners in metres, x to the right, y away from the viewer; they are
    checked to satisfy every firm fact. ``overlapping`` are pairs that overlap in part. ``named_otherwise`` are denials
    that hold by the atoms of such a pair, but not by its exact relation. ``finished`` is False if the time ran out
    before all preferences were tried.
    """

    boxes: NDArray[np.float64]
    given_up: tuple[GivenUp, ...]
    overlapping: tuple[tuple[int, int], ...]
    named_otherwise: tuple[int, ...]
    finished: bool


@dataclass(frozen=True)
class Impossible:
    """The proof that there is no picture: the edges of firm facts, and objects whose sizes are incompatible with them.

    Without sizes, no table with objects of any size satisfies the facts. ``minimal`` is True if leaving out any one of
    the facts and sizes was found to make a picture possible.
    """

    edges: tuple[int, ...]
    sizes: tuple[int, ...]
    minimal: bool


@dataclass(frozen=True)
class Undecided:
    """The answer if time runs out before a picture is found or proved impossible."""


def realise(
    graph: RelationGraph,
    sizes: Sequence[SizeRange],
    *,
    lying: Sequence[bool] | None = None,
    any_size: bool = False,
    deadline: Deadline = Deadline.never(),
    rng: np.random.Generator | None = None,
) -> Picture | Impossible | Undecided:
    """Find boxes that satisfy every firm fact of a graph in its reading, or prove that no such boxes exist.

    Parameters
    ----------
    graph
        The facts. Optional and hedged facts hold if possible, the heavier ones first.
    sizes
        One size range per node.
    lying
        Whether each object preferably lies along x.
    any_size
        Treat the sizes as preferences only.
    deadline
        Time limit; the answer comes soon after it at the latest.
    rng
        Generator of sizes, gaps and arrangements. Without it, the picture is always the same.

    Returns
    -------
    Picture, Impossible or Undecided
        The boxes; or the facts that allow none; or the reason why neither was found.

    Raises
    ------
    LimitError
        If there are more than ``MAX_PICTURED`` objects, since the memory grows with their square.
    """
    if len(graph.nodes) > MAX_PICTURED:
        raise LimitError(
            f"a picture must have at most {MAX_PICTURED} objects, got {len(graph.nodes)}; describe the table in parts"
        )
    things = things_of(sizes, lying if lying is not None else [False] * len(graph.nodes), rng)
    task = _Task(graph, things, any_size, rng)
    impossible = task.impossible(deadline)
    return task.picture(deadline) if impossible is None else impossible


class _Task:
    def __init__(self, graph: RelationGraph, things: Things, any_size: bool, rng: np.random.Generator | None) -> None:
        self.graph, self.things, self.rng = graph, things, rng
        self.points = 2 * len(graph.nodes)
        self.base = proper_boxes(len(graph.nodes))
        facts = fact_demands(graph)
        self.firm = [d for d in facts if is_firm(graph.fact(d.key[0]))]
        self.soft = sorted((d for d in facts if not is_firm(graph.fact(d.key[0]))), key=lambda d: -d.weight)
        self.sizes = () if any_size else size_demands(things)
        self.gap = 12.0 if rng is None else float(rng.uniform(8, 25))

    def impossible(self, deadline: Deadline) -> Impossible | Undecided | None:
        """Return the proof that there is no picture, or None if there is one, or Undecided at the deadline.

        The proof is for objects of any size if possible, else for usual sizes.
        """
        found = satisfy(self.points, self.base, [*self.firm, *self.sizes], deadline)
        if found is None:
            return Undecided()
        if isinstance(found, DifferenceNetwork):
            self.solved = found
            return None
        if any(demand.about is About.SIZE for demand in found):
            without = satisfy(self.points, self.base, self.firm, deadline)
            found = without if isinstance(without, tuple) else found
        return _impossible(minimised(self.points, self.base, found, deadline))

    def picture(self, deadline: Deadline) -> Picture:
        """Return boxes, improved in rounds that move overlapping boxes apart and arrange all boxes again."""
        named = name_demands(self.graph, [d.key[0] for d in self.firm])
        best = self._liked([*self.soft, *named], deadline)
        soft, apart = [d for d in best.kept if d.about is not About.APART], list[Demand]()
        edges, finished = self._composed(best, apart, deadline), best.finished
        dropped = list(best.dropped)
        for _ in range(ROUNDS):
            # move overlapping boxes apart, except stacked ones and those tried before
            known = {d.key for d in apart}
            new = []
            for a, b in np.argwhere(np.triu(overlapping(_boxes(edges)), 1)).tolist():
                nested = any(all(within(best.network, k, i, o) for k in (0, 1)) for i, o in ((a, b), (b, a)))
                if not nested and (a, b) not in known:
                    noise = np.zeros(4) if self.rng is None else self.rng.uniform(0, 60, 4)
                    new.append(apart_demand(a, b, edges, noise))
            if not new or not finished:
                break
            apart += new
            given_up = {d.demand.key for d in dropped}
            closer = self._relaxed([*soft, *(d for d in apart if d.key not in given_up)], deadline)
            if closer is None:
                finished = False
                break
            best = closer
            dropped += closer.dropped
            edges, finished = self._composed(best, apart, deadline), closer.finished and not deadline.passed
        return self._checked(edges, dropped, finished)

    def _liked(self, soft: Sequence[Demand], deadline: Deadline) -> Relaxed:
        """Return the soft demands that hold, or only the firm demands if there are no soft ones or no time."""
        found = self._relaxed(soft, deadline) if soft else Relaxed(self.solved, (), ())
        return Relaxed(self.solved, (), (), finished=False) if found is None else found

    def _relaxed(self, soft: Sequence[Demand], deadline: Deadline) -> Relaxed | None:
        found = relaxed(self.points, self.base, [*self.firm, *self.sizes], soft, deadline)
        if isinstance(found, tuple):
            raise AssertionError("the firm demands were satisfiable before, and no longer are")
        return found

    def _composed(self, best: Relaxed, apart: Sequence[Demand], deadline: Deadline) -> NDArray[np.int64]:
        network = best.network
        kept = {demand.key[0] for demand in (*self.firm, *best.kept) if demand.about is About.FACT}
        related = [
            (int(self.graph.subjects[edge]), int(self.graph.objects[edge]))
            for edge in sorted(kept)
            if self.graph.positive[edge]
        ]
        # objects with their length along y: as chosen, or else as preferred
        lengthwise = np.ones(len(self.things), dtype=np.bool_)
        for thing in range(len(self.things)):
            tall = -(network.distances[:, high(thing), low(thing)] >> 1)  # the least sides that follow
            least = self.things.least[thing]
            rather = not self.things.lying[thing]
            if not self.sizes or least[0] == least[1]:
                lengthwise[thing] = rather
            else:
                lengthwise[thing] = tall[1] >= least[0] if rather else not tall[0] >= least[0]
        wishes = Wishes(
            things=self.things,
            lengthwise=lengthwise,
            related=in_line(related),
            apart=tuple((d.key[0], d.key[1]) for d in apart),
            gap=self.gap,
        )
        return compose(network, wishes, deadline)

    def _checked(self, edges: NDArray[np.int64], dropped: Sequence[Dropped], finished: bool) -> Picture:
        """Return the picture after checking every fact."""
        boxes = _boxes(edges - edges.min(axis=1, keepdims=True) if self.points else edges) / 1000.0
        held, named = facts_that_hold(self.graph, boxes), facts_that_are_named(self.graph, boxes)
        wrong = [d.key[0] for d in self.firm if not held[d.key[0]]]
        if wrong or (boxes[:, 1] <= boxes[:, 0]).any():
            raise AssertionError(f"the picture breaks the facts {[str(self.graph.fact(edge)) for edge in wrong]}")
        reasons = {d.demand.key: d.because for d in dropped if d.demand.about is About.FACT}
        given_up = tuple(GivenUp(d.key[0], *_keys(reasons.get(d.key, ()))) for d in self.soft if not held[d.key[0]])
        overlapping = np.argwhere(np.triu(partly_overlapping(boxes), 1)).tolist()
        firm = [d.key[0] for d in self.firm]
        return Picture(
            boxes=boxes,
            given_up=given_up,
            overlapping=tuple((a, b) for a, b in overlapping),
            named_otherwise=tuple(edge for edge in firm if not named[edge]),
            finished=finished,
        )


def _boxes(edges: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return edges (2, 2 n) as corners (n, 2, 2)."""
    return np.moveaxis(edges.reshape(2, -1, 2), 0, 2)


def _keys(demands: Sequence[Demand]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Return the edges of the facts and the objects of the sizes among the demands."""
    edges = sorted(d.key[0] for d in demands if d.about is About.FACT)
    return tuple(edges), tuple(sorted(d.key[0] for d in demands if d.about is About.SIZE))


def _impossible(found: Minimal[Demand]) -> Impossible:
    edges, sizes = _keys(found.items)
    return Impossible(edges, sizes, found.proved)
