"""Spin images, compiled: points near a keypoint are placed in bins a buffer at a time, then added up.

Placing has no branches, so that the compiler turns it into vector instructions; points outside the support go to a bin
that is thrown away. A point adds (1, a, b, a b) to its bin, a and b being where it lies in it; the four corners of all
bins get their bilinear shares from these sums in the end. All arithmetic is in double precision.
"""

from __future__ import annotations

import math

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic

from deixis.perception.features.cells import ball_runs, cylinder_runs, most_runs

BUFFER = 512
"""Points placed at a time; three buffers of them stay in the fastest cache."""


@njit(cache=True, nogil=True, error_model="numpy")
def images(grid, normals, places, axes, width, support, cosine, radial, angular, out):  # type: ignore[no-untyped-def]
    """Fills ``out`` (k, bins) with the images of keypoints at ``places`` (k, 3) about ``axes`` (k, 3).

    ``normals`` (n, 3) are those of the grid's points, in its order and axes; none (0, 3) where neither a support
    angle (``cosine`` > 0) nor ``angular`` asks for them.
    """
    a, b, bins = np.empty(BUFFER), np.empty(BUFFER), np.empty(BUFFER, np.int32)
    angles = np.zeros(BUFFER)
    sums = np.empty((2, discarded(width) + 1, 4))
    image, turned = np.empty((width + 1, 2 * width + 1)), np.empty((width + 1, 2 * width + 1))
    runs = np.empty((most_runs(grid), 2), np.int64)
    radius = support / math.sqrt(2.0)
    for k in range(len(places)):
        sums[:] = 0.0
        image[:] = 0.0
        turned[:] = 0.0
        place, axis = places[k], axes[k]
        found = ball_runs(grid, place, support, runs) if radial else cylinder_runs(grid, place, axis, radius, runs)
        for r in range(found):
            for low in range(runs[r, 0], runs[r, 1], BUFFER):
                high = min(low + BUFFER, runs[r, 1])
                x, y, z = grid.x[low:high], grid.y[low:high], grid.z[low:high]
                if radial:
                    _place_in_ball(x, y, z, place, axis, width, support, a, b, bins)
                else:
                    _place_in_cylinder(x, y, z, place, axis, width, radius, a, b, bins)
                if len(normals):
                    _turn(normals[low:high], axis, cosine, discarded(width), bins, angles)
                if angular:
                    _add_angles(a, b, bins, angles, high - low, image, turned)
                else:
                    _add(a, b, bins, high - low, sums)
        if angular:
            image[:] = turned / (image + np.finfo(np.float64).eps)
        else:
            image /= max(_to_corners(sums, image), 1.0)
        out[k] = image.reshape(-1)


@njit(cache=True, nogil=True, error_model="numpy")
def discarded(width):  # type: ignore[no-untyped-def]
    """The bin for what lies outside."""
    return 2 * width * width


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract"})
def _place_in_cylinder(x, y, z, place, axis, width, radius, a, b, bins):  # type: ignore[no-untyped-def]
    scale, edge = width / radius, float(width)
    px, py, pz = place[0], place[1], place[2]
    nx, ny, nz = axis[0] * scale, axis[1] * scale, axis[2] * scale
    columns, last, outside = 2.0 * width, 2.0 * width - 1.0, float(discarded(width))
    for i in range(len(x)):
        dx, dy, dz = x[i] - px, y[i] - py, z[i] - pz
        beta = dx * nx + dy * ny + dz * nz
        squared = (dx * dx + dy * dy + dz * dz) * (scale * scale)
        alpha = np.sqrt(max(squared - beta * beta, 0.0))
        inside = (abs(beta) < edge) & (alpha < edge) & (squared > 0.0)
        row, column = np.floor(alpha), min(np.floor(beta + edge), last)
        a[i], b[i] = alpha - row, beta + edge - column
        bins[i] = np.int32(row * columns + column if inside else outside)


