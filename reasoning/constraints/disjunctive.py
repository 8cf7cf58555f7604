"""Choose one piece of every clause so that all difference constraints are consistent, or prove that it is impossible.

This is a disjunctive temporal problem (Stergiou and Koubarakis 2000). The search looks ahead: pieces that the chosen
ones exclude are not tried, the clause with the fewest possible pieces comes next, and a clause with an implied piece is
skipped. It jumps back to the latest choice that contributed to a failure (conflict-directed backjumping, Prosser 1993).
It is complete: if it ends without a solution there is no solution, and the clauses in its core are inconsistent with
the network alone.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.constraints.difference import Difference, DifferenceNetwork
from deixis.reasoning.errors import OutOfTimeError

Piece = tuple[Difference, ...]


@dataclass(frozen=True, slots=True)
class Clause:
    """A disjunction of pieces, each a conjunction of constraints; an empty piece holds, an empty clause fails."""

    pieces: tuple[Piece, ...]


class Clauses(Sequence[Clause]):
    """Clauses, with all their constraints as flat arrays for the compiled loops."""

    def __init__(self, clauses: Iterable[Clause]) -> None:
        self._clauses = tuple(clauses)
        pieces = [piece for clause in self._clauses for piece in clause.pieces]
        self._first_piece = np.cumsum([0, *(len(clause.pieces) for clause in self._clauses)], dtype=np.int64)
        first_bound = np.cumsum([0, *map(len, pieces)], dtype=np.int64)
        bounds = np.array([difference for piece in pieces for difference in piece], np.int64).reshape(-1, 4)
        self._arrays = self._first_piece, first_bound, bounds

    def __len__(self) -> int:
        return len(self._clauses)

    def __getitem__(self, position: Any) -> Any:
        return self._clauses[position]

    def next(self, network: DifferenceNetwork, taken: NDArray[np.int64]) -> tuple[int, int]:
        """Return the open clause with the fewest pieces that the network admits.

        Parameters
        ----------
        network
            The network.
        taken
            Piece taken of each clause, -1 for none.

        Returns
        -------
        tuple
            Position of the clause, or -1 if all hold, and the number of its admitted pieces.
        """
        from deixis.reasoning.constraints.kernels import next_clause

        clause, left = next_clause(network.matrices, *self._arrays, taken, network.free)
        return int(clause), int(left)

    def admitted(self, network: DifferenceNetwork, clause: int) -> list[bool]:
        """Say for each piece of a clause whether it can be added to a network.

        Parameters
        ----------
        network
            The network.
        clause
            Position of the clause.

        Returns
        -------
        list of bool
            True for each piece that can be added.
        """
        from deixis.reasoning.constraints.kernels import standing

        _, first_bound, bounds = self._arrays
        pieces = range(self._first_piece[clause], self._first_piece[clause + 1])
        ends = ((first_bound[piece], first_bound[piece + 1]) for piece in pieces)
        return [standing(network.matrices, bounds, *end, network.free) >= 0 for end in ends]

    def dive(self, network: DifferenceNetwork, last: NDArray[np.int64]) -> tuple[int, NDArray[Any]]:
        """Decide all clauses without backtracking.

        Parameters
        ----------
        network
            The network, which is not changed.
        last
            Piece of each clause to try first, -1 for none; changed to the pieces taken.

        Returns
        -------
        tuple
            1, -1 or 0 for solved, refuted or neither, and the distances.
        """
        from deixis.reasoning.constraints.kernels import dive

        distances = np.ascontiguousarray(network.distances).copy()
        return int(dive(distances, *self._arrays, last, network.free)), distances


class SearchOutcome(Enum):
    """The result of a search."""

    SOLVED = "solved"  # the network holds a solution
    REFUTED = "refuted"  # there is no solution, or no further one
    TIMED_OUT = "timed out"


@dataclass(slots=True, eq=False)
class Level:
    """A clause that is being decided."""

    clause: int
    length: int  # of the network before it
    order: Sequence[int]  # the numbers of its pieces, as they are tried
    forced: bool  # only the last piece in this order could be added
    tried: int = 0
    reasons: set[int] = field(default_factory=set)  # the clauses that excluded the pieces tried before
    solved: bool = False  # a solution was found under one of the pieces


class Search:
    """A search through the solutions of clauses over a network, which it changes; ``network.back(base)`` undoes it.

    The search ends at ``deadline``. After REFUTED without a solution, ``core`` has the positions of clauses that are
    inconsistent with the network. With ``keep``, the clauses of one piece that are taken first stay in the network,
    which saves the memory for taking them back.
    """

    def __init__(self, network: DifferenceNetwork, clauses: Clauses, deadline: Deadline, keep: bool = False) -> None:
        self.network, self.clauses, self.deadline = network, clauses, deadline
        self.base, self._keep, self._kept = len(network), keep, 0
        self.outcome = SearchOutcome.TIMED_OUT
        self.levels: list[Level] = []
        self.taken = np.full(len(clauses), -1, np.int64)  # the piece of each decided clause
        self.core: frozenset[int] = frozenset()
        self._solved = False

    def propagate(self) -> SearchOutcome:
        """Take pieces that are the only possible ones, until a choice is needed.

        Returns
        -------
        SearchOutcome
            The outcome; SOLVED means no contradiction.
        """
        return self._run(only_forced=True)

    def advance(self) -> SearchOutcome:
        """Go to the first or next solution; earlier pieces of a clause are preferred.

        Returns
        -------
        SearchOutcome
            Whether there is a solution, or a limit was reached.
        """
        if self._solved:
            self._solved = False
            for level in self.levels:
                level.solved = True
            if self.levels:
                self.levels[-1].reasons |= {level.clause for level in self.levels[:-1]}
                self._release(self.levels[-1])
            if not self.levels or not self._decide():
                self.outcome = SearchOutcome.REFUTED
                return self.outcome
        self.outcome = self._run(only_forced=False)
        self._solved = self.outcome is SearchOutcome.SOLVED
        return self.outcome

    def open(self) -> list[int]:
        """Return the clauses that are neither decided nor implied.

        Returns
        -------
        list of int
            Positions of the clauses.
        """
        taken, found = self.taken.copy(), list[int]()
        while (clause := self.clauses.next(self.network, taken)[0]) >= 0:
            found.append(clause)
            taken[clause] = 0
        return sorted(found)

    def _run(self, only_forced: bool) -> SearchOutcome:
        while True:
            if self.deadline.passed:
                return SearchOutcome.TIMED_OUT
            clause, left = self.clauses.next(self.network, self.taken)
            if clause < 0 or (only_forced and left > 1):
                return SearchOutcome.SOLVED
            self.levels.append(self._level(clause, left))
            if not self._decide():
                return SearchOutcome.REFUTED
            if self._keep and self._kept == len(self.levels) - 1 and len(self.clauses[clause].pieces) == 1:
                self._kept += 1
                self.network.keep()

    def _level(self, clause: int, left: int) -> Level:
        return Level(clause, len(self.network), range(len(self.clauses[clause].pieces)), left == 1)

    def _decide(self) -> bool:
        """Give the latest level a piece, backtracking as needed; return False if no level has a piece left."""
        while True:
            level = self.levels[-1]
            if self._take_next_piece(level):
                return True
            conflict = level.reasons | {level.clause}
            failed = level
            while True:
                self._release(self.levels.pop())
                if not self.levels:
                    self.core = frozenset(conflict)
                    self._note_failed(failed, None)
                    return False
                level = self.levels[-1]
                if level.clause in conflict:
                    break
            self._release(level)
            level.reasons |= conflict - {level.clause}
            self._note_failed(failed, level)

    def _release(self, level: Level) -> None:
        self.network.back(level.length)
        self.taken[level.clause] = -1

    def _take_next_piece(self, level: Level) -> bool:
        """Take the first untried piece that is consistent with all choices, and record why the others are not."""
        pieces = self.clauses[level.clause].pieces
        while level.tried < len(level.order):
            number = level.order[level.tried]
            level.tried += 1
            refused = next((d for d in pieces[number] if not self.network.add(d)), None)
            if refused is None:
                self.taken[level.clause] = number
                self._note_taken(level, number)
                return True
            begins = [above.length for above in self.levels]
            cycle = self.network.cycle(refused)
            for constraint in cycle:
                place = bisect_right(begins, constraint) - 1
                if 0 <= place < len(self.levels) - 1:
                    level.reasons.add(self.levels[place].clause)
            self._note_refused(level, number, refused, cycle)
            self.network.back(level.length)
        return False

    # ---- hooks for searches that prove their results

    def _note_taken(self, level: Level, number: int) -> None:
        """Handle the addition of a level's piece of this number to the network."""

    def _note_refused(self, level: Level, number: int, difference: Difference, cycle: Sequence[int]) -> None:
        """Handle a constraint of a piece that closes a negative cycle; earlier ones of the piece are added."""

    def _note_failed(self, failed: Level, into: Level | None) -> None:
        """Handle a level without a piece left, which refutes the latest piece of the level ``into``; None for all."""


