"""The spread of what is near a point along a surface; compiled."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True, error_model="numpy")
def spreads(points, neighbours, radius, jump):  # type: ignore[no-untyped-def]
    """For points (n, 3): mean (n, 3) and covariance (n, 3, 3) of those within ``radius`` (n,) that are reached from
    neighbour to neighbour without a ``jump`` (n,)."""
    n = len(points)
    means, covariances = np.empty((n, 3)), np.empty((n, 3, 3))
    stamp, queue = np.full(n, -1, np.int64), np.empty(n, np.int64)
    for i in range(n):
        queue[0], stamp[i], head, tail = i, i, 0, 1
        x, y, z, xx, xy, xz, yy, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        reach, step = radius[i] ** 2, jump[i] ** 2
        while head < tail:
            p = queue[head]
            head += 1
            dx, dy, dz = points[p, 0] - points[i, 0], points[p, 1] - points[i, 1], points[p, 2] - points[i, 2]
            x, y, z = x + dx, y + dy, z + dz
            xx, xy, xz, yy, yz, zz = xx + dx * dx, xy + dx * dy, xz + dx * dz, yy + dy * dy, yz + dy * dz, zz + dz * dz
            for q in neighbours[p]:
                if q < 0 or stamp[q] == i:
                    continue
                if squared(points, i, q) <= reach and squared(points, p, q) <= step:
                    stamp[q] = i
                    queue[tail] = q
                    tail += 1
        x, y, z = x / tail, y / tail, z / tail
        means[i, 0], means[i, 1], means[i, 2] = points[i, 0] + x, points[i, 1] + y, points[i, 2] + z
        c = covariances[i]
        c[0, 0], c[1, 1], c[2, 2] = xx / tail - x * x, yy / tail - y * y, zz / tail - z * z
        c[0, 1] = c[1, 0] = xy / tail - x * y
        c[0, 2] = c[2, 0] = xz / tail - x * z
        c[1, 2] = c[2, 1] = yz / tail - y * z
    return means, covariances


@njit(cache=True, nogil=True)
def squared(points, i, j):  # type: ignore[no-untyped-def]
    """The squared distance of two of the points (n, 3)."""
    x, y, z = points[i, 0] - points[j, 0], points[i, 1] - points[j, 1], points[i, 2] - points[j, 2]
    return x * x + y * y + z * z
