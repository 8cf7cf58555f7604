"""Difference constraints: the tightest bounds between all points, conflicts among the constraints, and explanations.

A constraint bounds ``x[head] - x[tail]`` from above. Constraints have a solution unless a cycle of them has a negative
sum (Bellman 1958), and the shortest paths are all that they imply: a simple temporal network (Dechter, Meiri and Pearl
1991). All shortest distances are kept. Adding a constraint takes time proportional to the number of distances that
change; constraints are taken back in reverse order.

A bound *x <= b* or *x < b* is one integer, its *code*: ``2 * b + 1`` or ``2 * b``, so that the smaller code is the
tighter bound, and the sum of two bounds is strict if either is. Timed automata store difference bound matrices in this
way (Bengtsson and Yi 2004); it needs no epsilon. Times are codes in microseconds, places codes in millimetres, and
orders of edges codes of 0, for which one byte per distance is enough.

Orders of the edges of thousands of objects have their own closure, :mod:`deixis.reasoning.entailment.closed`, which
needs only reachability, one bit per pair of points. In bits, a chain of 5,000 objects is closed in 0.1 s; with one byte
per pair, its 10,000 points take 2.8 s and 100 MB on each axis. Facts that leave a choice use this engine for the
objects connected with the choice; with 100 objects it is as fast as a search over bits.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

UNBOUNDED = 1 << 62
"""The code of no bound, for distances of 64 bits."""

ZERO, STRICT = 1, 0
"""The codes of *x <= 0* and of *x < 0*."""

ORDERS = np.dtype(np.int8)
"""The type of distances whose codes are only ZERO and STRICT."""


class Difference(NamedTuple):
    """The constraint that ``x[head] - x[tail]`` on one axis is at most, or less than, the bound with this code."""

    axis: int
    tail: int
    head: int
    code: int

    def denied(self) -> Difference:
        """Return the negation: ``x[tail] - x[head]`` is less than, or at most, the negated bound.

        Returns
        -------
        Difference
            The negation.
        """
        return Difference(self.axis, self.head, self.tail, 1 - self.code)


def add(a: int, b: int) -> int:
    """Return the code of a sum of bounds: *x <= a* and *y < b* give *x + y < a + b*.

    Parameters
    ----------
    a, b
        Codes of bounds.

    Returns
    -------
    int
        The code of the sum.
    """
    if a >= UNBOUNDED or b >= UNBOUNDED:
        return UNBOUNDED
    return (a & ~1) + (b & ~1) | (a & b & 1)


def add_arrays(a: NDArray[np.int64], b: NDArray[np.int64] | int) -> NDArray[np.int64]:
    """Return the codes of sums of bounds.

    Parameters
    ----------
    a, b
        Codes of bounds, arrays that broadcast.

    Returns
    -------
    ndarray
        Codes of the broadcast shape.
    """
    b = np.asarray(b, dtype=np.int64)
    total = (a & ~1) + (b & ~1) | (a & b & 1)
    return np.where((a >= UNBOUNDED) | (b >= UNBOUNDED), UNBOUNDED, total)


class DifferenceNetwork:
    """Constraints on points, separately for each axis; they always have a solution.

    ``dtype`` is the type of the distances; with :data:`ORDERS`, all codes must be ZERO or STRICT.

    >>> network = DifferenceNetwork(points=3)
    >>> network.add(Difference(0, 0, 1, 2 * 5 + 1)), network.add(Difference(0, 1, 2, 2 * -7))  # x1-x0<=5, x2-x1<-7
    (True, True)
    >>> int(network.distances[0, 0, 2])  # x2 - x0 < -2
    -4
    >>> back = Difference(0, 2, 0, 2 * 2 + 1)
    >>> network.add(back), network.cycle(back)  # x0 - x2 <= 2
    (False, [0, 1])
    """

    def __init__(self, points: int, axes: int = 1, dtype: np.dtype[Any] | type[np.int64] = np.int64) -> None:
        self.free = int(np.iinfo(dtype).max) // 2 + 1
        self._points = points
        self.matrices = np.full((axes, points, points), self.free, dtype=dtype)
        self.matrices[:, np.arange(points), np.arange(points)] = ZERO
        self._table = np.empty((16, 4), np.int64)  # the constraints: axis, tail, head, code
        self._changes: list[tuple[NDArray[np.int64], NDArray[Any]] | None] = []
        self._kept = 0

    # ``matrices`` has room for more points; compiled loops get it whole, since they would be compiled again for views
    @property
    def distances(self) -> NDArray[Any]:
        """Tightest codes of ``x[column] - x[row]``, shape (axes, points, points), ``free`` for no bound.

        This is a view; do not write to it.
        """
        return self.matrices[:, : self._points, : self._points]

    @property
    def points(self) -> int:
        """Number of points on each axis."""
        return self._points

    def __len__(self) -> int:
        """Return the number of constraints; :meth:`back` takes such a number."""
        return len(self._changes)

    @property
    def constraints(self) -> NDArray[np.int64]:
        """All constraints in the order of adding: axis, tail, head and code, shape (len, 4); a view."""
        return self._table[: len(self)]

    def add_point(self) -> None:
        """Add an unconstrained point on every axis; earlier constraints can no longer be taken back."""
        if self._points == self.matrices.shape[1]:
            axes, capacity = len(self.matrices), max(8, 2 * self._points)
            larger = np.full((axes, capacity, capacity), self.free, dtype=self.matrices.dtype)
            larger[:, : self._points, : self._points] = self.matrices
            self.matrices = larger
        self.matrices[:, self._points, self._points] = ZERO
        self._points += 1
        self.keep()

    def admits(self, difference: Difference) -> bool:
        """Return whether a constraint closes no negative cycle.

        Parameters
        ----------
        difference
            The constraint.

        Returns
        -------
        bool
            True if it can be added.
        """
        axis, tail, head, code = difference
        against = int(self.matrices[axis, head, tail])
        return against >= self.free or add(against, code) >= ZERO

    def add(self, difference: Difference) -> bool:
        """Add a constraint unless it closes a negative cycle.

        Parameters
        ----------
        difference
            The constraint.

        Returns
        -------
        bool
            True if it was added; False if nothing was changed.
        """
        if not self.admits(difference):
            return False
        from deixis.reasoning.constraints.kernels import tighten

        axis, tail, head, code = difference
        count, matrix = len(self), self.matrices[axis]
        if count == len(self._table):
            self._table = np.concatenate([self._table, np.empty((max(16, count), 4), np.int64)])
        self._table[count] = difference
        if code < matrix[tail, head]:
            cells, before = tighten(matrix, self._points, tail, head, code, self.free)
            self._changes.append((cells + axis * matrix.size, before))
        else:
            self._changes.append(None)
        return True

    def add_all(self, differences: NDArray[np.int64]) -> bool:
        """Add constraints in one compiled loop; they cannot be taken back.

        Parameters
        ----------
        differences
            The constraints, shape (k, 4).

        Returns
        -------
        bool
            False if they close a negative cycle; the network must not be used after that.
        """
        from deixis.reasoning.constraints.kernels import tighten_all

        self._table = np.concatenate([self.constraints, differences])
        self._changes += [None] * len(differences)
        self.keep()
        return bool(tighten_all(self.matrices, self._points, differences, self.free))

    def back(self, length: int) -> None:
        """Take back the constraints added last.

        Parameters
        ----------
        length
            Number of constraints to leave.
        """
        flat = self.matrices.reshape(-1)
        while len(self._changes) > length:
            change = self._changes.pop()
            if change is not None:
                flat[change[0]] = change[1]

    def keep(self) -> None:
        """Make the constraints so far permanent, which frees the memory for taking them back."""
        self._changes[self._kept :] = [None] * (len(self._changes) - self._kept)
        self._kept = len(self._changes)

    def replace(self, differences: Sequence[Difference]) -> None:
        """Replace all constraints by others.

        Parameters
        ----------
        differences
            The constraints, which must have a solution.
        """
        self._table, self._changes, self._kept = self._table[:0], [], 0
        self.matrices.fill(self.free)
        capacity = np.arange(self.matrices.shape[1])
        self.matrices[:, capacity, capacity] = ZERO
        self.add_all(np.array(differences, np.int64).reshape(-1, 4))

    def copy(self) -> DifferenceNetwork:
        """Return a network of the same points and constraints, which cannot be taken back there.

        Returns
        -------
        DifferenceNetwork
            The network.
        """
        other = DifferenceNetwork(0)
        other.free, other._points = self.free, self._points
        other.matrices, other._table = self.matrices.copy(), self._table.copy()
        other._changes = [None] * len(self)
        other._kept = len(self)
        return other

    def path(self, axis: int, tail: int, head: int) -> list[int]:
        """Return the fewest constraints that add up to the distance between two points.

        Parameters
        ----------
        axis
            The axis.
        tail, head
            The points.

        Returns
        -------
        list of int
            Numbers of the constraints, counted in the order of adding.
        """
        from deixis.reasoning.constraints.path_kernels import tight_path

        found = tight_path(self.matrices[axis], self._points, self.constraints, axis, tail, head)
        return [int(number) for number in found]

    def cycle(self, difference: Difference) -> list[int]:
        """Return the fewest constraints that close a negative cycle with a refused one.

        Parameters
        ----------
        difference
            The refused constraint.

        Returns
        -------
        list of int
            Numbers of the constraints, counted in the order of adding.
        """
        return self.path(difference.axis, difference.head, difference.tail)

    def nearest(self, wanted: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return a solution in whole numbers near the wanted ones.

        Parameters
        ----------
        wanted
            The wanted numbers, shape (axes, points).

        Returns
        -------
        ndarray
            The solution, shape (axes, points), equal to the wanted numbers if they are one.
        """
        return np.stack(
            [(row[:, None] + (matrix >> 1)).min(axis=0) for row, matrix in zip(wanted, self.distances, strict=True)]
        )
