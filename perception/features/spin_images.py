"""Spin images: how the surface around a keypoint looks when it is spun about the keypoint's normal.

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
from deixis.perception.features.blocks import in_blocks
from deixis.perception.features.describer import require_indices, require_length, require_points
from deixis.perception.features.keypoints import voxel_keypoints
from deixis.perception.features.normals import estimate_normals

LARGE_CLOUD = 20_000
CELLS_OF_FEW, CELLS_OF_MANY = 3, 5
"""Cells of the grid along the support: fewer read too many points, more have rows too short to be fast."""

UNIT_TOLERANCE = 1e-3
"""By how much the length of a normal may differ from 1."""


def image_size(width: int) -> int:
    """Return the number of bins: (width + 1) rows of distance from the axis times (2 width + 1) columns along it.

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
    """Return spin images (k, (width + 1) (2 width + 1)) of the points with the indices ``keypoints`` (k,), row by row.

    Each point within ``support`` metres of a keypoint p with normal n has a distance alpha from the axis (p, n) and a
    height beta along it. Bins measure support / width / sqrt(2) both ways, and hold what has alpha and abs(beta) less
    than width bins: a cylinder within the ball of the support. A point counts in its four bins' corners bilinearly, p
    itself and points in its place do not count, and an image sums to 1. An image without a point is 0 throughout
    (where the Point Cloud Library divides 0 by 0).

    ``radial`` bins distance from p (support / width) and elevation over the tangent plane (pi / 2 / width) instead.
    ``support_angle_cos`` above 0 leaves out points whose normal makes a larger angle with the axis; ``angular`` gives
    the mean angle (radians) between normals and axis in each bin, not the share of points. Of a normal and its
    opposite the nearer counts for both, so that no such angle is above a right one.
    ``normals`` (n, 3) are unit vectors; those of keypoints are always needed, the others for these two options only,
    where a point without one (nan) is left out. Points that are not finite are ignored. ``threads`` are all that the
    process may use if None; the result does not depend on them.

    Raises CloudError where shapes do not fit, a keypoint has no depth or no unit normal, or fewer points than
    ``min_points`` (itself included) lie nearer to it than ``support``.
    """
    _require(points, normals, keypoints, support, width, support_angle_cos)
    if not len(keypoints):
        return np.empty((0, image_size(width)), np.float32)

    from deixis.perception.features.kernels import cell_grid, images, in_axes_of

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
        raise CloudError(f"normals have the shape of their points, {points.shape}, not {normals.shape}")
    require_indices(keypoints, points, "keypoints")
    require_length(support, "a spin image's support")
    if width < 1:
        raise CloudError(f"a spin image is 1 bin wide or more, not {width}")
    if not 0.0 <= support_angle_cos <= 1.0:
        raise CloudError(f"the cosine of a support angle lies between 0 and 1, not at {support_angle_cos:g}")
    lengths = np.linalg.norm(normals[keypoints].astype(np.float64), axis=1)
    wrong = ~(np.abs(lengths - 1.0) <= UNIT_TOLERANCE)
    if wrong.any():
        at = int(np.argmax(wrong))
        raise CloudError(f"the normal of keypoint {keypoints[at]} has length {lengths[at]:g}; a unit vector is needed")


def _require_neighbours(
    grid: object, places: NDArray[np.float64], keypoints: NDArray[np.integer], support: float, least: int
) -> None:
    from deixis.perception.features.kernels import tally

    counts = np.zeros(len(places), np.int64)
    tally(grid, places, float(support), counts)
    if counts.min() < least:
        at = int(np.argmin(counts))
        raise CloudError(
            f"keypoint {keypoints[at]} has {counts[at]} points within {support:g} m, and {least} are asked for;"
            " choose a larger support or a smaller min_points"
        )


@dataclass(frozen=True)
class SpinImageDescriber:
    """A spin image at each voxel's keypoint; needs a keypoint with a normal (three points near it, not in a line).

    The defaults suit things of 5 to 30 cm seen from a metre by a camera with points 1 to 2 mm apart: some hundred
    keypoints on a plate, a dozen on a fork; a cylinder that reaches 7 cm around each; normals over 1.5 cm, which a
    noise of 2 mm hardly tilts. Lengths in metres. ``support_angle_cos``, ``radial`` and ``angular`` as in
    :func:`spin_images`. Normals are the cloud's own where it has them, else estimated.
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
        return "spin_images"

    @property
    def size(self) -> int:
        return image_size(self.width)

    @property
    def local(self) -> bool:
        return True

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Return spin images (k, size), in the order of voxels."""
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
    """Return indices (k,) of the voxels' keypoints that have a normal, and normals (n, 3): the cloud's own, or
    estimated.

    Estimated are only those of keypoints, the others being nan, unless they are wanted ``everywhere``.
    """
    keypoints = voxel_keypoints(cloud.points, voxel)
    if cloud.normals is not None:
        normals = cloud.normals
    else:
        at = np.flatnonzero(cloud.finite) if everywhere else keypoints
        normals = np.full(cloud.points.shape, np.nan, np.float32)
        normals[at] = estimate_normals(cloud.points, radius=radius, origin=cloud.origin, at=at, threads=threads)
    return keypoints[np.isfinite(normals[keypoints]).all(axis=1)], normals
