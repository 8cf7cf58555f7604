"""Compiled walks over a table of neighbours (n, k), in which -1 stands for none.

Heights are averaged over neighbours and grown from seeds, the spread of a surface is taken around each point, and
patches grow along the cheapest paths.
"""

from __future__ import annotations

import heapq

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def averaged(values, neighbours, apart, rounds):  # type: ignore[no-untyped-def]
    """Return each value (n,) averaged with those of its neighbours that differ by no more than ``apart`` (n,),
    repeatedly."""
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
    """Return the seeds (n,), and all allowed points (n,) that are connected with them through allowed ones."""
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


@njit(cache=True, nogil=True, error_model="numpy")
def spreads(points, neighbours, radius, jump):  # type: ignore[no-untyped-def]
    """Return for points (n, 3): mean (n, 3) and covariance (n, 3, 3) of those within ``radius`` (n,) that are
    reached from neighbour to neighbour without a ``jump`` (n,)."""
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
    """Return the squared distance of two of the points (n, 3)."""
    x, y, z = points[i, 0] - points[j, 0], points[i, 1] - points[j, 1], points[i, 2] - points[j, 2]
    return x * x + y * y + z * z


@njit(cache=True, nogil=True)
def grow(seeds, spacing, costs, points, smooth, normals, colours, neighbours, jump):  # type: ignore[no-untyped-def]
    """Return for each of n points the number of the seed (m,) with the cheapest path (Dijkstra, from all at once).

    ``costs`` are what a path pays: for a radian by which the normal turns, for a metre of height between the planes of
    neighbours, and for a difference in colour of 1 beyond the fourth. What no seed reaches grows by itself.
    """
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
                    total = so_far + _step_cost(smooth, normals, colours, p, q, spacing, costs)
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
def _step_cost(smooth, normals, colours, p, q, spacing, costs):  # type: ignore[no-untyped-def]
    """Return what a path pays for going from a point to its neighbour."""
    turn_cost, step_cost, colour_cost, colour_noise = costs
    turned, tint, step, way = 0.0, 0.0, 0.0, 0.0
    for axis in range(3):
        turned += (normals[p, axis] - normals[q, axis]) ** 2
        tint += (colours[p, axis] - colours[q, axis]) ** 2
        ahead = smooth[q, axis] - smooth[p, axis]
        way += ahead * ahead
        step += ahead * (normals[p, axis] + normals[q, axis]) / 2
    colour = colour_cost * max(0.0, tint**0.5 - colour_noise)
    return way**0.5 / spacing + turn_cost * turned**0.5 + step_cost * abs(step) + colour
