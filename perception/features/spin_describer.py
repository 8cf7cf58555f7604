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
        keypoints = voxel_keypoints(cloud.points, self.voxel)
        normals = self._normals(cloud, keypoints)
        keypoints = keypoints[np.isfinite(normals[keypoints]).all(axis=1)]
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

    def _normals(self, cloud: PointCloud, keypoints: NDArray[np.int64]) -> NDArray[np.float32]:
        """Normals (n, 3): the cloud's own, or estimated; only those of keypoints where no others are looked at."""
        if cloud.normals is not None:
            return cloud.normals
        everywhere = self.angular or self.support_angle_cos > 0
        at = np.flatnonzero(cloud.finite) if everywhere else keypoints
        normals = np.full(cloud.points.shape, np.nan, np.float32)
        normals[at] = estimate_normals(
            cloud.points, radius=self.normal_radius, origin=cloud.origin, at=at, threads=self.threads
        )
        return normals
