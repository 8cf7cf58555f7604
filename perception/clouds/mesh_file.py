"""Meshes as files: PLY, OBJ and STL, told by their content or suffix."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from deixis.perception.clouds.content import Content, content_of
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.clouds.obj import read_obj
from deixis.perception.clouds.ply import read_ply_mesh
from deixis.perception.clouds.stl import read_stl
from deixis.perception.errors import CloudError


def read_mesh(path: str | Path) -> Mesh:
    """Reads a mesh in the file's own unit and frame; polygons become fans of triangles.

    Raises CloudError, with the file and the place in it, where it is none or is damaged.
    """
    content = content_of(path)
    mesh = _mesh(content, Path(path).suffix.lower())
    finite = np.isfinite(mesh.vertices).all(axis=1)
    if not finite.all():
        raise CloudError(f"{content.name}: vertex {np.argmin(finite)} has a coordinate that is not finite; correct it")
    return mesh


def _mesh(content: Content, suffix: str) -> Mesh:
    if content.data[:4].tobytes() in (b"ply\n", b"ply\r") or suffix == ".ply":
        return read_ply_mesh(content)
    if suffix == ".obj":
        return read_obj(content)
    if suffix == ".stl":
        return read_stl(content)
    raise CloudError(f"{content.name}: this is no mesh that is read; PLY, OBJ (.obj) and STL (.stl) are")
