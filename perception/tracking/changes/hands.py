"""Follow hands, which come over the table from outside with their arms, from frame to frame."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.frames.image import FrameImage
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.outline import MIN_OUTSIDE_PIXELS, Outline
from deixis.perception.tracking.table.reference import GAP, Changes, Reference
from deixis.perception.tracking.things.pipeline import Pipeline

HAND_MARGIN = 4
"""Distance in pixels from a hand within which surfaces are taken for parts of the hand."""

TIP = 0.03
"""Length in metres of the end of a hand whose mean is its place."""

OUTERMOST = 0.01
"""Share of the points of a hand that may lie farther out than its end, for noise."""

MAX_STEP = 0.25
"""Largest distance in metres by which the end of one hand moves between two frames."""

MAX_CHANGE = 0.06
"""Largest difference in metres of two steps of a hand; beyond it, a thing joined or left the surface of the hand."""

LOW = 0.03
"""Height in metres above the table below which a surface that comes into view may lie on it."""

MEMORY = 30.0
"""Time in seconds for which the places of hands are kept."""

MIN_MOVING_PIXELS, MIN_MOVING_HEIGHT = 80, 0.01
"""Minimum number of pixels of something that moves and is not a thing, and their minimum height in metres."""

REACH = 0.12
"""Distance in metres from the end of a hand within which it holds the side of a thing."""


class Hands:
    """Surfaces that come from outside the table, and how their ends move from frame to frame."""

    def __init__(self) -> None:
        self._tips = np.zeros((0, 3))
        self._past: deque[tuple[float, NDArray[np.float64]]] = deque()
        self._before = np.zeros((0, 3))
        self._steps = np.zeros((0, 3))

    def see(
        self,
        image: FrameImage,
        changes: Changes,
        outline: Outline,
        back: NDArray[np.float64],
        resting: Iterable[Pipeline] = (),
        at: float = 0.0,
    ) -> NDArray[np.bool_]:
        """Find the hands in a frame.

        A camera that moves brings things into view at the border of the image, where nothing is known yet. Pixels
        without a reference therefore do not show a hand there if they are low, or within the box of a thing at rest.

        Parameters
        ----------
        image, changes
            The frame, and its comparison with the reference.
        outline
            Outline of the table.
        back
            Transform (4, 4) from the frame of the cloud to that of the table.
        resting
            Things at rest.
        at
            Time of the frame in seconds.

        Returns
        -------
        ndarray
            Mask (r, c) of their pixels, with those of surfaces at them.
        """
        from scipy.ndimage import binary_dilation

        from deixis.perception.tracking.kernels import UNKNOWN, connected

        of, count = connected(~changes.same & (image.depth > 0), image.depth, np.float32(GAP))
        pixels = np.flatnonzero(of)
        points, owner = image.places(pixels, back), of.ravel()[pixels]
        row, column = np.divmod(pixels, of.shape[1])
        border = (row < 2) | (column < 2) | (row >= of.shape[0] - 2) | (column >= of.shape[1] - 2)
        beyond = outline.beyond(points[:, :2])
        new = np.flatnonzero((border | beyond) & (changes.state.ravel()[pixels] == UNKNOWN))
        border[new] &= points[new, 2] > LOW
        root = border | beyond
        for thing in resting:
            root[new] &= ~thing.contains(points[new], thing.settings.margin)
        from_outside = np.bincount(owner, root, minlength=count + 1) >= MIN_OUTSIDE_PIXELS
        from_outside[0] = False
        self._move_to([_tip(points[owner == k], root[owner == k]) for k in np.flatnonzero(from_outside)])
        while self._past and self._past[0][0] < at - MEMORY:
            self._past.popleft()
        if len(self._tips):
            self._past.append((at, self._tips))
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

    def moved_since(self, since: float, place: NDArray[np.float64], size: float) -> NDArray[np.float64] | None:
        """Return how the hand that was at a thing at a time has moved since then.

        Parameters
        ----------
        since
            Time in seconds.
        place
            Middle of the thing at this time, shape (3,), in metres.
        size
            Distance in metres from the middle to the farthest side of the thing.

        Returns
        -------
        ndarray or None
            Movement of shape (3,) in metres; None if no hand was within reach, or if it was lost from sight.
        """
        start = tip = None
        for at, tips in self._past:
            if at < since:
                continue
            away = np.linalg.norm(tips - (place if tip is None else tip), axis=1)
            if away.min() > (size + REACH if tip is None else MAX_STEP):
                return None
            tip = tips[away.argmin()]
            start = tip if start is None else start
        return None if start is None or tip is None else tip - start

    def were_near(self, place: NDArray[np.float64], size: float, since: float) -> bool:
        """Return True if a hand has been so near that it may have set a thing down.

        Parameters
        ----------
        place
            Middle of the thing, shape (3,), in metres.
        size
            Distance in metres from the middle to the farthest side of the thing.
        since
            Time in seconds from which the places of hands count.

        Returns
        -------
        bool
            False if the thing must have been there before.
        """
        tips = np.concatenate([np.zeros((0, 3)), *(tips for at, tips in self._past if at >= since)])
        return bool((np.linalg.norm(tips - place, axis=1) < size + REACH).any())

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


def something_moves(
    image: FrameImage,
    changes: Changes,
    reference: Reference,
    back: NDArray[np.float64],
    things: Iterable[Pipeline],
    at: float,
    settings: TrackingSettings,
) -> bool:
    """Return True if something moves that is not one of the things, such as a part of a hand.

    Parameters
    ----------
    image, changes
        The frame, and its comparison with the reference.
    reference
        The table at rest.
    back
        Transform (4, 4) from the frame of the cloud to that of the table.
    things
        All things.
    at
        Time of the frame in seconds.
    settings
        Options of the tracker.

    Returns
    -------
    bool
        False if all that moves is within the boxes of things, or as low as the table.
    """
    from deixis.perception.tracking.kernels import NEARER

    moves = (changes.state == NEARER) & (at - reference.since < 0.5 * settings.steady)
    place = np.flatnonzero(moves & (image.depth > 0))
    if len(place) < MIN_MOVING_PIXELS:
        return False
    points = image.places(place, back)
    strange = points[:, 2] > MIN_MOVING_HEIGHT
    for thing in things:
        strange &= ~thing.contains(points, settings.margin)
    return bool(strange.sum() >= MIN_MOVING_PIXELS)


def _tip(points: NDArray[np.float64], root: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the end (3,) of a hand, which is the mean of those of its points that are farthest from its root."""
    start = points[root].mean(axis=0)
    axis = points.mean(axis=0) - start
    along = (points - start) @ axis / max(float(np.linalg.norm(axis)), 1e-9)
    tip: NDArray[np.float64] = points[along >= np.quantile(along, 1 - OUTERMOST) - TIP].mean(axis=0)
    return tip
