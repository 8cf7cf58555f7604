"""Compiles the kernels of this package once; the compiled code is kept on disk."""

from __future__ import annotations


def warm() -> None:
    """Detects a block on a table."""
    import numpy as np

    from deixis.perception.clouds.cloud import PointCloud
    from deixis.perception.detection.detect import detect

    x, y = (axis.ravel() for axis in np.mgrid[-0.3:0.3:0.01, 0.5:1.1:0.01])
    block = (abs(x) < 0.05) & (abs(y - 0.8) < 0.05)
    points = np.stack([x, y, np.where(block, -0.64, -0.7)], axis=1)
    detect(PointCloud(points.astype(np.float32)))
