"""What every descriptor looks like from outside, and the checks of arrays that the functions of this package share."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import CloudError


class Describer(Protocol):
    """Turns an object's view into numbers; two of the same settings describe the same view in the same way.

    ``size`` is the length of a descriptor; ``local`` says whether there is one for each keypoint, or one for the view.
    """

    @property
    def name(self) -> str: ...

    @property
    def size(self) -> int: ...

    @property
    def local(self) -> bool: ...

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Return descriptors (k, size) of a single object's cloud: one for each keypoint, or k = 1.

        Points without depth are ignored. A view with nothing to describe (no finite point, or none with what the
        descriptor needs) gives (0, size).
        """
        ...


def finite_points(cloud: PointCloud) -> NDArray[np.float64]:
    """Return the points that have a depth, (m, 3)."""
    return cloud.points[cloud.finite].astype(np.float64)


def require_points(points: NDArray[np.floating], name: str = "points") -> None:
    """Refuse what is not of shape (n, 3)."""
    if points.ndim != 2 or points.shape[1] != 3:
        raise CloudError(f"{name} have shape (n, 3), not {points.shape}")


def require_length(value: float, name: str) -> None:
    """Refuse a length that is not a positive, finite number of metres."""
    if not (math.isfinite(value) and value > 0):
        raise CloudError(f"{name} is a length above 0 in metres, not {value:g}")


def require_indices(indices: NDArray[np.integer], points: NDArray[np.floating], name: str) -> None:
    """Refuse indices (k,) of which one is out of range or names a point that is not finite."""
    if indices.ndim != 1 or not (indices.dtype.kind in "iu" or indices.size == 0):
        raise CloudError(f"{name} are whole numbers of shape (k,), not {indices.dtype} of shape {indices.shape}")
    if indices.size and (indices.min() < 0 or indices.max() >= len(points)):
        raise CloudError(f"{name} lie between 0 and {len(points) - 1}, not {indices.min()} and {indices.max()}")
    lost = ~np.isfinite(points[indices.astype(np.int64)]).all(axis=1)
    if lost.any():
        raise CloudError(f"{name} contain {indices[np.argmax(lost)]}, a point without depth")
