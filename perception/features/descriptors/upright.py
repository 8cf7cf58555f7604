"""Descriptor of upright things: spin images (Johnson and Hebert 1999) at two scales, each with the overall shape.

The overall shape uses the vertical: the distribution of points over height and radius, and the height, length and width
of the thing. A thing on a table may be turned about the vertical only, so that heights carry more information than
distances.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.describer import finite_points
from deixis.perception.features.descriptors.spin_images import image_size, keypoints_and_normals, spin_images
from deixis.perception.features.points.keypoints import voxel_keypoints

SPACING = 0.004
"""Distance in metres to which points are thinned, so that the weight of a part does not depend on its point density."""

FOOT_PERCENTILE, TOP_PERCENTILE = 1.0, 99.5
"""Percentiles of the height that bound a thing; points beyond are mostly noise."""

MIN_HEIGHT = 0.005
"""Minimum height of a thing in metres: the thickness of a sheet in the noise of a depth camera."""

EXTENT_OFFSET = 0.01
"""Offset in metres added to extents before their logarithm: the thickness of a thin thing is mostly noise."""

PLAN_DIRECTIONS = 18
"""Number of directions in plan that are tried: one for every five degrees of a right angle."""

HISTOGRAM_CELLS = 6
"""Number of cells of the histogram along each side."""


class UprightShape(NamedTuple):
    """Overall shape of an upright thing.

    ``profile`` (36,) holds square roots of the shares of points by height (rows, relative to the top) and horizontal
    distance from the centre (columns, relative to the largest). ``extents`` (3,) holds the logarithms of height, length
    and width in metres, each with ``EXTENT_OFFSET`` added.
    """

    profile: NDArray[np.float64]
    extents: NDArray[np.float64]


def upright_shape(points: NDArray[np.floating]) -> UprightShape | None:
    """Compute the overall shape of an object in the table's frame.

    The height is that of the top above the table, also for a thing that stands on another one. If a thing reaches below
    0, so that the frame is not the table's, its height is measured from its own foot. Length and width are the sides of
    the smallest rectangle around it in plan.

    Parameters
    ----------
    points
        Finite points, shape (n, 3), in metres, with z up and 0 on the table.

    Returns
    -------
    UprightShape or None
        The shape, or None for no points.

    Examples
    --------
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
    """Return points (n, 2) in the frame of the smallest rectangle around them, with its centre as origin.

    Parameters
    ----------
    plan
        Points seen from above, shape (n, 2), in metres.

    Returns
    -------
    ndarray
        The points in the frame of the rectangle, shape (n, 2).
    """
    angles = np.arange(PLAN_DIRECTIONS) * np.pi / 2 / PLAN_DIRECTIONS
    along = plan @ np.stack([np.cos(angles), np.sin(angles)])  # (n, turns)
    across = plan @ np.stack([-np.sin(angles), np.cos(angles)])
    least = int(np.argmin(np.ptp(along, axis=0) * np.ptp(across, axis=0)))
    turned = np.stack([along[:, least], across[:, least]], axis=1)
    aside: NDArray[np.float64] = turned - (turned.min(axis=0) + turned.max(axis=0)) / 2
    return aside


@dataclass(frozen=True)
class UprightDescriber:
    """Local descriptor: spin images of each of the ``supports`` (metres), with the thing's profile and extents.

    The cloud's frame must be the table's, z up and 0 on the table. Images and profile are square roots of histograms,
    so that equation 1 over these descriptors sums squares of Hellinger distances; ``profile`` and ``extents`` are the
    weights of these two parts. The large image shows the place of a keypoint on the thing, the small image its
    surroundings, and the overall shape, the same at all keypoints, the size and build of the thing. The other settings
    are those of :class:`.SpinImageDescriber`; docs/explanation/open_ended.md says how the numbers were chosen.
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
        """Name of the descriptor."""
        return "upright"

    @property
    def size(self) -> int:
        """Length of a descriptor."""
        return len(self.supports) * image_size(self.width) + HISTOGRAM_CELLS * HISTOGRAM_CELLS + 3

    @property
    def local(self) -> bool:
        """True: there is a descriptor for each keypoint."""
        return True

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Compute spin images at the voxel keypoints of a cloud, with the object's profile and extents.

        Parameters
        ----------
        cloud
            The points of one object in the table's frame, in metres.

        Returns
        -------
        ndarray
            Descriptors of shape (k, size), in the order of voxels.
        """
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
