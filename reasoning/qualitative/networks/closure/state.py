"""Hold a network while it is being closed: relations that only lose atoms, and a trail that explains why."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.errors import LimitError
from deixis.reasoning.qualitative.calculi.calculus import Calculus
from deixis.reasoning.qualitative.calculi.words import relation_of, words_of
from deixis.reasoning.qualitative.networks.closure.cells import Cells, Masks, Planes
from deixis.reasoning.qualitative.networks.closure.tables import tables
from deixis.reasoning.qualitative.networks.network import Network

Progress = Callable[[int, int], None]
"""Function called now and then with the pairs propagated so far, and the pairs due so far, which may still grow.
"""

MAX_BYTES = 1 << 31  # maximum memory of a network, with its relations before and after as words of 64 atoms
MAX_TRAIL_STEPS = 1 << 25  # maximum trail: half a gigabyte
STEPS_PER_CHECK = 20_000_000  # steps between two readings of the clock: some hundredths of a second


class NetworkState:
    """The remaining relations of a network's pairs; ``traced`` keeps the trail, which explanations need."""

    def __init__(self, calculus: Calculus, size: int, traced: bool = False) -> None:
        require_size(calculus, size)
        self.calculus, self.size = calculus, size
        table = tables(calculus)
        self._atoms, self._work = table.atoms, 1 if table.small else table.atoms * int(table.sizes.sum()) // 64 + 1
        self._cells: Cells = (Masks if table.small else Planes)(size, table, calculus.identity)
        self._dirty = np.zeros((size, (size + 63) // 64), dtype=np.uint64)
        self._waiting = np.zeros(size, dtype=np.int64)
        self._clock = np.array([0, 0, -1, -1, -1], dtype=np.int64)
        self._trail = np.zeros((4096 if traced else 0, 4), dtype=np.int32)
        self._count = np.array([0 if traced else -1], dtype=np.int64)

    @property
    def _bookkeeping(self) -> tuple[NDArray[Any], ...]:
        return self._dirty, self._waiting, self._clock, self._trail, self._count

    @property
    def emptied(self) -> tuple[int, int] | None:
        """The pair whose relation is empty, if any."""
        return None if self._clock[2] < 0 else (int(self._clock[2]), int(self._clock[3]))

    @property
    def passes(self) -> int:
        """Number of changes of pairs that were propagated."""
        return int(self._clock[1])

    def add(self, network: Network) -> bool:
        """Intersect with all constraints of a network; return False if a pair is emptied.

        Parameters
        ----------
        network
            A network over the same things, in the same calculus.

        Returns
        -------
        bool
            False after a contradiction.

        Raises
        ------
        LimitError
            The trail of a traced state does not fit in memory.
        """
        arrays = network.arrays
        return self.restrict(arrays.firsts, arrays.seconds, arrays.ids, arrays.relations)

    def restrict(
        self,
        firsts: NDArray[np.int64],
        seconds: NDArray[np.int64],
        ids: NDArray[np.int64],
        relations: tuple[int, ...],
    ) -> bool:
        """Intersect the relations of pairs with given ones; return False if a pair is emptied.

        Parameters
        ----------
        firsts, seconds
            Numbers of the things of m pairs, shape (m,) each.
        ids
            Position of each pair's relation in ``relations``, shape (m,).
        relations
            Different relations, as bit masks.

        Returns
        -------
        bool
            False after a contradiction.

        Raises
        ------
        LimitError
            The trail of a traced state does not fit in memory.
        """
        if not len(firsts) or self.emptied is not None:
            return self.emptied is None
        words, done = words_of(relations, self._atoms), 0
        while done < len(firsts):
            done = self._cells.restrict((firsts, seconds, ids), words, done, self._bookkeeping)
            if done < len(firsts):
                self._lengthen(self._atoms)
        return self.emptied is None

    def close(self, deadline: Deadline = Deadline.never(), progress: Progress | None = None) -> bool:
        """Close the network, up to a contradiction; return False if the deadline came first.

        Parameters
        ----------
        deadline
            End of the time limit, after which closing can be continued.
        progress
            Function that is called with the number of propagated changes and the number with the waiting ones.

        Returns
        -------
        bool
            False if out of time.

        Raises
        ------
        LimitError
            The trail of a traced state does not fit in memory.
        """
        from deixis.reasoning.qualitative.networks.closure.kernels import CLOSED, EMPTIED, FULL

        if self.emptied is not None or not self.size:
            return True
        budget = STEPS_PER_CHECK // (self.size * self._work + 64) + 1
        while True:
            status = self._cells.advance(budget, self._bookkeeping)
            if status in (CLOSED, EMPTIED):
                return True
            if status == FULL:
                self._lengthen(self.size * self._cells.atoms_per_row)
            if progress is not None:
                progress(self.passes, self.passes + int(self._waiting.sum()))
            if deadline.passed:
                return False

    def _lengthen(self, room: int) -> None:
        length = 2 * len(self._trail) + room
        if length > MAX_TRAIL_STEPS:
            raise LimitError(
                f"an explanation among {self.size:,} things in {self.calculus.name} needs a trail of more than "
                f"{MAX_TRAIL_STEPS:,} steps; split the network"
            )
        longer = np.zeros((length, 4), dtype=np.int32)
        longer[: len(self._trail)] = self._trail
        self._trail = longer

    def support(self, first: int, second: int) -> NDArray[np.bool_]:
        """Return the pairs i <= k whose constraints led to the relation of this one.

        Parameters
        ----------
        first, second
            Numbers of two things. The state must be traced.

        Returns
        -------
        ndarray
            Mask of the pairs, shape (n, n).
        """
        from deixis.reasoning.qualitative.networks.closure.kernels import support

        needed = np.zeros((self.size, self.size), dtype=np.bool_)
        support(first, second, int(self._count[0]), self._trail, needed)
        return needed

    def relation(self, first: int, second: int) -> int:
        """Return the current relation of a pair.

        Parameters
        ----------
        first, second
            Numbers of two things.

        Returns
        -------
        int
            Relation of ``first`` to ``second``, as a bit mask.
        """
        return self._cells.relation(first, second)

    def relations(self) -> NDArray[np.uint64]:
        """Return the current relations of all pairs.

        Returns
        -------
        ndarray
            Words of 64 atoms, shape (n, n, words), row to column.
        """
        return self._cells.relations()

    def distinct(self) -> tuple[tuple[int, ...], NDArray[np.int64]]:
        """Return the distinct relations, and the position of each pair's relation among them.

        Returns
        -------
        tuple
            Relations as bit masks, and positions, shape (n, n).
        """
        words = self.relations()
        relations, ids = distinct_rows(words.reshape(-1, words.shape[2]))
        return relations, ids.reshape(self.size, self.size)

    def masks(self) -> NDArray[np.uint64]:
        """Return the current relations of all pairs in a calculus of at most 64 atoms.

        Returns
        -------
        ndarray
            Bit masks, shape (n, n).

        Raises
        ------
        LimitError
            The calculus has more than 64 atoms.
        """
        if self._atoms > 64:
            raise LimitError(
                f"products are searched with up to 64 atoms an axis; {self.calculus.name} has {self._atoms}"
            )
        return self.relations()[:, :, 0]


def distinct_rows(words: NDArray[np.uint64]) -> tuple[tuple[int, ...], NDArray[np.int64]]:
    """Return the distinct rows as relations, and each row's position among them.

    Parameters
    ----------
    words
        Relations in words of 64 atoms, shape (m, words).

    Returns
    -------
    tuple
        Relations as bit masks, and positions, shape (m,).
    """
    if words.shape[1] == 1:
        values, ids = np.unique(words[:, 0], return_inverse=True)
        return tuple(int(value) for value in values), ids.astype(np.int64)
    rows = np.ascontiguousarray(words)
    packed = rows.view([("", rows.dtype)] * rows.shape[1]).ravel()
    _, first, ids = np.unique(packed, return_index=True, return_inverse=True)
    return tuple(relation_of(rows[k]) for k in first), ids.astype(np.int64)


def require_size(calculus: Calculus, size: int) -> None:
    """Raise LimitError, before anything is allocated, if a network of that size would not fit in memory.

    Parameters
    ----------
    calculus
        Calculus of the network.
    size
        Number of things.

    Raises
    ------
    LimitError
        The network would not fit in memory.
    """
    table = tables(calculus)
    bits = (16 if table.small else table.atoms) + 2 * 64 * ((table.atoms + 63) // 64)  # bytes of a pair
    if size * size * bits // 8 > MAX_BYTES:
        most = int((8 * MAX_BYTES / bits) ** 0.5)
        raise LimitError(
            f"a network of {size:,} things in {calculus.name} takes more than {MAX_BYTES >> 20:,} MB; up to {most:,} "
            "things can be closed: number the things without gaps, or split the network where nothing connects it"
        )