@njit(cache=True, nogil=True, error_model="numpy")
def _place_in_ball(x, y, z, place, axis, width, support, a, b, bins):  # type: ignore[no-untyped-def]
    for i in range(len(x)):
        dx, dy, dz = x[i] - place[0], y[i] - place[1], z[i] - place[2]
        distance = math.sqrt(dx * dx + dy * dy + dz * dz)
        bins[i] = discarded(width)
        if 0.0 < distance < support:
            sine = (dx * axis[0] + dy * axis[1] + dz * axis[2]) / distance
            elevation = math.asin(max(-1.0, min(1.0, sine)))
            across, along = distance * width / support, (elevation / (0.5 * math.pi) + 1.0) * width
            row, column = min(int(across), width - 1), min(int(along), 2 * width - 1)
            a[i], b[i] = across - row, along - column
            bins[i] = row * 2 * width + column


@njit(cache=True, nogil=True, error_model="numpy")
def _turn(normals, axis, cosine, outside, bins, angles):  # type: ignore[no-untyped-def]
    """The angles between normals and axis, a right one at most; what turns too far, or has no normal, is outside."""
    for i in range(len(normals)):
        turn = abs(normals[i, 0] * axis[0] + normals[i, 1] * axis[1] + normals[i, 2] * axis[2])
        if not turn >= cosine:  # not '<': without a normal the comparison is false
            bins[i] = outside
        else:
            angles[i] = math.acos(min(1.0, turn))


@intrinsic
def _add_four(typing, sums, at, a, b):  # type: ignore[no-untyped-def]
    """Adds (1, a, b, a b) to the four numbers at a position, in one vector addition."""

    def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
        _, position, a_value, b_value = arguments
        four = ir.VectorType(ir.DoubleType(), 4)
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        pointer = builder.bitcast(builder.gep(data, [position]), four.as_pointer())
        added = ir.Constant(four, [1.0, 0.0, 0.0, 0.0])
        for lane, value in enumerate((a_value, b_value, builder.fmul(a_value, b_value)), start=1):
            added = builder.insert_element(added, value, ir.Constant(ir.IntType(32), lane))
        builder.store(builder.fadd(builder.load(pointer, align=8), added), pointer, align=8)
        return context.get_dummy_value()

    return types.void(sums, at, a, b), generate


@njit(cache=True, nogil=True, error_model="numpy")
def _add(a, b, bins, count, sums):  # type: ignore[no-untyped-def]
    """Adds to two sets of sums by turns: neighbours in a run often share a bin, and need not wait for each other."""
    flat, half = sums.reshape(-1), count // 2
    other = sums.shape[1]
    for i in range(half):
        _add_four(flat, 4 * bins[i], a[i], b[i])  # type: ignore[call-arg]
        _add_four(flat, 4 * (bins[half + i] + other), a[half + i], b[half + i])
    if count % 2:
        _add_four(flat, 4 * bins[count - 1], a[count - 1], b[count - 1])  # type: ignore[call-arg]


@njit(cache=True, nogil=True, error_model="numpy")
def _to_corners(sums, image):  # type: ignore[no-untyped-def]
    """Adds to the image (width + 1, 2 width + 1) the shares that the sums stand for; returns the number of points.

    Sums are read one by one: a view of an array per bin costs as much as all the points of a small cloud.
    """
    total, columns = 0.0, image.shape[1] - 1
    for row in range(image.shape[0] - 1):
        for column in range(columns):
            at = row * columns + column
            ones = sums[0, at, 0] + sums[1, at, 0]
            if ones > 0.0:
                total += ones
                a = sums[0, at, 1] + sums[1, at, 1]
                b = sums[0, at, 2] + sums[1, at, 2]
                ab = sums[0, at, 3] + sums[1, at, 3]
                image[row, column] += ones - a - b + ab
                image[row + 1, column] += a - ab
                image[row, column + 1] += b - ab
                image[row + 1, column + 1] += ab
    return total


@njit(cache=True, nogil=True, error_model="numpy")
def _add_angles(a, b, bins, angles, count, image, turned):  # type: ignore[no-untyped-def]
    """Adds each point's shares to the image, and its angle times its shares to ``turned``.

    An average divides by shares however small, so these are added one by one, not got as differences of sums.
    """
    columns = image.shape[1] - 1
    for i in range(count):
        row, column = bins[i] // columns, bins[i] % columns
        if row < image.shape[0] - 1:
            for di in range(2):
                for dj in range(2):
                    share = (a[i] if di else 1.0 - a[i]) * (b[i] if dj else 1.0 - b[i])
                    image[row + di, column + dj] += share
                    turned[row + di, column + dj] += share * angles[i]
