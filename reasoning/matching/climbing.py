"""Climbing to where no move and no swap helps, in double precision; compiled."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def climb(labels, problem):  # type: ignore[no-untyped-def]
    """Moves and swaps of one object after another, each the best there is, until none helps."""
    out = problem.unary.shape[1] - 1
    holder = np.full(out + 1, -1)
    for i in range(len(labels)):
        holder[labels[i]] = i
    holder[out] = -1
    gain, better = np.empty(out + 1), True
    while better:
        better = False
        for i in range(len(labels)):
            gains_of(i, labels, problem, gain)
            best, chosen = 1e-9, -1
            for p in range(out + 1):
                if p != labels[i] and gain[p] > -np.inf:
                    gained = _exchange_gain(i, p, holder[p], gain, labels, problem)
                    if gained > best:
                        best, chosen = gained, p
            if chosen >= 0:
                better = True
                _exchange(i, chosen, labels, holder, out)


@njit(cache=True)
def gains_of(i, labels, problem, gain):  # type: ignore[no-untyped-def]
    """What object i is worth as each thing, with the others as they are, into ``gain`` (n2 + 1,)."""
    gain[:] = problem.unary[i]
    for slot in range(problem.first[i], problem.first[i + 1]):
        kind, q = problem.kind[problem.twin[slot]], labels[problem.other[slot]]
        for p in range(len(gain)):
            gain[p] += problem.tables[kind, q, p]


@njit(cache=True)
def _exchange_gain(i, p, j, gain, labels, problem):  # type: ignore[no-untyped-def]
    """What it gains to give object i thing p, and i's thing to j, who had p (or had nobody, -1)."""
    old = labels[i]
    gained = gain[p] - gain[old]
    if j < 0:
        return gained
    gained += problem.unary[j, old] - problem.unary[j, p]
    for slot in range(problem.first[j], problem.first[j + 1]):
        table, k = problem.tables[problem.kind[slot]], problem.other[slot]
        if k == i:  # counted at i's end with j still at p
            gained += np.float64(table[old, p]) - np.float64(table[p, p])
        else:
            gained += np.float64(table[old, labels[k]]) - np.float64(table[p, labels[k]])
    return gained


@njit(cache=True)
def _exchange(i, p, labels, holder, out):  # type: ignore[no-untyped-def]
    old, j = labels[i], holder[p]
    labels[i] = p
    if p < out:
        holder[p] = i
    if j >= 0:
        labels[j] = old
    if old < out:
        holder[old] = j
