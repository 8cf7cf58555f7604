"""Views of things that stand upright: spin images at two scales, each beside the shape of the whole."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.describer import finite_points
from deixis.perception.features.spin_describer import keypoints_and_normals
from deixis.perception.features.spin_images import image_size, spin_images
from deixis.perception.features.upright_shape import CELLS, upright_shape


@dataclass(frozen=True)
class UprightDescriber:
    """At each keypoint: spin images of each of the ``supports``, then the thing's profile and its extents.

    The cloud's frame is the table's, z up and 0 on the table. Images and profile are roots of histograms already, so
    that equation 1 over these descriptors sums squares of Hellinger's distances; ``profile`` and ``extents`` are the
    weights of these two. The large image says where on the thing a keypoint is, the small one what it is part of, and
    the whole, the same at all keypoints, of what size and build the thing is. Keypoints, normals and what else is set
    as in :class:`.SpinImageDescriber`; how the numbers were chosen: docs/open_ended.md.
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
        return len(self.supports) * image_size(self.width) + CELLS * CELLS + 3

    @property
    def local(self) -> bool:
        return True

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Descriptors (k, size), in the order of voxels."""
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
