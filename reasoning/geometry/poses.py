"""Orientation of things in the plane: fronts, and long axes modulo half a turn."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MIN_STRETCH = 0.2
"""Minimum stretch, (length - width) / (length + width), of a thing with a clear long axis: an aspect ratio of 1.5."""

TOOL_STRETCH = 0.43
"""Minimum stretch of a thing whose handle is at the end opposite its front: an aspect ratio of 2.5."""

SIDEWAYS = (math.pi / 4, 3 * math.pi / 4)
"""Angles in radians from the head of a thing between which it may face something with a side, as a knife with its edge.
"""


@dataclass(frozen=True, eq=False)
class Poses:
    """Orientation of n things as seen from above.

    Parameters
    ----------
    fronts
        Unit vectors from each thing to its front, shape (n, 2); NaN if it has none or it is unknown.
    axes
        Unit vectors along the long sides, shape (n, 2); a vector and its opposite mean the same axis.
    stretch
        (a - b) / (a + b) of the long side a and the short side b, shape (n,); 0 for squares and disks, without an axis.
    middle
        Middle of the scene, shape (2,).
    heads
        Unit vectors from the handles of long things to their heads, shape (n, 2); NaN where unknown. None for none.
    """

    fronts: Array
    axes: Array
    stretch: Array
    middle: Array
    heads: Array | None = None

    @classmethod
    def of_boxes(cls, boxes: Array, fronts: Array | None = None) -> Poses:
        """Return the poses of axis-aligned boxes, shape (n, 2, d), with unknown fronts by default.

        Parameters
        ----------
        boxes
            Lower and upper corners of shape (n, 2, d), in metres, with d at least 2.
        fronts
            Unit vectors of shape (n, 2) in the directions of the fronts; nan where a front is unknown, as all are by
            default.

        Returns
        -------
        Poses
            Poses whose long axes are the longer sides of the boxes seen from above; the x axis for a square.

        Examples
        --------
        >>> Poses.of_boxes(np.array([[[0.0, 0.0], [3.0, 1.0]]])).stretch.tolist()
        [0.5]
        """
        extents = boxes[:, 1, :2] - boxes[:, 0, :2]
        total = extents.sum(axis=1)
        difference = extents[:, 0] - extents[:, 1]
        stretch = np.divide(np.abs(difference), total, out=np.zeros(len(boxes)), where=total > 0)
        axes = np.where((difference >= 0)[:, None], [1.0, 0.0], [0.0, 1.0])
        return cls(np.full((len(boxes), 2), np.nan) if fronts is None else fronts, axes, stretch, _middle(boxes))

    def with_oriented(self, places: list[int], yaws: list[float], extents: list[tuple[float, float]]) -> Poses:
        """Return the poses in which some things have turned boxes: the angle and the length of their first side.

        Parameters
        ----------
        places
            Indices of the things with turned boxes.
        yaws
            Angle of the first side of each of these boxes from the x axis, in radians.
        extents
            Lengths of the first and the second side of each of these boxes, in metres.

        Returns
        -------
        Poses
            Poses in which the axes and the stretches of these things are replaced.
        """
        axes, stretch = self.axes.copy(), self.stretch.copy()
        for place, yaw, (first, second) in zip(places, yaws, extents, strict=True):
            angle = yaw if first >= second else yaw + math.pi / 2
            axes[place] = math.cos(angle), math.sin(angle)
            stretch[place] = abs(first - second) / (first + second) if first + second > 0 else 0.0
        return replace(self, axes=axes, stretch=stretch)

    def __getitem__(self, some: Any) -> Poses:
        """Return the poses of some things, by a slice or an array of positions."""
        heads = None if self.heads is None else self.heads[some]
        return replace(self, fronts=self.fronts[some], axes=self.axes[some], stretch=self.stretch[some], heads=heads)

    def turned(self, angle: float, mirrored: bool = False) -> Poses:
        """Return the poses in a scene mirrored left to right, then turned counter-clockwise about the origin.

        Parameters
        ----------
        angle
            Angle in radians.
        mirrored
            If True, mirror the scene left to right before it is turned.

        Returns
        -------
        Poses
            Poses with turned fronts, axes and middles; ``stretch`` is unchanged.
        """
        turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        flip = np.diag([-1.0, 1.0]) if mirrored else np.eye(2)
        heads = None if self.heads is None else self.heads @ flip @ turn
        fronts, axes, middle = (each @ flip @ turn for each in (self.fronts, self.axes, self.middle))
        return replace(self, fronts=fronts, axes=axes, middle=middle, heads=heads)

    @property
    def pointing(self) -> Array:
        """Unit vectors from the things to their fronts, or else to their heads, shape (n, 2); NaN where unknown."""
        if self.heads is None:
            return self.fronts
        return np.where(self.fronted[:, None], self.fronts, self.heads)

    def aim_angles(self, wanted: Array, facing: bool = False, handle: bool = False) -> Array:
        """Return the angles between the directions in which things point and wanted directions.

        Parameters
        ----------
        wanted
            Unit vectors: one direction of shape (2,), or those from each thing to m others, shape (n, m, 2).
        facing
            Whether the things should face in that direction. A thing of which only the head is known may face the
            direction with a side.
        handle
            Whether their handles should point there. That of a long thing is opposite its head.

        Returns
        -------
        ndarray
            Angles in radians, in [0, pi], shape (n,) or (n, m); NaN where they are unknown.

        Examples
        --------
        >>> knife = np.array([[[0.0, 0.0], [0.02, 0.2]]])
        >>> poses = replace(Poses.of_boxes(knife), heads=np.array([[0.0, 1.0]]))
        >>> right, away = np.array([1.0, 0.0]), np.array([0.0, 1.0])
        >>> np.degrees(poses.aim_angles(right)).round(), poses.aim_angles(right, facing=True)
        (array([90.]), array([nan]))
        >>> np.degrees(poses.aim_angles(away, handle=True)).round()
        array([180.])
        """
        ways = self.pointing
        by_head = np.logical_not(self.fronted | np.isnan(ways).any(axis=1))
        if handle:
            ways = np.where((by_head | (self.stretch >= TOOL_STRETCH))[:, None], -ways, ways)
        product = "nd,d->n" if wanted.ndim == 1 else "nd,nmd->nm"
        angles: Array = np.arccos(np.clip(np.einsum(product, ways, wanted), -1.0, 1.0))
        if facing and not handle:
            by_head = by_head if wanted.ndim == 1 else by_head[:, None]
            angles[by_head & (angles > SIDEWAYS[0]) & (angles < SIDEWAYS[1])] = np.nan
        return angles

    @property
    def fronted(self) -> NDArray[np.bool_]:
        """True for things with a known front, shape (n,)."""
        known: NDArray[np.bool_] = np.logical_not(np.isnan(self.fronts).any(axis=1))
        return known


def _middle(boxes: Array) -> Array:
    if not len(boxes):
        return np.zeros(2)
    middle: Array = (boxes[:, 0, :2].min(axis=0) + boxes[:, 1, :2].max(axis=0)) / 2
    return middle


def bearings(boxes: Array, others: Array) -> Array:
    """Return the directions from some things to others.

    Parameters
    ----------
    boxes
        Boxes of n things, shape (n, 2, d).
    others
        Boxes of m things, shape (m, 2, d).

    Returns
    -------
    ndarray
        Unit vectors in the plane, shape (n, m, 2); NaN for things at one place.

    Examples
    --------
    >>> plate, cup = np.array([[0.0, 0.0], [0.2, 0.2]]), np.array([[0.0, 0.4], [0.2, 0.6]])
    >>> bearings(np.array([plate]), np.array([cup, plate])).tolist()
    [[[0.0, 1.0], [nan, nan]]]
    """
    first, second = boxes[:, :, :2].mean(axis=1), others[:, :, :2].mean(axis=1)
    apart = second[None] - first[:, None]
    length = np.linalg.norm(apart, axis=2, keepdims=True)
    return np.asarray(np.divide(apart, length, out=np.full_like(apart, np.nan), where=length > 0))


def coaxial(first: Poses, second: Poses) -> Array:
    """Return how far long axes agree, in [-1, 1], shape (n, m): 1 for thin parallel things, -1 for crossing ones.

    Parameters
    ----------
    first
        Poses of n things.
    second
        Poses of m things.

    Returns
    -------
    ndarray
        Shape (n, m). Values are close to 0 for things that are nearly as wide as long.
    """
    cosine = np.clip(first.axes @ second.axes.T, -1.0, 1.0)
    result: Array = (2 * cosine**2 - 1) * np.sqrt(first.stretch[:, None] * second.stretch[None, :])
    return result
