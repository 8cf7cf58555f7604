"""Compiles the kernels of this package once; the compiled code is kept on disk."""

from __future__ import annotations


def warm() -> None:
    """Describes a tiny view in every way that has a kernel."""
    import numpy as np

    from deixis.perception.clouds.cloud import PointCloud
    from deixis.perception.features.keypoints import voxel_keypoints
    from deixis.perception.features.normals import estimate_normals
    from deixis.perception.features.spin_describer import SpinImageDescriber
    from deixis.perception.features.spin_images import spin_images

    side = np.linspace(0.0, 0.05, 6)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    cloud = PointCloud(np.stack([x, y, 1.0 + x * y], axis=1).astype(np.float32))
    SpinImageDescriber().describe(cloud)
    normals, keypoints = estimate_normals(cloud.points, neighbours=5), voxel_keypoints(cloud.points, 0.05)
    spin_images(cloud.points, normals, keypoints, support=0.05, min_points=1, angular=True, threads=1)
