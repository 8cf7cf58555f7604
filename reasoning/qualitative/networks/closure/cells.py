"""Lay out the relations of a network in memory, and run the compiled loops for each layout."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.qualitative.networks.closure.tables import Tables, half_of

Words = NDArray[np.uint64]


class Cells(ABC):
    """The relations of all pairs of n things, and the data that the loops need to narrow them.

    ``bookkeeping``, below, are the arrays dirty, waiting, clock, trail and count of ``kernels``, in that order.
    """

    atoms_per_row: int  # trail steps that narrowing one row may add, per thing

    @abstractmethod
    def restrict(self, ends: tuple[Any, ...], words: Words, start: int, bookkeeping: tuple[Any, ...]) -> int:
        """Intersect pairs with relations; return the first constraint not dealt with.

        Parameters
        ----------
        ends
            First and second thing of each of m constraints, and the row of its relation, arrays of shape (m,).
        words
            Different relations in words of 64 atoms, shape (k, words).
        start
            Position of the constraint to begin with.
        bookkeeping
            The arrays of the loops.

        Returns
        -------
        int
            Position of a constraint; m where all have been dealt with.
        """

    @abstractmethod
    def advance(self, budget: int, bookkeeping: tuple[Any, ...]) -> int:
        """Propagate changes; return CLOSED, EMPTIED, PAUSED or FULL.

        Parameters
        ----------
        budget
            Maximum number of changes to propagate in this call.
        bookkeeping
            The arrays of the loops.

        Returns
        -------
        int
            State in which the loop stopped.
        """

    @abstractmethod
    def relation(self, first: int, second: int) -> int:
        """Return the current relation of a pair.

        Parameters
        ----------
        first, second
            Numbers of two things.

        Returns
        -------
        int
            Relation as a bit mask.
        """

    @abstractmethod
    def relations(self) -> Words:
        """Return the current relations of all pairs.

        Returns
        -------
        ndarray
            Words of 64 atoms, shape (n, n, words), row to column.
        """


class Masks(Cells):
    """A layout for small calculi: 16 bits for each pair."""

    atoms_per_row = 1

    def __init__(self, size: int, tables: Tables, identity: int) -> None:
        self._tables, self._half = tables, half_of(tables.atoms)
        self.masks = np.full((size, size), (1 << tables.atoms) - 1, dtype=np.uint16)
        np.fill_diagonal(self.masks, 1 << identity)

    def restrict(self, ends: tuple[Any, ...], words: Words, start: int, bookkeeping: tuple[Any, ...]) -> int:
        """Intersect pairs with relations in the compiled loop; return the first constraint not dealt with."""
        from deixis.reasoning.qualitative.networks.closure.mask_kernels import restrict

        layout = self._half, self.masks, self._tables.mask_converses
        return int(restrict(*ends, words, start, *layout, *bookkeeping))

    def advance(self, budget: int, bookkeeping: tuple[Any, ...]) -> int:
        """Propagate changes in the compiled loop; return CLOSED, EMPTIED, PAUSED or FULL."""
        from deixis.reasoning.qualitative.networks.closure.mask_kernels import advance

        table = self._tables
        return int(advance(budget, self._half, table.compositions, table.mask_converses, self.masks, *bookkeeping))

    def relation(self, first: int, second: int) -> int:
        """Return the current relation of a pair."""
        return int(self.masks[first, second])

    def relations(self) -> Words:
        """Return the current relations of all pairs, (n, n, words of 64 atoms)."""
        return self.masks.astype(np.uint64)[:, :, None]


class Planes(Cells):
    """A layout for calculi of any size: one bit for each pair and atom, 64 pairs to a word."""

    def __init__(self, size: int, tables: Tables, identity: int) -> None:
        self._tables = tables
        self.atoms_per_row = tables.atoms
        self._full = np.full((size + 63) // 64, 0xFFFFFFFFFFFFFFFF, dtype=np.uint64)
        if size % 64:
            self._full[-1] = (1 << size % 64) - 1
        self.planes = np.tile(self._full[:, None], (size, 1, tables.atoms))
        things = np.arange(size)
        itself = np.zeros((size, tables.atoms), dtype=np.uint64)
        itself[:, identity] = np.uint64(1) << (things & 63).astype(np.uint64)
        others = ~(np.uint64(1) << (things & 63).astype(np.uint64))
        self.planes[things, things >> 6] = self.planes[things, things >> 6] & others[:, None] | itself

    def restrict(self, ends: tuple[Any, ...], words: Words, start: int, bookkeeping: tuple[Any, ...]) -> int:
        """Intersect pairs with relations in the compiled loop; return the first constraint not dealt with."""
        from deixis.reasoning.qualitative.networks.closure.kernels import restrict

        return int(restrict(*ends, words, start, self.planes, self._tables.converses, *bookkeeping))

    def advance(self, budget: int, bookkeeping: tuple[Any, ...]) -> int:
        """Propagate changes in the compiled loop; return CLOSED, EMPTIED, PAUSED or FULL."""
        from deixis.reasoning.qualitative.networks.closure.kernels import advance

        table = self._tables
        return int(advance(budget, table.sizes, table.needs, table.converses, self._full, self.planes, *bookkeeping))

    def relation(self, first: int, second: int) -> int:
        """Return the current relation of a pair."""
        bit = self.planes[first, second >> 6] >> np.uint64(second & 63) & np.uint64(1)
        return int.from_bytes(np.packbits(bit.astype(np.uint8), bitorder="little").tobytes(), "little")

    def relations(self) -> Words:
        """Return the current relations of all pairs, (n, n, words of 64 atoms)."""
        from deixis.reasoning.qualitative.networks.closure.kernels import relations

        size = len(self.planes)
        out = np.empty((size, size, (self._tables.atoms + 63) // 64), dtype=np.uint64)
        relations(self.planes, out)
        return out
