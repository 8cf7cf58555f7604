"""Find the neighbours of points: the pixels around a pixel, or the nearest points of an unorganised cloud.

The neighbours of a point are the points in nearly the same direction from the sensor, as in an image, so that occlusion
is visible. Without a known viewpoint, they are the nearest points in space. All later steps use only the neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import SurfaceSettings
from deixis.perception.detection.table.viewpoint import View, directions

NEIGHBOURS = 8
"""Number of neighbours of a point."""


class Neighbours(Protocol):
    """Neighbours of n points."""

    def averaged(self, values: NDArray[np.float64], apart: NDArray[np.float64], rounds: int) -> NDArray[np.float64]:
        """Return values averaged repeatedly with those of similar neighbours.

        Parameters
        ----------
        values
            Values of shape (n,).
        apart
            Largest difference from the value of a neighbour that counts, shape (n,).
        rounds
            Number of times that the values are averaged.

        Returns
        -------
        ndarray
            Values of shape (n,).
        """
        ...

    def grown(self, seeds: NDArray[np.bool_], allowed: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return a mask of the seeds and of all allowed points that are connected to them through allowed ones.

        Parameters
        ----------
        seeds, allowed
            Masks of shape (n,).

        Returns
        -------
        ndarray
            Mask of shape (n,).
        """
        ...

    def among(self, chosen: NDArray[np.intp]) -> NDArray[np.int32]:
        """Return the neighbours of chosen points among these points.

        Parameters
        ----------
        chosen
            Indices of m points, shape (m,).

        Returns
        -------
        ndarray
            Indices into ``chosen`` of shape (m, k); -1 for a missing neighbour.
        """
        ...


@dataclass(frozen=True, eq=False)
class ListedNeighbours:
    """Neighbours of n points as a ``table`` of their indices, shape (n, k); -1 for missing ones."""

    table: NDArray[np.int32]

    def averaged(self, values: NDArray[np.float64], apart: NDArray[np.float64], rounds: int) -> NDArray[np.float64]:
        """Return values averaged repeatedly with those of similar neighbours.

        Parameters
        ----------
        values, apart, rounds
            Values, largest differences and number of rounds, as for :class:`Neighbours`.

        Returns
        -------
        ndarray
            Values of shape (n,).
        """
        from deixis.perception.detection.kernels import averaged

        result: NDArray[np.float64] = averaged(values, self.table, apart, rounds)
        return result

    def grown(self, seeds: NDArray[np.bool_], allowed: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return a mask of the allowed points that are connected to seeds.

        Parameters
        ----------
        seeds, allowed
            Masks of shape (n,).

        Returns
        -------
        ndarray
            Mask of shape (n,).
        """
        from deixis.perception.detection.kernels import grown

        result: NDArray[np.bool_] = grown(seeds, allowed, self.table)
        return result

    def among(self, chosen: NDArray[np.intp]) -> NDArray[np.int32]:
        """Return the neighbours of chosen points among these points.

        Parameters
        ----------
        chosen
            Indices of m points, shape (m,).

        Returns
        -------
        ndarray
            Indices into ``chosen`` of shape (m, k); -1 for a missing neighbour.
        """
        from deixis.perception.detection.kernels import renumbered

        number = np.full(len(self.table), -1, np.int32)
        number[chosen] = np.arange(len(chosen))
        result: NDArray[np.int32] = renumbered(self.table, chosen, number)
        return result


@dataclass(frozen=True, eq=False)
class AdjacentPixels:
    """Neighbours of the points of an image: the points of the eight pixels around each of them.

    No table of neighbours is made for all points, because most of them are on the table and are only averaged.

    Parameters
    ----------
    places
        Index of the pixel of each point, row by row, shape (n,), ascending.
    rows, columns
        Row and column of this pixel, shape (n,).
    shape
        Numbers of rows and columns of the image.
    """

    places: NDArray[np.intp]
    rows: NDArray[np.int32]
    columns: NDArray[np.int32]
    shape: tuple[int, int]

    def averaged(self, values: NDArray[np.float64], apart: NDArray[np.float64], rounds: int) -> NDArray[np.float64]:
        """Return values averaged repeatedly with those of similar neighbours.

        Parameters
        ----------
        values, apart, rounds
            Values, largest differences and number of rounds, as for :class:`Neighbours`.

        Returns
        -------
        ndarray
            Values of shape (n,).
        """
        from deixis.perception.detection.kernels import averaged_pixels

        result: NDArray[np.float64] = averaged_pixels(values, self.rows, self.columns, self.shape, apart, rounds)
        return result

    def grown(self, seeds: NDArray[np.bool_], allowed: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return a mask of the allowed points that are connected to seeds.

        Parameters
        ----------
        seeds, allowed
            Masks of shape (n,).

        Returns
        -------
        ndarray
            Mask of shape (n,).
        """
        from deixis.perception.detection.kernels import grown_pixels

        result: NDArray[np.bool_] = grown_pixels(seeds, allowed, self.rows, self.columns, self.shape)
        return result

    def among(self, chosen: NDArray[np.intp]) -> NDArray[np.int32]:
        """Return the neighbours of chosen points among these points.

        Parameters
        ----------
        chosen
            Indices of m points, shape (m,).

        Returns
        -------
        ndarray
            Indices into ``chosen`` of shape (m, k); -1 for a missing neighbour.
        """
        return self._around(chosen, self.places[chosen])

    def has_enough(self, settings: SurfaceSettings) -> bool:
        """Return True if most points have enough neighbours, judged by a sample.

        Parameters
        ----------
        settings
            Least number of neighbours, the share of points that must have it, and the size of the sample.

        Returns
        -------
        bool
            False if lines of the image or many pixels have no depth.
        """
        few = np.arange(0, len(self.rows), max(1, len(self.rows) // settings.neighbour_sample_size))
        return has_enough(self._around(few, self.places), settings)

    def _around(self, chosen: NDArray[np.intp], places: NDArray[np.intp]) -> NDArray[np.int32]:
        """Return the neighbours of chosen points (m,) as indices into ``places`` (k,) of pixels, shape (m, 8)."""
        from deixis.perception.detection.kernels import pixel_neighbours

        number = np.full(self.shape, -1, np.int32)
        number.reshape(-1)[places] = np.arange(len(places))
        table = np.full((len(chosen), NEIGHBOURS), -1, np.int32)
        pixel_neighbours(number, self.rows[chosen], self.columns[chosen], 1, table)
        return table


def neighbours_in_image(view: View, settings: SurfaceSettings) -> Neighbours:
    """Return the neighbours of the points of an image.

    Parameters
    ----------
    view
        Points with a depth, and their pixels.
    settings
        Number of neighbours that points need, and the largest distance of neighbours in pixels.

    Returns
    -------
    Neighbours
        The adjacent pixels, or if lines of the image or many pixels have no depth, the next ones in their directions.

    Raises
    ------
    ValueError
        If the view is not an image.
    """
    if view.organised is None:
        raise ValueError("`view` must be an image")
    adjacent = AdjacentPixels(view.places, *view.pixels, view.organised)
    if adjacent.has_enough(settings):
        return adjacent
    return ListedNeighbours(neighbour_table(view.points, view.places, view.organised, settings))


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
