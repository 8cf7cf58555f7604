"""Compiled passage through binary rows of which some columns are lists, so that no row is as long as the next."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

DONE, TOO_SHORT, NEGATIVE = range(3)
SKIPPED = -1


@njit(cache=True)
def _length_at(data: NDArray[np.uint8], at: int, size: int, signed: bool, big: bool) -> int:
    value = 0
    for place in range(size):
        value = (value << 8) | int(data[at + (place if big else size - 1 - place)])
    if signed and value >> (8 * size - 1):
        value -= 1 << (8 * size)
    return value


@njit(cache=True)
def walk(
    data: NDArray[np.uint8],
    at: int,
    sizes: NDArray[np.int64],
    length_sizes: NDArray[np.int64],
    signed: NDArray[np.bool_],
    big: bool,
    slots: NDArray[np.int64],
    starts: NDArray[np.int64],
    lengths: NDArray[np.int64],
) -> tuple[int, int, int]:
    """Fills ``starts`` and ``lengths`` (rows, wanted): at which byte each wanted value or list begins, and how many.

    ``length_sizes`` is 0 for a column that is no list. Returns what went wrong, at which byte and in which row.
    """
    for row in range(len(starts)):
        for column in range(len(sizes)):
            length = 1
            size = length_sizes[column]
            if size:
                if at + size > len(data):
                    return TOO_SHORT, at, row
                length = _length_at(data, at, size, signed[column], big)
                if length < 0:
                    return NEGATIVE, at, row
                at += size
            if at + length * sizes[column] > len(data):
                return TOO_SHORT, at, row
            if slots[column] != SKIPPED:
                starts[row, slots[column]] = at
                lengths[row, slots[column]] = length
            at += length * sizes[column]
    return DONE, at, len(starts)
