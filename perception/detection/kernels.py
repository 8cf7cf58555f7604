"""Compiled loops over points and over a table of neighbours (n, k), in which -1 stands for a missing one.

The kernels compare and refine planes, average heights over neighbours and grow them from seeds, fit a plane around each
point, and grow patches along the cheapest paths.
"""

from __future__ import annotations

import numpy as np
from numba import njit

_BLOCK = 1024
"""Number of points in a block of a loop over planes, so that they stay in the fastest cache."""

_BUCKETS = 1024
"""Number of buckets for paths of similar cost, a power of two."""

_BUCKET_COST = 1 / 16
"""Range of the costs in a bucket, below that of most steps."""

_STRIP_ROWS = 48
"""Number of rows of an image that are averaged at once."""

_STRIP = 32
"""Number of pixels of a row whose neighbourhoods are summed at once."""


@njit(cache=True, nogil=True, fastmath=True)
def support(x, y, z, tolerance, planes):  # type: ignore[no-untyped-def]
    """Return the support of each plane (t, 4), normal and offset, shape (t,).

    The support is the sum of the ``tolerance`` (n,) of the points, given by ``x``, ``y`` and ``z`` (n,), that are
    within their tolerance of the plane.
    """
    result = np.zeros(len(planes), np.float32)
    for t in range(len(planes)):
        a, b, c, d = planes[t, 0], planes[t, 1], planes[t, 2], planes[t, 3]
        total = np.float32(0.0)
        for i in range(len(x)):
            off = abs(a * x[i] + b * y[i] + c * z[i] - d)
            total += tolerance[i] if off <= tolerance[i] else np.float32(0.0)
        result[t] = total
    return result


@njit(cache=True, nogil=True)
def refine(points, tolerance, normal, offset, shares):  # type: ignore[no-untyped-def]
    """Refit a plane by least squares, and return its normal (3,) and offset.

    Each of the ``shares`` (r,) in turn selects the points (n, 3) within that share of their tolerance (n,) of the
    plane before. Points are weighted by the inverse square of their tolerance.
    """
    turned = normal.copy()
    for share in shares:
        total, x, y, z, count = 0.0, 0.0, 0.0, 0.0, 0
        moments = np.zeros((6, 1))
        for i in range(len(points)):
            p, q, r = points[i, 0], points[i, 1], points[i, 2]
            if abs(p * turned[0] + q * turned[1] + r * turned[2] - offset) <= share * tolerance[i]:
                w = 1.0 / (tolerance[i] * tolerance[i])
                total, x, y, z, count = total + w, x + w * p, y + w * q, z + w * r, count + 1
        if count < 3:
            break
        x, y, z = x / total, y / total, z / total
        for i in range(len(points)):
            p, q, r = points[i, 0], points[i, 1], points[i, 2]
            if abs(p * turned[0] + q * turned[1] + r * turned[2] - offset) <= share * tolerance[i]:
                w = 1.0 / (tolerance[i] * tolerance[i]) / total
                p, q, r = p - x, q - y, r - z
                moments[0, 0] += w * p * p
                moments[1, 0] += w * p * q
                moments[2, 0] += w * p * r
                moments[3, 0] += w * q * q
                moments[4, 0] += w * q * r
                moments[5, 0] += w * r * r
        axis = least_axes(moments)[0]
        side = axis[0] * turned[0] + axis[1] * turned[1] + axis[2] * turned[2]
        turned = -axis if side < 0 else axis
        offset = turned[0] * x + turned[1] * y + turned[2] * z
    return turned, offset


@njit(cache=True, nogil=True)
def gathered(points, places):  # type: ignore[no-untyped-def]
    """Return the points (n, 3) at some places (m,) in double precision, shape (m, 3), and the corners of their box."""
    result, box = np.empty((len(places), 3)), np.empty((2, 3))
    box[0], box[1] = np.inf, -np.inf
    for i in range(len(places)):
        for axis in range(3):
            value = float(points[places[i], axis])
            result[i, axis] = value
            box[0, axis], box[1, axis] = min(box[0, axis], value), max(box[1, axis], value)
    return result, box


