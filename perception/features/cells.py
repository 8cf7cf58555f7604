"""Points sorted into cubic cells, and the runs of points that may lie within reach of a place; compiled.

A counting sort puts the points of a cell, and of the cells of a row, side by side. Rows follow the axis on which the
cloud is longest, so that they are few and long: what lies near a place is then a few runs of neighbouring memory.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

CELLS_PER_POINT = 2
"""At most so many cells for each point (and 4,096): a far outlier makes cells larger, never memory run out."""


class CellGrid(NamedTuple):
    """n points in the order of their cells; the axes are permuted, the longest last."""

    x: NDArray[np.float64]  # (n,)
    y: NDArray[np.float64]
    z: NDArray[np.float64]
    order: NDArray[np.int64]  # (n,): where each point stood before
    starts: NDArray[np.int64]  # (cells + 1,): the points of cell c are starts[c]:starts[c + 1]
    low: NDArray[np.float64]  # (3,): the least coordinates
    shape: NDArray[np.int64]  # (3,): cells along each axis
    cell: float  # a cell's edge
    axes: NDArray[np.int64]  # (3,): the axis of the points that x, y and z were


def cell_grid(points: NDArray[np.floating], cell: float) -> CellGrid:
    """The points (n, 3), n > 0 and all finite, in cells of about the given edge; larger ones where they are too many.

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
    """Vectors (m, 3) in the grid's axes, as the kernels take them."""
    return np.ascontiguousarray(vectors[:, grid.axes], dtype=np.float64)


@njit(cache=True, nogil=True, error_model="numpy")
def _sort(x, y, z, low, shape, cell, starts, order):  # type: ignore[no-untyped-def]
    """Fills ``starts`` and ``order``; points of one cell keep their order."""
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
    """How many runs there can be at most."""
    return grid.shape[0] * grid.shape[1]


@njit(cache=True, nogil=True, error_model="numpy")
def ball_runs(grid, place, radius, runs):  # type: ignore[no-untyped-def]
    """Runs of points that hold all within ``radius`` of ``place`` (3,), in ``runs`` (any, 2); returns their number."""
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
    """The same for a cylinder about ``place`` along the unit vector ``axis`` (3,), ``radius`` high to either side."""
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
    """Where a row, centred ``dx`` and ``dy`` off and ``half`` a cell wide to each side, may meet the cylinder."""
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
    """Half the extent, along an axis, of the cylinder of radius 1 and half height 1 whose axis has this component."""
    return abs(component) + math.sqrt(max(0.0, 1.0 - component * component))


@njit(cache=True, nogil=True, error_model="numpy")
def _window(grid, place, reach, axis):  # type: ignore[no-untyped-def]
    """The cells along an axis within reach, as a range."""
    first = math.floor((place[axis] - reach - grid.low[axis]) / grid.cell)
    last = math.floor((place[axis] + reach - grid.low[axis]) / grid.cell)
    return max(0, first), min(grid.shape[axis], last + 1)


@njit(cache=True, nogil=True, error_model="numpy")
def _offset(grid, place, index, axis):  # type: ignore[no-untyped-def]
    """From the place to the middle of a cell, along an axis."""
    return grid.low[axis] + (index + 0.5) * grid.cell - place[axis]


@njit(cache=True, nogil=True, error_model="numpy")
def _append(grid, i, j, low, high, runs, count):  # type: ignore[no-untyped-def]
    """One more run: the cells of row (i, j) that meet the interval from low to high, if they hold a point."""
    base = (i * grid.shape[1] + j) * grid.shape[2]
    first = max(0, math.floor((low - grid.low[2]) / grid.cell))
    last = min(grid.shape[2], math.floor((high - grid.low[2]) / grid.cell) + 1)
    if first < last and grid.starts[base + first] < grid.starts[base + last]:
        runs[count, 0], runs[count, 1] = grid.starts[base + first], grid.starts[base + last]
        return count + 1
    return count
