"""Averages over neighbours, and connected points, on a table of neighbours (n, k); compiled."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def averaged(values, neighbours, apart, rounds):  # type: ignore[no-untyped-def]
    """Each value (n,) averaged with those of its neighbours that differ by no more than ``apart`` (n,), repeatedly."""
    before = values.copy()
    after = np.empty_like(before)
    for _ in range(rounds):
        for i in range(len(before)):
            total, count = before[i], 1
            for j in neighbours[i]:
                if j >= 0 and abs(before[j] - before[i]) <= apart[i]:
                    total += before[j]
                    count += 1
            after[i] = total / count
        before, after = after, before
    return before


@njit(cache=True, nogil=True)
def grown(seeds, allowed, neighbours):  # type: ignore[no-untyped-def]
    """The seeds (n,), and all allowed points (n,) that are connected with them through allowed ones."""
    reached = seeds.copy()
    stack = np.empty(len(seeds), np.int64)
    count = 0
    for i in range(len(seeds)):
        if seeds[i]:
            stack[count] = i
            count += 1
    while count:
        count -= 1
        for j in neighbours[stack[count]]:
            if j >= 0 and allowed[j] and not reached[j]:
                reached[j] = True
                stack[count] = j
                count += 1
    return reached
