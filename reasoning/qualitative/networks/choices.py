"""Which pair to choose for next in a search, kept up to date from what changed instead of looked for among all pairs.

Pairs i < k of n things are counted as i * n + k.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from heapq import heappop, heappush

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.qualitative.calculi.calculus import atoms_of
from deixis.reasoning.qualitative.networks.state import NetworkState, distinct_rows

Open = tuple[int, int, tuple[int, ...]]
"""A pair, and the relations to try for it."""
PAIRS_PER_CHECK = 1 << 18  # pairs between two looks at the clock


class PairSelector(ABC):
    """The pairs of a state for which something is still to be chosen."""

    def __init__(self, state: NetworkState) -> None:
        self._state = state

    @abstractmethod
    def pick(self) -> Open | None:
        """Return the next pair, and what to try for it; None where nothing is left to choose."""

    @abstractmethod
    def note(self, positions: NDArray[np.int64]) -> None:
        """Take account of pairs (m,) that were narrowed, given back, or chosen for in vain."""


class FewestPiecesFirst(PairSelector):
    """The pair with the fewest tractable pieces among those with several; atoms where no subclass decides.

    Pairs wait in the order in which they are picked. One that changed waits in two places, and what it waits for in
    the old one is no longer true, which is seen when its turn comes.
    """

    def __init__(self, state: NetworkState, check: Callable[[], None]) -> None:
        super().__init__(state)
        self._pieces: dict[int, tuple[int, ...]] = {}
        self._pairs = max(1, state.size**2)
        size, found = self._state.size, [np.zeros(0, dtype=np.int64)]
        rows = max(1, PAIRS_PER_CHECK // max(1, size))
        for row in range(0, size, rows):
            check()
            positions = np.arange(row * size, min(row + rows, size) * size, dtype=np.int64)
            found.append(self._keys(positions[positions % size > positions // size]))
        self._first, self._next = np.sort(np.concatenate(found)), 0
        self._later: list[int] = []  # a heap
        self._waiting: set[int] = set()  # what is on it

    def _keys(self, positions: NDArray[np.int64]) -> NDArray[np.int64]:
        """Sorted by number of pieces, then by pair; only for pairs with several."""
        relations, ids = distinct_rows(self._state.relations_of(positions))
        counts = np.array([len(self._split(relation)) for relation in relations], dtype=np.int64)[ids]
        return (counts * self._pairs + positions)[counts > 1]

    def _split(self, relation: int) -> tuple[int, ...]:
        if relation not in self._pieces:
            calculus = self._state.calculus
            self._pieces[relation] = calculus.pieces(relation) if calculus.decided_by_closure else atoms_of(relation)
        return self._pieces[relation]

    def note(self, positions: NDArray[np.int64]) -> None:
        for key in self._keys(positions).tolist():
            if key not in self._waiting:
                self._waiting.add(key)
                heappush(self._later, key)

    def pick(self) -> Open | None:
        while self._later or self._next < len(self._first):
            if self._later and (self._next == len(self._first) or self._later[0] < self._first[self._next]):
                key = heappop(self._later)
                self._waiting.remove(key)
            else:
                self._next += 1
                key = int(self._first[self._next - 1])
            count, position = divmod(key, self._pairs)
            first, second = divmod(position, self._state.size)
            pieces = self._split(self._state.relation(first, second))
            if len(pieces) == count:
                return first, second, pieces
        return None


class FirstOpenPair(PairSelector):
    """The first pair that may still be several atoms."""

    def __init__(self, state: NetworkState) -> None:
        super().__init__(state)
        self._start = 0  # no pair before it may be several

    def note(self, positions: NDArray[np.int64]) -> None:
        if len(positions):
            self._start = min(self._start, int(positions.min()))

    def pick(self) -> Open | None:
        self._start = self._state.next_open(self._start)
        if self._start == self._state.size**2:
            return None
        first, second = divmod(self._start, self._state.size)
        return first, second, atoms_of(self._state.relation(first, second))
