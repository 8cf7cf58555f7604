"""The tables of a cloud: the one with most on it, and others, found as if those before were not there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import above_outline, in_largest_piece
from deixis.perception.detection.plane import (
    LEAST_SHARE,
    TABLE_HEIGHT,
    Outlook,
    Plane,
    level_of,
    table_plane,
    tolerance_at,
)
from deixis.perception.detection.viewpoint import likely

ON_TABLE = 0.01
"""Metres from the plane within which a point is the table's, as far as its outline goes."""

LEAST_TABLE = 0.3
"""Metres: what is shorter in both directions is hardly a table."""

ENOUGH = 30_000
"""Points by which another table is judged."""


@dataclass(frozen=True, eq=False)
class Table:
    """Its plane, from where it is seen, and the numbers (k,) of the points that are of no table before it."""

    plane: Plane
    outlook: Outlook
    points: NDArray[np.intp]


def tables(points: NDArray[np.float64], outlook: Outlook, seed: int) -> Iterator[Table]:
    """The tables under points (n, 3), all finite; none where nothing large is level."""
    plane, outlook = _first(points, outlook, seed)
    left = np.arange(len(points))
    while plane is not None:
        yield Table(plane, outlook, left)
        left = left[_beside(plane, points[left])]
        plane = _another(points[left], plane, outlook, seed) if len(left) >= LEAST_SHARE * len(points) else None


def _first(points: NDArray[np.float64], outlook: Outlook, seed: int) -> tuple[Plane | None, Outlook]:
    """The table's plane, for a camera that is held upright, else upside down; and from where it was seen."""
    plane = table_plane(points, outlook, seed)
    if plane is None and outlook.up is not None and outlook.right is not None:
        outlook = replace(outlook, up=-outlook.up, right=-outlook.right)
        plane = table_plane(points, outlook, seed)
    return plane, outlook if plane is None else likely(outlook, points, plane, seed)


def _beside(plane: Plane, points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which points (n, 3) are neither the table's nor above or below it, shape (n,)."""
    plan = points @ plane.across.T
    return ~above_outline(plan[np.abs(plane.heights(points)) < ON_TABLE], plan)


def _another(points: NDArray[np.float64], plane: Plane, outlook: Outlook, seed: int) -> Plane | None:
    """One more table among points (n, 3), those beside the table of a ``plane``; None where there is none.

    It is as level and about as high, neither being a floor to the other, and something stands on it.
    """
    few = points[:: max(1, len(points) // ENOUGH)]
    other = table_plane(points, replace(outlook, upwards=plane.normal), seed)
    if other is None or not other.is_along(plane):
        return None
    near = tolerance_at(few, outlook)
    level = level_of(other, few, near, few[np.abs(other.heights(few)) > near])
    if len(level.points) < LEAST_SHARE * len(few) or not level.bears(len(few)):
        return None
    plan = level.points @ other.across.T
    long = np.ptp(plan[in_largest_piece(plan)], axis=0).max()
    return other if long >= LEAST_TABLE and abs(np.median(plane.heights(level.points))) < TABLE_HEIGHT else None
