"""The spread of the points around a place, compiled."""

from __future__ import annotations

import numpy as np
from numba import njit

from deixis.perception.features.cells import ball_runs, most_runs


@njit(cache=True, nogil=True, error_model="numpy")
def spreads(grid, places, radius, counts, covariances):  # type: ignore[no-untyped-def]
    """For places (m, 3): how many points lie within ``radius``, border included, and their covariance (m, 3, 3)."""
    runs = np.empty((most_runs(grid), 2), np.int64)
    for m in range(len(places)):
        place = places[m]
        count, x, y, z, xx, xy, xz, yy, yz, zz = 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for r in range(ball_runs(grid, place, radius, runs)):
            for i in range(runs[r, 0], runs[r, 1]):
                dx, dy, dz = grid.x[i] - place[0], grid.y[i] - place[1], grid.z[i] - place[2]
                if dx * dx + dy * dy + dz * dz <= radius * radius:
                    count += 1
                    x, y, z = x + dx, y + dy, z + dz
                    xx, xy, xz = xx + dx * dx, xy + dx * dy, xz + dx * dz
                    yy, yz, zz = yy + dy * dy, yz + dy * dz, zz + dz * dz
        counts[m] = count
        if count:
            x, y, z = x / count, y / count, z / count
            c = covariances[m]
            c[0, 0], c[1, 1], c[2, 2] = xx / count - x * x, yy / count - y * y, zz / count - z * z
            c[0, 1] = c[1, 0] = xy / count - x * y
            c[0, 2] = c[2, 0] = xz / count - x * z
            c[1, 2] = c[2, 1] = yz / count - y * z


@njit(cache=True, nogil=True, error_model="numpy")
def tally(grid, places, radius, counts):  # type: ignore[no-untyped-def]
    """For places (m, 3): how many points lie nearer than ``radius``."""
    runs = np.empty((most_runs(grid), 2), np.int64)
    for m in range(len(places)):
        place = places[m]
        for r in range(ball_runs(grid, place, radius, runs)):
            for i in range(runs[r, 0], runs[r, 1]):
                dx, dy, dz = grid.x[i] - place[0], grid.y[i] - place[1], grid.z[i] - place[2]
                counts[m] += dx * dx + dy * dy + dz * dz < radius * radius
