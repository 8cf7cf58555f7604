"""Compare the points of a thing in any pose with a frame.

A point agrees where the frame shows its depth and its colour. It says nothing where something is before it, and it
speaks against a pose where the frame shows what is behind it.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.oriented_box import OrientedBox, turned_axes
from deixis.perception.tracking.frames.image import FrameImage, TableView
from deixis.perception.tracking.things.likeness import COLOUR_SPREAD, SHADE_SPREAD
from deixis.perception.tracking.things.particles import turned_by

HIDDEN_SCORE, EMPTY_SCORE = 0.12, -0.35
"""Scores of a point that something may hide, and of a point where something should be seen and is not."""

TOLERANCE = 0.003
"""Difference of two depths in metres that counts less than noise."""

COVERED_MARGIN = 0.003
"""Distance in metres by which the box of a thing is extended to cover the points that show it at rest."""

ALIGN_STEP, ALIGN_END = (0.012, 0.012, np.deg2rad(6.0)), 0.001
"""First steps in metres and radians of the search for a better pose at rest, and the step at which it ends."""

LEAST_INSIDE = 0.08
"""Minimum share of the points of a thing that are within the image, for it to be seen well."""


@dataclass(frozen=True, eq=False)
class Agreement:
    """Agreement of the points of a thing in one pose with a frame.

    Parameters
    ----------
    fit
        Share of the points that agree, of those that nothing hides.
    visible
        Share of the points that agree, of those within the image.
    exposed
        Share of the points that nothing hides.
    """

    fit: float
    visible: float
    exposed: float


@dataclass(frozen=True, eq=False)
class Sight:
    """Points of a thing, and a frame that may show them.

    Parameters
    ----------
    points, colours
        Points (n, 3) in the thing's own frame, in metres, and their colours (n, 3) from 0 to 255.
    image, view
        The frame, and its view of the table.
    taken
        Mask (r, c) of the pixels that belong to something else.
    noise
        Standard deviation of depths at one metre.
    """

    points: NDArray[np.float64]
    colours: NDArray[np.float64]
    image: FrameImage
    view: TableView
    taken: NDArray[np.bool_]
    noise: float

    def scores(
        self, places: NDArray[np.float64], turns: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return how well poses agree with the frame.

        Parameters
        ----------
        places, turns
            Places (m, 3) in the table's frame, in metres, and unit quaternions (m, 4), real part first.

        Returns
        -------
        tuple
            Scores of shape (m,); and numbers (m, 3) of points that agree, that nothing hides, and that are within the
            image.
        """
        from deixis.perception.tracking.kernels import scores

        found: tuple[NDArray[np.float64], NDArray[np.float64]] = scores(
            places, turns, self.points, self.colours, self.view.matrix, self.view.offset, self.image.depth,
            self.image.colour, self.taken, TOLERANCE, 2 * self.noise, SHADE_SPREAD, COLOUR_SPREAD, HIDDEN_SCORE,
            EMPTY_SCORE,
        )  # fmt: skip
        return found

    def agreement(self, place: NDArray[np.float64], turn: NDArray[np.float64]) -> Agreement:
        """Return how well one pose agrees with the frame.

        Parameters
        ----------
        place, turn
            Place (3,) in the table's frame, in metres, and unit quaternion (4,), real part first.

        Returns
        -------
        Agreement
            Shares of the points.
        """
        _, seen = self.scores(place[None], turn[None])
        inliers, exposed, inside = (float(count) for count in seen[0])
        every = len(self.points)
        return Agreement(inliers / max(exposed, 1.0), inliers / max(inside, LEAST_INSIDE * every), exposed / every)

    def shifted(
        self, start: NDArray[np.float64], box: OrientedBox, own: NDArray[np.float64], turn: float = 0.0
    ) -> tuple[NDArray[np.float64], float]:
        """Return the best pose that is shifted along the table and turned about the vertical from another.

        Only the points that nothing hides count, and the box of the thing must cover the points that show it.

        Parameters
        ----------
        start
            Pose (4, 4) from which the search begins.
        box
            Box of the thing in its own frame.
        own
            Points (k, 3) that show the thing, in the table's frame.
        turn
            Angle in radians about the vertical axis of the box by which the pose is turned before the search.

        Returns
        -------
        tuple
            Pose (4, 4), and the gain of its score over that of ``start``.
        """
        from deixis.perception.tracking.kernels import covered

        centre, half = np.array(box.centre), np.array(box.extents) / 2 + COVERED_MARGIN

        def weigh(places: NDArray[np.float64], turns: NDArray[np.float64]) -> NDArray[np.float64]:
            found, seen = self.scores(places, turns)
            exposed = seen[:, 1] / len(self.points)
            found = (found - HIDDEN_SCORE * (1 - exposed)) / np.maximum(exposed, LEAST_INSIDE)
            found += covered(places, turns, own, centre, box.yaw, half)
            return found

        first = float(weigh(start[None, :3, 3], quaternion(start)[None])[0])
        if turn:
            start = _turned(start, centre, turn)
        moved, turned = np.zeros((1, 3)), quaternion(start)[None]
        best = float(weigh(start[None, :3, 3], turned)[0]) if turn else first
        step, directions = np.array(ALIGN_STEP), np.array(list(itertools.product((-1, 0, 1), repeat=3)))
        while step[0] >= ALIGN_END:
            tried = moved + step * directions
            places = start[:3, 3] + np.column_stack([tried[:, :2], np.zeros(len(tried))])
            scores = weigh(places, turned_by(np.outer(tried[:, 2], (0.0, 0.0, 1.0)), turned.repeat(len(tried), axis=0)))
            if scores.max() > best:
                best, moved = float(scores.max()), tried[scores.argmax()][None]
            else:
                step = step / 2
        x, y, angle = moved[0]
        cosine, sine = np.cos(angle), np.sin(angle)
        pose = start.copy()
        pose[:3, :3] = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]]) @ pose[:3, :3]
        pose[:2, 3] += x, y
        return pose, best - first


def _turned(pose: NDArray[np.float64], middle: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """Return a pose turned about the vertical through a place in the frame of the thing."""
    turned = pose.copy()
    turned[:3, :3] = turned_axes(angle).T @ pose[:3, :3]
    turned[:3, 3] = pose[:3, :3] @ middle + pose[:3, 3] - turned[:3, :3] @ middle
    return turned


def quaternion(pose: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the rotation of a transform as a unit quaternion.

    Parameters
    ----------
    pose
        Transform of shape (4, 4).

    Returns
    -------
    ndarray
        Quaternion of shape (4,), real part first.
    """
    from scipy.spatial.transform import Rotation

    turn: NDArray[np.float64] = Rotation.from_matrix(pose[:3, :3]).as_quat()[[3, 0, 1, 2]]
    return turn
