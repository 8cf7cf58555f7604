"""Images of depth and colour from organised clouds, and the projection of the table's frame to their pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud

MAX_MISFIT = 2.0
"""Largest median distance in pixels between a point and the pixel at which a pinhole camera would see it."""


@dataclass(frozen=True, eq=False)
class Optics:
    """Pinhole camera of organised clouds.

    ``matrix`` (3, 3) takes a point, relative to ``eye`` (3,), to homogeneous coordinates of its column and row; the
    third one is the depth along the optical axis, in metres.
    """

    matrix: NDArray[np.float64]
    eye: NDArray[np.float64]

    def every(self, stride: int) -> Optics:
        """Return the camera of every ``stride``-th row and column.

        Parameters
        ----------
        stride
            Distance of the rows and columns that are kept.

        Returns
        -------
        Optics
            Camera of the smaller image, which begins in the middle of the first ``stride`` rows and columns.
        """
        first = stride // 2
        thinned = np.array([[1 / stride, 0, -first / stride], [0, 1 / stride, -first / stride], [0, 0, 1.0]])
        return Optics(thinned @ self.matrix, self.eye)


def optics_of(cloud: PointCloud, sample: int = 2000) -> Optics | None:
    """Return the pinhole camera that made an organised cloud.

    Parameters
    ----------
    cloud
        Cloud whose points are the pixels of an image.
    sample
        Number of points that are used.

    Returns
    -------
    Optics or None
        None if the cloud is not organised, or not the image of a pinhole camera at its origin.

    Notes
    -----
    Direct linear transformation (Abdel-Aziz and Karara 1971) with a known centre of projection.
    """
    if cloud.organised is None or min(cloud.organised) < 4:
        return None
    kept = np.flatnonzero(cloud.finite)
    if len(kept) < 50:
        return None
    kept = kept[:: max(1, len(kept) // sample)]
    row, column = (part.astype(np.float64) for part in np.divmod(kept, cloud.organised[1]))
    eye = np.asarray(cloud.origin, dtype=np.float64)
    rays = cloud.points[kept].astype(np.float64) - eye
    rays /= np.maximum(np.linalg.norm(rays, axis=1, keepdims=True), 1e-9)
    size = float(max(cloud.organised))
    middle = np.array([column.mean(), row.mean()])
    at = (np.stack([column, row], axis=1) - middle) / size
    zero = np.zeros_like(rays)
    terms = np.concatenate([np.hstack([rays, zero, -at[:, :1] * rays]), np.hstack([zero, rays, -at[:, 1:] * rays])])
    matrix = np.linalg.eigh(terms.T @ terms)[1][:, 0].reshape(3, 3)
    scale = np.linalg.norm(matrix[2])
    if scale == 0:  # all points at one place
        return None
    matrix /= scale
    matrix *= np.sign(np.median(rays @ matrix[2])) or 1.0
    matrix = np.array([[size, 0, middle[0]], [0, size, middle[1]], [0, 0, 1.0]]) @ matrix
    seen = rays @ matrix.T
    with np.errstate(invalid="ignore", divide="ignore"):
        off = np.hypot(seen[:, 0] / seen[:, 2] - column, seen[:, 1] / seen[:, 2] - row)
    return Optics(matrix, eye) if float(np.median(np.nan_to_num(off, nan=np.inf))) < MAX_MISFIT else None


@dataclass(frozen=True, eq=False)
class FrameImage:
    """Every n-th row and column of an organised cloud.

    ``points`` (r, c, 3) are in the frame of the cloud, ``depth`` (r, c) is along the optical axis, 0 without a
    measurement, and ``colour`` (r, c, 3) is 0 without colours.
    """

    points: NDArray[np.float32]
    depth: NDArray[np.float32]
    colour: NDArray[np.float32]
    optics: Optics

    def places(self, pixels: NDArray[np.intp], back: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the points that pixels show, in another frame.

        Parameters
        ----------
        pixels
            Flat indices of shape (k,).
        back
            Transform (4, 4) from the frame of the cloud to the other one.

        Returns
        -------
        ndarray
            Points of shape (k, 3), in metres.
        """
        return self.points.reshape(-1, 3)[pixels].astype(np.float64) @ back[:3, :3].T + back[:3, 3]


def image_of(cloud: PointCloud, optics: Optics, stride: int) -> FrameImage:
    """Return every ``stride``-th row and column of an organised cloud.

    Parameters
    ----------
    cloud
        Organised cloud.
    optics
        Its camera.
    stride
        Distance of the rows and columns that are kept.

    Returns
    -------
    FrameImage
        Depth and colour of the pixels that are kept.
    """
    from deixis.perception.tracking.kernels import depths

    assert cloud.organised is not None, "optics are known for organised clouds only"
    first = stride // 2
    points = np.ascontiguousarray(cloud.points.reshape(*cloud.organised, 3)[first::stride, first::stride])
    small = optics.every(stride)
    axis = small.matrix[2]
    depth = depths(points, axis.astype(np.float32), np.float32(-axis @ small.eye))
    if cloud.colours is None:
        colour = np.zeros(points.shape, np.float32)
    else:
        colour = cloud.colours.reshape(*cloud.organised, 3)[first::stride, first::stride].astype(np.float32)
    return FrameImage(points, depth, colour, small)


