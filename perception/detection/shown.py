"""Classify a cloud as a table, several tables, one object or a room; frame and descriptor of views depend on it."""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import SECTORS, connected
from deixis.perception.detection.quantiles import percentiles
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.table.tables import FoundTable
from deixis.reasoning.geometry.coordinates import coordinates


class Shows(StrEnum):
    """Kind of a cloud."""

    TABLE = "table"
    """One table, empty or with objects on it."""
    TABLES = "tables"
    """Several tables, one of which was used."""
    OBJECT = "object"
    """One object without a table; its upright direction is known only if it was given."""
    ROOM = "room"
    """Room: no table, or a floor with objects on it."""
    NOTHING = "nothing"
    """None of the other kinds."""


def is_small(points: NDArray[np.float64], settings: DetectionSettings) -> bool:
    """Return True if the points (n, 3), except a few, have the extents of tableware.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    settings
        Least length of an object, and the largest extents of tableware.

    Returns
    -------
    bool
        False also for points that are too small to be in metres.
    """
    limits = settings.scale
    _, middle, longest = _extents(points, settings)
    return bool(settings.least_length <= longest < limits.max_small_length and middle < limits.min_table_length)


def is_one_object(
    points: NDArray[np.float64], settings: DetectionSettings, levels: int = 0, is_bare_table: bool = False
) -> bool:
    """Return True if points without a table with objects are one connected object, and not a table.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    settings
        Extents of objects and tables.
    levels
        Number of level planes. Two or more are tables if there is room for them.
    is_bare_table
        True if most points are on one plane whose outline nothing surrounds. It is a table if it is as wide as one.

    Returns
    -------
    bool
        True for a single object, such as a scan of a cup, or a tray.
    """
    limits = settings.scale
    _, middle, longest = _extents(points, settings)
    if not settings.least_length <= longest < limits.max_object_length:
        return False
    if levels > 1 and longest >= levels * limits.min_table_length:
        return False
    if is_bare_table and middle >= limits.min_table_length:
        return False
    return share_connected(points, max(limits.object_gap, longest / 30)) > limits.min_connected_share


def is_bare_table(table: FoundTable, settings: DetectionSettings) -> bool:
    """Return True if most points of a view are on the top of a table, which is not an object such as a tray.

    A surface that is wholly in view and short is a tray or a board, and a rim around a surface is that of a tray.

    Parameters
    ----------
    table
        Table that was found, with its view.
    settings
        Least share of the points, and least length of a table whose whole outline is in view.

    Returns
    -------
    bool
        False for a face of an object, which holds only some of the points.
    """
    limits, top, view = settings.scale, table.top, table.view
    if len(top.on) < limits.min_sheet_share * len(view.points):
        return False
    plan = coordinates(view.points, table.plane.across)
    few = top.on[:: max(1, len(top.on) // 2000)]
    is_short = _extents(view.points[top.on], settings)[2] < limits.min_whole_table_length
    if is_short and not _is_cut_by_the_image(table):
        return False
    heights = table.plane.heights(view.points)
    at_edge = np.abs(top.outside) < limits.min_inset
    rising = at_edge & (heights > settings.plane.min_standing_height) & (heights < settings.plane.max_standing_height)
    x, y = (plan[rising] - plan[few].mean(axis=0)).T
    sectors = np.floor(np.arctan2(y, x) / (2 * np.pi) * SECTORS).astype(np.int64) % SECTORS
    return len(np.unique(sectors)) < limits.min_rim_share * SECTORS


def _is_cut_by_the_image(table: FoundTable) -> bool:
    """Return True if the top of a table reaches the border of an image, so that more of it may be out of view."""
    if table.view.organised is None:
        return False
    pixels = zip(table.view.pixels, table.view.organised, strict=True)
    return any(bool(((line[table.top.on] < 2) | (line[table.top.on] > size - 3)).any()) for line, size in pixels)


def is_large(points: NDArray[np.float64], settings: DetectionSettings) -> bool:
    """Return True if points (n, 3) extend as far as a room.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    settings
        Least width of a room.

    Returns
    -------
    bool
        Judged by the second longest extent.
    """
    return _extents(points, settings)[1] > settings.scale.min_room_width


def _extents(points: NDArray[np.float64], settings: DetectionSettings) -> list[float]:
    """Return the extents of all points except outliers along their principal axes, in metres, ascending."""
    points = points[:: max(1, len(points) // 20_000)]
    axes = np.linalg.svd(np.cov(points.T))[0]
    outliers = (settings.scale.outlier_percent, 100 - settings.scale.outlier_percent)
    low, high = percentiles(points @ axes, outliers)
    extents: list[float] = np.sort(high - low).tolist()
    return extents


def share_connected(points: NDArray[np.float64], gap: float) -> float:
    """Return the fraction of points in the largest connected piece.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres; at most about 20 000 of them are examined.
    gap
        Side in metres of the cells of the grid on which points are connected.

    Returns
    -------
    float
        Fraction in [0, 1], without the outermost points.
    """
    points = points[:: max(1, len(points) // 20_000)]
    low, high = np.percentile(points, (0.5, 99.5), axis=0)
    inside = ((points >= low) & (points <= high)).all(axis=1)
    if not inside.any():
        return 0.0
    return float(np.bincount(connected(points[inside], gap)).max() / inside.sum())
