"""Choosing a piece of every clause so that all constraints agree, or proving that none can be chosen.

The problem is a disjunctive temporal one (Stergiou and Koubarakis 2000) on two axes. The search looks ahead (a piece
that what was chosen excludes is no choice; a clause with the fewest choices left comes next; a clause that holds
anyway is passed over) and jumps back to the latest choice that had a part in a failure (conflict-directed
backjumping, Prosser 1993). It is complete: where it ends without a solution there is none, and the clauses that it
names have none by themselves.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.entailment.realisation.differences import Difference, Differences


@dataclass(frozen=True, slots=True)
class Clause:
    """Of these pieces one must hold, all its constraints together; an empty piece holds, and no piece cannot."""

    pieces: tuple[tuple[Difference, ...], ...]


@dataclass(frozen=True)
class Solved:
    """The constraints chosen, and of which piece each clause was given (-1: it holds anyway)."""

    differences: Differences
    chosen: tuple[int, ...]


@dataclass(frozen=True)
class Refuted:
    """There is no solution, nor one of these clauses alone (by their positions)."""

    core: frozenset[int]


@dataclass(frozen=True)
class TimedOut:
    """The time was up."""


@dataclass(slots=True)
class _Level:
    """A clause that was decided: the piece it has now, what it excluded others for, and where to go back to."""

    clause: int
    length: int
    tried: set[int] = field(default_factory=set)
    reasons: set[int] = field(default_factory=set)


class _Pieces:
    """All constraints of all pieces as flat arrays, so that one look at the distances tells what is excluded."""

    def __init__(self, clauses: Sequence[Clause]) -> None:
        pieces = [(c, piece) for c, clause in enumerate(clauses) for piece in clause.pieces]
        self.clause = np.array([c for c, _ in pieces], dtype=np.int64)
        self.first = np.searchsorted(self.clause, np.arange(len(clauses) + 1))
        flat = [(p, *difference) for p, (_, piece) in enumerate(pieces) for difference in piece]
        table = np.array(flat, dtype=np.int64).reshape(-1, 5)
        self.piece, self.axis, self.tail, self.head, self.bound = table.T
        self.sizes = np.bincount(self.piece, minlength=len(pieces))
        self.clauses = len(clauses)

    def excluded(self, differences: Differences) -> NDArray[np.bool_]:
        """The pieces of which some constraint cannot hold any more, shape (pieces,)."""
        against = differences.distances[self.axis, self.head, self.tail] + self.bound < 0
        found: NDArray[np.bool_] = np.bincount(self.piece[against], minlength=len(self.clause)) > 0
        return found

    def settled(self, differences: Differences) -> NDArray[np.bool_]:
        """The clauses of which some piece holds anyway, shape (clauses,)."""
        implied = differences.distances[self.axis, self.tail, self.head] <= self.bound
        holds = np.bincount(self.piece[implied], minlength=len(self.clause)) == self.sizes
        found: NDArray[np.bool_] = np.bincount(self.clause[holds], minlength=self.clauses) > 0
        return found


def solve(points: int, clauses: Sequence[Clause], deadline: float) -> Solved | Refuted | TimedOut:
    """A choice of pieces that agree, the earlier pieces of a clause preferred; or that there is none.

    ``points`` is how many numbers there are on each axis, ``deadline`` a value of ``time.monotonic()``.
    """
    return _Search(points, clauses).run(deadline)


class _Search:
    def __init__(self, points: int, clauses: Sequence[Clause]) -> None:
        self.clauses = clauses
        self.pieces = _Pieces(clauses)
        self.differences = Differences(points)
        self.levels: list[_Level] = []
        self.chosen: dict[int, int] = {}
        self.forced = 0  # so many levels, the first, are of clauses with one piece

    def run(self, deadline: float) -> Solved | Refuted | TimedOut:
        while True:
            if time.monotonic() > deadline:
                return TimedOut()
            clause = self._next()
            if clause is None:
                chosen = tuple(self.chosen.get(c, -1) for c in range(len(self.clauses)))
                return Solved(self.differences, chosen)
            self.levels.append(_Level(clause, len(self.differences)))
            core = self._decide()
            if core is not None:
                return Refuted(frozenset(core))
            self._keep_what_was_no_choice()

    def _keep_what_was_no_choice(self) -> None:
        """Saves the memory to take back what is never taken back: there is no other piece to go back for."""
        if len(self.levels) == self.forced + 1 and len(self.clauses[self.levels[-1].clause].pieces) == 1:
            self.forced += 1
            self.differences.keep()

    def _next(self) -> int | None:
        """The open clause with the fewest pieces left; None where all hold."""
        pieces = self.pieces
        choices = np.bincount(pieces.clause[~pieces.excluded(self.differences)], minlength=len(self.clauses))
        choices[pieces.settled(self.differences)] = np.iinfo(np.int64).max
        choices[list(self.chosen)] = np.iinfo(np.int64).max
        if not len(choices) or choices.min() == np.iinfo(np.int64).max:
            return None
        return int(choices.argmin())

    def _decide(self) -> set[int] | None:
        """Gives the latest level a piece, going back as far as needed; the core where no level has one left."""
        while True:
            level = self.levels[-1]
            if self._take_next_piece(level):
                return None
            conflict = level.reasons | {level.clause}
            self.levels.pop()
            while self.levels and self.levels[-1].clause not in conflict:
                del self.chosen[self.levels.pop().clause]
            if not self.levels:
                return conflict
            level = self.levels[-1]
            del self.chosen[level.clause]
            level.reasons |= conflict - {level.clause}
            self.differences.back(level.length)

    def _take_next_piece(self, level: _Level) -> bool:
        """The first piece not tried that agrees with all that is chosen; why the others do not is kept."""
        for number, piece in enumerate(self.clauses[level.clause].pieces):
            if number in level.tried:
                continue
            level.tried.add(number)
            against = self._add(piece, level.clause)
            if against is None:
                self.chosen[level.clause] = number
                return True
            level.reasons |= against - {level.clause}
            self.differences.back(level.length)
        return False

    def _add(self, piece: tuple[Difference, ...], clause: int) -> set[int] | None:
        for difference in piece:
            against = self.differences.add(difference, clause)
            if against is not None:
                return against
        return None