@njit(cache=True, nogil=True)
def in_frame(points, frame, eye):  # type: ignore[no-untyped-def]
    """Return points (n, 3) moved by a transform (4, 4), their heights (n,), and distances (n,) from ``eye`` (3,).

    The heights are the last coordinates; ``eye`` is in the new frame.
    """
    n = len(points)
    result, heights, distance = np.empty((n, 3)), np.empty(n), np.empty(n)
    for i in range(n):
        p, q, r = points[i, 0], points[i, 1], points[i, 2]
        x = frame[0, 0] * p + frame[0, 1] * q + frame[0, 2] * r + frame[0, 3]
        y = frame[1, 0] * p + frame[1, 1] * q + frame[1, 2] * r + frame[1, 3]
        z = frame[2, 0] * p + frame[2, 1] * q + frame[2, 2] * r + frame[2, 3]
        result[i, 0], result[i, 1], result[i, 2], heights[i] = x, y, z, z
        distance[i] = np.sqrt((x - eye[0]) ** 2 + (y - eye[1]) ** 2 + (z - eye[2]) ** 2)
    return result, heights, distance


@njit(cache=True, nogil=True, error_model="numpy")
def depths_below(heights, growth, band):  # type: ignore[no-untyped-def]
    """Return the depths below 0 and above ``-band`` of heights (n,) divided by the ``growth`` of the noise (n,)."""
    result, count = np.empty(len(heights)), 0
    for i in range(len(heights)):
        scaled = heights[i] / growth[i]
        result[count] = -scaled
        count += scaled < 0 and scaled > -band
    return result[:count]


@njit(cache=True, nogil=True)
def averaged(values, neighbours, apart, rounds):  # type: ignore[no-untyped-def]
    """Return values (n,) averaged repeatedly with those of neighbours that differ by at most ``apart`` (n,)."""
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


@njit(cache=True, nogil=True, error_model="numpy")
def averaged_pixels(values, row, column, shape, apart, rounds):  # type: ignore[no-untyped-def]
    """Return values (n,) of pixels averaged repeatedly with those of adjacent pixels, as ``averaged`` does.

    ``row`` and ``column`` (n,) are the pixels of an image of ``shape`` rows and columns, in the order of the rows.

    Notes
    -----
    Strips of the image are averaged one after the other, each with the rows around it, so that they stay in a cache.
    Pixels without a value are infinite and so differ from all others.
    """
    height, width = _STRIP_ROWS + 2 * rounds + 2, shape[1] + 2
    images = np.empty((3, height, width))
    before, after, limit = images[0], images[1], images[2]
    result, start, n = np.empty(len(values)), 0, len(values)
    for top in range(0, shape[0], _STRIP_ROWS):
        while start < n and row[start] < top - rounds:
            start += 1
        images[:] = np.inf
        end = start
        while end < n and row[end] < top + _STRIP_ROWS + rounds:
            r, c = row[end] - top + rounds + 1, column[end] + 1
            before[r, c], limit[r, c] = values[end], apart[end]
            end += 1
        for _ in range(rounds):
            for r in range(1, height - 1):
                above, own, below = before[r - 1], before[r], before[r + 1]
                most, mean = limit[r], after[r]
                for c in range(shape[1]):
                    middle, total, count = own[c + 1], own[c + 1], 1.0
                    for k in range(3):
                        near = abs(above[c + k] - middle) <= most[c + 1]
                        total, count = total + (above[c + k] if near else 0.0), count + (1.0 if near else 0.0)
                    for k in range(0, 3, 2):
                        near = abs(own[c + k] - middle) <= most[c + 1]
                        total, count = total + (own[c + k] if near else 0.0), count + (1.0 if near else 0.0)
                    for k in range(3):
                        near = abs(below[c + k] - middle) <= most[c + 1]
                        total, count = total + (below[c + k] if near else 0.0), count + (1.0 if near else 0.0)
                    mean[c + 1] = total / count
            before, after = after, before
        for i in range(start, end):
            if top <= row[i] < top + _STRIP_ROWS:
                result[i] = before[row[i] - top + rounds + 1, column[i] + 1]
    return result


@njit(cache=True, nogil=True)
def grown(seeds, allowed, neighbours):  # type: ignore[no-untyped-def]
    """Return a mask of the seeds (n,) and all allowed points (n,) that are connected to them through allowed ones."""
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
def grown_pixels(seeds, allowed, row, column, shape):  # type: ignore[no-untyped-def]
    """Return a mask as ``grown`` does, of points (n,) whose neighbours are the adjacent pixels.

    ``row`` and ``column`` (n,) are the pixels of an image of ``shape`` rows and columns.
    """
    n, width = len(seeds), shape[1] + 2
    waiting = np.zeros((shape[0] + 2) * width, np.bool_)  # allowed and not yet reached, with a border
    reached = np.zeros(len(waiting), np.bool_)
    stack, count = np.empty(n, np.int32), 0
    for i in range(n):
        at = (row[i] + 1) * width + column[i] + 1
        if seeds[i]:
            reached[at], stack[count], count = True, at, count + 1
        else:
            waiting[at] = allowed[i]
    while count:
        count -= 1
        at = stack[count]
        for start in (at - width - 1, at - 1, at + width - 1):
            for other in range(start, start + 3):
                if waiting[other]:
                    waiting[other], reached[other], stack[count] = False, True, other
                    count += 1
    result = np.empty(n, np.bool_)
    for i in range(n):
        result[i] = reached[(row[i] + 1) * width + column[i] + 1]
    return result


