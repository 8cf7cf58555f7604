"""Keypoints: one measured point for each occupied voxel, whatever the order of the points.

Kasaei et al. thin a view by an octree (voxel) filter, and keep the measured points nearest to its output; so does this
module. The leaves of an octree of one depth are a grid of voxels, so that no tree is built.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import CloudError
from deixis.perception.features.describer import require_length, require_points

MAX_VOXELS_ALONG_AXIS = 2**40
"""Maximum number of voxels along an axis; coordinates in double precision cannot distinguish more."""

SUBVOXELS = float(2**24)
"""Steps per edge of a voxel, in which positions are whole numbers: sums do not depend on order, and ties are exact."""


def voxel_keypoints(points: NDArray[np.floating], size: float) -> NDArray[np.int64]:
    """Return the indices of the points nearest to the centroids of the occupied voxels.

    Parameters
    ----------
    points
        Points of shape (n, 3) in metres; those that are not finite are ignored.
    size
        Edge of the voxels in metres.

    Returns
    -------
    Indices of shape (k,), in the order of voxels (x, then y, then z); none if no point is finite.

    Raises
    ------
    CloudError
        If the shape is wrong, or ``size`` is not a length above 0 or too small for the extent of the cloud.

    Notes
    -----
    The grid of voxels begins at the least finite coordinates. Neither moving the cloud nor shuffling its points changes
    the chosen points, except for rounding at the borders of voxels; turning the cloud does. Of equally near points the
    one with the least coordinates is taken, and of points at the same place the first. Source: Potmesil 1987 (octrees);
    Kasaei et al., Interactive Open-Ended Learning for 3D Object Recognition, 2015.

    Examples
    --------
    >>> voxel_keypoints(np.array([[0.0, 0, 0], [0.4, 0, 0], [0.5, 0, 0], [1.2, 0, 0], [np.nan, 0, 0]]), 1.0)
    array([1, 3])
    """
    require_points(points)
    require_length(size, "a voxel's edge")
    finite = np.flatnonzero(np.isfinite(points).all(axis=1))
    if not finite.size:
        return np.empty(0, np.int64)
    places = points[finite].astype(np.float64)
    inside = places - places.min(axis=0)
    inside /= size
    if inside.max() > MAX_VOXELS_ALONG_AXIS:
        raise CloudError(f"a voxel's edge of {size:g} m is too small for a cloud of {inside.max() * size:g} m")
    voxels = np.floor(inside)
    inside -= voxels
    order = np.lexsort(voxels.T[::-1])
    voxels, inside = voxels[order], inside[order]
    first = np.concatenate([[True], (voxels[1:] != voxels[:-1]).any(axis=1)])
    indices = finite[order]
    starts = np.flatnonzero(first)
    sizes = np.diff(np.append(starts, len(indices)))
    group = np.repeat(np.arange(len(starts)), sizes)
    whole = np.rint(inside * SUBVOXELS).astype(np.int64)
    sums = np.add.reduceat(whole, starts, axis=0)
    offsets = whole * sizes[group, None] - sums[group]  # from the centroid, times the number of points in the voxel
    distances = (offsets.astype(np.float64) ** 2).sum(axis=1)
    nearest = distances == np.minimum.reduceat(distances, starts)[group]
    candidates = np.flatnonzero(nearest)
    x, y, z = places[order][candidates].T
    candidates = candidates[np.lexsort((indices[candidates], z, y, x, group[candidates]))]
    leading = np.unique(group[candidates], return_index=True)[1]
    return indices[candidates[leading]]