def solve(points: int, axes: int, clauses: Iterable[Clause], deadline: Deadline) -> Search:
    """Search for a solution of clauses.

    Parameters
    ----------
    points
        Number of points.
    axes
        Number of axes.
    clauses
        The clauses.
    deadline
        Time limit.

    Returns
    -------
    Search
        The search: solved, refuted, or out of time.
    """
    search = Search(DifferenceNetwork(points, axes), Clauses(clauses), deadline, keep=True)
    search.advance()
    return search


def solution(
    network: DifferenceNetwork, clauses: Clauses, last: NDArray[np.int64], deadline: Deadline
) -> NDArray[Any] | None:
    """Return the distances in a solution of clauses over a network.

    The network is not changed. A single dive comes first, since it finds most solutions.

    Parameters
    ----------
    network
        The network.
    clauses
        The clauses.
    last
        Piece of each clause to try first, -1 for none; changed to the pieces taken.
    deadline
        Time limit.

    Returns
    -------
    ndarray or None
        The distances, or None without a solution.

    Raises
    ------
    OutOfTimeError
        If the deadline passes first.
    """
    if deadline.passed:
        raise OutOfTimeError("time limit reached before every choice in the facts was considered")
    found, distances = clauses.dive(network, last)
    if found != 0:
        return distances if found > 0 else None
    search = Search(network, clauses, deadline)
    search.advance()
    distances = network.distances.copy()
    network.back(search.base)
    if search.outcome is SearchOutcome.TIMED_OUT:
        raise OutOfTimeError("time limit reached before every choice in the facts was considered")
    return distances if search.outcome is SearchOutcome.SOLVED else None
