"""Estimate the normals of a cloud, from the plane through each point's neighbourhood, oriented towards the sensor.

The normal is the direction of least variance in a neighbourhood: the eigenvector of the smallest eigenvalue of its
covariance (Hoppe et al. 1992).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import CloudError
from deixis.perception.features.describer import require_indices, require_length, require_points
from deixis.perception.features.points.blocks import in_blocks

LINE_SPREAD_RATIO = 1e-6
"""Ratio of the second to the first variance below which a neighbourhood is a line, and has no plane."""

NEIGHBOURHOOD_BATCH = 50_000
"""Number of neighbourhoods of k points that are gathered at a time, which bounds memory."""


def estimate_normals(
    points: NDArray[np.floating],
    *,
    radius: float | None = None,
    neighbours: int | None = None,
    origin: Sequence[float] = (0.0, 0.0, 0.0),
    at: NDArray[np.integer] | None = None,
    threads: int | None = None,
) -> NDArray[np.float32]:
    """Estimate unit normals of points, oriented towards the sensor.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    radius
        Radius of a neighbourhood in metres. Give either ``radius`` or ``neighbours``.
    neighbours
        Number of nearest points in a neighbourhood, the point itself included; at least 3.
    origin
        Position of the sensor.
    at
        Indices of shape (m,) of the points whose normals are estimated; all points by default.
    threads
        Number of threads; by default one for each processor that the process may use.

    Returns
    -------
    Normals of shape (n, 3), or (m, 3) with ``at``. A normal is nan if the point is not finite, or if its neighbourhood
    has fewer than three points or is a line.

    Raises
    ------
    CloudError
        If shapes do not fit, or not exactly one of ``radius`` and ``neighbours`` is given.

    Notes
    -----
    A normal at a right angle to the line of sight has a first nonzero component above 0. If the variance of a
    neighbourhood is equal in two directions (an edge, a bead), the normal is one of many.

    Examples
    --------
    >>> square = np.array([[0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]], np.float64)
    >>> estimate_normals(square, radius=1.5)[0].tolist()
    [0.0, 0.0, -1.0]
    """
    require_points(points)
    finite = np.isfinite(points).all(axis=1)
    wanted = np.flatnonzero(finite) if at is None else np.asarray(at)
    require_indices(wanted, points, "indices of normals")
    normals = np.full((len(points), 3), np.nan, np.float32) if at is None else np.empty((len(wanted), 3), np.float32)
    if len(wanted):
        counts, covariances = neighbourhoods(points[finite], points[wanted], radius, neighbours, threads)
        largest = np.abs(covariances).max(axis=(1, 2))
        scale = np.where(largest > 0, largest, 1.0)[:, None, None]
        values, vectors = np.linalg.eigh(covariances / scale)
        planes: NDArray[np.float64] = vectors[:, :, 0]
        planes[(counts < 3) | (values[:, 1] <= LINE_SPREAD_RATIO * values[:, 2])] = np.nan
        found = planes
        directions = found
        side = (directions * (np.asarray(origin, np.float64) - points[wanted])).sum(axis=1)
        first = np.take_along_axis(directions, (directions != 0).argmax(axis=1)[:, None], axis=1)[:, 0]
        directions[(side < 0) | ((side == 0) & (first < 0))] *= -1
        directions += 0.0
        normals[wanted if at is None else slice(None)] = found
    return normals


def neighbourhoods(
    points: NDArray[np.floating],
    places: NDArray[np.floating],
    radius: float | None,
    neighbours: int | None,
    threads: int | None,
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Count the points around some places, and compute their covariances.

    A neighbourhood holds the points within a radius, or the nearest ones; give one of the two.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    places
        Centres of the neighbourhoods, shape (m, 3), in metres.
    radius
        Radius in metres, or None.
    neighbours
        Number of nearest points, at least 3, or None.
    threads
        Number of threads; None means one for each processor.

    Returns
    -------
    tuple
        Numbers of points, shape (m,), and covariances, shape (m, 3, 3).

    Raises
    ------
    CloudError
        If an argument has another shape or range.
    """
    if (radius is None) == (neighbours is None):
        raise CloudError("normals need exactly one of `radius` and `neighbours`")
    if radius is not None:
        require_length(radius, "a normal's radius")
        from deixis.perception.features.points.kernels import cell_grid, in_axes_of, spreads

        grid = cell_grid(points, radius)
        turned, radius = in_axes_of(grid, places), float(radius)
        counts, covariances = np.zeros(len(places), np.int64), np.zeros((len(places), 3, 3))
        in_blocks(
            lambda start, stop: spreads(grid, turned[start:stop], radius, counts[start:stop], covariances[start:stop]),
            len(places),
            threads,
        )
        back = np.argsort(grid.axes)
        return counts, covariances[:, back][:, :, back]
    if neighbours is None or neighbours < 3:
        raise CloudError(f"`neighbours` must be at least 3, got {neighbours}")
    from scipy.spatial import cKDTree

    count = min(neighbours, len(points))
    tree = cKDTree(points)
    covariances = np.empty((len(places), 3, 3))
    for start in range(0, len(places), NEIGHBOURHOOD_BATCH):
        part = slice(start, start + NEIGHBOURHOOD_BATCH)
        nearest = tree.query(places[part], k=[*range(1, count + 1)], workers=threads or -1)[1]
        around = points[nearest].astype(np.float64) - places[part, None]
        around -= around.mean(axis=1, keepdims=True)
        covariances[part] = np.einsum("mki,mkj->mij", around, around) / count
    return np.full(len(places), count), covariances
