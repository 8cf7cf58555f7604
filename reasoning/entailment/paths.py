"""Why a bound between two edges holds: the path of bounds with the fewest facts, or the smallest circle of them.

Every fact gives some edges of a graph of points; an object's own edges cost nothing. A bound that holds in every
picture is a path there (:mod:`deixis.reasoning.entailment.closed`), and a contradiction a circle with a strict step.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.entailment.bounds import Bound, Bounds
from deixis.reasoning.entailment.closed import PointGraph, point_graph

Path = tuple[int, ...]
"""Premises in the order in which they lead from the subject of a bound to its object, or the other way round."""

_KEPT_TREES = 24


@dataclass(frozen=True, eq=False)
class _Tree:
    """The states that a search reached, ascending, with their costs and the states and premises that led there."""

    states: NDArray[np.int64]
    cost: NDArray[np.int64]
    before: NDArray[np.int64]
    premise: NDArray[np.int64]

    def find(self, state: int) -> int:
        """The position of a state, or -1 where it was not reached."""
        place = int(np.searchsorted(self.states, state))
        return place if place < len(self.states) and self.states[place] == state else -1

    def best(self, point: int, strict: bool) -> int:
        """The position of the cheaper of a point's states; only the strict one counts where that is asked for."""
        found = [self.find(2 * point + passed) for passed in ((1,) if strict else (0, 1))]
        there = [place for place in found if place >= 0]
        return min(there, key=lambda place: int(self.cost[place]), default=-1)

    def costs(self, points: NDArray[np.int64], strict: bool) -> NDArray[np.int64]:
        """The cost of each point's cheaper state, or of its strict one; ``FAR`` where that was not reached."""
        from deixis.reasoning.entailment.path_kernels import FAR

        found = np.full(len(points), FAR)
        for passed in (1,) if strict else (0, 1):
            place = np.minimum(np.searchsorted(self.states, 2 * points + passed), len(self.states) - 1)
            there = self.states[place] == 2 * points + passed
            found = np.where(there, np.minimum(found, self.cost[place]), found)
        return found

    def way(self, place: int) -> list[int]:
        """The premises from a state back to the root, each once where it comes twice in a row."""
        premises: list[int] = []
        while self.before[place] >= 0:
            premise = int(self.premise[place])
            if premise >= 0 and (not premises or premises[-1] != premise):
                premises.append(premise)
            place = self.find(int(self.before[place]))
        return premises


class OrderPaths:
    """Shortest explanations over the bounds of n objects; searches are kept as long as they are likely to be used."""

    def __init__(self, bounds: Bounds, n: int) -> None:
        self._bounds = bounds
        self._n = n
        self._trees: OrderedDict[tuple[int, bool], _Tree] = OrderedDict()

    def prepare(self) -> None:
        """Builds both graphs, which the first search does otherwise."""
        assert self._onward.size == self._back.size

    @cached_property
    def _onward(self) -> PointGraph:
        return point_graph(self._bounds, self._n)

    @cached_property
    def _back(self) -> PointGraph:
        """The same graph with every edge turned round."""
        from deixis.reasoning.entailment.kernels import rows_of

        graph = self._onward
        tails = np.repeat(np.arange(len(graph.first) - 1), np.diff(graph.first))
        first, order = rows_of(graph.heads, len(graph.first) - 1)
        return PointGraph(graph.size, first, tails[order], graph.strict[order], graph.premise[order])

    @cached_property
    def _scratch(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        from deixis.reasoning.entailment.path_kernels import FAR

        states = 2 * (len(self._onward.first) - 1)
        queue = np.empty(2 * (2 * states + 2), np.int64)
        return np.full(states, FAR), np.empty(states, np.int64), np.empty(states, np.int64), queue

    def path(self, bound: Bound, subject: int, object: int) -> Path | None:
        """The premises that lead from subject to object with the fewest facts; None where the bound does not follow."""
        tree, place = self._reach(bound, subject, object)
        return None if place < 0 else tuple(reversed(tree.way(place)))

    def costs(self, bound: Bound, subject: int, objects: NDArray[np.int64]) -> NDArray[np.int64]:
        """How many facts those paths take from a subject to each of some objects, ``FAR`` where there is none."""
        points = (2 * bound.axis + (bound.head_side if bound.tail == 0 else bound.tail_side)) * self._n + objects
        tree, _ = self._reach(bound, subject, subject)
        return tree.costs(points, bound.strict)

    def _reach(self, bound: Bound, subject: int, object: int) -> tuple[_Tree, int]:
        """The search from the subject's edge, and where in it the object's edge is; -1 where it was not reached."""
        tail, head = bound.points(subject, object, self._n)
        onward = bound.tail == 0
        root, target = (tail, head) if onward else (head, tail)
        tree = self._tree(root, onward)
        return tree, tree.best(target, bound.strict)

    def _tree(self, root: int, onward: bool) -> _Tree:
        key = (root, onward)
        if key in self._trees:
            self._trees.move_to_end(key)
            return self._trees[key]
        tree = self._search(root, self._onward if onward else self._back)
        self._trees[key] = tree
        if len(self._trees) > _KEPT_TREES:
            self._trees.popitem(last=False)
        return tree

    def _search(self, root: int, graph: PointGraph) -> _Tree:
        from deixis.reasoning.entailment.path_kernels import FAR, search

        cost, before, by, queue = self._scratch
        edges = (graph.first, graph.heads, graph.strict, graph.premise)
        reached = search(*edges, root, -1, FAR, cost, before, by, queue)
        states = np.unique(queue[:reached])
        tree = _Tree(states, cost[states], before[states], self._premises(graph, by, before, states))
        cost[states] = FAR
        return tree

    @staticmethod
    def _premises(
        graph: PointGraph, by: NDArray[np.int64], before: NDArray[np.int64], states: NDArray[np.int64]
    ) -> NDArray[np.int64]:
        edges = np.where(before[states] >= 0, by[states], 0)
        return np.where(before[states] >= 0, graph.premise[edges], -1) if len(graph.premise) else edges

    def circle(self) -> Path | None:
        """The premises of the contradiction that takes the fewest facts; None where the bounds agree."""
        from deixis.reasoning.entailment.kernels import strict_within, strong_parts
        from deixis.reasoning.entailment.path_kernels import shortest_circle

        graph = self._onward
        part, _ = strong_parts(graph.first, graph.heads)
        if strict_within(graph.first, graph.heads, graph.strict, part) < 0:
            return None
        edges = shortest_circle(graph.first, graph.heads, graph.strict, graph.premise, part)
        return tuple(dict.fromkeys(premise for premise in graph.premise[edges].tolist() if premise >= 0))
