"""The simple temporal network (Dechter, Meiri & Pearl 1991): time points under difference constraints.

Minimal distances between all points are kept. Adding a constraint updates them in O(m^2) for m points; a constraint
that closes a negative cycle is refused, with the cycle, and changes nothing. Removing constraints recomputes
everything. Bounds are exact, and strict ones are strict (:mod:`deixis.reasoning.constraints.difference`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.constraints.difference import UNBOUNDED, Difference, DifferenceNetwork, add
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.errors import LimitError
from deixis.reasoning.temporal.bounds import MAX_SECONDS, TICKS, Bounds, bound_text
from deixis.reasoning.temporal.errors import TemporalConflictError, UnknownFluentError
from deixis.reasoning.temporal.fluent import ORIGIN

MAX_POINTS = 8191
"""Maximum number of points of a network; its distances take 8 bytes per pair, 512 MB at this size."""

MAX_TOTAL = 1 << 59
"""Maximum sum of all differences stated between points, 9,000 years, so that no sum overflows."""


@dataclass(frozen=True, slots=True)
class DifferenceConstraint:
    """The constraint that ``head - tail`` is at most, or less than, the bound ``code``; ``why`` explains it."""

    tail: str
    head: str
    code: int
    why: Proof[str]


class SimpleTemporalNetwork:
    """Named time points, including the origin, and the tightest bounds on their differences.

    >>> network = SimpleTemporalNetwork(["a", "b"])
    >>> network.add(difference("origin", "a", Bounds(1, 2)) + difference("a", "b", Bounds(3, 4)))
    >>> str(network.bounds("origin", "b"))
    '[4, 6]'
    >>> network.add(difference("origin", "b", Bounds(0, 3)))
    Traceback (most recent call last):
    deixis.reasoning.temporal.errors.TemporalConflictError: these cannot all hold: b <= 3; a <= b - 3; a >= 1
    """

    def __init__(self, points: Iterable[str] = ()) -> None:
        self.differences = DifferenceNetwork(1)
        self._index = {ORIGIN: 0}
        self._constraints: list[DifferenceConstraint] = []
        self._between = 0  # the sum of the constraints between points other than the origin
        for point in points:
            self.add_point(point)

    @property
    def points(self) -> tuple[str, ...]:
        """Names of all points, in the order of the rows of distances; the origin is the first."""
        return tuple(self._index)

    @property
    def constraints(self) -> tuple[DifferenceConstraint, ...]:
        """All constraints, in the order of adding."""
        return tuple(self._constraints)

    @property
    def distances(self) -> NDArray[np.int64]:
        """Tightest bounds on column minus row as codes, shape (m, m); a view, do not write to it."""
        distances: NDArray[np.int64] = self.differences.distances[0]
        return distances

    def index(self, point: str) -> int:
        """Return the row of a point.

        Parameters
        ----------
        point
            Its name.

        Returns
        -------
        int
            The row in the matrix of distances.

        Raises
        ------
        UnknownFluentError
            If there is no such point.
        """
        try:
            return self._index[point]
        except KeyError:
            raise UnknownFluentError("time point", point, self._index) from None

    def add_point(self, point: str) -> None:
        """Add a point if it is new.

        Parameters
        ----------
        point
            Its name.

        Raises
        ------
        LimitError
            If the network would have more than ``MAX_POINTS`` points.
        """
        if point in self._index:
            return
        if len(self._index) == MAX_POINTS:
            raise LimitError(f"a temporal network has at most {MAX_POINTS} points; describe the time in parts")
        self._index[point] = len(self._index)
        self.differences.add_point()

    def code(self, tail: str, head: str) -> int:
        """Return the tightest upper bound on the difference of two points.

        Parameters
        ----------
        tail, head
            Names of the points.

        Returns
        -------
        int
            Code of the bound on ``head - tail``.
        """
        return int(self.distances[self.index(tail), self.index(head)])

    def bounds(self, tail: str, head: str) -> Bounds:
        """Return the tightest bounds on the difference of two points.

        Parameters
        ----------
        tail, head
            Names of the points.

        Returns
        -------
        Bounds
            Bounds on ``head - tail``, in seconds.
        """
        return Bounds.from_codes(self.code(head, tail), self.code(tail, head))

    def add(self, constraints: Sequence[DifferenceConstraint]) -> None:
        """Add all constraints, or none.

        Parameters
        ----------
        constraints
            The constraints.

        Raises
        ------
        TemporalConflictError
            If they contradict the network; the error has the negative cycle.
        LimitError
            If differences add up to more than can be computed exactly.
        """
        if not self.try_add(constraints):
            raise TemporalConflictError(self.refutation(constraints), minimal=False)

    def try_add(self, constraints: Sequence[DifferenceConstraint]) -> bool:
        """Add all constraints, or none if a negative cycle would close.

        Parameters
        ----------
        constraints
            The constraints.

        Returns
        -------
        bool
            True if they were added.

        Raises
        ------
        LimitError
            If the times are too long to be added up exactly.
        """
        for each in constraints:
            self.index(each.tail)
            self.index(each.head)
        # a simple path has every constraint at most once, so their sum bounds its length
        total = self._between + sum(map(_size, constraints))
        if total > MAX_TOTAL or any(abs(c.code >> 1) > MAX_SECONDS * TICKS for c in constraints):
            raise LimitError("the stated times are too long to be added up exactly; is the unit right?")
        length = len(self._constraints)
        if all(self._take_in(constraint) for constraint in constraints):
            return True
        self.back(length)
        return False

    def _take_in(self, constraint: DifferenceConstraint) -> bool:
        if not self.differences.add(self._difference(constraint)):
            return False
        self._between += _size(constraint)
        self._constraints.append(constraint)
        return True

    def _difference(self, constraint: DifferenceConstraint) -> Difference:
        return Difference(0, self.index(constraint.tail), self.index(constraint.head), constraint.code)

    def back(self, length: int) -> None:
        """Take back the constraints added last, as far as :meth:`keep` allows.

        Parameters
        ----------
        length
            Number of constraints to leave.
        """
        self.differences.back(length)
        self._between -= sum(map(_size, self._constraints[length:]))
        del self._constraints[length:]

    def keep(self) -> None:
        """Make the constraints so far permanent, which frees the memory for taking them back."""
        self.differences.keep()

    def retract(self, constraints: Iterable[DifferenceConstraint]) -> None:
        """Remove constraints, each once, and recompute everything.

        Parameters
        ----------
        constraints
            Constraints of the network.
        """
        for constraint in constraints:
            self._constraints.remove(constraint)
        self._between = sum(map(_size, self._constraints))
        self.differences.replace([self._difference(constraint) for constraint in self._constraints])

    def copy(self) -> SimpleTemporalNetwork:
        """Return an independent network with the same points and constraints.

        Returns
        -------
        SimpleTemporalNetwork
            The network.
        """
        other = SimpleTemporalNetwork()
        other.differences = self.differences.copy()
        other._index = dict(self._index)
        other._constraints = list(self._constraints)
        other._between = self._between
        return other

    def explain(self, tail: str, head: str) -> Proof[str] | None:
        """Explain the upper bound on the difference of two points.

        Parameters
        ----------
        tail, head
            Names of the points.

        Returns
        -------
        Proof[str] or None
            The fewest constraints that add up to the bound on ``head - tail``, or None without a bound.
        """
        code = self.code(tail, head)
        if code >= UNBOUNDED or tail == head:
            return None
        path = [self._constraints[k].why for k in self.differences.path(0, self.index(tail), self.index(head))]
        text = bound_text(tail, head, code, ORIGIN)
        return path[0] if len(path) == 1 and path[0].claim == text else Proof(text, Rule.SHORTEST_PATH, tuple(path))

    def refutation(self, constraints: Sequence[DifferenceConstraint]) -> Proof[str]:
        """Return the negative cycle that constraints would close, which :meth:`try_add` refuses; change nothing.

        The cycle is simple: it passes each of its points once.

        Parameters
        ----------
        constraints
            Constraints that :meth:`try_add` refuses.

        Returns
        -------
        Proof[str]
            The cycle, as a proof of a contradiction.
        """
        length = len(self._constraints)
        refused = next(constraint for constraint in constraints if not self._take_in(constraint))
        proof = self.cycle(refused)
        self.back(length)
        return proof

    def cycle(self, refused: DifferenceConstraint) -> Proof[str]:
        """Return the negative cycle that a constraint closes with those of the network.

        Parameters
        ----------
        refused
            A constraint that the network refuses.

        Returns
        -------
        Proof[str]
            The cycle, as a proof of a contradiction.
        """
        cycle = [refused, *(self._constraints[k] for k in self.differences.cycle(self._difference(refused)))]
        code = add(self.code(refused.head, refused.tail), refused.code)
        point = next((c.tail for c in cycle if c.tail != ORIGIN), ORIGIN)
        return Proof(bound_text(point, point, code, ORIGIN), Rule.NEGATIVE_CYCLE, tuple(c.why for c in cycle))

    def record(self, length: int, constraints: Sequence[DifferenceConstraint]) -> None:
        """Set constraints whose differences a search has added directly.

        Parameters
        ----------
        length
            Number of the constraints to keep before them.
        constraints
            The constraints.
        """
        self._constraints[length:] = constraints


def _size(constraint: DifferenceConstraint) -> int:
    """Return the length that a constraint can add to a path beyond the two constraints at the origin."""
    return 0 if ORIGIN in (constraint.tail, constraint.head) else abs(constraint.code >> 1)


def difference(tail: str, head: str, bounds: Bounds, source: str | None = None) -> tuple[DifferenceConstraint, ...]:
    """Return the constraints that the difference of two points lies within bounds.

    Parameters
    ----------
    tail, head
        Names of the points.
    bounds
        Bounds on ``head - tail``, in seconds.
    source
        Place of the statement, for explanations.

    Returns
    -------
    tuple of DifferenceConstraint
        At most two constraints.
    """
    found = []
    for start, end, code in ((tail, head, bounds.at_most), (head, tail, bounds.at_least)):
        if code < UNBOUNDED:
            text = bound_text(start, end, code, ORIGIN)
            found.append(DifferenceConstraint(start, end, code, Proof(text, Rule.STATED, source=source)))
    return tuple(found)