@njit(cache=True, nogil=True)
def groups(chosen, neighbours):  # type: ignore[no-untyped-def]
    """Return the connected group of each chosen point, numbered from 0 by its first point; -1 for the others."""
    of = np.full(len(chosen), -1, np.int32)
    stack = np.empty(len(chosen), np.int64)
    found = 0
    for i in range(len(chosen)):
        if not chosen[i] or of[i] >= 0:
            continue
        of[i], stack[0], count = found, i, 1
        while count:
            count -= 1
            for j in neighbours[stack[count]]:
                if j >= 0 and chosen[j] and of[j] < 0:
                    of[j] = found
                    stack[count] = j
                    count += 1
        found += 1
    return of


@njit(cache=True, nogil=True)
def pixel_neighbours(number, row, column, steps, table):  # type: ignore[no-untyped-def]
    """Fill empty entries of a table (n, 8) with the pixels at a distance of ``steps``, in place.

    ``row`` and ``column`` (n,) are the positions of the points; ``number`` (r, c) is the index of the point of each
    pixel, -1 for none.
    """
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
    """Return the point nearest to the mean of each of ``count`` groups of points (n, 3), given by ``of`` (n,)."""
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
    """Return the mean distance of points (n, 3) from their neighbours, shape (n,); -1 without neighbours."""
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
    """Return the means (n, 3) of each value (n, 3) and those of its neighbours."""
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
    """Fit a plane around each point (n, 3), and return unit normals (n, 3) and the points moved onto the planes (n, 3).

    A plane is fitted to at most ``most`` points within ``radius`` (n,) that are reached from neighbour to neighbour
    without a ``jump`` (n,). Normals point towards the ``eye`` (3,).
    """
    n = len(points)
    middles, moments = np.empty((n, 3)), np.empty((6, n))
    stamp, queue = np.full(n, -1, np.int32), np.empty(n, np.int32)
    for i in range(n):
        queue[0], stamp[i], head, tail = i, i, 0, 1
        x, y, z, xx, xy, xz, yy, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        reach, step = radius[i] * radius[i], jump[i] * jump[i]
        while head < tail:
            p = queue[head]
            head += 1
            dx, dy, dz = points[p, 0] - points[i, 0], points[p, 1] - points[i, 1], points[p, 2] - points[i, 2]
            x, y, z = x + dx, y + dy, z + dz
            xx, xy, xz, yy, yz, zz = xx + dx * dx, xy + dx * dy, xz + dx * dz, yy + dy * dy, yz + dy * dz, zz + dz * dz
            if tail >= most:
                continue
            for q in neighbours[p]:
                if q < 0 or stamp[q] == i:
                    continue
                if squared(points, i, q) > reach:
                    stamp[q] = i  # too far, from any neighbour
                elif tail < most and squared(points, p, q) <= step:
                    stamp[q] = i
                    queue[tail] = q
                    tail += 1
        x, y, z = x / tail, y / tail, z / tail
        middles[i, 0], middles[i, 1], middles[i, 2] = x, y, z
        moments[0, i], moments[1, i], moments[2, i] = xx / tail - x * x, xy / tail - x * y, xz / tail - x * z
        moments[3, i], moments[4, i], moments[5, i] = yy / tail - y * y, yz / tail - y * z, zz / tail - z * z
    return _onto_planes(points, middles, moments, eye)


