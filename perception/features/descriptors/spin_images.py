"""Spin images: histograms of the points around a keypoint, by distance from its normal and height along it.

A. E. Johnson, M. Hebert: Using spin images for efficient object recognition in cluttered 3D scenes, IEEE PAMI 21(5),
1999; bins, support and borders as in the class SpinImageEstimation of the Point Cloud Library. Views as sets of spin
images are the representation of the paper.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import CloudError
from deixis.perception.features.describer import require_indices, require_length, require_points
from deixis.perception.features.points.blocks import in_blocks
from deixis.perception.features.points.keypoints import voxel_keypoints
from deixis.perception.features.points.normals import estimate_normals

LARGE_CLOUD = 20_000
CELLS_OF_FEW, CELLS_OF_MANY = 3, 5
"""Cells of the grid per support, in small and large clouds: fewer read too many points, more have too short rows."""

UNIT_TOLERANCE = 1e-3
"""Tolerance for the length of a unit normal."""


def image_size(width: int) -> int:
    """Return the number of bins: width + 1 rows of distance from the axis, times 2 width + 1 columns along it.

    Parameters
    ----------
    width
        Number of bins from the keypoint to the end of the support.

    Returns
    -------
    int
        The number of bins.

    Examples
    --------
    >>> image_size(8)
    153
    """
    return (width + 1) * (2 * width + 1)


def spin_images(
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    keypoints: NDArray[np.integer],
    *,
    support: float,
    width: int = 8,
    support_angle_cos: float = 0.0,
    min_points: int = 0,
    radial: bool = False,
    angular: bool = False,
    threads: int | None = None,
) -> NDArray[np.float32]:
    """Compute spin images at keypoints of a cloud.

    Parameters
    ----------
    points
        Points of shape (n, 3) in metres; those that are not finite are ignored.
    normals
        Unit normals of shape (n, 3). Those of the keypoints are always needed, the others only for ``angular`` or
        ``support_angle_cos``; then points without a normal (nan) are ignored.
    keypoints
        Indices of shape (k,).
    support
        Radius in metres of the ball around a keypoint that holds the image.
    width
        Number of bins along the distance from the axis.
    support_angle_cos
        Cosine of the largest angle between a point's normal and the axis; 0 accepts all points.
    min_points
        Minimum number of points, the keypoint included, within the support of each keypoint.
    radial
        Use the distance from the keypoint (bins of support / width) and the elevation over the tangent plane (bins of
        pi / 2 / width) as coordinates.
    angular
        Return the mean angle in radians between normals and axis in each bin, instead of the share of points.
    threads
        Number of threads; by default one for each processor that the process may use. The result does not depend on it.

    Returns
    -------
    Images of shape (k, (width + 1) (2 width + 1)), row by row. An image sums to 1, or is 0 throughout if there is no
    point in it (where the Point Cloud Library divides 0 by 0).

    Raises
    ------
    CloudError
        If shapes do not fit, a keypoint has no depth or no unit normal, or has fewer neighbours than ``min_points``.

    Notes
    -----
    A point at a keypoint p with normal n has the distance alpha from the axis (p, n) and the height beta along it. Bins
    measure support / width / sqrt(2) in both, and hold points with alpha and abs(beta) below width bins: a cylinder
    within the ball of the support. A point counts bilinearly at the four corners of its bin; points at the place of p
    do not count. A normal and its opposite are equivalent, so that no angle exceeds a right angle.
    """
    _require(points, normals, keypoints, support, width, support_angle_cos)
    if not len(keypoints):
        return np.empty((0, image_size(width)), np.float32)

    from deixis.perception.features.points.kernels import cell_grid, images, in_axes_of

    finite = np.isfinite(points).all(axis=1)
    grid = cell_grid(points[finite], support / (CELLS_OF_FEW if len(points) < LARGE_CLOUD else CELLS_OF_MANY))
    places, axes = in_axes_of(grid, points[keypoints]), in_axes_of(grid, normals[keypoints])
    looked_at = normals[finite][grid.order] if angular or support_angle_cos > 0 else normals[:0]
    turning = in_axes_of(grid, looked_at)
    if min_points:
        _require_neighbours(grid, places, keypoints, support, min_points)
    settings = int(width), float(support), float(support_angle_cos), bool(radial), bool(angular)
    out = np.empty((len(keypoints), image_size(width)), np.float32)

    def draw(start: int, stop: int) -> None:
        part = slice(start, stop)
        images(grid, turning, places[part], axes[part], *settings, out[part])

    in_blocks(draw, len(keypoints), threads)
    return out


def _require(
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    keypoints: NDArray[np.integer],
    support: float,
    width: int,
    support_angle_cos: float,
) -> None:
    require_points(points)
    if normals.shape != points.shape:
        raise CloudError(f"normals must have the shape of their points, {points.shape}, got {normals.shape}")
    require_indices(keypoints, points, "keypoints")
    require_length(support, "a spin image's support")
    if width < 1:
        raise CloudError(f"a spin image's width must be at least 1 bin, got {width}")
    if not 0.0 <= support_angle_cos <= 1.0:
        raise CloudError(f"the cosine of a support angle must be from 0 to 1, got {support_angle_cos:g}")
    lengths = np.linalg.norm(normals[keypoints].astype(np.float64), axis=1)
    wrong = ~(np.abs(lengths - 1.0) <= UNIT_TOLERANCE)
    if wrong.any():
        at = int(np.argmax(wrong))
        raise CloudError(f"the normal of keypoint {keypoints[at]} must be a unit vector, got length {lengths[at]:g}")


def _require_neighbours(
    grid: object, places: NDArray[np.float64], keypoints: NDArray[np.integer], support: float, least: int
) -> None:
    from deixis.perception.features.points.kernels import tally

    counts = np.zeros(len(places), np.int64)
    tally(grid, places, float(support), counts)
    if counts.min() < least:
        at = int(np.argmin(counts))
        raise CloudError(
            f"keypoint {keypoints[at]} must have at least {least} points within {support:g} m, got {counts[at]};"
            " choose a larger `support` or a smaller `min_points`"
        )


@dataclass(frozen=True)
class SpinImageDescriber:
    """Local descriptor: a spin image at each voxel keypoint that has a normal.

    The defaults suit things of 5 to 30 cm, seen from 1 m by a camera with points 1 to 2 mm apart: about a hundred
    keypoints on a plate and a dozen on a fork, cylinders of 7 cm around each, and normals over 1.5 cm, which noise of
    2 mm hardly tilts. Lengths are in metres. ``support_angle_cos``, ``radial`` and ``angular`` are described in
    :func:`spin_images`. Normals are those of the cloud, or estimated if it has none.
    """

    width: int = 8
    support: float = 0.10
    voxel: float = 0.02
    normal_radius: float = 0.015
    support_angle_cos: float = 0.0
    radial: bool = False
    angular: bool = False
    threads: int | None = None

    @property
    def name(self) -> str:
        """Name of the descriptor."""
        return "spin_images"

    @property
    def size(self) -> int:
        """Length of a descriptor."""
        return image_size(self.width)

    @property
    def local(self) -> bool:
        """True: there is a descriptor for each keypoint."""
        return True

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Compute spin images at the voxel keypoints of a cloud.

        Parameters
        ----------
        cloud
            The points of one object, in metres.

        Returns
        -------
        ndarray
            Spin images of shape (k, size), in the order of voxels.
        """
        everywhere = self.angular or self.support_angle_cos > 0
        keypoints, normals = keypoints_and_normals(cloud, self.voxel, self.normal_radius, everywhere, self.threads)
        return spin_images(
            cloud.points,
            normals,
            keypoints,
            support=self.support,
            width=self.width,
            support_angle_cos=self.support_angle_cos,
            radial=self.radial,
            angular=self.angular,
            threads=self.threads,
        )


def keypoints_and_normals(
    cloud: PointCloud, voxel: float, radius: float, everywhere: bool = False, threads: int | None = None
) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
    """Return the voxel keypoints that have a normal, and the normals.

    The normals are those of the cloud, or estimated if it has none.

    Parameters
    ----------
    cloud
        A cloud of n points, in metres.
    voxel
        Edge of a voxel in metres.
    radius
        Radius in metres of the neighbourhood that a normal is estimated from.
    everywhere
        True to estimate normals at all points, False at keypoints only.
    threads
        Number of threads; None means one for each processor.

    Returns
    -------
    tuple
        Indices of the keypoints, shape (k,), and normals, shape (n, 3), with nan where there is none.
    """
    keypoints = voxel_keypoints(cloud.points, voxel)
    if cloud.normals is not None:
        normals = cloud.normals
    else:
        at = np.flatnonzero(cloud.finite) if everywhere else keypoints
        normals = np.full(cloud.points.shape, np.nan, np.float32)
        normals[at] = estimate_normals(cloud.points, radius=radius, origin=cloud.origin, at=at, threads=threads)
    return keypoints[np.isfinite(normals[keypoints]).all(axis=1)], normals
