"""Cheapest paths from many seeds at once (Dijkstra), over a surface; compiled."""

from __future__ import annotations

import heapq

import numpy as np
from numba import njit

from deixis.perception.detection.surface_kernels import squared

TURN = 1.5
"""What a path pays for a radian by which the normal turns, in spacings of seeds."""

STEP = 400.0
"""For a metre of height between the planes of neighbours."""

TINT, SEEN = 0.05, 2.0
"""For a difference in colour of 1 (L*a*b*), beyond what noise alone makes."""


@njit(cache=True, nogil=True)
def grow(seeds, spacing, points, smooth, normals, colours, neighbours, jump):  # type: ignore[no-untyped-def]
    """For each of n points the number of the seed (m,) with the cheapest path; what no seed reaches grows by itself."""
    n = len(smooth)
    of = np.full(n, -1, np.int32)
    cost = np.full(n, np.inf)
    heap = [(0.0, np.int64(seeds[0]), np.int64(0))]
    for number in range(len(seeds)):
        cost[seeds[number]] = 0.0
        if number:
            heap.append((0.0, np.int64(seeds[number]), np.int64(number)))
    following, start = len(seeds), 0
    while True:
        while len(heap):
            so_far, p, s = heapq.heappop(heap)
            if of[p] >= 0:
                continue
            of[p] = s
            for q in neighbours[p]:
                if q >= 0 and of[q] < 0 and squared(points, p, q) <= jump[p] ** 2:
                    total = so_far + _price(smooth, normals, colours, p, q, spacing)
                    if total < cost[q]:
                        cost[q] = total
                        heapq.heappush(heap, (total, np.int64(q), s))
        while start < n and of[start] >= 0:
            start += 1
        if start == n:
            return of
        heap.append((0.0, np.int64(start), np.int64(following)))
        following += 1


@njit(cache=True, nogil=True)
def _price(smooth, normals, colours, p, q, spacing):  # type: ignore[no-untyped-def]
    """What a path pays for going from a point to its neighbour."""
    turned, tint, step, way = 0.0, 0.0, 0.0, 0.0
    for axis in range(3):
        turned += (normals[p, axis] - normals[q, axis]) ** 2
        tint += (colours[p, axis] - colours[q, axis]) ** 2
        ahead = smooth[q, axis] - smooth[p, axis]
        way += ahead * ahead
        step += ahead * (normals[p, axis] + normals[q, axis]) / 2
    return way**0.5 / spacing + TURN * turned**0.5 + STEP * abs(step) + TINT * max(0.0, tint**0.5 - SEEN)
