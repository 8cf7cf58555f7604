"""What the compiled loops of both layouts share; ``kernels`` describes the arrays."""

from __future__ import annotations

import numpy as np
from numba import njit, types
from numba.extending import intrinsic

CLOSED, EMPTIED, PAUSED, FULL = 0, 1, 2, 3

ONE = np.uint64(1)
NONE = np.uint64(0)


@intrinsic
def _trailing_zeros(typing, word):  # type: ignore[no-untyped-def]
    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        return builder.cttz(arguments[0], context.get_constant(types.boolean, True))

    return types.uint64(types.uint64), generate


@njit(cache=True)
def low_bit(word):  # type: ignore[no-untyped-def]
    """The position of the lowest bit of a word that is not 0; unsigned, so that indexing needs no look at its sign."""
    return _trailing_zeros(word)  # type: ignore[call-arg]


@njit(cache=True)
def mark(i, k, dirty, waiting):  # type: ignore[no-untyped-def]
    bit = ONE << np.uint64(k & 63)
    if i != k and not dirty[i, k >> 6] & bit:
        dirty[i, k >> 6] |= bit
        waiting[i] += 1


@njit(cache=True)
def support(i, k, count, trail, needed):  # type: ignore[no-untyped-def]
    """Marks in ``needed`` (n, n) the pairs on which the relation of i and k rests, going back through the trail."""
    needed[min(i, k), max(i, k)] = True
    for m in range(count - 1, -1, -1):
        a, b, by = trail[m, 0], trail[m, 1], trail[m, 3]
        if by >= 0 and needed[min(a, b), max(a, b)]:
            needed[min(a, by), max(a, by)] = True
            needed[min(b, by), max(b, by)] = True
