"""The protocol of all descriptors, and the checks of arrays that this package shares."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import CloudError


class Describer(Protocol):
    """Method that turns a view of an object into descriptors; equal settings give equal descriptors."""

    @property
    def name(self) -> str:
        """Name of the descriptor."""
        ...

    @property
    def size(self) -> int:
        """Length of a descriptor."""
        ...

    @property
    def local(self) -> bool:
        """True for one descriptor per keypoint, False for one per view."""
        ...

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Describe the cloud of a single object by one descriptor for each keypoint, or by one.

        Points without depth are ignored.

        Parameters
        ----------
        cloud
            The points of one object, in metres.

        Returns
        -------
        ndarray
            Descriptors of shape (k, size). A view without a finite point, or without what the descriptor needs, gives k
            = 0.
        """
        ...


def finite_points(cloud: PointCloud) -> NDArray[np.float64]:
    """Return the points with a depth, shape (m, 3).

    Parameters
    ----------
    cloud
        A cloud of n points.

    Returns
    -------
    ndarray
        The m ≤ n points with finite coordinates, shape (m, 3).
    """
    return cloud.points[cloud.finite].astype(np.float64)


def require_points(points: NDArray[np.floating]) -> None:
    """Raise CloudError unless the points have shape (n, 3).

    Parameters
    ----------
    points
        Array to check.

    Raises
    ------
    CloudError
        If they have another shape.
    """
    if points.ndim != 2 or points.shape[1] != 3:
        raise CloudError(f"`points` must have shape (n, 3), got {points.shape}")


def require_length(value: float, name: str) -> None:
    """Raise CloudError unless a length is a positive, finite number of metres.

    Parameters
    ----------
    value
        The length in metres.
    name
        Name of the argument in the message.

    Raises
    ------
    CloudError
        If it is not.
    """
    if not (math.isfinite(value) and value > 0):
        raise CloudError(f"{name} must be a length above 0 in metres, got {value:g}")


def require_indices(indices: NDArray[np.integer], points: NDArray[np.floating], name: str) -> None:
    """Raise CloudError unless all indices name finite points.

    Parameters
    ----------
    indices
        Indices of points, shape (k,).
    points
        The points, shape (n, 3).
    name
        Name of the argument in the message.

    Raises
    ------
    CloudError
        If an index is out of range, or that of a point that is not finite.
    """
    if indices.ndim != 1 or not (indices.dtype.kind in "iu" or indices.size == 0):
        raise CloudError(f"{name} must be whole numbers of shape (k,), got {indices.dtype} of shape {indices.shape}")
    if indices.size and (indices.min() < 0 or indices.max() >= len(points)):
        raise CloudError(f"{name} must be from 0 to {len(points) - 1}, got {indices.min()} to {indices.max()}")
    lost = ~np.isfinite(points[indices.astype(np.int64)]).all(axis=1)
    if lost.any():
        raise CloudError(f"{name} must be points with a depth, got {indices[np.argmax(lost)]}, which has none")
