"""Facts that leave a choice, or deny one: decided by search, and what all pictures share.

A disjunction such as *left or above*, or the denial of *top left*, is no conjunction of bounds but a choice between
several. Each of them is a product of convex relations, the tractable pieces into which a rectangle-algebra relation is
split (Balbiani, Condotta and Fariñas del Cerro 1999), so that a choice of pieces that the closure finds consistent has
a picture. The search takes what is forced first and splits the choice with the fewest pieces left.

What every picture shares is found by refutation: a bound holds in all of them where its denial has no picture, and
every picture found on the way strikes out the bounds that fail in it.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.entailment.bounds import AXES, Alternatives
from deixis.reasoning.errors import LimitError

Row = tuple[int, int, bool]
"""A bound between two points: tail, head, strict."""


class OutOfTimeError(LimitError, TimeoutError):
    """The time limit struck before a search was done; nothing was decided."""


@dataclass(frozen=True)
class Choice:
    """One of the alternatives must hold between two objects; ``premise`` is the fact that says so."""

    alternatives: Alternatives
    subject: int
    object: int
    premise: int

    def rows(self, n: int) -> list[list[Row]]:
        """Every alternative as bounds between the points of n objects."""
        return [
            [(*bound.points(self.subject, self.object, n), bound.strict) for bound in conjunction]
            for conjunction in self.alternatives
        ]


@dataclass(frozen=True, eq=False)
class State:
    """The closed bounds between p points as bit rows, shape (p, ceil(p / 64)) each."""

    weak: NDArray[np.uint64]  # the row's point is not after the column's
    strong: NDArray[np.uint64]  # the row's point is before the column's

    def copy(self) -> State:
        return State(self.weak.copy(), self.strong.copy())

    def add(self, row: Row) -> bool:
        """Adds a bound; False where it contradicts the others, after which the state is of no use."""
        from deixis.reasoning.entailment.choice_kernels import add_bound

        return bool(add_bound(self.weak, self.strong, *row))


def base_state(rows: Sequence[Row], n: int) -> State | None:
    """The closure of bounds between the points of n objects; None where they contradict each other."""
    points = 2 * AXES * n
    state = State(
        np.zeros((points, (points + 63) // 64), np.uint64), np.zeros((points, (points + 63) // 64), np.uint64)
    )
    here = np.arange(points)
    state.weak[here, here >> 6] = np.uint64(1) << (here & 63).astype(np.uint64)
    own = [((2 * axis) * n + k, (2 * axis + 1) * n + k, True) for axis in range(AXES) for k in range(n)]
    return state if all(state.add(row) for row in [*own, *rows]) else None


class Search:
    """Searches for pictures of bounds and choices until ``deadline`` (``time.monotonic``)."""

    def __init__(self, choices: Sequence[Choice], n: int, deadline: float) -> None:
        self._deadline = deadline
        parts = [conjunction for choice in choices for conjunction in choice.rows(n)]
        self._first_part = np.cumsum([0, *(len(choice.alternatives) for choice in choices)])
        self._first_bound = np.cumsum([0, *(len(part) for part in parts)])
        rows = [row for part in parts for row in part]
        self._tails = np.array([row[0] for row in rows], np.int64)
        self._heads = np.array([row[1] for row in rows], np.int64)
        self._strict = np.array([row[2] for row in rows], np.bool_)
        self._bounds = self._first_part, self._first_bound, self._tails, self._heads, self._strict
        self._taken = np.full(len(choices), -1, np.int64)

    def picture(self, state: State) -> State | None:
        """A state below ``state`` in which every choice is settled; None where there is none.

        A single dive that takes what the last picture took comes first, since most pictures are found so. Raises
        OutOfTimeError at the deadline.
        """
        from deixis.reasoning.entailment.choice_kernels import dive

        self._check_clock()
        below = state.copy()
        if dive(below.weak, below.strong, *self._bounds, *self._open(), self._taken):
            return below
        return self._search(state.copy(), *self._open())

    def _open(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """All alternatives left, and all choices to be made."""
        return np.ones(self._first_part[-1], np.bool_), np.ones(len(self._first_part) - 1, np.bool_)

    def _check_clock(self) -> None:
        if time.monotonic() > self._deadline:
            raise OutOfTimeError("the time limit struck before every choice in the facts was weighed")

    def settled(self, state: State) -> State | None:
        """The state with everything added that single choices force; None where one has nothing left."""
        below = state.copy()
        return None if self._propagate(below, *self._open()) == -2 else below

    def _propagate(self, state: State, alive: NDArray[np.bool_], pending: NDArray[np.bool_]) -> int:
        from deixis.reasoning.entailment.choice_kernels import propagate

        return int(propagate(state.weak, state.strong, *self._bounds, alive, pending))

    def _search(self, state: State, alive: NDArray[np.bool_], pending: NDArray[np.bool_]) -> State | None:
        """Depth first with a stack of its own, so that many choices are no deep recursion."""
        stack = [(state, alive, pending)]
        while stack:
            self._check_clock()
            state, alive, pending = stack.pop()
            choice = self._propagate(state, alive, pending)
            if choice == -1:
                return state
            if choice == -2:
                continue
            parts = range(self._first_part[choice], self._first_part[choice + 1])
            for part in reversed([part for part in parts if alive[part]]):
                below = state.copy()
                if all(below.add(row) for row in self._rows(part)):
                    left = pending.copy()
                    left[choice] = False
                    stack.append((below, alive.copy(), left))
        return None

    def _rows(self, part: int) -> list[Row]:
        chosen = range(self._first_bound[part], self._first_bound[part + 1])
        return [(int(self._tails[k]), int(self._heads[k]), bool(self._strict[k])) for k in chosen]


def shared(search: Search, state: State) -> tuple[State | None, bool]:
    """What all pictures below a state share, and whether that is all of it; None where there is no picture.

    At the deadline what has been proved so far is given, which is right, and False. Raises OutOfTimeError where not
    even one picture was found.
    """
    picture = search.picture(state)
    if picture is None:
        return None, True
    known = search.settled(state)
    assert known is not None
    common = picture
    try:
        while (row := _candidate(known, common)) is not None:
            without = known.copy()
            other = search.picture(without) if without.add(_denied(row)) else None
            if other is None:
                known.add(row)
            else:
                common = State(common.weak & other.weak, common.strong & other.strong)
    except OutOfTimeError:
        return known, False
    return known, True


def _denied(row: Row) -> Row:
    tail, head, strict = row
    return head, tail, not strict


def _candidate(known: State, common: State) -> Row | None:
    """A bound that holds in all pictures found and is not known to follow; strict ones first, they say more."""
    for strict, held, seen in ((True, known.strong, common.strong), (False, known.weak, common.weak)):
        tails, words = np.nonzero(seen & ~held)
        if len(tails):
            bits = int(seen[tails[0], words[0]] & ~held[tails[0], words[0]])
            return int(tails[0]), 64 * int(words[0]) + (bits & -bits).bit_length() - 1, strict
    return None
