"""Triangle meshes: the surfaces of objects, from a design program or a scanner."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import CloudError


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles between vertices, in the unit and frame of the file.

    ``names`` lists the parts that the file names (groups in OBJ); ``part`` holds the index of the part of each face.
    Raises CloudError if the arrays do not fit each other.

    >>> mesh = Mesh(np.eye(3), np.array([[0, 1, 2]], np.int32), ("fork",), np.array([0], np.int32))
    >>> len(mesh.part_named("fork").faces)
    1
    """

    vertices: NDArray[np.float64]  # (n, 3)
    faces: NDArray[np.int32]  # (m, 3): rows of vertices
    names: tuple[str, ...] = ()
    part: NDArray[np.int32] | None = None  # (m,): index in names

    def __post_init__(self) -> None:
        for name, array in (("vertices", self.vertices), ("faces", self.faces)):
            if array.ndim != 2 or array.shape[1] != 3:
                raise CloudError(f"`{name}` must have shape (n, 3), got {array.shape}")
        if self.faces.size and not (self.faces.min() >= 0 and self.faces.max() < len(self.vertices)):
            raise CloudError(
                f"`faces` must hold rows of vertices from 0 to {len(self.vertices) - 1}, got {self.faces.min()} to"
                f" {self.faces.max()}"
            )
        if self.part is not None and (
            self.part.shape != (len(self.faces),)
            or (self.part.size and not 0 <= self.part.min() <= self.part.max() < len(self.names))
        ):
            raise CloudError(
                f"`part` must hold an index from 0 to {len(self.names) - 1} for each of {len(self.faces)} faces, "
                f"got shape {self.part.shape}"
            )

    def part_named(self, name: str) -> Mesh:
        """Return the faces of one part with their vertices only.

        Parameters
        ----------
        name
            Name of the part.

        Returns
        -------
        Mesh
            The mesh of the part.

        Raises
        ------
        CloudError
            If there is no such part.
        """
        if self.part is None or name not in self.names:
            known = ", ".join(self.names) or "none"
            raise CloudError(f"the mesh has no part '{name}'; its parts are: {known}")
        faces = self.faces[self.part == self.names.index(name)]
        used, inverse = np.unique(faces, return_inverse=True)
        return Mesh(self.vertices[used], inverse.reshape(-1, 3).astype(np.int32))


def fans(lengths: NDArray[np.int64], corners: NDArray[np.int64]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Split polygons into triangles, each polygon as a fan around its first corner.

    Parameters
    ----------
    lengths
        Number of corners of each polygon, shape (polygons,); one with fewer than three corners has no triangle.
    corners
        Corners of all polygons one after the other, shape (corners,).

    Returns
    -------
    The corners of the triangles, shape (m, 3), and the index of the polygon of each, shape (m,).

    Examples
    --------
    >>> fans(np.array([3, 4]), np.array([0, 1, 2, 5, 6, 7, 8]))[0].tolist()
    [[0, 1, 2], [5, 6, 7], [5, 7, 8]]
    """
    starts = np.cumsum(lengths) - lengths
    many = np.maximum(lengths - 2, 0)
    polygon = np.repeat(np.arange(len(lengths)), many)
    step = np.arange(len(polygon)) - np.repeat(np.cumsum(many) - many, many)
    first = starts[polygon]
    return corners[np.stack([first, first + step + 1, first + step + 2], axis=1)].astype(np.int32), polygon