@njit(cache=True, nogil=True, error_model="numpy")
def planes_in_image(points, row, column, radius, reach, eye, steps):  # type: ignore[no-untyped-def]
    """Fit a plane around each point (n, 3) of an image, and return normals and moved points as ``planes`` does.

    A plane is fitted to the points within ``radius`` (n,) at the pixels around that of the point. ``row`` and
    ``column`` (n,) are in the order of the rows. ``steps`` (s, 2), rows and columns, leads to these pixels, the nearest
    first, and ``reach`` (n,) is their maximum distance in pixels.

    Notes
    -----
    The sums over the neighbourhoods of a strip of a row are made at once, two pixels of the neighbourhood after the
    other, so that the processor adds several at a time and keeps them for two additions. Points on the surface within
    the radius are nearly always those that paths from neighbour to neighbour reach.
    """
    n = len(points)
    around = np.abs(steps).max()
    low = (row.min() - around, column.min() - around)
    shape = (row.max() - low[0] + around + 1, column.max() - low[1] + around + _STRIP)
    image = np.full((3, shape[0] + 1, shape[1]), 1e9)  # of pixels without a point, which are out of reach
    for i in range(n):
        for axis in range(3):
            image[axis, row[i] - low[0], column[i] - low[1]] = points[i, axis]
    middles, moments = np.empty((n, 3)), np.empty((6, n))
    totals, squares = np.empty((10, _STRIP)), np.empty(_STRIP)
    count, sx, sy, sz = totals[0], totals[1], totals[2], totals[3]
    sxx, sxy, sxz, syy, syz, szz = totals[4], totals[5], totals[6], totals[7], totals[8], totals[9]
    start = 0
    while start < n:
        end, first, farthest = start, column[start], 0.0
        squares[:], totals[:] = -1.0, 0.0
        while end < n and row[end] == row[start] and column[end] < first + _STRIP:
            squares[column[end] - first] = radius[end] * radius[end]
            farthest = max(farthest, reach[end])
            end += 1
        width, r, c = column[end - 1] - first + 1, row[start] - low[0], first - low[1]
        x, y, z = image[0, r, c : c + _STRIP], image[1, r, c : c + _STRIP], image[2, r, c : c + _STRIP]
        inside = 0
        while inside < len(steps) and steps[inside, 0] ** 2 + steps[inside, 1] ** 2 <= farthest * farthest:
            inside += 1
        for step in range(0, inside, 2):
            down, right = r + steps[step, 0], c + steps[step, 1]
            u, v, w = image[0, down], image[1, down], image[2, down]
            u, v, w = u[right : right + _STRIP], v[right : right + _STRIP], w[right : right + _STRIP]
            down, right = shape[0], 0  # of an odd number of pixels, the last one is without a point
            if step + 1 < inside:
                down, right = r + steps[step + 1, 0], c + steps[step + 1, 1]
            p, q, s = image[0, down], image[1, down], image[2, down]
            p, q, s = p[right : right + _STRIP], q[right : right + _STRIP], s[right : right + _STRIP]
            for k in range(width):
                limit = squares[k]
                dx, dy, dz = u[k] - x[k], v[k] - y[k], w[k] - z[k]
                near = dx * dx + dy * dy + dz * dz <= limit
                dx, dy, dz, one = dx if near else 0.0, dy if near else 0.0, dz if near else 0.0, 1.0 if near else 0.0
                ex, ey, ez = p[k] - x[k], q[k] - y[k], s[k] - z[k]
                near = ex * ex + ey * ey + ez * ez <= limit
                ex, ey, ez, two = ex if near else 0.0, ey if near else 0.0, ez if near else 0.0, 1.0 if near else 0.0
                count[k] = count[k] + one + two
                sx[k], sy[k], sz[k] = sx[k] + dx + ex, sy[k] + dy + ey, sz[k] + dz + ez
                sxx[k] = sxx[k] + dx * dx + ex * ex
                sxy[k] = sxy[k] + dx * dy + ex * ey
                sxz[k] = sxz[k] + dx * dz + ex * ez
                syy[k] = syy[k] + dy * dy + ey * ey
                syz[k] = syz[k] + dy * dz + ey * ez
                szz[k] = szz[k] + dz * dz + ez * ez
        for i in range(start, end):
            k = column[i] - first
            mx, my, mz = sx[k] / count[k], sy[k] / count[k], sz[k] / count[k]
            middles[i, 0], middles[i, 1], middles[i, 2] = mx, my, mz
            moments[0, i], moments[1, i] = sxx[k] / count[k] - mx * mx, sxy[k] / count[k] - mx * my
            moments[2, i], moments[3, i] = sxz[k] / count[k] - mx * mz, syy[k] / count[k] - my * my
            moments[4, i], moments[5, i] = syz[k] / count[k] - my * mz, szz[k] / count[k] - mz * mz
        start = end
    return _onto_planes(points, middles, moments, eye)


