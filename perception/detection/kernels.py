"""Compiled walks over a table of neighbours (n, k), in which -1 stands for none.

Heights are averaged over neighbours and grown from seeds, a plane is laid through what is around each point, and
patches grow along the cheapest paths.
"""

from __future__ import annotations

import heapq

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def support(points, tolerance, normals, offsets):  # type: ignore[no-untyped-def]
    """Return the sum of ``tolerance`` (n,) over the points (n, 3) within it of each plane, ``normals`` (t, 3) and
    ``offsets`` (t,), shape (t,)."""
    result = np.zeros(len(normals))
    for t in range(len(normals)):
        a, b, c, d = normals[t, 0], normals[t, 1], normals[t, 2], offsets[t]
        for i in range(len(points)):
            if abs(a * points[i, 0] + b * points[i, 1] + c * points[i, 2] - d) <= tolerance[i]:
                result[t] += tolerance[i]
    return result


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


@njit(cache=True, nogil=True)
def pixel_neighbours(number, row, column, steps, table):  # type: ignore[no-untyped-def]
    """Put into a table (n, 8), where it has none, the pixels so many ``steps`` from those in each ``row`` and
    ``column`` (n,), by their ``number`` (r, c), -1 for none."""
    rows, columns = number.shape
    for i in range(len(row)):
        k = 0
        for down in range(-1, 2):
            for right in range(-1, 2):
                if down == 0 and right == 0:
                    continue
                r, c = row[i] + steps * down, column[i] + steps * right
                if table[i, k] < 0 and 0 <= r < rows and 0 <= c < columns:
                    table[i, k] = number[r, c]
                k += 1


@njit(cache=True, nogil=True)
def nearest_to_means(points, of, count):  # type: ignore[no-untyped-def]
    """Return for each of ``count`` groups that points (n, 3) belong to by ``of`` (n,) the point nearest to their
    mean."""
    middles, sizes = np.zeros((count, 3)), np.zeros(count)
    for i in range(len(of)):
        sizes[of[i]] += 1
        for axis in range(3):
            middles[of[i], axis] += points[i, axis]
    result, least = np.zeros(count, np.int64), np.full(count, np.inf)
    for i in range(len(of)):
        off, group = 0.0, of[i]
        for axis in range(3):
            off += (points[i, axis] - middles[group, axis] / sizes[group]) ** 2
        if off < least[group]:
            least[group], result[group] = off, i
    return result


@njit(cache=True, nogil=True)
def gaps(points, neighbours):  # type: ignore[no-untyped-def]
    """Return the mean distance of points (n, 3) from their neighbours, (n,); -1 where there are none."""
    result = np.empty(len(points))
    for i in range(len(points)):
        total, count = 0.0, 0
        for j in neighbours[i]:
            if j >= 0:
                total += squared(points, i, j) ** 0.5
                count += 1
        result[i] = total / count if count else -1.0
    return result


@njit(cache=True, nogil=True)
def mixed(values, neighbours):  # type: ignore[no-untyped-def]
    """Return the means (n, 3) of values (n, 3) and those of their neighbours."""
    result = np.empty_like(values)
    for i in range(len(values)):
        a, b, c, count = values[i, 0], values[i, 1], values[i, 2], 1
        for j in neighbours[i]:
            if j >= 0:
                a, b, c, count = a + values[j, 0], b + values[j, 1], c + values[j, 2], count + 1
        result[i, 0], result[i, 1], result[i, 2] = a / count, b / count, c / count
    return result


@njit(cache=True, nogil=True, error_model="numpy")
def planes(points, neighbours, radius, jump, eye, most):  # type: ignore[no-untyped-def]
    """Return for points (n, 3) the plane through those within ``radius`` (n,) that are reached from neighbour to
    neighbour without a ``jump`` (n,), ``most`` of them at most: its unit normal (n, 3) towards the ``eye`` (3,), and
    the point moved onto it."""
    n = len(points)
    normals, smooth = np.empty((n, 3)), np.empty((n, 3))
    stamp, queue = np.full(n, -1, np.int64), np.empty(n, np.int64)
    normal = np.empty(3)
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
                if tail < most and squared(points, i, q) <= reach and squared(points, p, q) <= step:
                    stamp[q] = i
                    queue[tail] = q
                    tail += 1
        x, y, z = x / tail, y / tail, z / tail
        _least_axis(
            xx / tail - x * x,
            xy / tail - x * y,
            xz / tail - x * z,
            yy / tail - y * y,
            yz / tail - y * z,
            zz / tail - z * z,
            normal,
        )
        towards = 0.0
        for axis in range(3):
            towards += (eye[axis] - points[i, axis]) * normal[axis]
        side = -1.0 if towards < 0 else 1.0
        off = -(x * normal[0] + y * normal[1] + z * normal[2])  # of the point, from the plane
        for axis in range(3):
            normals[i, axis] = side * normal[axis]
            smooth[i, axis] = points[i, axis] - off * normal[axis]
    return normals, smooth


