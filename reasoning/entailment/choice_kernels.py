"""The compiled loops under :mod:`deixis.reasoning.entailment.choices`, on closed bit rows of points, shape (points,
words).

A row of bits is as in :mod:`deixis.reasoning.entailment.kernels`: bit b of word w is point 64 w + b.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def add_bound(weak, strong, tail, head, strict):  # type: ignore[no-untyped-def]
    """Adds one bound to closed bit rows, shape (points, words); False where it contradicts them."""
    one = np.uint64(1)
    word, mask = tail >> 6, one << np.uint64(tail & 63)
    against = weak if strict else strong
    if against[head, word] & mask:
        return False
    words = weak.shape[1]
    for u in range(len(weak)):
        if not weak[u, word] & mask:
            continue
        stronger = strict or (strong[u, word] & mask) != 0
        for w in range(words):
            strong[u, w] |= weak[head, w] if stronger else strong[head, w]
            weak[u, w] |= weak[head, w]
    return True


@njit(cache=True)
def standing(weak, strong, tail, head, strict):  # type: ignore[no-untyped-def]
    """Whether closed bit rows imply a bound (1), exclude it (-1), or leave it open (0)."""
    there = np.uint64(1) << np.uint64(head & 63)
    back = np.uint64(1) << np.uint64(tail & 63)
    if (strong if strict else weak)[tail, head >> 6] & there:
        return 1
    if (weak if strict else strong)[head, tail >> 6] & back:
        return -1
    return 0


@njit(cache=True)
def propagate(weak, strong, first_part, first_bound, tails, heads, strict, alive, pending):  # type: ignore[no-untyped-def]
    """Takes every choice of which one alternative is left, until nothing changes.

    The alternatives of choice c are ``first_part[c]:first_part[c + 1]``, the bounds of alternative p
    ``first_bound[p]:first_bound[p + 1]``; ``alive`` and ``pending`` say which alternatives and choices are left.
    Returns the choice with the fewest alternatives left, -1 where all are settled, -2 on a contradiction.
    """
    changed = True
    while changed:
        changed = False
        best, fewest = -1, 1 << 30
        for c in range(len(pending)):
            if not pending[c]:
                continue
            left, last = 0, -1
            for p in range(first_part[c], first_part[c + 1]):
                if not alive[p]:
                    continue
                lowest = 1
                for b in range(first_bound[p], first_bound[p + 1]):
                    lowest = min(lowest, standing(weak, strong, tails[b], heads[b], strict[b]))
                if lowest == 1:
                    pending[c] = False
                    break
                if lowest == -1:
                    alive[p] = False
                    continue
                left += 1
                last = p
            if not pending[c]:
                continue
            if left == 0:
                return -2
            if left == 1:
                for b in range(first_bound[last], first_bound[last + 1]):
                    if not add_bound(weak, strong, tails[b], heads[b], strict[b]):
                        return -2
                pending[c] = False
                changed = True
            elif left < fewest:
                best, fewest = c, left
    return best


@njit(cache=True)
def dive(weak, strong, first_part, first_bound, tails, heads, strict, alive, pending, taken):  # type: ignore[no-untyped-def]
    """Settles all choices without ever going back: each takes the alternative that it took last, else the first left.

    False where that ends in a contradiction, which says nothing of other ways. ``taken`` (choices,) holds what was
    taken (-1: nothing yet) and is written.
    """
    while True:
        choice = propagate(weak, strong, first_part, first_bound, tails, heads, strict, alive, pending)
        if choice < 0:
            return choice == -1
        part = taken[choice]
        if part < 0 or not alive[part]:
            part = first_part[choice]
            while not alive[part]:
                part += 1
        for b in range(first_bound[part], first_bound[part + 1]):
            if not add_bound(weak, strong, tails[b], heads[b], strict[b]):
                return False
        taken[choice] = part
        pending[choice] = False