@njit(cache=True, nogil=True, error_model="numpy")
def _onto_planes(points, middles, moments, eye):  # type: ignore[no-untyped-def]
    """Return the normals (n, 3) of planes, towards the ``eye`` (3,), and points (n, 3) moved onto the planes (n, 3).

    A plane has a middle (n, 3), relative to its point, and six second moments (6, n).
    """
    n = len(points)
    normals, smooth = least_axes(moments), np.empty((n, 3))
    for i in range(n):
        towards, off = 0.0, 0.0
        for axis in range(3):
            towards += (eye[axis] - points[i, axis]) * normals[i, axis]
            off -= middles[i, axis] * normals[i, axis]  # of the point, from the plane
        for axis in range(3):
            smooth[i, axis] = points[i, axis] - off * normals[i, axis]
            if towards < 0:
                normals[i, axis] = -normals[i, axis]
    return normals, smooth


@njit(cache=True, nogil=True, error_model="numpy")
def least_axes(moments):  # type: ignore[no-untyped-def]
    """Return the unit eigenvectors (n, 3) of the smallest eigenvalues of n symmetric matrices.

    The matrices are given as rows xx, xy, xz, yy, yz and zz of an array (6, n).

    Notes
    -----
    Newton's method finds the smallest root of the characteristic polynomial. Starting from 0, which is not above the
    root, it rises to the root without passing it, because the polynomial is concave below the mean of its roots. A
    fixed number of steps lets the loop run on several matrices at once. The eigenvector is the longest cross product of
    two rows of the matrix minus the eigenvalue. If the two smallest eigenvalues are equal, it is the vector of their
    eigenspace nearest to z.
    """
    n = moments.shape[1]
    least, result = np.empty(n), np.empty((n, 3))
    for i in range(n):
        xx, xy, xz = moments[0, i], moments[1, i], moments[2, i]
        yy, yz, zz = moments[3, i], moments[4, i], moments[5, i]
        trace = xx + yy + zz
        minors = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz
        determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
        root = 0.0
        for _ in range(12):
            value = ((root - trace) * root + minors) * root - determinant
            slope = (3 * root - 2 * trace) * root + minors
            root -= value / slope if slope > 0 else 0.0
        least[i] = root
    for i in range(n):
        xx, xy, xz = moments[0, i], moments[1, i], moments[2, i]
        yy, yz, zz = moments[3, i], moments[4, i], moments[5, i]
        trace, a, b, c = xx + yy + zz, xx - least[i], yy - least[i], zz - least[i]
        x, y, z = xy * yz - xz * b, xz * xy - a * yz, a * b - xy * xy
        length = x * x + y * y + z * z
        p, q, r = xy * c - xz * yz, xz * xz - a * c, a * yz - xy * xz
        if p * p + q * q + r * r > length:
            x, y, z, length = p, q, r, p * p + q * q + r * r
        p, q, r = b * c - yz * yz, yz * xz - xy * c, xy * yz - b * xz
        if p * p + q * q + r * r > length:
            x, y, z, length = p, q, r, p * p + q * q + r * r
        if (
            not length > 1e-12 * trace**4
        ):  # the two smallest are equal, as for a line: take the most upright axis across it
            p, q, r = a * a + xy * xy + xz * xz, xy * xy + b * b + yz * yz, xz * xz + yz * yz + c * c
            if p >= q and p >= r:  # the longest row is along the line
                x, y, z, length = a, xy, xz, p
            elif q >= r:
                x, y, z, length = xy, b, yz, q
            else:
                x, y, z, length = xz, yz, c, r
            if z * z < 0.99 * length:
                x, y, z = -x * z, -y * z, x * x + y * y
            else:
                x, y, z = z, 0.0, -x
            length = x * x + y * y + z * z
        if not length > 0:
            x, y, z, length = 0.0, 0.0, 1.0, 1.0
        size = np.sqrt(length)
        result[i, 0], result[i, 1], result[i, 2] = x / size, y / size, z / size
    return result


