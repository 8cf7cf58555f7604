"""PLY, the Stanford polygon format, as clouds and as meshes: ascii, and binary of either order of bytes.

The format: G. Turk, "The PLY Polygon File Format" (1994). Of the element ``vertex`` the columns that
:mod:`deixis.perception.clouds.columns` knows are read, of ``face`` the list of its corners; everything else is passed
over. A file read as a cloud is checked whole all the same.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.columns import KNOWN, POINT, Columns, cloud_of_columns
from deixis.perception.clouds.content import Content
from deixis.perception.clouds.mesh import Mesh, fans
from deixis.perception.clouds.ply_header import read_header
from deixis.perception.clouds.ply_tables import Table, binary_table, text_table
from deixis.perception.errors import CloudError

CORNERS = frozenset({"vertex_indices", "vertex_index"})


def read_ply(content: Content) -> PointCloud:
    """The vertices as a cloud; raises CloudError, with the line or byte, where the file is malformed."""
    columns, _, _ = _body(content)
    return cloud_of_columns(columns, content.name)


def read_ply_mesh(content: Content) -> Mesh:
    """Vertices and faces; raises CloudError where there are none, or where the file is malformed."""
    columns, lengths, corners = _body(content)
    missing = [name for name in POINT if name not in columns]
    if missing:
        raise CloudError(f"{content.name}: there is no property '{missing[0]}' of vertex; a vertex has x, y and z")
    faces, _ = fans(lengths, corners)
    if not len(faces):
        raise CloudError(f"{content.name}: there is no face in this file; it is a cloud and no mesh")
    return Mesh(np.stack([columns[name] for name in POINT], axis=1).astype(np.float64), faces)


def _body(content: Content) -> tuple[Columns, NDArray[np.int64], NDArray[np.int64]]:
    """The vertices' columns, how many corners each face has, and all their corners one after the other."""
    header = read_header(content)
    read = text_table if header.encoding == "ascii" else binary_table
    tables: dict[str, Table] = {}
    at = header.end
    for element in header.elements:
        wanted = {"vertex": KNOWN, "face": CORNERS}.get(element.name, frozenset[str]())
        tables[element.name] = read(content, at, element, wanted)
        at = tables[element.name].end
    content.refuse_rest(at)
    face = tables.get("face")
    if face is None or face.lengths is None or face.values is None:
        return tables["vertex"].columns, np.empty(0, np.int64), np.empty(0, np.int64)
    vertices = next(element.rows for element in header.elements if element.name == "vertex")
    return tables["vertex"].columns, face.lengths, _corners(content.name, vertices, face.lengths, face.values)


def _corners(file: str, vertices: int, lengths: NDArray[np.int64], values: NDArray[np.number]) -> NDArray[np.int64]:
    """The values as corners; raises CloudError where one is no vertex."""
    good = (values >= 0) & (values < vertices) & (values == np.floor(values))
    if not good.all():
        wrong = int(np.argmin(good))
        face = int(np.searchsorted(np.cumsum(lengths), wrong, side="right"))
        raise CloudError(
            f"{file}: face {face} has vertex {values[wrong]:g} as a corner, and there are {vertices}, from 0 on;"
            " correct the face or the count"
        )
    return values.astype(np.int64)
