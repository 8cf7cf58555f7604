"""Outlines seen from above: connected pieces, circles around partly hidden rims, and boxes around objects."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import OutlineSettings
from deixis.perception.oriented_box import OrientedBox, turned_axes
from deixis.reasoning.geometry.coordinates import coordinates

SECTORS = 36
"""Number of sectors into which a circle is divided."""


def in_largest_piece(plan: NDArray[np.float64], cell_size: float) -> NDArray[np.bool_]:
    """Return a mask of the points in the largest connected piece.

    Parameters
    ----------
    plan
        Places of n points in plan, shape (n, 2), in metres.
    cell_size
        Side of the cells of a grid on which points are connected, in metres; a thousandth of the extent if that is
        more.

    Returns
    -------
    ndarray
        Mask of shape (n,).
    """
    from scipy.ndimage import label

    from deixis.perception.detection.kernels import corners_of_box

    if not len(plan):
        return np.zeros(0, dtype=np.bool_)
    low, high = corners_of_box(plan)
    cells = np.floor((plan - low) / max(cell_size, float((high - low).max()) / 1000)).astype(np.int64)
    rows, columns = corners_of_box(cells)[1].astype(np.int64) + 1
    cell = cells[:, 0] * columns + cells[:, 1]
    grid = np.zeros((rows, columns), dtype=np.bool_)
    grid.reshape(-1)[cell] = True
    of = label(grid, np.ones((3, 3)))[0].reshape(-1)[cell]
    largest: NDArray[np.bool_] = of == np.bincount(of).argmax()
    return largest


def occupied_cells(plan: NDArray[np.float64], cell: float) -> NDArray[np.float64]:
    """Return the centres of the grid cells that contain places.

    Parameters
    ----------
    plan
        Places in plan, shape (n, 2), in metres.
    cell
        Side of a cell in metres.

    Returns
    -------
    ndarray
        Centres of shape (k, 2), in metres.
    """
    if not len(plan):
        return np.zeros((0, 2))
    from deixis.perception.detection.kernels import corners_of_box, occupied

    low, high = np.floor(corners_of_box(plan) / cell).astype(np.int64)
    rows, columns = (high - low + 1).tolist()
    if rows * columns > 50 * len(plan) + 1000:  # a few are far away
        few: NDArray[np.float64] = np.unique(np.floor(plan / cell).astype(np.int64), axis=0).astype(np.float64) + 0.5
        return few * cell
    middles: NDArray[np.float64] = (np.argwhere(occupied(plan, cell, low, (rows, columns))) + low + 0.5) * cell
    return middles


def cell_codes(points: NDArray[np.float64], cell: float) -> NDArray[np.int64]:
    """Return a number for the cell of each point in a grid around their middle; it grows by x, then y, then z.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres. Those more than a million cells from the middle count as at that distance.
    cell
        Side of the cubic cells, in metres.

    Returns
    -------
    ndarray
        Codes of shape (n,): 2**42, 2**21 and 1 more for the next cell along x, y and z.
    """
    if not len(points):
        return np.zeros(0, np.int64)
    half = 2**20
    middle = np.median(points[:: max(1, len(points) // 10_000)], axis=0)
    x, y, z = (np.clip(np.floor((points - middle) / cell), 1 - half, half - 2) + half).astype(np.int64).T
    codes: NDArray[np.int64] = (x << 42) | (y << 21) | z
    return codes


def connected(points: NDArray[np.float64], cell: float) -> NDArray[np.intp]:
    """Return the number of the connected group of each point, from 0.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    cell
        Side of the cells of a grid in metres; points in the same cell or in adjacent ones are connected.

    Returns
    -------
    ndarray
        Numbers of shape (n,).

    Examples
    --------
    >>> connected(np.array([[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [9.0, 9.0, 9.0]]), 0.02).tolist()
    [0, 0, 1]
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    codes, of = np.unique(cell_codes(points, cell), return_inverse=True)
    steps = [(x << 42) + (y << 21) + z for x in (0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)]
    starts, ends = [], []
    for step in (each for each in steps if each > 0):
        at = np.minimum(np.searchsorted(codes, codes + step), max(len(codes) - 1, 0))
        met = np.flatnonzero(codes[at] == codes + step)
        starts.append(met)
        ends.append(at[met])
    start, end = np.concatenate(starts), np.concatenate(ends)
    graph = coo_array((np.ones(len(start), np.bool_), (start, end)), shape=(len(codes), len(codes)))
    groups: NDArray[np.intp] = connected_components(graph, directed=False)[1][of].astype(np.intp)
    return groups


def corners_of(plan: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Return the corners (k, 2) of the convex hull of places (n, 2), in order; None for too few or collinear places.

    Parameters
    ----------
    plan
        Places in plan, shape (n, 2), in metres.

    Returns
    -------
    ndarray or None
        Counter-clockwise corners of shape (k, 2).
    """
    hull = hull_of(plan)
    return None if hull is None else np.asarray(hull.points[hull.vertices])


def hull_of(plan: NDArray[np.float64]) -> Any:
    """Return the ``scipy.spatial.ConvexHull`` of places (n, 2), or None for too few or collinear places.

    Parameters
    ----------
    plan
        Places in plan, shape (n, 2), in metres.

    Returns
    -------
    scipy.spatial.ConvexHull or None
        Hull of the outermost places; its indices refer to these.
    """
    from scipy.spatial import ConvexHull, QhullError

    from deixis.perception.detection.kernels import outermost

    try:
        return ConvexHull(plan[outermost(plan)])
    except (QhullError, ValueError):
        return None


@dataclass(frozen=True, eq=False)
class Circle:
    """Circle seen from above, in metres."""

    centre: NDArray[np.float64]  # (2,)
    radius: float

    def enclosed_by(self, corners: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the corners (2, 3) of a box, moved apart in plan where the circle reaches beyond them.

        Parameters
        ----------
        corners
            Lower and upper corner, shape (2, 3), in metres.

        Returns
        -------
        ndarray
            Corners of shape (2, 3) of the smallest box that holds the box and the circle.
        """
        larger = corners.copy()
        larger[0, :2] = np.minimum(corners[0, :2], self.centre - self.radius)
        larger[1, :2] = np.maximum(corners[1, :2], self.centre + self.radius)
        return larger

    def off(self, plan: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the distances (n,) of places (n, 2) from the circle, relative to its radius; negative inside.

        Parameters
        ----------
        plan
            Places in plan, shape (n, 2), in metres.

        Returns
        -------
        ndarray
            Ratios of shape (n,), at least -1; 0 on the circle.
        """
        out: NDArray[np.float64] = np.linalg.norm(plan - self.centre, axis=1) / self.radius - 1.0
        return out

    def sectors(self, plan: NDArray[np.float64], edge: float) -> NDArray[np.int64]:
        """Return the sorted sectors that have places (n, 2) at the edge of the circle or outside it.

        Parameters
        ----------
        plan
            Places in plan, shape (n, 2), in metres.
        edge
            Width of the edge within the circle, relative to the radius.

        Returns
        -------
        ndarray
            Sectors in [0, ``SECTORS``), counter-clockwise from the x axis.
        """
        x, y = (plan[self.off(plan) > -edge] - self.centre).T
        turn = np.arctan2(y, x) / (2 * np.pi) % 1.0
        return np.unique(np.minimum(turn * SECTORS, SECTORS - 1).astype(np.int64))

    def turned(self, axes: NDArray[np.float64]) -> Circle:
        """Return the circle in coordinates along other axes.

        Parameters
        ----------
        axes
            Unit vectors of the axes as rows, shape (2, 2).

        Returns
        -------
        Circle
            Circle with an equal radius.
        """
        return Circle(axes @ self.centre, self.radius)


def circle_around(corners: NDArray[np.float64] | None, edge: float) -> Circle | None:
    """Return the circle through the corners of a convex hull, or None.

    Parameters
    ----------
    corners
        Corners in plan, shape (k, 2), in metres, as :func:`corners_of` returns them.
    edge
        Largest distance of a corner from the circle, relative to its radius.

    Returns
    -------
    Circle or None
        None if there are fewer than five corners, or one of them is too far from the circle.

    Notes
    -----
    The circle is fitted by algebraic least squares (Kasa, A circle fitting procedure and its error analysis, 1976).
    """
    if corners is None or len(corners) < 5:
        return None
    terms = np.column_stack([2 * corners, np.ones(len(corners))])
    x, y, rest = np.linalg.lstsq(terms, (corners**2).sum(axis=1))[0].tolist()
    circle = Circle(np.array([x, y]), math.sqrt(max(rest + x * x + y * y, 1e-12)))
    return circle if np.abs(circle.off(corners)).max() <= edge else None


def rim_of(
    plan: NDArray[np.float64],
    corners: NDArray[np.float64] | None,
    table: NDArray[np.float64],
    settings: OutlineSettings,
) -> Circle | None:
    """Return the whole rim of a partly hidden round object, or None.

    Parameters
    ----------
    plan
        Visible places of the object in plan, shape (n, 2), in metres.
    corners
        Corners of their convex hull, as :func:`corners_of` returns them.
    table
        Places at which the table is visible, shape (m, 2), in metres.
    settings
        Tolerance, range of radii, and the number of sectors that must be visible.

    Returns
    -------
    Circle or None
        None if the visible part is not round, too little of the edge is visible, or the table is visible inside the
        supposed rim.
    """
    circle = circle_around(corners, settings.rim_tolerance)
    if circle is None or not settings.min_rim_radius <= circle.radius <= settings.max_rim_radius:
        return None
    seen = circle.sectors(plan, settings.rim_tolerance)
    gaps = np.sort(np.diff(np.append(seen, seen[0] + SECTORS)) - 1)
    if SECTORS - gaps[-1] < settings.min_rim_sectors or gaps[:-1].max(initial=0) > settings.rim_gap_sectors:
        return None
    table = table[(np.abs(table - circle.centre) < circle.radius).all(axis=1)]
    within = table[circle.off(table) * circle.radius < -settings.rim_inset]
    bare = len(np.unique(np.floor(within / settings.bare_cell), axis=0)) * settings.bare_cell**2
    return circle if bare < settings.bare_share * np.pi * circle.radius**2 else None


def upright_box(
    points: NDArray[np.float64], settings: OutlineSettings, rim: Circle | None = None
) -> NDArray[np.float64]:
    """Return the lower and upper corner of points in the frame of the table.

    The box has no part below the table.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    settings
        Share of outermost points that are noise.
    rim
        Circle in plan that the box includes.

    Returns
    -------
    ndarray
        Corners of shape (2, 3), in metres.

    Examples
    --------
    >>> upright_box(np.array([[0.0, 0, -0.001], [1, 2, 3]]), OutlineSettings()).tolist()
    [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]
    """
    skip = int(settings.trim_share * len(points))  # the outermost points along each axis are noise
    ordered = np.sort(points, axis=0)
    box = np.stack([ordered[skip], ordered[len(points) - 1 - skip]])
    if rim is not None:
        box = rim.enclosed_by(box)
    box[:, 2] = np.maximum(box[:, 2], 0.0)
    return box


def oriented_box(
    points: NDArray[np.float64],
    settings: OutlineSettings,
    rim: Circle | None = None,
    corners: NDArray[np.float64] | None = None,
) -> OrientedBox:
    """Return the upright box of points with the smallest base.

    Parameters
    ----------
    points
        Points of shape (n, 3) in the frame of the table, in metres.
    settings
        Share of outermost points that are noise.
    rim
        Circle in plan that the box includes.
    corners
        Corners of the convex hull of the points in plan, if they are known.

    Returns
    -------
    OrientedBox
        Box whose first side is the longer one, with a yaw in (-pi/2, pi/2].

    Notes
    -----
    The smallest rectangle has a side along the convex hull by the theorem of Freeman and Shapira (1975).
    """
    corners = corners_of(points[:, :2]) if corners is None else corners
    box = _box_along(_best_angle(points[:, :2], corners), points, settings, rim)
    if box.extents[1] > box.extents[0]:
        box = _box_along(box.yaw + np.pi / 2, points, settings, rim)
    return box


def _box_along(yaw: float, points: NDArray[np.float64], settings: OutlineSettings, rim: Circle | None) -> OrientedBox:
    """Return the box with a side in the direction of ``yaw``."""
    yaw = float(np.pi / 2 - (np.pi / 2 - yaw) % np.pi)
    axes = turned_axes(yaw)
    low, high = upright_box(coordinates(points, axes), settings, rim and rim.turned(axes[:2, :2]))
    (x, y, z), (length, width, height) = (axes.T @ ((low + high) / 2)).tolist(), (high - low).tolist()
    return OrientedBox((x, y, z), yaw, (length, width, height))


def _best_angle(plan: NDArray[np.float64], corners: NDArray[np.float64] | None) -> float:
    """Return the yaw of the smallest rectangle around places (n, 2), whose convex hull has ``corners`` (k, 2)."""
    if corners is None:
        along = np.ptp(plan, axis=0)
        return float(np.arctan2(along[1], along[0])) if along.any() else 0.0
    sides = np.roll(corners, -1, axis=0) - corners
    angles = np.unique(np.arctan2(sides[:, 1], sides[:, 0]) % (np.pi / 2))
    turned = corners @ np.stack([np.cos(angles), np.sin(angles)])
    across = corners @ np.stack([-np.sin(angles), np.cos(angles)])
    return float(angles[np.argmin(np.ptp(turned, axis=0) * np.ptp(across, axis=0))])
