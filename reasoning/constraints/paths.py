"""Explanations of an order of two points: the path of orders with the fewest premises, or the smallest cycle.

If all bounds are 0, so that the constraints are orders, an order is implied exactly if there is a path for it, and the
orders are inconsistent exactly if a cycle contains a strict one. Explanations need only the stated orders, not the
implied ones. The searches are breadth first, one premise per step, from any of thousands of points.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

_KEPT_TREES = 24


@dataclass(frozen=True, eq=False)
class OrderGraph:
    """Points and the orders between them as rows of edges, from each point to the points that are not before it."""

    first: NDArray[np.int64]  # (points + 1,)
    heads: NDArray[np.int64]
    strict: NDArray[np.bool_]
    premise: NDArray[np.int64]  # the caller's number of the premise of each order; -1 for none

    @classmethod
    def of(
        cls,
        points: int,
        tails: NDArray[np.int64],
        heads: NDArray[np.int64],
        strict: NDArray[np.bool_],
        premise: NDArray[np.int64],
    ) -> OrderGraph:
        """Return the graph of edges in any order.

        Parameters
        ----------
        points
            Number of points.
        tails, heads
            Points of each edge, shape (k,).
        strict
            True for strict orders, shape (k,).
        premise
            Number of the premise of each edge, shape (k,).

        Returns
        -------
        OrderGraph
            The graph.
        """
        from deixis.reasoning.constraints.path_kernels import rows_of

        first, order = rows_of(tails, points)
        return cls(first, heads[order], strict[order], premise[order])

    @cached_property
    def _tails(self) -> NDArray[np.int64]:
        return np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))

    @cached_property
    def parts(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Strongly connected component of each point, and the points by component, last ones first."""
        from deixis.reasoning.constraints.path_kernels import strong_parts

        part, members = strong_parts(self.first, self.heads)
        return part, members

    @cached_property
    def contradictory(self) -> bool:
        """True if a cycle of orders contains a strict one."""
        from deixis.reasoning.constraints.path_kernels import strict_within

        return bool(strict_within(self.first, self.heads, self.strict, self.parts[0]) >= 0)

    @property
    def is_single_cycle(self) -> bool:
        """True if the edges between points that must be equal form one cycle, which removing any edge opens."""
        part = self.parts[0]
        inside = part[self._tails] == part[self.heads]
        large = np.flatnonzero(np.bincount(part) > 1)
        return len(large) == 1 and int(inside.sum()) == int((part == large[0]).sum())

    def reversed(self) -> OrderGraph:
        """Return the graph with every edge reversed.

        Returns
        -------
        OrderGraph
            The graph.
        """
        return OrderGraph.of(len(self.first) - 1, self.heads, self._tails, self.strict, self.premise)

    def shortest_cycle(self) -> tuple[int, ...] | None:
        """Return the premises of the contradiction with the fewest premises, or None if the orders are consistent.

        Returns
        -------
        tuple of int or None
            The premises, or None if the orders are consistent.
        """
        from deixis.reasoning.constraints.path_kernels import shortest_strict_cycle

        if not self.contradictory:
            return None
        edges = shortest_strict_cycle(self.first, self.heads, self.strict, self.premise, self.parts[0])
        return tuple(dict.fromkeys(premise for premise in self.premise[edges].tolist() if premise >= 0))


@dataclass(frozen=True, eq=False)
class _Tree:
    """The states that a search reached, ascending, with their costs and the states and premises before them.

    A state is twice a point, plus 1 if the path has passed a strict edge.
    """

    states: NDArray[np.int64]
    cost: NDArray[np.int64]
    before: NDArray[np.int64]
    premise: NDArray[np.int64]

    def find(self, state: int) -> int:
        """Return the position of a state, or -1 if it was not reached."""
        place = int(np.searchsorted(self.states, state))
        return place if place < len(self.states) and self.states[place] == state else -1

    def way(self, target: int, strict: bool) -> tuple[int, ...] | None:
        """Return the premises on the path from the root to a point, no two equal in a row; None if there is no path."""
        found = [self.find(2 * target + passed) for passed in ((1,) if strict else (0, 1))]
        place = min((place for place in found if place >= 0), key=lambda place: int(self.cost[place]), default=-1)
        if place < 0:
            return None
        premises: list[int] = []
        while self.before[place] >= 0:
            premise = int(self.premise[place])
            if premise >= 0 and (not premises or premises[-1] != premise):
                premises.append(premise)
            place = self.find(int(self.before[place]))
        return tuple(reversed(premises))


class ShortestPaths:
    """Shortest explanations over a graph; recent searches are cached by their root.

    ``backwards`` searches against the edges, so that one search explains all that is before a point.
    """

    def __init__(self, graph: OrderGraph) -> None:
        self.graph = graph
        self._trees: OrderedDict[tuple[int, bool], _Tree] = OrderedDict()

    @cached_property
    def reverse(self) -> OrderGraph:
        """Graph with every edge reversed."""
        return self.graph.reversed()

    def path(self, root: int, target: int, strict: bool, backwards: bool = False) -> tuple[int, ...] | None:
        """Return the fewest premises for the order of two points.

        Parameters
        ----------
        root
            The first point.
        target
            The second point, which is not before the first.
        strict
            True if it is after the first.
        backwards
            True to exchange the two.

        Returns
        -------
        tuple of int or None
            The premises, or None if the order is not implied.
        """
        return self._tree(root, backwards).way(target, strict)

    def costs(self, root: int, targets: NDArray[np.int64], strict: bool, backwards: bool = False) -> NDArray[np.int64]:
        """Return the number of premises of the paths to some points.

        Parameters
        ----------
        root
            Start of the paths.
        targets
            Their ends, shape (k,).
        strict
            True for paths with a strict edge.
        backwards
            True to follow edges from head to tail.

        Returns
        -------
        ndarray
            Numbers of shape (k,); ``FAR`` for points without a path.
        """
        from deixis.reasoning.constraints.path_kernels import FAR

        tree = self._tree(root, backwards)
        found = np.full(len(targets), FAR)
        for passed in (1,) if strict else (0, 1):
            place = np.minimum(np.searchsorted(tree.states, 2 * targets + passed), len(tree.states) - 1)
            there = tree.states[place] == 2 * targets + passed
            found = np.where(there, np.minimum(found, tree.cost[place]), found)
        return found

    @cached_property
    def _scratch(self) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        from deixis.reasoning.constraints.path_kernels import FAR

        states = 2 * (len(self.graph.first) - 1)
        queue = np.empty(2 * (2 * states + 2), np.int64)
        return np.full(states, FAR), np.empty(states, np.int64), np.empty(states, np.int64), queue

    def _tree(self, root: int, backwards: bool) -> _Tree:
        key = (root, backwards)
        if key in self._trees:
            self._trees.move_to_end(key)
            return self._trees[key]
        from deixis.reasoning.constraints.path_kernels import FAR, fewest

        graph = self.reverse if backwards else self.graph
        cost, before, by, queue = self._scratch
        edges = (graph.first, graph.heads, graph.strict, graph.premise)
        reached = np.sort(queue[: fewest(*edges, root, -1, FAR, cost, before, by, queue)])
        states = reached[np.diff(reached, prepend=-1) > 0]
        led = before[states] >= 0
        premise = np.full(len(states), -1)
        premise[led] = graph.premise[by[states[led]]]
        tree = self._trees[key] = _Tree(states, cost[states], before[states], premise)
        cost[states] = FAR
        if len(self._trees) > _KEPT_TREES:
            self._trees.popitem(last=False)
        return tree
