"""Find the top of a table: the points of its plane that belong to it, and its outline.

Objects may hide so much of a table that its visible parts are not connected. Two parts belong to one table if something
above the plane hides the space between them from the sensor. Where the view passes through the plane to something
lower, or to nothing, there is no table.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import hull_of, in_largest_piece
from deixis.perception.detection.settings import DetectionSettings, TableTopSettings
from deixis.perception.detection.table.plane import Plane
from deixis.perception.detection.table.viewpoint import View, directions
from deixis.reasoning.geometry.coordinates import coordinates

_EMPTY, _LEVEL, _ABOVE, _BELOW = 0, 1, 2, 3
"""Content of a cell of the image: nothing, the plane, something above it, or something below it."""


@dataclass(frozen=True, eq=False)
class TableTop:
    """Points of a view (n, 3) on the top of a table, given by their indices ``on`` (k,), and the outline of the top."""

    plane: Plane
    points: NDArray[np.float64]
    on: NDArray[np.intp]
    settings: DetectionSettings

    @cached_property
    def outline(self) -> NDArray[np.float64]:
        """Convex hull of the top along ``plane.across``, as half planes (h, 3); h is 0 for too few points."""
        step = max(1, len(self.on) // self.settings.top.outline_sample_size)
        hull = hull_of(coordinates(self.points[self.on[::step]], self.plane.across))
        return np.zeros((0, 3)) if hull is None else np.asarray(hull.equations)

    def beyond(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the distances of points from the outline seen from above; negative inside.

        Parameters
        ----------
        points
            Points of shape (n, 3), in metres.

        Returns
        -------
        ndarray
            Distances of shape (n,), in metres; infinite without an outline.
        """
        from deixis.perception.detection.kernels import greatest_offset

        if not len(self.outline):
            return np.full(len(points), np.inf)
        sides = np.column_stack([self.outline[:, :2] @ self.plane.across, self.outline[:, 2]])
        offsets: NDArray[np.float64] = greatest_offset(points, sides)
        return offsets

    @cached_property
    def outside(self) -> NDArray[np.float64]:
        """Distance of each point of the view from the outline in metres, shape (n,); negative inside."""
        return self.beyond(self.points)

    @property
    def is_below(self) -> NDArray[np.bool_]:
        """Mask of the points of the view that are above or below the top, shape (n,)."""
        result: NDArray[np.bool_] = self.outside <= self.settings.top.slack
        return result


def table_top(view: View, plane: Plane, settings: DetectionSettings) -> TableTop:
    """Return the top of the table of a ``plane``: its largest connected part, and all parts that objects separate.

    Parameters
    ----------
    view
        Points with a depth, and their viewpoint.
    plane
        Plane of the table.
    settings
        Tolerances of the plane, and sizes of parts.

    Returns
    -------
    TableTop
        Points on the top; empty if no point is close to the plane.
    """
    limits = settings.top
    flat, shape = _cells(view, plane, limits)
    heights = plane.heights(view.points)
    level = np.abs(heights) < settings.plane.table_band
    shown = _shown(flat, heights, level, shape, limits)
    from scipy.ndimage import label

    parts, count = label(shown == _LEVEL, np.ones((3, 3)))
    of = np.where(level, parts.ravel()[flat], 0) if len(flat) else np.zeros(0, np.int64)
    sizes = np.bincount(of, minlength=count + 1)
    sizes[0] = 0
    if not sizes.any():
        return TableTop(plane, view.points, np.zeros(0, np.intp), settings)
    chosen = np.zeros(count + 1, dtype=np.bool_)
    chosen[sizes.argmax()] = True
    wide = np.bincount(parts.ravel(), minlength=count + 1) >= limits.min_part_cells
    left = [int(part) for part in np.argsort(-sizes) if part and wide[part] and not chosen[part]]
    while more := [part for part in left if _goes_on(shown, chosen[parts], parts == part, limits)]:
        upright = _upright(view.points, of, more, heights, plane, settings)
        chosen[[part for part in more if part not in upright]] = True
        left = [part for part in left if part not in more]
    return TableTop(plane, view.points, np.flatnonzero(chosen[of]), settings)


