"""What a cloud shows: a table, several, one object, or a room. The frame and the descriptor of views depend on it."""

from __future__ import annotations

from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import DetectionSettings


class Shows(StrEnum):
    """What a cloud shows."""

    TABLE = "table"
    """One table, with things on it or bare."""
    TABLES = "tables"
    """Several tables, of which one was looked at."""
    OBJECT = "object"
    """One object without a table. Which way up it is was not seen, unless it was told."""
    ROOM = "room"
    """A room: no table, or a floor with things on it."""
    NOTHING = "nothing"
    """Neither a table, nor one object, nor a room."""


def is_small(points: NDArray[np.float64], settings: DetectionSettings) -> bool:
    """Return whether all points (n, 3), but for a few, are within the size of tableware."""
    limits = settings.scale
    _, middle, longest = _extents(points, settings)
    return bool(settings.least_length <= longest < limits.max_small_length and middle < limits.min_table_length)


def is_one_object(points: NDArray[np.float64], settings: DetectionSettings, levels: int = 0) -> bool:
    """Return whether points (n, 3) on which no table with things was found are one connected object, and not a sheet.

    A sheet as wide as a table is a bare table; two ``levels`` and more are tables where there is room for as many.
    """
    limits = settings.scale
    thin, middle, longest = _extents(points, settings)
    if not settings.least_length <= longest < limits.max_object_length:
        return False
    if levels > 1 and longest >= levels * limits.min_table_length:
        return False
    if middle >= limits.min_table_length and thin < limits.max_sheet_thickness:
        return False
    return share_connected(points, max(limits.object_gap, longest / 30)) > limits.min_connected_share


def is_large(points: NDArray[np.float64], settings: DetectionSettings) -> bool:
    """Return whether points (n, 3) reach as far as a room does."""
    return _extents(points, settings)[1] > settings.scale.min_room_width


def _extents(points: NDArray[np.float64], settings: DetectionSettings) -> list[float]:
    """Return how far all points but a few reach along their principal axes, the least first."""
    points = points[:: max(1, len(points) // 20_000)]
    axes = np.linalg.svd(np.cov(points.T))[0]
    outliers = (settings.scale.outlier_percent, 100 - settings.scale.outlier_percent)
    low, high = np.percentile(points @ axes, outliers, axis=0)
    extents: list[float] = np.sort(high - low).tolist()
    return extents


def share_connected(points: NDArray[np.float64], gap: float) -> float:
    """Return the share of points (n, 3) that are in the largest connected piece over a grid of cells of ``gap``
    metres."""
    from scipy.ndimage import label

    points = points[:: max(1, len(points) // 20_000)]
    low, high = np.percentile(points, (0.5, 99.5), axis=0)
    inside = ((points >= low) & (points <= high)).all(axis=1)
    if not inside.any():
        return 0.0
    cells = np.floor((points[inside] - low) / gap).astype(np.int64)
    grid = np.zeros(cells.max(axis=0) + 1, dtype=np.bool_)
    grid[tuple(cells.T)] = True
    pieces, _ = label(grid, np.ones((3, 3, 3)))
    return float(np.bincount(pieces[tuple(cells.T)]).max() / len(cells))
