"""The hot loop of difference constraints: all shortest paths after one constraint more."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray


@njit(cache=True)
def tighten(
    distances: NDArray[np.int64],
    last: NDArray[np.int32],
    tail: int,
    head: int,
    bound: int,
    number: int,
    free: int,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int32]]:
    """Takes in ``x[head] - x[tail] <= bound``, the constraint of that number, which closes no negative cycle.

    ``distances`` and ``last`` (points, points) are changed: the shortest paths, and the last constraint on each.
    Distances of ``free`` and more are none. Returns the flat places that changed and what was there before.
    """
    points = len(distances)
    rows = np.flatnonzero(distances[:, tail] + bound < distances[:, head])
    columns = np.flatnonzero(distances[head] + bound < distances[tail])
    ends = last[head, columns]
    ends[columns == head] = number
    onward = bound + distances[head, columns]
    cells = np.empty(len(rows) * len(columns), dtype=np.int64)
    old_distances, old_last = np.empty(len(cells), dtype=np.int64), np.empty(len(cells), dtype=np.int32)
    changed = 0
    for row in rows:
        start = distances[row, tail]
        for k, column in enumerate(columns):
            through = start + onward[k]
            if through < distances[row, column] and through < free:
                cells[changed] = row * points + column
                old_distances[changed], old_last[changed] = distances[row, column], last[row, column]
                distances[row, column], last[row, column] = through, ends[k]
                changed += 1
    return cells[:changed].copy(), old_distances[:changed].copy(), old_last[:changed].copy()
