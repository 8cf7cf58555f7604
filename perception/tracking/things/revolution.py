"""Find the hidden back of an upright round thing, such as a bottle, from the arcs of its front."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import Circle

SLICE = 0.01
"""Height in metres of the slices in each of which the points lie on one circle."""

MIN_SLICES, MIN_SLICE_POINTS = 5, 15
"""Minimum numbers of slices, and of points of a slice that counts."""

MAX_OFF = 0.006
"""Distance in metres from its circle beyond which a point shows something else, such as a handle."""

MIN_ROUND_SHARE = 0.85
"""Minimum share of the points that lie on the circles."""

MAX_MISFIT = 0.0025
"""Largest root mean square distance in metres of these points from the circles; faces of a box are farther off."""

MAX_RADIUS = 0.15
"""Largest radius in metres of an upright round thing."""

SECTORS, MIN_SECTORS = 36, 11
"""Number of sectors of a circle, and the minimum number of them in which points must be."""


def circle_around(points: NDArray[np.float64]) -> Circle | None:
    """Return the circle in plan that an upright round thing fills.

    The circles of all slices have one centre, by linear least squares (Kasa 1976) without the points that are off.
    Noise makes the circles of narrow arcs too small, never too large.

    Parameters
    ----------
    points
        Points of the thing, shape (n, 3), in the frame of the table, in metres.

    Returns
    -------
    Circle or None
        Circle of the widest slice; None if the thing is not round, or too flat to tell.
    """
    of = np.floor(points[:, 2] / SLICE).astype(np.int64)
    of -= of.min(initial=0)
    count = np.bincount(of)
    kept = (count >= MIN_SLICE_POINTS)[of]
    if (count >= MIN_SLICE_POINTS).sum() < MIN_SLICES:
        return None
    plan = points[:, :2]
    total, off = int(kept.sum()), np.zeros(len(plan))
    centre, radius = np.zeros(2), np.zeros(len(count))
    for _ in range(4):
        number = np.maximum(np.bincount(of[kept], minlength=len(count)), 1)
        terms = np.column_stack([2 * plan, (plan**2).sum(axis=1)])[kept]
        means = np.column_stack([np.bincount(of[kept], term, minlength=len(count)) / number for term in terms.T])
        terms = terms - means[of[kept]]
        centre = np.linalg.lstsq(terms[:, :2], terms[:, 2], rcond=None)[0]
        away = np.linalg.norm(plan - centre, axis=1)
        radius = np.bincount(of[kept], away[kept], minlength=len(count)) / number
        off = away - radius[of]
        kept = (count >= MIN_SLICE_POINTS)[of] & (np.abs(off) < MAX_OFF)
        if kept.sum() < MIN_ROUND_SHARE * total:
            return None
    misfit = float(np.sqrt(np.mean(off[kept] ** 2)))
    angle = np.arctan2(*(plan - centre)[kept].T)
    sectors = len(np.unique(np.floor(angle * SECTORS / (2 * np.pi))))
    widest = float(np.quantile(radius[count >= MIN_SLICE_POINTS], 0.9))
    if misfit > MAX_MISFIT or sectors < MIN_SECTORS or not 0 < widest < MAX_RADIUS:
        return None
    return Circle(np.asarray(centre, np.float64), widest)
