"""Coordinates of points along axes, in blocks, and lengths of vectors."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_BLOCK, _PRODUCTS = 4096, 1 << 17
"""Maximum number of points, and of products, that are multiplied at once, too few for BLAS to start threads."""


def coordinates(points: NDArray[np.floating], axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the coordinates of points along one axis or several: the product ``points @ axes.T``.

    Parameters
    ----------
    points
        Points of shape (n, d), in metres.
    axes
        Vector of shape (d,), or several of shape (k, d).

    Returns
    -------
    ndarray
        Coordinates of shape (n,) or (n, k).

    Notes
    -----
    The points are multiplied in blocks, because BLAS starts threads for large products. With so few columns, they use
    more than ten times the processor time of the product.

    Examples
    --------
    >>> coordinates(np.array([[1.0, 2.0, 3.0]]), np.eye(3)[1:]).tolist()
    [[2.0, 3.0]]
    """
    result = np.empty((len(points), *axes.shape[:-1]))
    block = max(min(_BLOCK, _PRODUCTS // max(axes.size, 1)), 1)
    for start in range(0, len(points), block):
        np.matmul(points[start : start + block], axes.T, out=result[start : start + block])
    return result


def norms(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the lengths of vectors in space: ``np.linalg.norm(vectors, axis=1)``, several times as fast.

    Parameters
    ----------
    vectors
        Vectors of shape (n, 3).

    Returns
    -------
    ndarray
        Lengths of shape (n,).

    Examples
    --------
    >>> norms(np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 2.0]])).tolist()
    [5.0, 2.0]
    """
    x, y, z = vectors.T
    result: NDArray[np.float64] = np.sqrt(x * x + y * y + z * z)
    return result
