"""Find the hidden back of an upright round thing, such as a bottle, from the arcs of its front, and its handle."""

from __future__ import annotations

from dataclasses import dataclass, replace

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


SEARCH = (0.02, 0.005), (0.005, 0.001)
"""Distances in metres to all sides in which an axis is looked for, and the distances of those that are tried."""

HANDLE_BEYOND = 0.008
"""Distance in metres from the surface of revolution beyond which a point shows a handle."""

MIN_HANDLE, HANDLE_WIDTH, MIN_HANDLE_SHARE = 8, np.deg2rad(30.0), 0.6
"""Minimum number of points of a handle, the largest angle in radians of their directions from that of the middle one,
and their minimum share of all points that stand out."""


@dataclass(frozen=True, eq=False)
class Revolution:
    """Surface of revolution about a vertical axis at ``centre`` (2,): the radius (s,) of each slice from ``bottom``.

    Slices without enough points have the radius 0.
    """

    centre: NDArray[np.float64]
    bottom: int
    radius: NDArray[np.float64]

    @property
    def widest(self) -> Circle:
        """Circle of the widest slice."""
        return Circle(self.centre, float(np.quantile(self.radius[self.radius > 0], 0.9)))

    def _off(self, points: NDArray[np.float64], centre: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the distances (n,) of points (n, 3) from the surface about an axis (2,), 0 where it is not known."""
        of = (np.floor(points[:, 2] / SLICE).astype(np.int64) - self.bottom).clip(0, len(self.radius) - 1)
        away = np.linalg.norm(points[:, :2] - centre, axis=1) - self.radius[of]
        return np.where(self.radius[of] > 0, away, 0.0)

    def moved_to(self, points: NDArray[np.float64]) -> Revolution:
        """Return the surface about the axis, of those nearby, about which most points lie on it.

        Parameters
        ----------
        points
            Points of the thing, shape (n, 3), in metres.

        Returns
        -------
        Revolution
            Surface with equal radii.
        """
        centre = self.centre
        for reach, step in SEARCH:
            shifts = np.arange(-reach, reach + step / 2, step)
            centres = centre + np.stack(np.meshgrid(shifts, shifts), axis=-1).reshape(-1, 2)
            on = [int((np.abs(self._off(points, each)) < MAX_OFF).sum()) for each in centres]
            best = np.flatnonzero(np.array(on) == max(on))
            centre = centres[best].mean(axis=0)
        return replace(self, centre=centre)

    def is_handle(self, points: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Return a mask of the points that stand out from the surface.

        Parameters
        ----------
        points
            Points of the thing, shape (n, 3), in metres.

        Returns
        -------
        ndarray
            Mask of shape (n,).
        """
        return np.asarray(self._off(points, self.centre) > HANDLE_BEYOND)

    def handle(self, points: NDArray[np.float64]) -> float | None:
        """Return the direction of the points that stand out from the surface.

        Parameters
        ----------
        points
            Points of the thing, shape (n, 3), in metres.

        Returns
        -------
        float or None
            Angle about the axis in radians; None if few points stand out, or not on one side.
        """
        out = (points[:, :2] - self.centre)[self.is_handle(points)]
        if len(out) < MIN_HANDLE:
            return None
        directions = out / np.linalg.norm(out, axis=1, keepdims=True)
        beside = directions @ directions.T > np.cos(HANDLE_WIDTH)
        most = beside[beside.sum(axis=1).argmax()]
        x, y = directions[most].mean(axis=0)
        return float(np.arctan2(y, x)) if most.sum() >= max(MIN_HANDLE, MIN_HANDLE_SHARE * len(out)) else None


def circle_around(points: NDArray[np.float64]) -> Circle | None:
    """Return the circle in plan that an upright round thing fills.

    Parameters
    ----------
    points
        Points of the thing, shape (n, 3), in the frame of the table, in metres.

    Returns
    -------
    Circle or None
        Circle of the widest slice; None if the thing is not round, or too flat to tell.
    """
    found = revolution_around(points)
    return None if found is None else found.widest


def revolution_around(points: NDArray[np.float64]) -> Revolution | None:
    """Return the surface of revolution of an upright round thing.

    The circles of all slices have one centre, by linear least squares (Kasa 1976) without the points that are off.
    Noise makes the circles of narrow arcs too small, never too large.

    Parameters
    ----------
    points
        Points of the thing, shape (n, 3), in the frame of the table, in metres.

    Returns
    -------
    Revolution or None
        Axis, and the radii of the slices; None if the thing is not round, or too flat to tell.
    """
    of = np.floor(points[:, 2] / SLICE).astype(np.int64)
    bottom = int(of.min(initial=0))
    of -= bottom
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
    found = Revolution(np.asarray(centre, np.float64), bottom, np.where(count >= MIN_SLICE_POINTS, radius, 0.0))
    if misfit > MAX_MISFIT or sectors < MIN_SECTORS or not 0 < found.widest.radius < MAX_RADIUS:
        return None
    return found
