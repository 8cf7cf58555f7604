"""Run algebraic closure in compiled loops for small calculi: one axis, up to 16 atoms, pair by pair.

A network of n things is ``masks`` (n, n), each relation 16 bits. For look-ups a relation is cut in two, its lower
``half`` bits and the rest: ``compositions`` (2, 2^half, 2, 2^half) composes each part of a left relation with each part
of a right one, ``converses`` (2, 2^half) takes the converse of each part. A row of the trail holds row, column, the
removed atoms, and the thing that caused it. Everything else is as in
:mod:`deixis.reasoning.qualitative.networks.closure.kernels`.
"""

from __future__ import annotations

import numpy as np

from deixis.reasoning.kernel import kernel
from deixis.reasoning.qualitative.networks.closure.kernels import CLOSED, EMPTIED, FULL, ONE, PAUSED, low_bit, mark


@kernel()
def _narrow(i, k, left, by, half, masks, converses, dirty, waiting, clock, trail, count):  # type: ignore[no-untyped-def]
    """Narrow a pair, seen from both things; return False if nothing is left."""
    if count[0] >= 0:
        trail[count[0], 0] = i
        trail[count[0], 1] = k
        trail[count[0], 2] = masks[i, k] & ~left
        trail[count[0], 3] = by
        count[0] += 1
    masks[i, k] = left
    masks[k, i] = converses[0, left & ((1 << half) - 1)] | converses[1, left >> half]
    mark(i, k, dirty, waiting)
    mark(k, i, dirty, waiting)
    if not left:
        clock[2], clock[3], clock[4] = i, k, by
    return left != 0


@kernel(lambda firsts, *rest: 10 * len(firsts))
def restrict(firsts, seconds, ids, words, start, half, masks, converses, dirty, waiting, clock, trail, count):  # type: ignore[no-untyped-def]
    """Intersect pairs with relations, from constraint ``start`` on; return the first constraint not dealt with."""
    for m in range(start, len(firsts)):
        if count[0] >= 0 and count[0] >= len(trail):
            return m
        i, k = firsts[m], seconds[m]
        left = masks[i, k] & np.uint16(words[ids[m], 0])
        if left != masks[i, k] and not _narrow(
            i, k, left, -1, half, masks, converses, dirty, waiting, clock, trail, count
        ):
            return len(firsts)
    return len(firsts)


def _steps(budget, half, compositions, converses, masks, *rest):  # type: ignore[no-untyped-def]
    """Estimate the steps of closure: every pair is propagated several times, to every third thing."""
    return 4 * len(masks) ** 3


@kernel(_steps)
def advance(budget, half, compositions, converses, masks, dirty, waiting, clock, trail, count):  # type: ignore[no-untyped-def]
    """Propagate ``budget`` changes; return CLOSED, EMPTIED, PAUSED (budget spent) or FULL (no room in the trail)."""
    n, words = dirty.shape
    rows = np.zeros((2, 1 << half), dtype=np.uint16)
    changed = np.zeros(n + 1, dtype=np.int64)
    lefts = np.zeros(n + 1, dtype=np.uint16)
    idle = 0
    while idle <= n:
        i = clock[0]
        if waiting[i] == 0:
            clock[0] = i + 1 if i + 1 < n else 0
            idle += 1
            continue
        idle = 0
        for w in range(words):
            while dirty[i, w]:
                if budget <= 0:
                    return PAUSED
                if count[0] >= 0 and count[0] + n > len(trail):
                    return FULL
                j = (w << 6) + int(low_bit(dirty[i, w]))
                dirty[i, w] &= dirty[i, w] - ONE
                waiting[i] -= 1
                budget -= 1
                clock[1] += 1
                _compose(masks[i, j], half, compositions, rows)
                for c in range(narrower(masks[i], masks[j], half, rows[0], rows[1], changed, lefts)):
                    if not _narrow(
                        i, changed[c], lefts[c], j, half, masks, converses, dirty, waiting, clock, trail, count
                    ):
                        return EMPTIED
    return CLOSED


@kernel()
def _compose(relation, half, compositions, rows):  # type: ignore[no-untyped-def]
    """Compose the relation with every lower part, and with every upper part."""
    low, high = compositions[0, relation & ((1 << half) - 1)], compositions[1, relation >> half]
    for part in range(2):
        np.bitwise_or(low[part], high[part], rows[part])


@kernel()
def narrower(mine, others, half, low, high, changed, lefts):  # type: ignore[no-untyped-def]
    """List the narrowed pairs of a row, and their new relations; branch-free, since branches would be unpredictable."""
    found, shift = np.uint64(0), np.uint64(half)
    lower = (ONE << shift) - ONE
    for k in range(len(mine)):
        other = np.uint64(others[k])
        left = mine[k] & (low[other & lower] | high[other >> shift])
        changed[found], lefts[found] = k, left
        found += np.uint64(left != mine[k])
    return found
