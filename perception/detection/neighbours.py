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

_AROUND = ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1))


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
        return _pixels(kept, *organised)
    places = points if eye is None else directions(points, eye)
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


def _pixels(kept: NDArray[np.intp], rows: int, columns: int) -> NDArray[np.int32]:
    number = np.full((rows + 2, columns + 2), -1, np.int32)
    row, column = np.divmod(kept, columns)
    number[row + 1, column + 1] = np.arange(len(kept))
    table = [number[row + 1 + down, column + 1 + right] for down, right in _AROUND]
    return np.ascontiguousarray(np.stack(table, axis=1))
