"""Point clouds, as a depth camera or a simulator produces them, before any object is recognised."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.answers import count
from deixis.arguments import typed
from deixis.perception.errors import CloudError


@dataclass(frozen=True, eq=False, repr=False)
class PointCloud:
    """Points in metres, in one frame, with their colours, labels and normals.

    A point without depth keeps its row; at least one of its coordinates is not finite.

    Parameters
    ----------
    points
        Coordinates, shape (n, 3), in metres.
    colours
        Red, green and blue from 0 to 255, shape (n, 3), or None.
    labels
        Number of the segment of each point, shape (n,), or None.
    normals
        Unit vectors, shape (n, 3), or None.
    organised
        Rows and columns, if the points are the pixels of an image, row by row (n = rows * columns); else None.
    origin
        Position of the sensor in the frame of the points, in metres.

    Raises
    ------
    CloudError
        If the shape of an array does not fit the points.

    Examples
    --------
    >>> cloud = PointCloud(np.array([[0, 0, 1], [np.nan, 0, 0]], np.float32), organised=(1, 2))
    >>> cloud
    <PointCloud 2 points, image of 1 row by 2 columns>
    >>> len(cloud), cloud.finite.tolist()
    (2, [True, False])
    >>> len(cloud.take(cloud.finite))
    1
    """

    points: NDArray[np.float32]  # (n, 3)
    colours: NDArray[np.uint8] | None = None  # (n, 3): red, green, blue
    labels: NDArray[np.int32] | None = None  # (n,): the number of a segment
    normals: NDArray[np.float32] | None = None  # (n, 3): unit vectors
    organised: tuple[int, int] | None = None
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __repr__(self) -> str:
        arrays = [name for name in ("colours", "labels", "normals") if getattr(self, name) is not None]
        parts = [count(len(self.points), "point"), *(["with " + ", ".join(arrays)] if arrays else [])]
        if self.organised is not None:
            rows, columns = self.organised
            parts.append(f"image of {count(rows, 'row')} by {count(columns, 'column')}")
        return f"<PointCloud {', '.join(parts)}>"

    def __post_init__(self) -> None:
        for name, kinds in (("points", "fiu"), ("colours", "iu"), ("labels", "iu"), ("normals", "f")):
            array = getattr(self, name)
            optional = array is None and name != "points"
            if not optional and (not isinstance(array, np.ndarray) or array.ndim == 0 or array.dtype.kind not in kinds):
                numbers = "numbers" if "f" in kinds else "whole numbers"
                given = f"of {array.dtype}" if isinstance(array, np.ndarray) else type(array).__name__
                raise CloudError(f"`{name}` must be an array of {numbers}, got {given}")
        typed("organised", self.organised, "tuple[int, int] | None")
        n = len(self.points)
        wanted = {"points": (n, 3), "colours": (n, 3), "labels": (n,), "normals": (n, 3)}
        for name, shape in wanted.items():
            array = getattr(self, name)
            if array is not None and array.shape != shape:
                wanted_shape = "(n, 3)" if name == "points" else f"{shape}, a row for each point"
                raise CloudError(f"`{name}` must have shape {wanted_shape}, got {array.shape}")
        if self.organised is not None and (self.organised[0] * self.organised[1] != n or min(self.organised) < 0):
            rows, columns = self.organised
            raise CloudError(
                f"an image of {rows} rows and {columns} columns must have {rows * columns} points, got {n}"
            )

    def __len__(self) -> int:
        return len(self.points)

    @property
    def finite(self) -> NDArray[np.bool_]:
        """Mask of the points that have a depth, shape (n,)."""
        x, y, z = (np.isfinite(self.points[:, axis]) for axis in range(3))
        result: NDArray[np.bool_] = x & y & z
        return result

    def take(self, chosen: NDArray[np.bool_] | NDArray[np.integer]) -> PointCloud:
        """Return a cloud of chosen points, with their colours, labels and normals.

        Parameters
        ----------
        chosen
            Mask of shape (n,), or indices of the points, shape (k,).

        Returns
        -------
        PointCloud
            A cloud of the k chosen points, which is not organised.
        """
        try:
            points = self.points[chosen]
        except IndexError as error:
            raise CloudError(f"`chosen` must be a mask or indices of the {len(self)} points: {error}") from error
        return PointCloud(
            points,
            None if self.colours is None else self.colours[chosen],
            None if self.labels is None else self.labels[chosen],
            None if self.normals is None else self.normals[chosen],
            origin=self.origin,
        )

    @classmethod
    def from_open3d(cls, cloud: Any) -> PointCloud:
        """Return the points of an Open3D cloud, with their colours and normals.

        Parameters
        ----------
        cloud
            An ``open3d.geometry.PointCloud`` of n points.

        Returns
        -------
        PointCloud
            A cloud of n points, which is not organised.

        Examples
        --------
        >>> PointCloud.from_open3d(PointCloud(np.array([[0, 0, 1]], np.float32)).to_open3d()).points.tolist()
        [[0.0, 0.0, 1.0]]
        """
        colours = np.asarray(cloud.colors) if cloud.has_colors() else None
        return cls(
            np.asarray(cloud.points, dtype=np.float32),
            None if colours is None else np.clip(np.round(255 * colours), 0, 255).astype(np.uint8),
            normals=np.asarray(cloud.normals, dtype=np.float32) if cloud.has_normals() else None,
        )

    def to_open3d(self) -> Any:
        """Return the points that have a depth for Open3D, with their colours and normals.

        Returns
        -------
        open3d.geometry.PointCloud
            The points with finite coordinates.

        Raises
        ------
        MissingExtraError
            If Open3D is not installed.

        Examples
        --------
        >>> cloud = PointCloud(np.array([[0, 0, 1], [np.nan, 0, 0]], np.float32))
        >>> cloud.to_open3d()
        PointCloud with 1 points.
        """
        from deixis.perception.open3d import open3d

        kept = self.take(self.finite)
        cloud = open3d().geometry.PointCloud(open3d().utility.Vector3dVector(kept.points.astype(np.float64)))
        if kept.colours is not None:
            cloud.colors = open3d().utility.Vector3dVector(kept.colours / 255.0)
        if kept.normals is not None:
            cloud.normals = open3d().utility.Vector3dVector(kept.normals.astype(np.float64))
        return cloud
