"""Boxes around the points of things: along the axes of the table, and turned about the vertical."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.circles import Circle
from deixis.perception.detection.outline import corners_of
from deixis.perception.scene import OrientedBox, turned_axes

TRIM = 0.002
"""The share of the points at either end of an axis that are taken for noise."""


def upright_box(points: NDArray[np.float64], rim: Circle | None = None) -> NDArray[np.float64]:
    """Least and greatest corner (2, 3) of points (n, 3) in the table's frame; it stands on the table or above it.

    ``rim`` is a circle in the plan that it takes in, too.

    >>> upright_box(np.array([[0.0, 0, -0.001], [1, 2, 3]])).tolist()
    [[0.0, 0.0, 0.0], [1.0, 2.0, 3.0]]
    """
    box = trimmed(points)
    if rim is not None:
        box[0, :2] = np.minimum(box[0, :2], rim.centre - rim.radius)
        box[1, :2] = np.maximum(box[1, :2], rim.centre + rim.radius)
    box[:, 2] = np.maximum(box[:, 2], 0.0)
    return box


def trimmed(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Least and greatest values (2, d) of values (n, d), but for the few at either end that are noise."""
    skip = int(TRIM * len(values))
    ordered = np.sort(values, axis=0)
    return np.stack([ordered[skip], ordered[len(values) - 1 - skip]])


def oriented_box(points: NDArray[np.float64], rim: Circle | None = None) -> OrientedBox:
    """The upright box with the smallest plan, among those with a side along a side of the points' outline.

    Its first side is the longer one, with a yaw above -pi/2, to pi/2. ``rim`` is a circle in the plan that it takes in,
    too. That the smallest rectangle has such a side is the theorem of Freeman and Shapira (1975).
    """
    box = _box_along(_best_angle(points[:, :2]), points, rim)
    if box.extents[1] > box.extents[0]:
        box = _box_along(box.yaw + np.pi / 2, points, rim)
    return box


def _box_along(yaw: float, points: NDArray[np.float64], rim: Circle | None) -> OrientedBox:
    """The box with a side in that direction."""
    yaw = float(np.pi / 2 - (np.pi / 2 - yaw) % np.pi)
    axes = turned_axes(yaw)
    low, high = upright_box(points @ axes.T, rim and rim.turned(axes[:2, :2]))
    (x, y, z), (length, width, height) = (axes.T @ ((low + high) / 2)).tolist(), (high - low).tolist()
    return OrientedBox((x, y, z), yaw, (length, width, height))


def _best_angle(plan: NDArray[np.float64]) -> float:
    corners = corners_of(plan)
    if corners is None:
        along = np.ptp(plan, axis=0)
        return float(np.arctan2(along[1], along[0])) if along.any() else 0.0
    sides = np.roll(corners, -1, axis=0) - corners
    angles = np.unique(np.arctan2(sides[:, 1], sides[:, 0]) % (np.pi / 2))
    turned = corners @ np.stack([np.cos(angles), np.sin(angles)])
    across = corners @ np.stack([-np.sin(angles), np.cos(angles)])
    return float(angles[np.argmin(np.ptp(turned, axis=0) * np.ptp(across, axis=0))])
