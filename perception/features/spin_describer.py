"""Views as sets of spin images, the representation of the paper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.keypoints import voxel_keypoints
from deixis.perception.features.normals import estimate_normals
from deixis.perception.features.spin_images import image_size, spin_images


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
        """Spin images (k, size), in the order of voxels."""
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
    """Indices (k,) of the voxels' keypoints that have a normal, and normals (n, 3): the cloud's own, or estimated.

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
