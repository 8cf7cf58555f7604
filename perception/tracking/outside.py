"""Know the outline of the table, and follow what comes over it from outside: hands with their arms."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.image import FrameImage

HULL_SLACK = 0.03
"""Distance in metres beyond the outline of the table from which a point is not above it."""

MIN_OUTSIDE_PIXELS = 12
"""Number of pixels at the border of the image or beyond the table from which a surface comes from outside."""

MAX_OUTLINE_POINTS = 5000
"""Number of points of one frame by which the outline is extended."""

HAND_MARGIN = 4
"""Distance in pixels from a hand within which surfaces are taken for parts of the hand."""

GAP = 0.025
"""Difference of depths in metres at which neighbouring pixels belong to different surfaces."""

TIP = 0.03
"""Length in metres of the end of a hand whose mean is its place."""

OUTERMOST = 0.01
"""Share of the points of a hand that may lie farther out than its end, for noise."""

MAX_STEP = 0.25
"""Largest distance in metres by which the end of one hand moves between two frames."""

MAX_CHANGE = 0.06
"""Largest difference in metres of two steps of a hand; beyond it, a thing joined or left the surface of the hand."""

REACH = 0.12
"""Distance in metres from the end of a hand within which it holds the side of a thing."""


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


class Hands:
    """Surfaces that come from outside the table, and how their ends move from frame to frame."""

    def __init__(self) -> None:
        self._tips = np.zeros((0, 3))
        self._before = np.zeros((0, 3))
        self._steps = np.zeros((0, 3))

    def see(
        self, image: FrameImage, changed: NDArray[np.bool_], outline: Outline, back: NDArray[np.float64]
    ) -> NDArray[np.bool_]:
        """Find the hands in a frame.

        Parameters
        ----------
        image
            The frame.
        changed
            Mask (r, c) of the pixels that are not as in the reference.
        outline
            Outline of the table.
        back
            Transform (4, 4) from the frame of the cloud to that of the table.

        Returns
        -------
        ndarray
            Mask (r, c) of their pixels, with those of surfaces at them.
        """
        from scipy.ndimage import binary_dilation

        from deixis.perception.tracking.kernels import connected

        of, count = connected(changed & (image.depth > 0), image.depth, np.float32(GAP))
        pixels = np.flatnonzero(of)
        points, owner = image.places(pixels, back), of.ravel()[pixels]
        row, column = np.divmod(pixels, of.shape[1])
        border = (row < 2) | (column < 2) | (row >= of.shape[0] - 2) | (column >= of.shape[1] - 2)
        root = border | outline.beyond(points[:, :2])
        from_outside = np.bincount(owner, root, minlength=count + 1) >= MIN_OUTSIDE_PIXELS
        from_outside[0] = False
        self._move_to([_tip(points[owner == k], root[owner == k]) for k in np.flatnonzero(from_outside)])
        if not from_outside.any():
            return np.zeros(of.shape, np.bool_)
        around = binary_dilation(from_outside[of], np.ones((3, 3)), iterations=HAND_MARGIN)
        near = np.bincount(of[around], minlength=count + 1) > 0
        near[0] = False
        found: NDArray[np.bool_] = near[of]
        return found

    def carried(self, place: NDArray[np.float64], size: float) -> NDArray[np.float64] | None:
        """Return how the hand that may hold a thing has moved since the frame before.

        Parameters
        ----------
        place
            Middle of the thing in the frame before, shape (3,), in metres.
        size
            Distance in metres from the middle to the farthest side of the thing.

        Returns
        -------
        ndarray or None
            Movement of shape (3,) in metres; None if no hand is within reach.
        """
        away = np.linalg.norm(self._before - place, axis=1)
        if not len(away) or np.isnan(away).all() or np.nanmin(away) > size + REACH:
            return None
        step: NDArray[np.float64] = self._steps[int(np.nanargmin(away))]
        return step

    def _move_to(self, tips: list[NDArray[np.float64]]) -> None:
        """Take the ends of the hands in a new frame; the step of one that was not seen before is NaN."""
        before, last = self._tips, self._steps
        self._tips = np.array(tips).reshape(-1, 3)
        self._steps, self._before = np.full(self._tips.shape, np.nan), np.full(self._tips.shape, np.nan)
        if not len(before):
            return
        for k, tip in enumerate(self._tips):
            nearest = int(np.linalg.norm(before - tip, axis=1).argmin())
            step = tip - before[nearest]
            if np.linalg.norm(step) < MAX_STEP:
                self._before[k] = before[nearest]
                self._steps[k] = last[nearest] if np.linalg.norm(step - last[nearest]) > MAX_CHANGE else step


def _tip(points: NDArray[np.float64], root: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the end (3,) of a hand, which is the mean of those of its points that are farthest from its root."""
    start = points[root].mean(axis=0)
    axis = points.mean(axis=0) - start
    along = (points - start) @ axis / max(float(np.linalg.norm(axis)), 1e-9)
    tip: NDArray[np.float64] = points[along >= np.quantile(along, 1 - OUTERMOST) - TIP].mean(axis=0)
    return tip
