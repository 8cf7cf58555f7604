"""Difference constraints on two axes: what they imply of every two points, and which of them exclude each other.

A constraint bounds ``x[head] - x[tail]`` from above, by a whole number. Constraints have a solution where no cycle of
them has a negative sum (Bellman 1958), and then the shortest paths are all that follows from them (a simple temporal
network: Dechter, Meiri and Pearl 1991). All paths are kept, updated as a constraint is added, and taken back in
reverse order; the last constraint of each path is kept too, so that what follows can be explained.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FREE = np.int64(2**60)
"""The distance between points that are not related; half of it and more counts as that."""


class Difference(NamedTuple):
    """``x[head] - x[tail] <= bound`` on one axis."""

    axis: int
    tail: int
    head: int
    bound: int


class _Change(NamedTuple):
    axis: int
    cells: NDArray[np.int64]
    distances: NDArray[np.int64]
    last: NDArray[np.int32]


class Differences:
    """Constraints on ``points`` whole numbers on each of two axes, always with a solution.

    ``distances`` (2, points, points) are the least upper bounds of ``x[column] - x[row]`` that follow.
    """

    def __init__(self, points: int) -> None:
        self.distances = np.full((2, points, points), FREE, dtype=np.int64)
        self.distances[:, np.arange(points), np.arange(points)] = 0
        self._last = np.full((2, points, points), -1, dtype=np.int32)
        self._added: list[tuple[Difference, int]] = []
        self._changes: list[_Change | None] = []
        self._kept = 0

    def __len__(self) -> int:
        """How many constraints were added; :meth:`back` goes back to such a number."""
        return len(self._changes)

    def add(self, constraint: Difference, reason: int) -> set[int] | None:
        """Adds a constraint for a reason; None, or where it closes a negative cycle (and is not added) the reasons of
        the others on it."""
        axis, tail, head, bound = constraint
        distances = self.distances[axis]
        if distances[head, tail] + bound < 0:
            return self.why(axis, head, tail)
        self._added.append((constraint, reason))
        if distances[tail, head] <= bound:
            self._changes.append(None)
            return None
        from deixis.reasoning.entailment.realisation.kernels import tighten

        number = len(self._added) - 1
        free = int(FREE) // 2
        self._changes.append(_Change(axis, *tighten(distances, self._last[axis], tail, head, bound, number, free)))
        return None

    def keep(self) -> None:
        """Forgets how to take back what was added so far: it must not be gone back beyond this."""
        self._changes[self._kept :] = [None] * (len(self._changes) - self._kept)
        self._kept = len(self._changes)

    def back(self, length: int) -> None:
        """Takes back the constraints added last, until ``length`` are left."""
        while len(self._changes) > length:
            change = self._changes.pop()
            self._added.pop()
            if change is not None:
                self.distances[change.axis].reshape(-1)[change.cells] = change.distances
                self._last[change.axis].reshape(-1)[change.cells] = change.last

    def why(self, axis: int, tail: int, head: int) -> set[int]:
        """The reasons of the constraints on the shortest path from ``tail`` to ``head``."""
        found: set[int] = set()
        while head != tail:
            constraint, reason = self._added[self._last[axis, tail, head]]
            found.add(reason)
            head = constraint.tail
        return found

    def constraints(self) -> list[Difference]:
        """All that were added, in their order."""
        return [constraint for constraint, _ in self._added]

    def nearest(self, wanted: NDArray[np.int64]) -> NDArray[np.int64]:
        """A solution near the wanted numbers (2, points), and equal to them where they are one.

        Each number is lowered as far as the others demand: the result is the greatest solution below ``wanted``.
        """
        return np.stack([(wanted[axis][:, None] + self.distances[axis]).min(axis=0) for axis in (0, 1)])
