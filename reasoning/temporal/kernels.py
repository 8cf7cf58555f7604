"""The compiled loops of the simple temporal network, on plain arrays.

Throughout: ``distances`` (m, m) int64, of which the first ``count`` rows and columns are in use, holds the tightest
bound on *column point minus row point* as a code of :mod:`deixis.reasoning.temporal.bounds`.
"""

from __future__ import annotations

import numpy as np
from numba import njit

_UNBOUNDED = 1 << 62
_ZERO = 1


@njit(cache=True)
def _add(a, b):  # type: ignore[no-untyped-def]
    if a >= _UNBOUNDED or b >= _UNBOUNDED:
        return _UNBOUNDED
    return ((a & ~1) + (b & ~1)) | (a & b & 1)


@njit(cache=True)
def tighten(distances, count, tail, head, code):  # type: ignore[no-untyped-def]
    """Takes in one constraint that closes no negative cycle, in O(count ** 2), in place.

    Only rows that reach the head better through it, and columns that the tail reaches better, can change. Returns the
    cells that changed, as flat indices, and what stood there before.
    """
    rows, reach = np.empty(count, np.int64), np.empty(count, np.int64)
    columns, onward = np.empty(count, np.int64), np.empty(count, np.int64)
    n_rows = n_columns = 0
    for i in range(count):
        through = _add(distances[i, tail], code)
        if through < distances[i, head]:
            rows[n_rows], reach[n_rows] = i, through
            n_rows += 1
        if _add(code, distances[head, i]) < distances[tail, i]:
            columns[n_columns], onward[n_columns] = i, distances[head, i]
            n_columns += 1
    cells, before = np.empty(n_rows * n_columns, np.int64), np.empty(n_rows * n_columns, np.int64)
    changed = 0
    for r in range(n_rows):
        i = rows[r]
        for c in range(n_columns):
            j = columns[c]
            through = _add(reach[r], onward[c])
            if through < distances[i, j]:
                cells[changed], before[changed] = i * distances.shape[1] + j, distances[i, j]
                changed += 1
                distances[i, j] = through
    return cells[:changed].copy(), before[:changed].copy()


@njit(cache=True)
def close(distances, count):  # type: ignore[no-untyped-def]
    """All shortest paths from direct bounds, in place and in O(count ** 3) (Floyd 1962, Warshall 1962)."""
    for k in range(count):
        for i in range(count):
            first = distances[i, k]
            if first < _UNBOUNDED and i != k:
                for j in range(count):
                    through = _add(first, distances[k, j])
                    if through < distances[i, j]:
                        distances[i, j] = through


@njit(cache=True)
def _realisable(four, constraints):  # type: ignore[no-untyped-def]
    """Whether constraints (k, 3: tail, head, code) can be added to a closed network of four points; changes it."""
    for k in range(len(constraints)):
        tail, head, code = constraints[k]
        if code >= _UNBOUNDED or code >= four[tail, head]:
            continue
        if _add(four[head, tail], code) < _ZERO:
            return False
        for i in range(4):
            first = _add(four[i, tail], code)
            for j in range(4):
                through = _add(first, four[head, j])
                if through < four[i, j]:
                    four[i, j] = through
    return True


@njit(cache=True)
def admitted(distances, pairs, definitions):  # type: ignore[no-untyped-def]
    """The Allen relations that each pair of fluents may bear: masks, shape (p,) uint16.

    ``pairs`` (p, 4) holds the points of start and finish of the first fluent and of the second; ``definitions``
    (13, k, 3) the constraints that define each relation on these four, padded with unbounded ones.
    """
    masks = np.zeros(len(pairs), np.uint16)
    four, trial = np.empty((4, 4), np.int64), np.empty((4, 4), np.int64)
    for p in range(len(pairs)):
        for i in range(4):
            for j in range(4):
                four[i, j] = distances[pairs[p, i], pairs[p, j]]
        for relation in range(13):
            trial[:] = four
            if _realisable(trial, definitions[relation]):
                masks[p] |= np.uint16(1 << relation)
    return masks