@njit(cache=True, nogil=True, error_model="numpy")
def measures_of_parts(part, chosen, sizes, weights, middles, normals, tints, areas):  # type: ignore[no-untyped-def]
    """Measure the parts of the ``chosen`` (k,) of s patches, which are given by ``part`` (k,), from 0 to p - 1.

    Returns
    -------
    Lower and upper corner, centre and mean colour of each part, shape (p, 3) each, and an array (4, p): the sums of
    the sizes and of the areas, the standard deviation of the colours, and the bulge.
    """
    count = part.max() + 1 if len(part) else 0
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    centres, colours = np.zeros((count, 3)), np.zeros((count, 3))
    totals, total_weights, out = np.zeros((4, count)), np.zeros(count), np.zeros(count)
    for k in range(len(part)):
        p, i = part[k], chosen[k]
        totals[0, p] += sizes[i]
        totals[1, p] += areas[i]
        total_weights[p] += weights[i]
        for axis in range(3):
            low[p, axis], high[p, axis] = min(low[p, axis], middles[i, axis]), max(high[p, axis], middles[i, axis])
            centres[p, axis] += middles[i, axis] * sizes[i]
            colours[p, axis] += tints[i, axis] * weights[i]
    for p in range(count):
        for axis in range(3):
            centres[p, axis] /= totals[0, p]
            colours[p, axis] /= total_weights[p]
    for k in range(len(part)):
        p, i = part[k], chosen[k]
        varied, along, away = 0.0, 0.0, 0.0
        for axis in range(3):
            varied += (tints[i, axis] - colours[p, axis]) ** 2
            along += (middles[i, axis] - centres[p, axis]) * normals[i, axis]
            away += (middles[i, axis] - centres[p, axis]) ** 2
        totals[2, p] += varied * weights[i]
        totals[3, p] += along * sizes[i]
        out[p] += np.sqrt(away) * sizes[i]
    for p in range(count):
        totals[2, p] = np.sqrt(totals[2, p] / total_weights[p])
        totals[3, p] /= max(out[p], 1e-9)
    return low, high, centres, colours, totals


