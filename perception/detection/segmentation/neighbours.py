"""Find the neighbours of points: the pixels around a pixel, or the nearest points of an unorganised cloud.

The neighbours of a point are the points in nearly the same direction from the sensor, as in an image, so that occlusion
is visible. Without a known viewpoint, they are the nearest points in space. All later steps use only the table of
neighbours.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import SurfaceSettings
from deixis.perception.detection.table.viewpoint import directions

NEIGHBOURS = 8
"""Number of neighbours of a point."""


def neighbour_table(
    points: NDArray[np.float64],
    kept: NDArray[np.intp],
    organised: tuple[int, int] | None,
    settings: SurfaceSettings,
    eye: NDArray[np.float64] | None = None,
) -> NDArray[np.int32]:
    """Return the indices of the neighbours of finite points, shape (n, 8); -1 for missing ones.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    kept
        Indices of the points in the image, shape (n,).
    organised
        Rows and columns of the image; None for an unorganised cloud.
    settings
        Limits of the distance of neighbours, in pixels and relative to the usual distance.
    eye
        Viewpoint of an unorganised cloud, shape (3,); None if it is unknown.

    Returns
    -------
    ndarray
        Indices of shape (n, 8).

    Examples
    --------
    >>> neighbour_table(np.zeros((3, 3)), np.array([0, 1, 3]), (2, 2), SurfaceSettings())[0].tolist()
    [-1, -1, -1, -1, 1, -1, -1, 2]
    """
    if organised is not None:
        return _pixels(kept, *organised, settings)
    return _nearest(points if eye is None else directions(points, eye), settings)


def _nearest(places: NDArray[np.float64], settings: SurfaceSettings) -> NDArray[np.int32]:
    """Return the nearest places of each of n places (n, 3), in any order, without those much farther than usual."""
    from scipy.spatial import cKDTree

    count = min(NEIGHBOURS + 1, len(places))
    found = np.full((len(places), NEIGHBOURS), -1, np.int32)
    if count < 2:
        return found
    tree = cKDTree(places)
    order = tree.indices  # queries next to each other in space share what the processor caches: half the time
    distance, index = np.empty((len(places), count)), np.empty((len(places), count), np.int32)
    distance[order], index[order] = tree.query(places[order], k=count, workers=-1)
    usual = float(np.median(distance[:, 1:]))
    index[(distance > settings.max_neighbour_ratio * usual) | (index == np.arange(len(places))[:, None])] = -1
    found[:, : count - 1] = index[:, 1:]
    return found


def has_enough(table: NDArray[np.int32], settings: SurfaceSettings) -> bool:
    """Return True if most points have enough neighbours, judged by a sample of a table (n, 8).

    From a wrong viewpoint, points that are adjacent in direction are far apart and have few neighbours.

    Parameters
    ----------
    table
        Indices of neighbours, shape (n, 8); -1 for missing ones.
    settings
        Least number of neighbours, the share of points that must have it, and the size of the sample.

    Returns
    -------
    bool
        True for a table without points.
    """
    few = table[:: max(1, len(table) // settings.neighbour_sample_size)]
    enough = (few >= 0).sum(axis=1) >= settings.min_neighbours
    return not len(few) or bool(enough.mean() >= settings.min_neighbours_share)


def _pixels(kept: NDArray[np.intp], rows: int, columns: int, settings: SurfaceSettings) -> NDArray[np.int32]:
    """Return the pixels around each pixel; where they have no depth, the next ones in the same directions."""
    from deixis.perception.detection.kernels import pixel_neighbours

    number = np.full((rows, columns), -1, np.int32)
    row, column = np.divmod(kept, columns)
    number[row, column] = np.arange(len(kept))
    table = np.full((len(kept), NEIGHBOURS), -1, np.int32)
    for steps in range(1, settings.max_pixel_steps + 1):
        pixel_neighbours(number, row, column, steps, table)
        if has_enough(table, settings):
            break
    return table
