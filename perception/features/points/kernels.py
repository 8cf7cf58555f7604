"""Compiled kernels on the neighbourhoods of a cloud's points: covariances for normals, and spin images.

A counting sort puts the points into cubic cells, so that the points of a cell, and of the cells of a row, are adjacent
in memory. Rows follow the axis along which the cloud is longest, so that they are few and long: the neighbourhood of a
place is then a few runs of contiguous memory.

Points near a keypoint are placed in the bins of its spin image a buffer at a time, without branches, so that the
compiler turns it into vector instructions; points outside the support go to a bin that is thrown away. A point adds
(1, a, b, a b) to its bin, a and b being where it lies in it; the four corners of all bins get their bilinear shares
from these sums in the end. All arithmetic is in double precision.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from llvmlite import ir
from numba import njit, types
from numba.extending import intrinsic
from numpy.typing import NDArray

CELLS_PER_POINT = 2
"""Maximum number of cells per point (plus 4,096): a far outlier makes cells larger instead of exhausting memory."""


class CellGrid(NamedTuple):
    """Grid of n points in the order of their cells; the axes are permuted, the longest last."""

    x: NDArray[np.float64]  # (n,)
    y: NDArray[np.float64]
    z: NDArray[np.float64]
    order: NDArray[np.int64]  # (n,): original index of each point
    starts: NDArray[np.int64]  # (cells + 1,): the points of cell c are starts[c]:starts[c + 1]
    low: NDArray[np.float64]  # (3,): the least coordinates
    shape: NDArray[np.int64]  # (3,): cells along each axis
    cell: float  # a cell's edge
    axes: NDArray[np.int64]  # (3,): the axis of the points that x, y and z were


def cell_grid(points: NDArray[np.floating], cell: float) -> CellGrid:
    """Sort points into the cells of a grid.

    Parameters
    ----------
    points
        Finite points, shape (n, 3), n > 0.
    cell
        Edge of a cell; cells are larger if they would be too many.

    Returns
    -------
    CellGrid
        The grid, with the points in the order of its cells.

    Examples
    --------
    >>> grid = cell_grid(np.array([[0.0, 0, 9], [5, 0, 0], [0, 0, 0]]), 1.0)
    >>> grid.shape.tolist(), grid.order.tolist(), grid.axes.tolist()
    ([1, 6, 10], [2, 0, 1], [1, 0, 2])
    """
    cell, columns = float(cell), np.ascontiguousarray(points.T, dtype=np.float64)
    low, extent = columns.min(axis=1), np.ptp(columns, axis=1)
    most = CELLS_PER_POINT * len(points) + 4096
    while np.prod(np.floor(extent / cell) + 1) > most:
        cell *= 1.25
    axes = np.argsort(extent, kind="stable")
    shape = np.floor(extent[axes] / cell).astype(np.int64) + 1
    starts = np.zeros(int(shape.prod()) + 1, np.int64)
    order = np.empty(len(points), np.int64)
    x, y, z = (columns[axis] for axis in axes)
    _sort(x, y, z, low[axes], shape, cell, starts, order)
    return CellGrid(x[order], y[order], z[order], order, starts, low[axes], shape, cell, axes)


def in_axes_of(grid: CellGrid, vectors: NDArray[np.floating]) -> NDArray[np.float64]:
    """Permute the axes of vectors as the kernels need them.

    Parameters
    ----------
    grid
        Grid whose axes are permuted, the longest last.
    vectors
        Vectors of shape (m, 3).

    Returns
    -------
    ndarray
        The vectors in the axes of the grid, shape (m, 3).
    """
    return np.ascontiguousarray(vectors[:, grid.axes], dtype=np.float64)


@njit(cache=True, nogil=True, error_model="numpy")
def _sort(x, y, z, low, shape, cell, starts, order):  # type: ignore[no-untyped-def]
    """Fill ``starts`` and ``order``; points of one cell keep their order."""
    codes = np.empty(len(x), np.int64)
    for i in range(len(x)):
        code = int((x[i] - low[0]) / cell) * shape[1] + int((y[i] - low[1]) / cell)
        codes[i] = code * shape[2] + int((z[i] - low[2]) / cell)
        starts[codes[i] + 1] += 1
    for c in range(len(starts) - 1):
        starts[c + 1] += starts[c]
    following = starts.copy()
    for i in range(len(x)):
        order[following[codes[i]]] = i
        following[codes[i]] += 1


@njit(cache=True, nogil=True, error_model="numpy")
def most_runs(grid):  # type: ignore[no-untyped-def]
    """Return the maximum number of runs."""
    return grid.shape[0] * grid.shape[1]


@njit(cache=True, nogil=True, error_model="numpy")
def ball_runs(grid, place, radius, runs):  # type: ignore[no-untyped-def]
    """Fill ``runs`` (any, 2) with the runs that hold the points within ``radius`` of ``place``; return their number."""
    count = 0
    reach = radius + 1e-6 * (radius + grid.cell)
    diagonal = math.sqrt(0.5) * grid.cell
    first, last = _window(grid, place, reach, 0)
    left, right = _window(grid, place, reach, 1)
    for i in range(first, last):
        for j in range(left, right):
            across = _offset(grid, place, i, 0) ** 2 + _offset(grid, place, j, 1) ** 2
            nearest = max(math.sqrt(across) - diagonal, 0.0)
            if nearest <= reach:
                half = math.sqrt(reach * reach - nearest * nearest)
                count = _append(grid, i, j, place[2] - half, place[2] + half, runs, count)
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def cylinder_runs(grid, place, axis, radius, runs):  # type: ignore[no-untyped-def]
    """Fill ``runs`` (any, 2) with runs that hold all points of a cylinder; return their number.

    The cylinder is about ``place`` (3,) along the unit vector ``axis`` (3,), and extends by ``radius`` to either side.
    """
    count = 0
    reach = radius + 1e-6 * (radius + grid.cell)
    first, last = _window(grid, place, reach * _breadth(axis[0]), 0)
    left, right = _window(grid, place, reach * _breadth(axis[1]), 1)
    half = reach * _breadth(axis[2])
    for i in range(first, last):
        for j in range(left, right):
            low, high = _interval(_offset(grid, place, i, 0), _offset(grid, place, j, 1), axis, reach, 0.5 * grid.cell)
            low, high = max(low, -half), min(high, half)
            if low <= high:
                count = _append(grid, i, j, place[2] + low, place[2] + high, runs, count)
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def _interval(dx, dy, axis, reach, half):  # type: ignore[no-untyped-def]
    """Return the interval in which a row, centred ``dx`` and ``dy`` off and ``half`` wide to each side, may meet it."""
    low, high = -np.inf, np.inf
    along = dx * axis[0] + dy * axis[1]
    slope = axis[2]
    if abs(slope) > 1e-3:  # between the two bases
        height = reach + half * (abs(axis[0]) + abs(axis[1]))
        low = (-along - math.copysign(height, slope)) / slope
        high = (-along + math.copysign(height, slope)) / slope
    steep = 1.0 - slope * slope
    if steep > 1e-3:  # within the mantle, widened by half a row's diagonal: a quadratic inequality
        wide = reach + math.sqrt(2.0) * half
        middle = slope * along / steep
        squared = middle * middle - (dx * dx + dy * dy - along * along - wide * wide) / steep
        if squared < 0.0:
            return 1.0, -1.0
        low, high = max(low, middle - math.sqrt(squared)), min(high, middle + math.sqrt(squared))
    return low, high


@njit(cache=True, nogil=True, error_model="numpy")
def _breadth(component):  # type: ignore[no-untyped-def]
    """Return half the extent along a coordinate axis of a cylinder of radius 1 and half height 1.

    ``component`` is that of the cylinder's axis along the coordinate axis.
    """
    return abs(component) + math.sqrt(max(0.0, 1.0 - component * component))


@njit(cache=True, nogil=True, error_model="numpy")
def _window(grid, place, reach, axis):  # type: ignore[no-untyped-def]
    """Return the range of cells along an axis within reach."""
    first = math.floor((place[axis] - reach - grid.low[axis]) / grid.cell)
    last = math.floor((place[axis] + reach - grid.low[axis]) / grid.cell)
    return max(0, first), min(grid.shape[axis], last + 1)


@njit(cache=True, nogil=True, error_model="numpy")
def _offset(grid, place, index, axis):  # type: ignore[no-untyped-def]
    """Return the distance along an axis from the place to the centre of a cell."""
    return grid.low[axis] + (index + 0.5) * grid.cell - place[axis]


@njit(cache=True, nogil=True, error_model="numpy")
def _append(grid, i, j, low, high, runs, count):  # type: ignore[no-untyped-def]
    """Add the run of the cells of row (i, j) in the interval, if they hold a point; return the number of runs."""
    base = (i * grid.shape[1] + j) * grid.shape[2]
    first = max(0, math.floor((low - grid.low[2]) / grid.cell))
    last = min(grid.shape[2], math.floor((high - grid.low[2]) / grid.cell) + 1)
    if first < last and grid.starts[base + first] < grid.starts[base + last]:
        runs[count, 0], runs[count, 1] = grid.starts[base + first], grid.starts[base + last]
        return count + 1
    return count


@njit(cache=True, nogil=True, error_model="numpy")
def spreads(grid, places, radius, counts, covariances):  # type: ignore[no-untyped-def]
    """Fill the counts (m,) and covariances (m, 3, 3) of the points within ``radius``, border included, of places."""
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
    """Fill the counts (m,) of the points nearer than ``radius`` to the places (m, 3)."""
    runs = np.empty((most_runs(grid), 2), np.int64)
    for m in range(len(places)):
        place = places[m]
        for r in range(ball_runs(grid, place, radius, runs)):
            for i in range(runs[r, 0], runs[r, 1]):
                dx, dy, dz = grid.x[i] - place[0], grid.y[i] - place[1], grid.z[i] - place[2]
                counts[m] += dx * dx + dy * dy + dz * dz < radius * radius


BUFFER = 512
"""Number of points placed at a time; three buffers of this length fit into the fastest cache."""


@njit(cache=True, nogil=True, error_model="numpy")
def images(grid, normals, places, axes, width, support, cosine, radial, angular, out):  # type: ignore[no-untyped-def]
    """Fill ``out`` (k, bins) with the images of keypoints at ``places`` (k, 3) about ``axes`` (k, 3).

    ``normals`` (n, 3) are those of the grid's points, in its order and axes; they may be empty (0, 3) unless a support
    angle (``cosine`` > 0) or ``angular`` needs them.
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
    """Return the bin for points outside."""
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
    """Fill in the angles between normals and axis, up to a right angle; larger or missing ones go to ``outside``."""
    for i in range(len(normals)):
        turn = abs(normals[i, 0] * axis[0] + normals[i, 1] * axis[1] + normals[i, 2] * axis[2])
        if not turn >= cosine:  # not '<': without a normal the comparison is false
            bins[i] = outside
        else:
            angles[i] = math.acos(min(1.0, turn))


@intrinsic
def _add_four(typing, sums, at, a, b):  # type: ignore[no-untyped-def]
    """Add (1, a, b, a b) to the four numbers at a position by one vector addition."""

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
    """Add alternately to two sets of sums: neighbours in a run often share a bin, and then need not wait."""
    flat, half = sums.reshape(-1), count // 2
    other = sums.shape[1]
    for i in range(half):
        _add_four(flat, 4 * bins[i], a[i], b[i])  # type: ignore[call-arg]
        _add_four(flat, 4 * (bins[half + i] + other), a[half + i], b[half + i])
    if count % 2:
        _add_four(flat, 4 * bins[count - 1], a[count - 1], b[count - 1])  # type: ignore[call-arg]


@njit(cache=True, nogil=True, error_model="numpy")
def _to_corners(sums, image):  # type: ignore[no-untyped-def]
    """Add the shares in the sums to the image (width + 1, 2 width + 1); return the number of points.

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
    """Add each point's shares to the image, and its angle times its shares to ``turned``.

    An average divides by shares, however small; they are therefore added one by one, not computed as differences.
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