@njit(cache=True, nogil=True)
def near_boxes(low, high, gap):  # type: ignore[no-untyped-def]
    """Return the pairs (k, 2) of boxes less than ``gap`` apart; their corners (p, 2) must be sorted by lower x."""
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
def outermost(plan):  # type: ignore[no-untyped-def]
    """Return a mask of the finite places (n, 2) that may be corners of their convex hull, shape (n,).

    They are the places outside the polygon of the farthest places in sixteen directions (Akl and Toussaint, A fast
    convex hull algorithm, 1978).
    """
    count = 16
    way, farthest, most = np.empty((count, 2)), np.zeros(count, np.int64), np.full(count, -np.inf)
    for k in range(count):
        way[k, 0], way[k, 1] = np.cos(2 * np.pi * k / count), np.sin(2 * np.pi * k / count)
    for i in range(len(plan)):
        x, y = plan[i, 0], plan[i, 1]
        for k in range(count // 2):
            along = way[k, 0] * x + way[k, 1] * y
            if along > most[k]:
                most[k], farthest[k] = along, i
            if -along > most[k + count // 2]:
                most[k + count // 2], farthest[k + count // 2] = -along, i
    side, corners = np.empty((count, 3)), 0
    for k in range(count):
        a, b = farthest[k], farthest[(k + 1) % count]
        across, down = plan[b, 1] - plan[a, 1], plan[a, 0] - plan[b, 0]
        if across != 0 or down != 0:
            side[corners, 0], side[corners, 1] = across, down
            side[corners, 2] = across * plan[a, 0] + down * plan[a, 1]
            corners += 1
    result = np.ones(len(plan), np.bool_)
    if corners < 3:
        return result
    for i in range(len(plan)):
        inside = True
        for k in range(corners):
            if side[k, 0] * plan[i, 0] + side[k, 1] * plan[i, 1] >= side[k, 2]:
                inside = False
                break
        result[i] = not inside
    return result


@njit(cache=True, nogil=True)
def occupied(plan, cell, low, shape):  # type: ignore[no-untyped-def]
    """Return a mask of the grid cells, of shape ``shape`` and from cell ``low`` (2,), that contain places (n, 2)."""
    grid = np.zeros(shape, np.bool_)
    for i in range(len(plan)):
        grid[int(np.floor(plan[i, 0] / cell)) - low[0], int(np.floor(plan[i, 1] / cell)) - low[1]] = True
    return grid


@njit(cache=True, nogil=True)
def corners_of_box(places):  # type: ignore[no-untyped-def]
    """Return the lower and upper corner (2, d) of one or more places (n, d)."""
    box = np.empty((2, places.shape[1]))
    for axis in range(places.shape[1]):
        box[0, axis], box[1, axis] = places[0, axis], places[0, axis]
    for i in range(len(places)):
        for axis in range(places.shape[1]):
            box[0, axis] = min(box[0, axis], places[i, axis])
            box[1, axis] = max(box[1, axis], places[i, axis])
    return box


@njit(cache=True, nogil=True)
def renumbered(neighbours, chosen, number):  # type: ignore[no-untyped-def]
    """Return the neighbours (m, k) of the ``chosen`` points (m,) as new indices ``number`` (n,), or -1."""
    result = np.full((len(chosen), neighbours.shape[1]), -1, np.int32)
    for i in range(len(chosen)):
        for k in range(neighbours.shape[1]):
            q = neighbours[chosen[i], k]
            if q >= 0:
                result[i, k] = number[q]
    return result


@njit(cache=True, nogil=True, fastmath=True)
def greatest_offset(points, sides):  # type: ignore[no-untyped-def]
    """Return the largest signed distance of points (n, 3) from half spaces (h, 4), normal and offset, shape (n,)."""
    result = np.empty(len(points))
    x, y, z = np.empty(_BLOCK), np.empty(_BLOCK), np.empty(_BLOCK)
    for start in range(0, len(points), _BLOCK):
        size = min(_BLOCK, len(points) - start)
        most = result[start : start + size]
        for i in range(size):
            x[i], y[i], z[i] = points[start + i, 0], points[start + i, 1], points[start + i, 2]
            most[i] = -1e300
        for k in range(len(sides)):
            a, b, c, d = sides[k, 0], sides[k, 1], sides[k, 2], sides[k, 3]
            for i in range(size):
                off = a * x[i] + b * y[i] + c * z[i] + d
                most[i] = off if off > most[i] else most[i]
    return result


@njit(cache=True, nogil=True)
def squared(points, i, j):  # type: ignore[no-untyped-def]
    """Return the squared distance of points i and j of (n, 3)."""
    x, y, z = points[i, 0] - points[j, 0], points[i, 1] - points[j, 1], points[i, 2] - points[j, 2]
    return x * x + y * y + z * z


@njit(cache=True, nogil=True)
def meetings(of, neighbours, points, jump, count):  # type: ignore[no-untyped-def]
    """Find the boundaries between patches.

    Parameters
    ----------
    of
        Patch of each point, shape (n,).
    neighbours
        Neighbours of each point, shape (n, k), -1 for missing ones.
    points
        Coordinates, shape (n, 3).
    jump
        Distance beyond which a neighbour is on another surface, shape (n,).
    count
        Number of patches.

    Returns
    -------
    The sorted pairs of adjacent patches (m, 2), the lower number first; the number of pairs of neighbouring points of
    each (m,), and the number of those with a jump (m,).

    Notes
    -----
    The pairs are counted in a hash table, because they are met in no order and each of them often. The count begins
    again with a larger table if more than half of it is full; arrays that a loop replaces would make it far slower.
    """
    room = 1024
    while room < 16 * count:
        room *= 2
    while True:
        keys, total, jumped = np.full(room, -1, np.int64), np.zeros(room, np.int64), np.zeros(room, np.int64)
        if _count_meetings(of, neighbours, points, jump, count, keys, total, jumped):
            break
        room *= 2
    filled = np.flatnonzero(keys >= 0)
    filled = filled[np.argsort(keys[filled])]
    pairs = np.empty((len(filled), 2), np.int64)
    pairs[:, 0], pairs[:, 1] = keys[filled] // count, keys[filled] % count
    return pairs, total[filled].astype(np.float64), jumped[filled].astype(np.float64)


@njit(cache=True, nogil=True)
def _count_meetings(of, neighbours, points, jump, count, keys, total, jumped):  # type: ignore[no-untyped-def]
    """Count the neighbours and jumps between each pair of patches in a hash table, in place; return False if it fills.

    The key of a pair is its lower number times the ``count`` of patches, plus the higher one. The size of the table is
    a power of two, and its free ``keys`` are -1.
    """
    size, last, at, mask = 0, -1, 0, len(keys) - 1
    for p in range(len(of)):
        for k in range(neighbours.shape[1]):
            q = neighbours[p, k]
            if q < 0 or of[p] == of[q]:
                continue
            key = np.int64(min(of[p], of[q])) * count + max(of[p], of[q])
            if key != last:  # usually the pair is the previous one
                last, at = key, (key * 0x9E3779B1 >> 13) & mask
                while keys[at] >= 0 and keys[at] != key:
                    at = (at + 1) & mask
                if keys[at] < 0:
                    if 2 * size > mask:
                        return False
                    keys[at], size = key, size + 1
            total[at] += 1
            jumped[at] += squared(points, p, q) > jump[p] * jump[p]
    return True


@njit(cache=True, nogil=True)
def grow(seeds, spacing, costs, points, smooth, normals, colours, neighbours, jump):  # type: ignore[no-untyped-def]
    """Return the seed (m,) with the cheapest path to each of n points (from all seeds at once), shape (n,).

    ``costs`` holds the cost per radian of turning normals, per metre of height between the planes of neighbours, and
    per unit of colour difference above the fourth value. Points that no seed reaches form patches of their own.

    Notes
    -----
    The method is that of U. Meyer and P. Sanders, "Delta-stepping: a parallelizable shortest path algorithm", Journal
    of Algorithms 49, 2003, on one processor. Points wait in buckets of similar cost. A bucket keeps the points in the
    order in which paths reach them, near each other in space, so that the processor finds them in its cache; a heap
    mixes them. For the same reason, the costs of all steps are computed before, in the order of the points. A point
    whose cost falls after it left its bucket waits again.
    """
    n, m = neighbours.shape
    step_costs = _step_costs(spacing, costs, points, smooth, normals, colours, neighbours, jump)
    of, cost = np.full(n, -1, np.int32), np.full(n, np.inf)
    first = np.full(_BUCKETS, -1, np.int32)  # of the doubly linked list of each bucket
    bucket, before, after = np.full(n, -1, np.int32), np.empty(n, np.int32), np.empty(n, np.int32)
    for number in range(len(seeds)):
        p = seeds[number]
        of[p], cost[p] = number, 0.0
        _put(p, 0, first, bucket, before, after)
    following, start, waiting, now = len(seeds), 0, len(seeds), 0
    while True:
        while waiting:
            p = first[now % _BUCKETS]
            if p < 0:
                now += 1
                continue
            _take(p, first, bucket, before, after)
            waiting -= 1
            for k in range(m):
                total = cost[p] + step_costs[p, k]
                if total < np.inf and total < cost[neighbours[p, k]]:
                    q = neighbours[p, k]
                    of[q], cost[q] = of[p], total
                    place = min(max(int(total / _BUCKET_COST), now), now + _BUCKETS - 1) % _BUCKETS
                    if place != bucket[q]:
                        if bucket[q] >= 0:
                            _take(q, first, bucket, before, after)
                            waiting -= 1
                        _put(q, place, first, bucket, before, after)
                        waiting += 1
        while start < n and of[start] >= 0:
            start += 1
        if start == n:
            return of
        of[start], cost[start], waiting, now = following, 0.0, 1, 0
        _put(start, 0, first, bucket, before, after)
        following += 1


@njit(cache=True, nogil=True)
def _put(p, place, first, bucket, before, after):  # type: ignore[no-untyped-def]
    """Insert a point at the head of the list of a bucket."""
    bucket[p], before[p], after[p] = place, -1, first[place]
    if first[place] >= 0:
        before[first[place]] = p
    first[place] = p


@njit(cache=True, nogil=True)
def _take(p, first, bucket, before, after):  # type: ignore[no-untyped-def]
    """Remove a point from the list of its bucket."""
    if before[p] >= 0:
        after[before[p]] = after[p]
    else:
        first[bucket[p]] = after[p]
    if after[p] >= 0:
        before[after[p]] = before[p]
    bucket[p] = -1


@njit(cache=True, nogil=True, error_model="numpy")
def _step_costs(spacing, costs, points, smooth, normals, colours, neighbours, jump):  # type: ignore[no-untyped-def]
    """Return the cost of a path from each point to each of its neighbours, shape (n, k); infinite beyond a jump."""
    n, m = neighbours.shape
    turn_cost, step_cost, colour_cost, colour_noise = costs
    result = np.full((n, m), np.inf)
    for p in range(n):
        reach = jump[p] * jump[p]
        for k in range(m):
            q = neighbours[p, k]
            if q < 0 or not squared(points, p, q) <= reach:
                continue
            back = m - 1 - k  # of p among the neighbours of q, if they are the pixels around them
            if q < p and neighbours[q, back] == p and result[q, back] < np.inf:
                result[p, k] = result[q, back]
                continue
            turned, tint, step, way = 0.0, 0.0, 0.0, 0.0
            for axis in range(3):
                turned += (normals[p, axis] - normals[q, axis]) ** 2
                tint += (colours[p, axis] - colours[q, axis]) ** 2
                ahead = smooth[q, axis] - smooth[p, axis]
                way += ahead * ahead
                step += ahead * (normals[p, axis] + normals[q, axis]) / 2
            colour = colour_cost * max(0.0, tint**0.5 - colour_noise)
            result[p, k] = way**0.5 / spacing + turn_cost * turned**0.5 + step_cost * abs(step) + colour
    return result
