"""Fast point feature histograms (FPFH), computed by Open3D.

R. B. Rusu, N. Blodow, M. Beetz: Fast point feature histograms (FPFH) for 3D registration, ICRA 2009.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.describer import finite_points
from deixis.perception.features.points.keypoints import voxel_keypoints
from deixis.perception.features.points.normals import estimate_normals
from deixis.perception.open3d import open3d

NEIGHBOURS = 100
"""Maximum number of neighbours in a histogram; the nearest, if more lie within the radius."""


@dataclass(frozen=True)
class FpfhDescriber:
    """Local descriptor: histograms of angles between normals (33 bins) at voxel keypoints; lengths in metres.

    Each of three angles has 11 bins, which sum to 200, or are all 0 if no neighbour of the keypoint has a normal. The
    cloud is first thinned to one point per voxel of ``spacing``, so that the distance of the camera hardly matters.
    """

    radius: float = 0.03
    voxel: float = 0.02
    normal_radius: float = 0.015
    spacing: float = 0.005

    @property
    def name(self) -> str:
        """Name of the descriptor."""
        return "fpfh"

    @property
    def size(self) -> int:
        """Length of a descriptor."""
        return 33

    @property
    def local(self) -> bool:
        """True: there is a descriptor for each keypoint."""
        return True

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Compute fast point feature histograms at the voxel keypoints of a cloud.

        Parameters
        ----------
        cloud
            The points of one object, in metres.

        Returns
        -------
        ndarray
            Histograms of shape (k, 33), in the order of voxels.
        """
        points = finite_points(cloud)
        points = points[voxel_keypoints(points, self.spacing)]
        normals = estimate_normals(points, radius=self.normal_radius, origin=cloud.origin)
        usable = np.isfinite(normals).all(axis=1)
        points, normals = points[usable], normals[usable]
        keypoints = voxel_keypoints(points, self.voxel)
        if not len(keypoints):
            return np.empty((0, self.size), np.float32)

        library = open3d()
        seen = library.geometry.PointCloud(library.utility.Vector3dVector(points))
        seen.normals = library.utility.Vector3dVector(normals.astype(np.float64))
        search = library.geometry.KDTreeSearchParamHybrid(self.radius, NEIGHBOURS)
        histograms = library.pipelines.registration.compute_fpfh_feature(seen, search).data
        return np.ascontiguousarray(histograms.T[keypoints], dtype=np.float32)
