"""Why an order of two points holds: the path of orders with the fewest premises, or the smallest cycle of them.

Where all bounds are 0, so that constraints are mere orders, an order holds in every solution where a path says so, and
the orders contradict each other where a cycle has a strict one among them. Explanations need the stated orders only,
not what follows from them: searches go breadth first, a premise a step, from any of thousands of points.
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
    """Points and the orders between them as rows of edges: from each point to those that lie not before it."""

    first: NDArray[np.int64]  # (points + 1,)
    heads: NDArray[np.int64]
    strict: NDArray[np.bool_]
    premise: NDArray[np.int64]  # what each order comes from, as a number of the caller's; -1: from nothing

    @classmethod
    def of(
        cls,
        points: int,
        tails: NDArray[np.int64],
        heads: NDArray[np.int64],
        strict: NDArray[np.bool_],
        premise: NDArray[np.int64],
    ) -> OrderGraph:
        """Return the graph of edges in any order."""
        from deixis.reasoning.constraints.path_kernels import rows_of

        first, order = rows_of(tails, points)
        return cls(first, heads[order], strict[order], premise[order])

    @cached_property
    def _tails(self) -> NDArray[np.int64]:
        return np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))

    @cached_property
    def parts(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """The strongly connected part of each point, and the points in the order of their parts, last ones first."""
        from deixis.reasoning.constraints.path_kernels import strong_parts

        part, members = strong_parts(self.first, self.heads)
        return part, members

    @cached_property
    def contradictory(self) -> bool:
        """Whether some orders go round in a cycle with a strict one among them."""
        from deixis.reasoning.constraints.path_kernels import strict_within

        return bool(strict_within(self.first, self.heads, self.strict, self.parts[0]) >= 0)

    @property
    def is_single_cycle(self) -> bool:
        """Whether the edges between points that are forced to be equal are one cycle, which any one edge opens."""
        part = self.parts[0]
        inside = part[self._tails] == part[self.heads]
        large = np.flatnonzero(np.bincount(part) > 1)
        return len(large) == 1 and int(inside.sum()) == int((part == large[0]).sum())

    def reversed(self) -> OrderGraph:
        """Return the same graph with every edge turned round."""
        return OrderGraph.of(len(self.first) - 1, self.heads, self._tails, self.strict, self.premise)

    def shortest_cycle(self) -> tuple[int, ...] | None:
        """Return the premises of the contradiction that takes the fewest; None where the orders agree."""
        from deixis.reasoning.constraints.path_kernels import shortest_circle

        if not self.contradictory:
            return None
        edges = shortest_circle(self.first, self.heads, self.strict, self.premise, self.parts[0])
        return tuple(dict.fromkeys(premise for premise in self.premise[edges].tolist() if premise >= 0))


@dataclass(frozen=True, eq=False)
class _Tree:
    """The states that a search reached, ascending, with their costs and the states and premises that led there.

    A state is twice a point, plus 1 where a strict edge has been passed.
    """

    states: NDArray[np.int64]
    cost: NDArray[np.int64]
    before: NDArray[np.int64]
    premise: NDArray[np.int64]

    def find(self, state: int) -> int:
        """Return the position of a state, or -1 where it was not reached."""
        place = int(np.searchsorted(self.states, state))
        return place if place < len(self.states) and self.states[place] == state else -1

    def way(self, target: int, strict: bool) -> tuple[int, ...] | None:
        """Return the premises from the root to a point, each once where it comes twice in a row; None without a way."""
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
    """Shortest explanations over a graph; the searches from a point are kept as long as they are likely to be used.

    ``backwards`` goes against the edges, so that one search explains what lies before a point.
    """

    def __init__(self, graph: OrderGraph) -> None:
        self.graph = graph
        self._trees: OrderedDict[tuple[int, bool], _Tree] = OrderedDict()

    @cached_property
    def reverse(self) -> OrderGraph:
        """The graph with every edge turned round."""
        return self.graph.reversed()

    def path(self, root: int, target: int, strict: bool, backwards: bool = False) -> tuple[int, ...] | None:
        """Return the fewest premises by which the target is not before the root, or after it; None where it is not."""
        return self._tree(root, backwards).way(target, strict)

    def costs(self, root: int, targets: NDArray[np.int64], strict: bool, backwards: bool = False) -> NDArray[np.int64]:
        """Return how many premises those paths take to each of some points, ``FAR`` where there is none."""
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
