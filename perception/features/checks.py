"""Checks of arrays that the functions of this package share; each error says what is expected."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import CloudError


def require_points(points: NDArray[np.floating], name: str = "points") -> None:
    """Refuses what is not of shape (n, 3)."""
    if points.ndim != 2 or points.shape[1] != 3:
        raise CloudError(f"{name} have shape (n, 3), not {points.shape}")


def require_length(value: float, name: str) -> None:
    """Refuses a length that is not a positive, finite number of metres."""
    if not (math.isfinite(value) and value > 0):
        raise CloudError(f"{name} is a length above 0 in metres, not {value:g}")


def require_indices(indices: NDArray[np.integer], points: NDArray[np.floating], name: str) -> None:
    """Refuses indices (k,) of which one is out of range or names a point that is not finite."""
    if indices.ndim != 1 or not (indices.dtype.kind in "iu" or indices.size == 0):
        raise CloudError(f"{name} are whole numbers of shape (k,), not {indices.dtype} of shape {indices.shape}")
    if indices.size and (indices.min() < 0 or indices.max() >= len(points)):
        raise CloudError(f"{name} lie between 0 and {len(points) - 1}, not {indices.min()} and {indices.max()}")
    lost = ~np.isfinite(points[indices.astype(np.int64)]).all(axis=1)
    if lost.any():
        raise CloudError(f"{name} contain {indices[np.argmax(lost)]}, a point without depth")
