"""The best of two maps, part by part; compiled.

Where two maps differ, the objects that differ fall into parts with no fact and no thing in common. Each part may be
taken from either map, whatever is taken elsewhere, so that the best of all such combinations is found part by part
(partition crossover; Whitley, Hains and Howe 2009 for tours, Tinos, Whitley and Chicano 2015 for sums of terms).
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def combine(labels, other, problem):  # type: ignore[no-untyped-def]
    """Takes into ``labels`` (n1,) each part of the other map that is worth more there; returns what that gained."""
    part = _parts(labels, other, problem)
    gain = np.zeros(len(labels))
    for i in range(len(labels)):
        if labels[i] == other[i]:
            continue
        root = _root(part, i)
        gain[root] += problem.unary[i, other[i]] - problem.unary[i, labels[i]]
        for slot in range(problem.first[i], problem.first[i + 1]):
            j, kind = problem.other[slot], problem.kind[slot]
            if j > i or labels[j] == other[j]:  # a fact within the part counts once
                said = np.float64(problem.tables[kind, other[i], other[j]])
                gain[root] += said - problem.tables[kind, labels[i], labels[j]]
    total = 0.0
    for i in range(len(labels)):
        if gain[_root(part, i)] > 1e-9:
            labels[i] = other[i]
            total += max(gain[i], 0.0)
    return total


@njit(cache=True)
def _parts(labels, other, problem):  # type: ignore[no-untyped-def]
    """A forest of the objects (n1,): those that differ are in one tree with what shares a fact or a thing with them."""
    part, out = np.arange(len(labels)), problem.unary.shape[1] - 1
    wanted_by = np.full(out + 1, -1)
    for i in range(len(labels)):
        wanted_by[other[i]] = i
    for i in range(len(labels)):
        if labels[i] == other[i]:
            continue
        if labels[i] < out and wanted_by[labels[i]] >= 0:
            part[_root(part, i)] = _root(part, wanted_by[labels[i]])
        for slot in range(problem.first[i], problem.first[i + 1]):
            j = problem.other[slot]
            if labels[j] != other[j]:
                part[_root(part, i)] = _root(part, j)
    return part


@njit(cache=True)
def _root(part, i):  # type: ignore[no-untyped-def]
    while part[i] != i:
        part[i] = part[part[i]]
        i = part[i]
    return i
