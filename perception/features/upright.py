"""Views of things that stand upright: spin images at two scales, each beside the shape of the whole.

The shape of the whole is what a thing looks like to a robot that knows where up is: how its points lie over height and
radius, and how high, long and wide it is. A thing on a table may be turned about the vertical and no other way, so that
heights tell more than distances do.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.describer import finite_points
from deixis.perception.features.keypoints import voxel_keypoints
from deixis.perception.features.spin_images import image_size, keypoints_and_normals, spin_images

SPACING = 0.004
"""Metres between the points that count: neither distance from the camera nor noise makes a part weigh more."""

FOOT_PERCENTILE, TOP_PERCENTILE = 1.0, 99.5
"""Percentiles of height between which a thing lies; what lies beyond is mostly noise."""

MIN_HEIGHT = 0.005
"""Metres that a thing is high at least, which is what a depth camera's noise makes of a sheet."""

EXTENT_OFFSET = 0.01
"""Metres added to extents before their logarithm: what a thin thing measures is mostly noise."""

PLAN_DIRECTIONS = 18
"""Directions in plan that are looked at: every five degrees of a right angle."""

HISTOGRAM_CELLS = 6
"""Of the histogram, both ways."""


class UprightShape(NamedTuple):
    """``profile`` (36,): roots of the shares of points by height above the table (rows, over that of the top) and
    horizontal distance from the middle (over the largest). ``extents`` (3,): logarithms of the top's height, of length
    and of width.
    """

    profile: NDArray[np.float64]
    extents: NDArray[np.float64]


def upright_shape(points: NDArray[np.floating]) -> UprightShape | None:
    """Return the shape of finite points (n, 3) in metres in the table's frame, z up and 0 on the table; None of none.

    What stands on another thing is as high as its top is above the table. Where a thing reaches below 0, so that the
    frame is not the table's, height is over its own foot. Length and width are the sides of the smallest rectangle in
    plan, its middle is the thing's.

    >>> rod = np.linspace([0, 0, 0], [0, 0.3, 0], 100)
    >>> (np.exp(upright_shape(rod).extents) - EXTENT_OFFSET).round(3).tolist()
    [0.005, 0.3, 0.0]
    """
    if not len(points):
        return None
    thinned = points[voxel_keypoints(points, SPACING)].astype(np.float64)
    lowest, top = np.percentile(thinned[:, 2], (FOOT_PERCENTILE, TOP_PERCENTILE))
    foot = min(float(lowest), 0.0)
    height = max(float(top - foot), MIN_HEIGHT)
    aside = in_smallest_rectangle(thinned[:, :2])
    sides = np.sort(np.ptp(aside, axis=0))[::-1]
    radii = np.hypot(*aside.T)
    over, outward = np.clip((thinned[:, 2] - foot) / height, 0.0, 1.0), radii / max(float(radii.max()), MIN_HEIGHT)
    counts, _, _ = np.histogram2d(over, outward, bins=HISTOGRAM_CELLS, range=((0.0, 1.0), (0.0, 1.0)))
    return UprightShape(np.sqrt(counts.ravel() / len(thinned)), np.log(np.array([height, *sides]) + EXTENT_OFFSET))


def in_smallest_rectangle(plan: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points (n, 2) along the sides of the smallest rectangle around them, from its middle."""
    angles = np.arange(PLAN_DIRECTIONS) * np.pi / 2 / PLAN_DIRECTIONS
    along = plan @ np.stack([np.cos(angles), np.sin(angles)])  # (n, turns)
    across = plan @ np.stack([-np.sin(angles), np.cos(angles)])
    least = int(np.argmin(np.ptp(along, axis=0) * np.ptp(across, axis=0)))
    turned = np.stack([along[:, least], across[:, least]], axis=1)
    aside: NDArray[np.float64] = turned - (turned.min(axis=0) + turned.max(axis=0)) / 2
    return aside


@dataclass(frozen=True)
class UprightDescriber:
    """At each keypoint: spin images of each of the ``supports``, then the thing's profile and its extents.

    The cloud's frame is the table's, z up and 0 on the table. Images and profile are roots of histograms already, so
    that equation 1 over these descriptors sums squares of Hellinger's distances; ``profile`` and ``extents`` are the
    weights of these two. The large image says where on the thing a keypoint is, the small one what it is part of, and
    the whole, the same at all keypoints, of what size and build the thing is. Keypoints, normals and what else is set
    as in :class:`.SpinImageDescriber`; how the numbers were chosen: docs/explanation/open_ended.md.
    """

    supports: tuple[float, ...] = (0.2, 0.05)
    width: int = 5
    voxel: float = 0.02
    normal_radius: float = 0.015
    profile: float = 0.35
    extents: float = 0.1
    threads: int | None = None

    @property
    def name(self) -> str:
        return "upright"

    @property
    def size(self) -> int:
        return len(self.supports) * image_size(self.width) + HISTOGRAM_CELLS * HISTOGRAM_CELLS + 3

    @property
    def local(self) -> bool:
        return True

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Return descriptors (k, size), in the order of voxels."""
        shape = upright_shape(finite_points(cloud))
        if shape is None:
            return np.empty((0, self.size), np.float32)
        keypoints, normals = keypoints_and_normals(cloud, self.voxel, self.normal_radius, threads=self.threads)
        images = [
            np.sqrt(
                spin_images(cloud.points, normals, keypoints, support=support, width=self.width, threads=self.threads)
            )
            for support in self.supports
        ]
        whole = np.concatenate([self.profile * shape.profile, self.extents * shape.extents])
        rows = np.broadcast_to(whole.astype(np.float32), (len(images[0]), len(whole)))
        return np.concatenate([*images, rows], axis=1)
