"""The tables of a cloud: the one with most on it, and others, found as if those before were not there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import above_outline, in_largest_piece
from deixis.perception.detection.plane import Outlook, Plane, level_of, table_plane, tolerance_at
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.viewpoint import likely


@dataclass(frozen=True, eq=False)
class FoundTable:
    """Its plane, from where it is seen, and the numbers (k,) of the points that are of no table before it."""

    plane: Plane
    outlook: Outlook
    points: NDArray[np.intp]


def tables(points: NDArray[np.float64], outlook: Outlook, settings: DetectionSettings) -> Iterator[FoundTable]:
    """Yield the tables under points (n, 3), all finite; none where nothing large is level."""
    view = outlook
    base = table_plane(points, view, settings)
    if base is None and view.up is not None and view.right is not None:
        view = replace(view, up=-view.up, right=-view.right)
        base = table_plane(points, view, settings)
    plane, outlook = base, view if base is None else likely(view, points, base, settings)
    left = np.arange(len(points))
    while plane is not None:
        yield FoundTable(plane, outlook, left)
        places = points[left]
        plan = places @ plane.across.T
        on = np.abs(plane.heights(places)) < settings.plane.table_band
        left = left[~above_outline(plan[on], plan, settings.outlines)]
        enough = len(left) >= settings.plane.min_inlier_share * len(points)
        plane = _another(points[left], plane, outlook, settings) if enough else None


def _another(points: NDArray[np.float64], plane: Plane, outlook: Outlook, settings: DetectionSettings) -> Plane | None:
    """Return one more table among points (n, 3), those beside the table of a ``plane``; None where there is none.

    It is as level and about as high, neither being a floor to the other, and something stands on it.
    """
    limits = settings.plane
    few = points[:: max(1, len(points) // limits.next_table_sample_size)]
    other = table_plane(points, replace(outlook, upwards=plane.normal), settings)
    if other is None or not other.is_along(plane, limits):
        return None
    near = tolerance_at(few, outlook, limits)
    level = level_of(other, few, near, few[np.abs(other.heights(few)) > near], limits)
    if len(level.points) < limits.min_inlier_share * len(few) or not level.bears(len(few), limits):
        return None
    plan = level.points @ other.across.T
    long = np.ptp(plan[in_largest_piece(plan, settings.outlines.table_cell)], axis=0).max()
    drop = abs(np.median(plane.heights(level.points)))
    return other if long >= settings.scale.min_table_length and drop < limits.floor_drop else None
