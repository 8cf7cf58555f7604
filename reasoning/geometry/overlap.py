"""Gaps and overlaps of all pairs of boxes, axis by axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def gaps(boxes: Array) -> Array:
    """Return the distances of all pairs of boxes along each axis.

    Parameters
    ----------
    boxes
        Minimum and maximum corners, shape (n, 2, d).

    Returns
    -------
    ndarray
        Lengths in the unit of the boxes, shape (n, n, d); 0 where the intervals touch or overlap.

    Examples
    --------
    >>> gaps(np.array([[[0.0, 0.0], [1.0, 1.0]], [[3.0, 0.5], [4.0, 2.0]]]))[0, 1].tolist()
    [2.0, 0.0]
    """
    low, high = boxes[:, 0], boxes[:, 1]
    apart: Array = np.maximum(np.maximum(low[:, None] - high[None], low[None] - high[:, None]), 0.0)
    return apart


def common_lengths(boxes: Array) -> Array:
    """Return the lengths of the common intervals of all pairs of boxes along each axis.

    Parameters
    ----------
    boxes
        Minimum and maximum corners, shape (n, 2, d).

    Returns
    -------
    ndarray
        Lengths in the unit of the boxes, shape (n, n, d); 0 where the intervals touch or are apart.

    Examples
    --------
    >>> common_lengths(np.array([[[0.0, 0.0], [1.0, 1.0]], [[3.0, 0.5], [4.0, 2.0]]]))[0, 1].tolist()
    [0.0, 0.5]
    """
    low, high = boxes[:, 0], boxes[:, 1]
    common: Array = np.maximum(np.minimum(high[:, None], high[None]) - np.maximum(low[:, None], low[None]), 0.0)
    return common


def overlapping(boxes: Array | NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which pairs of boxes have points of their interiors in common.

    Parameters
    ----------
    boxes
        Minimum and maximum corners, shape (n, 2, d).

    Returns
    -------
    ndarray
        True for each such pair, shape (n, n); boxes that only touch do not overlap.

    Examples
    --------
    >>> overlapping(np.array([[[0.0, 0.0], [1.0, 1.0]], [[1.0, 0.0], [2.0, 1.0]], [[0.5, 0.5], [3.0, 0.9]]])).tolist()
    [[True, False, True], [False, True, True], [True, True, True]]
    """
    low, high = boxes[:, 0], boxes[:, 1]
    found: NDArray[np.bool_] = np.all((low[:, None] < high[None]) & (low[None] < high[:, None]), axis=2)
    return found