@dataclass(frozen=True, eq=False)
class TableView:
    """View of the table by a camera.

    ``matrix`` (3, 3) and ``offset`` (3,) take points of the table's frame to homogeneous pixel coordinates, ``back``
    (4, 4) takes the frame of the cloud to that of the table, and ``level`` (r, c) is the depth of the table's plane at
    each pixel, infinite where it is not in view.
    """

    matrix: NDArray[np.float64]
    offset: NDArray[np.float64]
    back: NDArray[np.float64]
    level: NDArray[np.float32]

    def shows(self, place: NDArray[np.float64]) -> bool:
        """Return True if a place is within the image.

        Parameters
        ----------
        place
            Place of shape (3,) in the table's frame, in metres.

        Returns
        -------
        bool
            True also if something hides it.
        """
        column, row, depth = self.matrix @ place + self.offset
        rows, columns = self.level.shape
        return bool(depth > 0 and 0 <= row < rows * depth and 0 <= column < columns * depth)

    def pixels(self, places: NDArray[np.float64]) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
        """Return the pixels at which places are seen, also those that something hides.

        Parameters
        ----------
        places
            Places of shape (n, 3) in the table's frame, in metres.

        Returns
        -------
        tuple
            Flat indices and depths, each of shape (k,), of those of the places that are within the image.
        """
        seen = places @ self.matrix.T + self.offset
        depth = seen[:, 2]
        column, row = np.rint(seen[:, :2] / np.maximum(seen[:, 2:], 1e-9)).clip(-1, 1e6).astype(np.int64).T
        rows, columns = self.level.shape
        within = (depth > 0) & (row >= 0) & (column >= 0) & (row < rows) & (column < columns)
        return np.asarray(row[within] * columns + column[within]), np.asarray(depth[within])

    def hides(self, places: NDArray[np.float64], depth: NDArray[np.float32], margin: float) -> NDArray[np.bool_]:
        """Return True for each place that is out of the image, or behind something.

        Parameters
        ----------
        places
            Places of shape (n, 3) in the table's frame, in metres.
        depth
            Depths (r, c) of a frame of this view, 0 without a measurement.
        margin
            Distance in metres by which a surface must be nearer than a place that it hides.

        Returns
        -------
        ndarray
            Mask of shape (n,).
        """
        seen = places @ self.matrix.T + self.offset
        away = np.maximum(seen[:, 2], 1e-9)
        column, row = np.rint(seen[:, :2] / away[:, None]).clip(-1, 1e6).astype(np.int64).T
        rows, columns = depth.shape
        hidden = (seen[:, 2] <= 0) | (row < 0) | (column < 0) | (row >= rows) | (column >= columns)
        within = np.flatnonzero(~hidden)
        measured = depth[row[within], column[within]]
        hidden[within] = (measured > 0) & (measured < away[within] - margin)
        return np.asarray(hidden)


def table_view(optics: Optics, back: NDArray[np.float64], shape: tuple[int, int]) -> TableView:
    """Return the view of a table by a camera.

    Parameters
    ----------
    optics
        The camera.
    back
        Transform (4, 4) from the frame of the cloud to that of the table.
    shape
        Rows and columns of the image.

    Returns
    -------
    TableView
        Projection of points of the table's frame, and the depth of the plane of the table.
    """
    out = np.linalg.inv(back)
    matrix = optics.matrix @ out[:3, :3]
    offset = optics.matrix @ (out[:3, 3] - optics.eye)
    across, down, ahead = back[2, :3] @ np.linalg.inv(optics.matrix)
    drop = across * np.arange(shape[1]) + down * np.arange(shape[0])[:, None] + ahead
    height = float(back[2, :3] @ optics.eye + back[2, 3])
    with np.errstate(divide="ignore", invalid="ignore"):
        level = np.where(drop * height < 0, -height / drop, np.inf)
    return TableView(matrix, offset, back, level.astype(np.float32))


def enlarged(mask: NDArray[np.bool_], stride: int, shape: tuple[int, int]) -> NDArray[np.bool_]:
    """Return a mask of every ``stride``-th pixel as one of all pixels.

    Parameters
    ----------
    mask
        Mask (r, c) of the pixels that are compared.
    stride
        Every how many rows and columns are compared.
    shape
        Rows and columns of the whole image.

    Returns
    -------
    ndarray
        Mask of this shape.
    """
    large = np.repeat(np.repeat(mask, stride, axis=0), stride, axis=1)
    whole = np.zeros(shape, np.bool_)
    rows, columns = min(shape[0], large.shape[0]), min(shape[1], large.shape[1])
    whole[:rows, :columns] = large[:rows, :columns]
    return whole
