"""Know the outline of the table in plan, and what crosses it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

HULL_SLACK = 0.03
"""Minimum distance in metres beyond the outline of the table at which a point is not above it."""

MIN_OUTSIDE_PIXELS = 12
"""Minimum number of pixels at the border of the image or beyond the table at which a surface comes from outside."""

MAX_OUTLINE_POINTS = 5000
"""Number of points of one frame by which the outline is extended."""


class Outline:
    """Convex outline of the table in plan, which grows as more of it comes into view."""

    def __init__(self) -> None:
        self._corners = np.zeros((0, 2))
        self._sides = np.zeros((0, 3))

    def extend(self, plan: NDArray[np.float64]) -> None:
        """Extend the outline by places on the table.

        Parameters
        ----------
        plan
            Places of shape (n, 2) in the table's frame, in metres.
        """
        from deixis.perception.detection.outline import hull_of

        plan = np.concatenate([self._corners, plan[:: max(1, len(plan) // MAX_OUTLINE_POINTS)]])
        hull = hull_of(plan) if len(plan) >= 3 else None
        if hull is None:
            self._corners, self._sides = plan, np.zeros((0, 3))
        else:
            self._corners, self._sides = plan[hull.vertices], np.asarray(hull.equations)

    def beyond(self, plan: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Find the places that are not above the table.

        Parameters
        ----------
        plan
            Places of shape (n, 2) in the table's frame, in metres.

        Returns
        -------
        ndarray
            Mask of shape (n,); all False while no outline is known.
        """
        if not len(self._sides):
            return np.zeros(len(plan), np.bool_)
        with np.errstate(invalid="ignore"):
            outside = (plan @ self._sides[:, :2].T + self._sides[:, 2]).max(axis=1)
        return np.asarray(outside > HULL_SLACK)

    def is_crossed_by(self, points: NDArray[np.float64]) -> bool:
        """Return True if a surface comes from beyond the table.

        Parameters
        ----------
        points
            Points of the surface, shape (n, 3), in the table's frame, in metres.

        Returns
        -------
        bool
            False for a thing whose edge is a little beyond.
        """
        return bool(self.beyond(points[:, :2]).sum() > max(MIN_OUTSIDE_PIXELS, 0.2 * len(points)))
