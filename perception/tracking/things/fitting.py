"""Fit a thing to the pixels that show it at rest, in all directions about the vertical."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.frames.image import FrameImage, TableView
from deixis.perception.tracking.things.pipeline import Pipeline

DIRECTIONS = 8
"""Number of directions about the vertical in which a thing is tried, beside those of the longest axis of the pixels."""


@dataclass(frozen=True, eq=False)
class Fit:
    """Pose (4, 4) of a thing, and how well it agrees with pixels.

    ``agreement`` is the share of the points that agree, of those that nothing hides; ``visible`` the share of all
    points that agree; and ``explained`` the share of the pixels that lie in the thing's box.
    """

    pose: NDArray[np.float64]
    agreement: float
    visible: float
    explained: float

    @property
    def score(self) -> float:
        """Product of the shares of agreeing points and of explained pixels."""
        return self.agreement * self.explained


def fits(
    thing: Pipeline,
    image: FrameImage,
    view: TableView,
    pixels: NDArray[np.intp],
    taken: NDArray[np.bool_],
    noise: float,
) -> Iterator[Fit]:
    """Yield the best poses of a thing around each direction about the vertical in which it may stand.

    One is that of its particle filter, and one lies as it last did: the filter lets a thin thing tilt out of the few
    pixels that show it. The thing keeps its pose, and its particle filter begins there again.

    Parameters
    ----------
    thing
        The thing.
    image, view
        The frame, and its view of the table.
    pixels
        Pixels that show it, as flat indices of shape (k,).
    taken
        Mask (r, c) of the pixels that show something else.
    noise
        Standard deviation of depths at one metre.

    Yields
    ------
    Fit
        Pose in which it lies as at its last rest, except for the direction.
    """
    points = image.places(pixels, view.back)
    tints = image.colour.reshape(-1, 3)[pixels].astype(np.float64)
    turn, middle = thing.last_rest[:3, :3], (points.min(axis=0) + points.max(axis=0)) / 2
    along = _axis(points[:, :2]) - _axis((thing.cloud.points @ turn.T.astype(np.float32))[:, :2])
    for angle in (along, along + np.pi, *(np.arange(DIRECTIONS) * 2 * np.pi / DIRECTIONS)):
        cosine, sine = np.cos(angle), np.sin(angle)
        start = np.eye(4)
        start[:3, :3] = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]]) @ turn
        start[:3, 3] = middle
        thing.put(start)
        found, agreement, visible = thing.follow(image, view, taken, points, tints, 0.0, noise)
        for pose, agrees, seen in (
            (found.pose, agreement, visible),
            thing.laid(start, image, view, taken, points, noise),
        ):
            explained = float(thing.contains(points, thing.settings.margin, pose).mean())
            yield Fit(pose, agrees, seen, explained)
    thing.put(thing.pose)


def _axis(plan: NDArray[np.floating]) -> float:
    """Return the angle of the longest axis of places (n, 2) in radians."""
    along = np.linalg.eigh(np.cov(plan.T) + 1e-12 * np.eye(2))[1][:, 1]
    return float(np.arctan2(along[1], along[0]))
