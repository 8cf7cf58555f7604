"""Find the tables of a cloud one after another, each without the points of the tables before."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.table.plane import CameraPose, Plane, level_of, table_plane, tolerance_at
from deixis.perception.detection.table.table_top import TableTop, largest_part_length, table_top
from deixis.perception.detection.table.viewpoint import View, is_sure, likeliest_pose, sampled, verified_pose


@dataclass(frozen=True, eq=False)
class FoundTable:
    """Plane and top of a table, and the view without the points of the tables before."""

    plane: Plane
    top: TableTop
    view: View


def tables(view: View, settings: DetectionSettings) -> Iterator[FoundTable]:
    """Yield the tables of a view; yield nothing if no large surface is level.

    Each table has its own viewpoint, because one cloud may combine several views.

    Parameters
    ----------
    view
        Points with a depth, and their viewpoint.
    settings
        Tolerances of planes, and sizes of tables.

    Yields
    ------
    FoundTable
        Table with its plane, its top and its view. Points below a table are not searched for further ones.
    """
    points, pose = view.points, verified_pose(view.pose, view.points, settings)
    base = table_plane(points, pose, settings)
    if base is None and pose.up is not None and pose.right is not None:
        pose = replace(pose, up=-pose.up, right=-pose.right)
        base = table_plane(points, pose, settings)
    plane, left = base, replace(view, pose=pose)
    while plane is not None:
        top = table_top(left, plane, settings)
        own = _own_pose(pose if pose.known else view.pose, top, settings)
        yield FoundTable(plane, top, replace(left, pose=own))
        beside = np.flatnonzero(~top.is_below)
        if len(beside) < settings.plane.min_inlier_share * len(points):
            return
        left = left.take(beside)
        plane = _another(left.points, plane, own, settings)


def _own_pose(pose: CameraPose, top: TableTop, settings: DetectionSettings) -> CameraPose:
    """Return the viewpoint of the points around a table."""
    if is_sure(pose, top.plane, settings):
        return pose
    near = np.flatnonzero(top.outside <= settings.top.margin)
    around = top.points[sampled(near if len(near) else np.arange(len(top.points)), settings)]
    return likeliest_pose(verified_pose(pose, around, settings), around, top.plane, settings)


def _another(points: NDArray[np.float64], plane: Plane, pose: CameraPose, settings: DetectionSettings) -> Plane | None:
    """Return another table among points (n, 3) beside the table of a ``plane``, or None.

    The other table must be parallel, of similar height (neither is the floor below the other), and not empty.
    """
    limits = settings.plane
    few = points[:: max(1, len(points) // limits.next_table_sample_size)]
    other = table_plane(points, replace(pose, upwards=plane.normal), settings)
    if other is None or not other.is_along(plane, limits):
        return None
    near = tolerance_at(few, pose, limits)
    level = level_of(other, few, near, few[np.abs(other.heights(few)) > near], limits)
    if len(level.points) < limits.min_inlier_share * len(few) or not level.has_objects(len(few), limits):
        return None
    long = largest_part_length(level.points, other, settings.top)
    drop = abs(np.median(plane.heights(level.points)))
    return other if long >= settings.scale.min_table_length and drop < limits.floor_drop else None
