"""Who is next to whom: the pixels around a pixel, or the nearest points of a cloud that is no image.

As seen from the sensor a point's neighbours are those in nearly the same direction, as in an image; so it is known what
hides what. Of a cloud that was not seen from one known place, the nearest in space are taken.

Everything after this works on a table of neighbours, and does not ask where it came from.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import SurfaceSettings
from deixis.perception.detection.viewpoint import directions

NEIGHBOURS = 8
"""Number of neighbours of a point."""


def neighbour_table(
    points: NDArray[np.float64],
    kept: NDArray[np.intp],
    organised: tuple[int, int] | None,
    settings: SurfaceSettings,
    eye: NDArray[np.float64] | None = None,
) -> NDArray[np.int32]:
    """Return for each of the points (n, 3), finite, its neighbours (n, 8) as indices among these, -1 where there is
    none.

    ``kept`` (n,) are the places of the points in the image of ``organised`` rows and columns; without these, ``eye``
    (3,) is from where they were seen, if that is known.

    >>> neighbour_table(np.zeros((3, 3)), np.array([0, 1, 3]), (2, 2), SurfaceSettings())[0].tolist()
    [-1, -1, -1, -1, 1, -1, -1, 2]
    """
    if organised is not None:
        return _pixels(kept, *organised, settings)
    return _nearest(points if eye is None else directions(points, eye), settings)


def _nearest(places: NDArray[np.float64], settings: SurfaceSettings) -> NDArray[np.int32]:
    """Return the nearest of the places (n, 3), in no order, but for those much farther away than usual."""
    from scipy.spatial import cKDTree

    count = min(NEIGHBOURS + 1, len(places))
    found = np.full((len(places), NEIGHBOURS), -1, np.int32)
    if count < 2:
        return found
    distance, index = cKDTree(places).query(places, k=count, workers=-1)
    usual = float(np.median(distance[:, 1:]))
    near = index.astype(np.int32)
    near[(distance > settings.max_neighbour_ratio * usual) | (near == np.arange(len(places))[:, None])] = -1
    found[:, : count - 1] = near[:, 1:]
    return found


def has_enough(table: NDArray[np.int32], settings: SurfaceSettings) -> bool:
    """Return whether most points have neighbours enough, by some rows of a table (n, 8).

    They have not where points that are next to each other in direction are apart: they were not seen from there.
    """
    few = table[:: max(1, len(table) // settings.neighbour_sample_size)]
    enough = (few >= 0).sum(axis=1) >= settings.min_neighbours
    return not len(few) or bool(enough.mean() >= settings.min_neighbours_share)


def _pixels(kept: NDArray[np.intp], rows: int, columns: int, settings: SurfaceSettings) -> NDArray[np.int32]:
    """Return the pixels around each; of an image in which lines or many pixels have no depth, the next ones that have
    it, in the same directions."""
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
