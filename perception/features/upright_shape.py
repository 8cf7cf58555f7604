"""What a thing looks like as a whole to a robot that knows where up is: how its points lie over height and radius, and
how high, long and wide it is.

A thing on a table may be turned about the vertical and no other way, so that heights tell more than distances do.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.perception.features.keypoints import voxel_keypoints

SPACING = 0.004
"""Metres between the points that count: neither distance from the camera nor noise makes a part weigh more."""

LOWEST, HIGHEST = 1.0, 99.5
"""Percentiles of height between which a thing lies; what lies beyond is mostly noise."""

FLAT = 0.005
"""Metres that a thing is high at least, which is what a depth camera's noise makes of a sheet."""

GRAIN = 0.01
"""Metres added to extents before their logarithm: what a thin thing measures is mostly noise."""

TURNS = 18
"""Directions in plan that are looked at: every five degrees of a right angle."""

CELLS = 6
"""Of the histogram, both ways."""


class UprightShape(NamedTuple):
    """``profile`` (36,): roots of the shares of points by height above the table (rows, over that of the top) and
    horizontal distance from the middle (over the largest). ``extents`` (3,): logarithms of the top's height, of length
    and of width.
    """

    profile: NDArray[np.float64]
    extents: NDArray[np.float64]


def upright_shape(points: NDArray[np.floating]) -> UprightShape | None:
    """Of finite points (n, 3) in metres in the table's frame, z up and 0 on the table; None of none.

    What stands on another thing is as high as its top is above the table. Where a thing reaches below 0, so that the
    frame is not the table's, height is over its own foot. Length and width are the sides of the smallest rectangle in
    plan, its middle is the thing's.

    >>> rod = np.linspace([0, 0, 0], [0, 0.3, 0], 100)
    >>> (np.exp(upright_shape(rod).extents) - GRAIN).round(3).tolist()
    [0.005, 0.3, 0.0]
    """
    if not len(points):
        return None
    thinned = points[voxel_keypoints(points, SPACING)].astype(np.float64)
    lowest, top = np.percentile(thinned[:, 2], (LOWEST, HIGHEST))
    foot = min(float(lowest), 0.0)
    height = max(float(top - foot), FLAT)
    aside, sides = _smallest_rectangle(thinned[:, :2])
    radii = np.hypot(*aside.T)
    over, outward = np.clip((thinned[:, 2] - foot) / height, 0.0, 1.0), radii / max(float(radii.max()), FLAT)
    counts, _, _ = np.histogram2d(over, outward, bins=CELLS, range=((0.0, 1.0), (0.0, 1.0)))
    return UprightShape(np.sqrt(counts.ravel() / len(thinned)), np.log(np.array([height, *sides]) + GRAIN))


def _smallest_rectangle(plan: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points (n, 2) from the middle of the smallest rectangle around them, along its sides; and these, longer first."""
    angles = np.arange(TURNS) * np.pi / 2 / TURNS
    along = plan @ np.stack([np.cos(angles), np.sin(angles)])  # (n, turns)
    across = plan @ np.stack([-np.sin(angles), np.cos(angles)])
    least = int(np.argmin(np.ptp(along, axis=0) * np.ptp(across, axis=0)))
    turned = np.stack([along[:, least], across[:, least]], axis=1)
    middle = (turned.min(axis=0) + turned.max(axis=0)) / 2
    return turned - middle, np.sort(np.ptp(turned, axis=0))[::-1]