def _cells(view: View, plane: Plane, settings: TableTopSettings) -> tuple[NDArray[np.int64], tuple[int, int]]:
    """Return the cell of each point, shape (n,), numbered row by row, and the numbers of rows and columns of cells.

    Cells are blocks of pixels for an image, blocks of directions from a known sensor, or else squares seen from above.
    """
    if not len(view.points):
        return np.zeros(0, np.int64), (0, 0)
    count = min(float(settings.max_cells), np.sqrt(len(view.points)) / settings.min_cell_side)
    if view.organised is not None:
        size = max(1, round(max(view.organised) / max(count, 1.0)))
        rows, columns = view.pixels
        shape = (-(-view.organised[0] // size), -(-view.organised[1] // size))
        return rows // size * shape[1] + columns // size, shape
    if view.pose.known:
        rays = directions(view.points, view.pose.eye)
        ahead = rays.mean(axis=0)
        ahead /= max(float(np.linalg.norm(ahead)), 1e-9)
        depth = np.maximum(rays @ ahead, 0.1)  # no sensor sees more than 84 degrees aside
        at = coordinates(rays, np.linalg.svd(ahead[None])[2][1:]) / depth[:, None]
        side = float(np.ptp(np.percentile(at, (1, 99), axis=0), axis=0).max()) / max(count, 1.0)
    else:
        at = coordinates(view.points, plane.across)
        side = settings.plan_cell
    low, high = np.percentile(at, (0.1, 99.9), axis=0)
    side = max(side, float((high - low).max()) / 1000, 1e-9)
    cells = np.floor((np.clip(at, low, high) - low) / side).astype(np.int64)
    shape = (int(cells[:, 0].max()) + 1, int(cells[:, 1].max()) + 1)
    return cells[:, 0] * shape[1] + cells[:, 1], shape


def _shown(
    flat: NDArray[np.int64],
    heights: NDArray[np.float64],
    level: NDArray[np.bool_],
    shape: tuple[int, ...],
    settings: TableTopSettings,
) -> NDArray[np.int8]:
    """Return the content of each cell, of shape ``shape``, from the cells (n,) of points with ``heights`` (n,)."""
    count = int(np.prod(shape))
    total = np.bincount(flat, minlength=count)
    on = np.bincount(flat[level], minlength=count)
    below = np.bincount(flat[~level & (heights < 0)], minlength=count)
    shown = np.where(total > 0, _ABOVE, _EMPTY).astype(np.int8)
    shown[below > total / 2] = _BELOW
    shown[(on > 0) & (on >= settings.min_level_share * total)] = _LEVEL
    return shown.reshape(shape)


def _upright(
    points: NDArray[np.float64],
    of: NDArray[np.intp],
    wanted: list[int],
    heights: NDArray[np.float64],
    plane: Plane,
    settings: DetectionSettings,
) -> set[int]:
    """Return the wanted parts with something right above nearly all of them: strips of a wall and tall objects.

    ``of`` (n,) gives the part of each point, from 1; 0 for points that are not level with the plane.
    """
    limits, is_wanted = settings.top, np.zeros(int(of.max()) + 1, dtype=np.bool_)
    is_wanted[wanted] = True
    on = np.flatnonzero(is_wanted[of])
    above = np.flatnonzero((heights > settings.plane.table_band) & (heights < settings.reach))
    below, over = (
        np.floor(coordinates(points.take(some, axis=0), plane.across) / limits.plan_cell).astype(np.int64)
        for some in (on, above)
    )
    low, high = below.min(axis=0), below.max(axis=0)
    over = over[((over >= low) & (over <= high)).all(axis=1)]
    below, over = ((cells - low) @ (high[1] - low[1] + 1, 1) for cells in (below, over))
    cells, cell = np.unique(below, return_inverse=True)
    is_covered = np.isin(cells, over)
    part, cell = np.divmod(np.unique(of[on] * len(cells) + cell), len(cells))
    own, covered = np.bincount(part), np.bincount(part[is_covered[cell]], minlength=len(is_wanted))
    return {k for k in wanted if covered[k] > limits.max_covered_share * own[k]}


def _goes_on(
    shown: NDArray[np.int8], top: NDArray[np.bool_], part: NDArray[np.bool_], settings: TableTopSettings
) -> bool:
    """Return True if a part of the plane (r, c) belongs to the same table as its ``top`` (r, c).

    Straight lines lead from the cells of the part that face the top to the nearest cells of the top. Most of them must
    pass over something that hides the plane.
    """
    from scipy.spatial import cKDTree

    starts, ends = np.argwhere(part), np.argwhere(top)
    distance, nearest = cKDTree(ends).query(starts)
    steps = int(np.ceil(distance.max())) + 1
    along = np.linspace(0.0, 1.0, steps + 1)[1:-1]
    line = np.rint(starts[:, None] + (ends[nearest] - starts)[:, None] * along[None, :, None]).astype(np.int64)
    met, own = (grid[line[..., 0], line[..., 1]] for grid in (shown, part))
    between = ~own & ~top[line[..., 0], line[..., 1]]
    facing = (own & (along * distance[:, None] > 1.5)).sum(axis=1) == 0
    count = np.maximum(between.sum(axis=1), 1)
    below, empty = ((between & (met == kind)).sum(axis=1) for kind in (_BELOW, _EMPTY))
    gap = empty * distance / steps  # cells
    hidden = (below <= settings.max_below_share * count) & ((empty <= settings.max_empty_share * count) | (gap <= 1.0))
    return bool(hidden[facing].mean() > 0.5) if facing.any() else False


def largest_part_length(points: NDArray[np.float64], plane: Plane, settings: TableTopSettings) -> float:
    """Return the longer side of the largest connected part of points along a plane.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    plane
        Plane along which the sides are measured.
    settings
        Side of the cells on which points are connected.

    Returns
    -------
    float
        Length in metres.
    """
    plan = coordinates(points, plane.across)
    return float(np.ptp(plan[in_largest_piece(plan, settings.plan_cell)], axis=0).max())
