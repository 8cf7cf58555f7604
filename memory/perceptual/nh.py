"""The compiled sum behind :mod:`deixis.memory.perceptual.checksum`."""

from __future__ import annotations

import numpy as np
from numba import njit

_LOWER, _HALF = np.uint64(0xFFFFFFFF), np.uint64(32)
_ODD = np.uint64(0x9E3779B97F4A7C15)


@njit(cache=True, nogil=True)
def nh(words, key, length, rest):  # type: ignore[no-untyped-def]
    """NH of 64-bit words (n,), each taken as two numbers of 32 bits, under a key (b,) of as many as a block has.

    The sums of the blocks are chained, beginning with the length in bytes, and ending with the rest of the
    bytes as a number.
    """
    total = np.uint64(length)
    for first in range(0, words.size, key.size):
        block = words[first : first + key.size]  # a slice: with a sum for an index it would not be as fast
        part = np.uint64(0)
        for i in range(block.size):
            word, other = block[i], key[i]
            part += ((word + other) & _LOWER) * (((word >> _HALF) + (other >> _HALF)) & _LOWER)
        total = (total ^ part) * _ODD
    return (total ^ np.uint64(rest)) * _ODD