@njit(cache=True, nogil=True, error_model="numpy")
def _least_axis(xx, xy, xz, yy, yz, zz, axis):  # type: ignore[no-untyped-def]
    """Put the unit eigenvector of the least eigenvalue of a symmetric matrix (3, 3) into ``axis`` (3,).

    The eigenvalue is the trigonometric root of the characteristic polynomial (O. K. Smith, Eigenvalues of a symmetric
    3 x 3 matrix, 1961); the eigenvector is the longest cross product of two rows of the matrix less that value.
    """
    mean = (xx + yy + zz) / 3
    a, b, c = xx - mean, yy - mean, zz - mean
    off = xy * xy + xz * xz + yz * yz
    scale = ((a * a + b * b + c * c + 2 * off) / 6) ** 0.5
    axis[0], axis[1], axis[2] = 0.0, 0.0, 1.0
    if not scale > 0:
        return
    half = (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)) / (2 * scale**3)
    least = mean + 2 * scale * np.cos((np.arccos(min(max(half, -1.0), 1.0)) + 2 * np.pi) / 3)
    a, b, c = xx - least, yy - least, zz - least
    longest = 0.0
    for pair in range(3):
        if pair == 0:
            x, y, z = xy * yz - xz * b, xz * xy - a * yz, a * b - xy * xy
        elif pair == 1:
            x, y, z = xy * c - xz * yz, xz * xz - a * c, a * yz - xy * xz
        else:
            x, y, z = b * c - yz * yz, yz * xz - xy * c, xy * yz - b * xz
        length = x * x + y * y + z * z
        if length > longest:
            longest = length
            size = length**0.5
            axis[0], axis[1], axis[2] = x / size, y / size, z / size
    if longest > 0:
        return
    # Two least values are alike: anything across the greatest will do.
    x, y, z = a + xy + xz, xy + b + yz, xz + yz + c
    if abs(z) >= abs(x) and abs(z) >= abs(y):
        x, y, z = 0.0, z, -y
    else:
        x, y, z = y, -x, 0.0
    size = (x * x + y * y + z * z) ** 0.5
    if size > 0:
        axis[0], axis[1], axis[2] = x / size, y / size, z / size


@njit(cache=True, nogil=True)
def near_boxes(low, high, gap):  # type: ignore[no-untyped-def]
    """Return the pairs (k, 2) of boxes, corners (p, 2) in the order of their least x, that are less than a ``gap``
    apart."""
    found = [(0, 0)][:0]
    for i in range(len(low)):
        for j in range(i + 1, len(low)):
            if low[j, 0] - high[i, 0] >= gap:
                break
            x = max(low[j, 0] - high[i, 0], low[i, 0] - high[j, 0], 0.0)
            y = max(low[j, 1] - high[i, 1], low[i, 1] - high[j, 1], 0.0)
            if x * x + y * y < gap * gap:
                found.append((i, j))
    pairs = np.empty((len(found), 2), np.int64)
    for k in range(len(found)):
        pairs[k, 0], pairs[k, 1] = found[k]
    return pairs


@njit(cache=True, nogil=True)
def greatest_offset(plan, sides):  # type: ignore[no-untyped-def]
    """Return how far places (n, 2) are beyond the farthest of half planes (h, 3), (n,); infinite without any."""
    result = np.empty(len(plan))
    for i in range(len(plan)):
        most = -np.inf
        for k in range(len(sides)):
            most = max(most, sides[k, 0] * plan[i, 0] + sides[k, 1] * plan[i, 1] + sides[k, 2])
        result[i] = most if len(sides) else np.inf
    return result


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
