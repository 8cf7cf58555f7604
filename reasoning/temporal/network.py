"""The simple temporal network (Dechter, Meiri & Pearl 1991): time points under difference constraints.

Minimal distances between all points are kept. A constraint that is added updates them in O(m^2) for m points; one that
closes a negative cycle is refused, with the cycle, and nothing is changed. To take constraints away all is worked out
again. Bounds are exact, and strict ones are strict: see :mod:`deixis.reasoning.temporal.bounds`.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.errors import LimitError
from deixis.reasoning.temporal.bounds import FARTHEST, TICKS, UNBOUNDED, ZERO, Bounds, add, bound_text
from deixis.reasoning.temporal.errors import TemporalConflictError, UnknownFluentError
from deixis.reasoning.temporal.explanation import Explanation, Rule
from deixis.reasoning.temporal.fluent import ORIGIN

MAX_POINTS = 8191
"""Points of one network: its distances take 8 bytes a pair, 512 MB at this size."""

MAX_TOTAL = 1 << 59
"""The most that all differences stated between points may add up to, so that no sum overflows: 9,000 years."""


@dataclass(frozen=True, slots=True)
class DifferenceConstraint:
    """That ``head - tail`` is at most, or less than, what ``code`` says; ``why`` explains it."""

    tail: str
    head: str
    code: int
    why: Explanation


@dataclass
class Trail:
    """What additions changed, so that they can be undone, the last first."""

    cells: list[tuple[NDArray[np.int64], NDArray[np.int64]]] = field(default_factory=list)
    constraints: int = 0


class SimpleTemporalNetwork:
    """Named time points, the origin among them, and the tightest bounds on their differences.

    >>> network = SimpleTemporalNetwork(["a", "b"])
    >>> network.add(difference("origin", "a", Bounds(1, 2)) + difference("a", "b", Bounds(3, 4)))
    >>> str(network.bounds("origin", "b"))
    '[4, 6]'
    >>> network.add(difference("origin", "b", Bounds(0, 3)))
    Traceback (most recent call last):
    deixis.reasoning.temporal.errors.TemporalConflictError: these cannot all hold: b <= 3; a <= b - 3; a >= 1
    """

    def __init__(self, points: Iterable[str] = ()) -> None:
        self._index = {ORIGIN: 0}
        self._distances = np.full((8, 8), UNBOUNDED, dtype=np.int64)
        self._distances[0, 0] = ZERO
        self._constraints: list[DifferenceConstraint] = []
        self._between = 0  # what the constraints between points other than the origin add up to
        for point in points:
            self.add_point(point)

    @property
    def points(self) -> tuple[str, ...]:
        """The names of all points, in the order of the distances' rows; the origin is the first."""
        return tuple(self._index)

    @property
    def constraints(self) -> tuple[DifferenceConstraint, ...]:
        """All that was added."""
        return tuple(self._constraints)

    @property
    def distances(self) -> NDArray[np.int64]:
        """The tightest bounds on column minus row as codes, shape (m, m); a view, not to be written to."""
        return self._distances[: len(self._index), : len(self._index)]

    def index(self, point: str) -> int:
        """The row of a point; raises UnknownFluentError where there is none."""
        try:
            return self._index[point]
        except KeyError:
            raise UnknownFluentError("time point", point, self._index) from None

    def add_point(self, point: str) -> None:
        """Adds a point, if it is not there yet; raises LimitError beyond ``MAX_POINTS``."""
        count = len(self._index)
        if point in self._index:
            return
        if count == MAX_POINTS:
            raise LimitError(f"a temporal network has at most {MAX_POINTS} points; tell of the time in parts")
        if count == len(self._distances):
            larger = np.full((2 * count, 2 * count), UNBOUNDED, dtype=np.int64)
            larger[:count, :count] = self._distances
            self._distances = larger
        self._index[point] = count
        self._distances[count, count] = ZERO

    def code(self, tail: str, head: str) -> int:
        """The tightest upper bound on ``head - tail``, as a code."""
        return int(self._distances[self.index(tail), self.index(head)])

    def bounds(self, tail: str, head: str) -> Bounds:
        """The tightest bounds on ``head - tail``, in seconds."""
        return Bounds.from_codes(self.code(head, tail), self.code(tail, head))

    def add(self, constraints: Sequence[DifferenceConstraint]) -> None:
        """Takes in constraints, all or none.

        Raises TemporalConflictError, with the negative cycle, where they contradict what is there; LimitError where
        differences add up to more than can be told exactly. Nothing is changed then.
        """
        if self.try_add(constraints) is None:
            raise TemporalConflictError(self.refutation(constraints), minimal=False)

    def try_add(self, constraints: Sequence[DifferenceConstraint]) -> Trail | None:
        """The same, and how to undo it; None, and nothing changed, where a negative cycle would close."""
        self._require_summable(constraints)
        trail = Trail()
        for constraint in constraints:
            if not self._take_in(constraint, trail):
                self.undo(trail)
                return None
        return trail

    def _take_in(self, constraint: DifferenceConstraint, trail: Trail) -> bool:
        from deixis.reasoning.temporal.kernels import tighten

        tail, head = self.index(constraint.tail), self.index(constraint.head)
        if add(int(self._distances[head, tail]), constraint.code) < ZERO:
            return False
        if constraint.code < self._distances[tail, head]:
            trail.cells.append(tighten(self._distances, len(self._index), tail, head, constraint.code))
        self._between += _size(constraint)
        self._constraints.append(constraint)
        trail.constraints += 1
        return True

    def _require_summable(self, constraints: Sequence[DifferenceConstraint]) -> None:
        """A simple path passes every constraint once at the most, so their sum bounds its length."""
        for constraint in constraints:
            self.index(constraint.tail), self.index(constraint.head)
        total = self._between + sum(map(_size, constraints))
        if total > MAX_TOTAL or any(abs(c.code >> 1) > FARTHEST * TICKS for c in constraints):
            raise LimitError("the stated times are too long to be added up exactly; is the unit right?")

    def undo(self, trail: Trail) -> None:
        """Takes back the last additions; trails are undone in the reverse of their order."""
        flat = self._distances.reshape(-1)
        for cells, before in reversed(trail.cells):
            flat[cells] = before
        if trail.constraints:
            self._between -= sum(map(_size, self._constraints[-trail.constraints :]))
            del self._constraints[-trail.constraints :]

    def retract(self, constraints: Iterable[DifferenceConstraint]) -> None:
        """Takes constraints away, each once, and works everything out again, in O(m^3)."""
        from deixis.reasoning.temporal.kernels import close

        for constraint in constraints:
            self._constraints.remove(constraint)
        self._between = sum(map(_size, self._constraints))
        self._distances.fill(UNBOUNDED)
        np.fill_diagonal(self._distances, ZERO)
        for constraint in self._constraints:
            tail, head = self.index(constraint.tail), self.index(constraint.head)
            self._distances[tail, head] = min(self._distances[tail, head], constraint.code)
        close(self._distances, len(self._index))

    def copy(self) -> SimpleTemporalNetwork:
        """A network with the same points and constraints, that changes by itself."""
        other = SimpleTemporalNetwork()
        other._index = dict(self._index)
        other._distances = self._distances.copy()
        other._constraints = list(self._constraints)
        other._between = self._between
        return other

    def explain(self, tail: str, head: str) -> Explanation | None:
        """Why ``head - tail`` is bounded as it is: the fewest constraints that add up to it; None where it is not."""
        code = self.code(tail, head)
        if code >= UNBOUNDED or tail == head:
            return None
        path = self._path(self.index(tail), self.index(head))
        text = bound_text(tail, head, code, ORIGIN)
        if len(path) == 1 and path[0].why.conclusion == text:
            return path[0].why
        return Explanation(text, Rule.SHORTEST_PATH, tuple(constraint.why for constraint in path))

    def refutation(self, constraints: Sequence[DifferenceConstraint]) -> Explanation:
        """The negative cycle that constraints would close, which :meth:`try_add` refuses; changes nothing.

        The cycle is simple: it passes each of its points once.
        """
        trail = Trail()
        for constraint in constraints:
            if not self._take_in(constraint, trail):
                cycle = [constraint, *self._path(self.index(constraint.head), self.index(constraint.tail))]
                code = add(self.code(constraint.head, constraint.tail), constraint.code)
                self.undo(trail)
                point = next((c.tail for c in cycle if c.tail != ORIGIN), ORIGIN)
                text = bound_text(point, point, code, ORIGIN)
                return Explanation(text, Rule.NEGATIVE_CYCLE, tuple(c.why for c in cycle))
        raise AssertionError("the constraints close no negative cycle")

    def _path(self, start: int, end: int) -> list[DifferenceConstraint]:
        """The fewest constraints that add up to the distance from one point to another.

        A breadth-first search over the constraints that lie on some shortest way, twice over: with and without a strict
        one passed so far, since a strict distance needs one.
        """
        useful = self._on_shortest_ways(start, end)
        goal = (end, not self._distances[start, end] & 1)
        came: dict[tuple[int, bool], tuple[tuple[int, bool], DifferenceConstraint]] = {}
        waiting = deque([(start, False)])
        while waiting and goal not in came:
            here = waiting.popleft()
            for head, constraint in useful.get(here[0], ()):
                there = (head, here[1] or not constraint.code & 1)
                if there not in came and there != (start, False):
                    came[there] = (here, constraint)
                    waiting.append(there)
        path = []
        place = goal
        while place != (start, False):
            place, constraint = came[place]
            path.append(constraint)
        return path[::-1]

    def _on_shortest_ways(self, start: int, end: int) -> dict[int, list[tuple[int, DifferenceConstraint]]]:
        """By tail, the constraints on some shortest way, strictness left aside."""
        ends = [(self._index[c.tail], self._index[c.head], c.code) for c in self._constraints]
        tails, heads, codes = np.array(ends, dtype=np.int64).reshape(-1, 3).T
        first, last = self._distances[start, tails], self._distances[heads, end]
        known = (first < UNBOUNDED) & (last < UNBOUNDED)
        tight = known & ((first >> 1) + (codes >> 1) + (last >> 1) == self._distances[start, end] >> 1)
        useful: dict[int, list[tuple[int, DifferenceConstraint]]] = {}
        for position in np.flatnonzero(tight):
            useful.setdefault(int(tails[position]), []).append((int(heads[position]), self._constraints[position]))
        return useful


def _size(constraint: DifferenceConstraint) -> int:
    """What a constraint can add to a path beyond the two that touch the origin."""
    return 0 if ORIGIN in (constraint.tail, constraint.head) else abs(constraint.code >> 1)


def difference(tail: str, head: str, bounds: Bounds, source: str | None = None) -> tuple[DifferenceConstraint, ...]:
    """The constraints, at most two, that say that ``head - tail`` lies within bounds, as stated ones."""
    found = []
    for start, end, code in ((tail, head, bounds.at_most), (head, tail, bounds.at_least)):
        if code < UNBOUNDED:
            text = bound_text(start, end, code, ORIGIN)
            found.append(DifferenceConstraint(start, end, code, Explanation(text, Rule.STATED, source=source)))
    return tuple(found)
