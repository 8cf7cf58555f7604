"""Read meshes from PLY, OBJ and STL files, identified by their content or suffix.

OBJ, the format of Wavefront, has vertices (``v``), faces (``f``) and named parts (``o``, ``g``). Normals, textures,
materials, lines and points are skipped. The corners of a face count vertices from 1, or backwards from the last vertex
so far if they are negative; polygons become fans of triangles. STL has triangles without names: binary (80 bytes, a
count, 50 bytes per triangle) or ascii (``vertex x y z``). Corners with equal coordinates become one vertex. Normals are
skipped, because the order of the corners gives the same direction.

The readers of OBJ and STL are our own. We compared them with those of trimesh 5.2 on a sphere of 82,000 triangles
(medians of the time, trimesh first). OBJ: 72 ms and 183 ms (188 ms if one face is a polygon). Binary STL: 138 ms both.
Ascii STL: 479 ms and 544 ms, with a peak memory of 177 MiB and 29 MiB for a file of 23 MiB. We do not use trimesh
because it reads some wrong or damaged files without an error. In OBJ, it takes corner 0 for the first vertex, and
counts negative corners from the last vertex of the file. In ascii STL, it takes numbers of one line for those of the
next, drops a second solid that is truncated, and refuses a solid with the word vertex in its name. It never names the
line of an error.
"""

from __future__ import annotations

import io
from array import array
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deixis.perception.checks import shown
from deixis.perception.clouds.content import MAX_LINE, Content, content_of
from deixis.perception.clouds.formats.ply import read_ply_mesh
from deixis.perception.clouds.mesh import Mesh, fans
from deixis.perception.errors import CloudError

_STL_HEADER = 84
_STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_mesh(path: str | Path) -> Mesh:
    """Read a mesh from a PLY, OBJ or STL file.

    Polygons become fans of triangles.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Mesh
        The mesh in the unit and frame of the file.

    Raises
    ------
    CloudError
        If the file is not a mesh or is damaged; the message names the place in it.
    """
    content, suffix = content_of(path), Path(path).suffix.lower()
    if content.data[:4].tobytes() in (b"ply\n", b"ply\r") or suffix == ".ply":
        mesh = read_ply_mesh(content)
    elif suffix == ".obj":
        mesh = read_obj(content)
    elif suffix == ".stl":
        mesh = read_stl(content)
    else:
        raise CloudError(f"{content.name}: unknown mesh format; give a PLY, OBJ (.obj) or STL (.stl) file")
    finite = np.isfinite(mesh.vertices).all(axis=1)
    if not finite.all():
        raise CloudError(f"{content.name}: vertex {np.argmin(finite)} has a coordinate that is not finite; correct it")
    return mesh


@dataclass
class _ObjLines:
    """Content of an OBJ file in plain arrays, so that memory stays near the size of the text."""

    vertices: array[float] = field(default_factory=lambda: array("d"))
    lengths: array[int] = field(default_factory=lambda: array("q"))
    corners: array[int] = field(default_factory=lambda: array("q"))
    parts: array[int] = field(default_factory=lambda: array("q"))
    names: dict[str, int] = field(default_factory=dict)
    part: int = -1


def read_obj(content: Content) -> Mesh:
    """Return the mesh of an OBJ file.

    The last ``o`` or ``g`` before a face names its part; faces before the first one belong to the part ''. Parts
    without faces are left out.

    Parameters
    ----------
    content
        The file.

    Returns
    -------
    Mesh
        The mesh with its parts.

    Raises
    ------
    CloudError
        If the file is malformed or has no face; the message has the line.
    """
    parsed = _ObjLines()
    for number, line in enumerate(io.BytesIO(content.data.data), start=1):
        if len(line) > MAX_LINE:
            raise CloudError(
                f"{content.name}:{number}: a line must have at most {MAX_LINE} bytes, got more; shorten it"
            )
        _take_obj_line(line.decode("latin-1").split(), parsed, f"{content.name}:{number}")
    if not parsed.lengths:
        raise CloudError(f"{content.name}: there is no face (f) in this file; give a mesh")
    faces, polygon = fans(np.array(parsed.lengths), np.array(parsed.corners))
    used, part = np.unique(np.array(parsed.parts)[polygon], return_inverse=True)
    names = list(parsed.names)
    vertices = np.array(parsed.vertices).reshape(-1, 3)
    return Mesh(vertices, faces, tuple(names[place] for place in used.tolist()), part.astype(np.int32))


def _take_obj_line(words: list[str], parsed: _ObjLines, where: str) -> None:
    """Add the words of one line to ``parsed``."""
    keyword = words[0] if words else "#"
    if keyword == "v":
        try:
            x, y, z = (float(w) for w in words[1:][:3])
        except ValueError:
            raise CloudError(f"{where}: a vertex must have three numbers, x, y and z; correct them") from None
        parsed.vertices.extend((x, y, z))
    elif keyword == "f":
        if len(words) < 4:
            raise CloudError(f"{where}: a face must have at least 3 corners, got {len(words) - 1}; take it out")
        parsed.lengths.append(len(words) - 1)
        parsed.corners.extend(_corner(word, len(parsed.vertices) // 3, where) for word in words[1:])
        if parsed.part < 0:
            parsed.part = parsed.names.setdefault("", len(parsed.names))
        parsed.parts.append(parsed.part)
    elif keyword in ("o", "g"):
        parsed.part = parsed.names.setdefault(" ".join(words[1:]), len(parsed.names))


def _corner(word: str, vertices: int, where: str) -> int:
    """Return the row of the vertex that v, v/vt, v//vn or v/vt/vn names."""
    try:
        number = int(word.partition("/")[0])
    except ValueError:
        raise CloudError(
            f"{where}: a corner must be the number of a vertex, from 1, got '{shown(word)}'; correct it"
        ) from None
    row = number - 1 if number > 0 else vertices + number
    if number == 0 or not 0 <= row < vertices:
        raise CloudError(
            f"{where}: a corner must be one of the {vertices} vertices so far, from 1, got '{shown(word)}'"
        )
    return row


def read_stl(content: Content) -> Mesh:
    """Return the mesh of an STL file.

    Parameters
    ----------
    content
        The file, text or binary.

    Returns
    -------
    Mesh
        The mesh.

    Raises
    ------
    CloudError
        If the file is malformed or has no triangle; the message has the line or byte.
    """
    # A binary file may begin with 'solid' too, so the length that its count implies decides.
    declared = int(content.data[80:_STL_HEADER].view("<u4")[0]) if len(content) >= _STL_HEADER else 0
    if _STL_HEADER + declared * _STL_TRIANGLE.itemsize == len(content):
        corners = content.data[_STL_HEADER:].view(_STL_TRIANGLE)["corners"].reshape(-1, 3).astype(np.float64)
    elif content.data[:5].tobytes() == b"solid":
        corners = _ascii_corners(content)
    else:
        raise CloudError(
            f"{content.name}: byte 80: a file of {declared} triangles must have"
            f" {_STL_HEADER + declared * _STL_TRIANGLE.itemsize} bytes, got {len(content)}; correct the count, or get"
            " the whole file"
        )
    if not len(corners):
        raise CloudError(f"{content.name}: there is no triangle in this file; give a mesh")
    vertices, faces = np.unique(corners, axis=0, return_inverse=True)
    return Mesh(vertices, faces.reshape(-1, 3).astype(np.int32))


def _ascii_corners(content: Content) -> NDArray[np.float64]:
    corners = array("d")
    for number, line in enumerate(io.BytesIO(content.data.data), start=1):
        words = line[:MAX_LINE].split()
        if words[:1] == [b"vertex"]:
            try:
                x, y, z = (float(word) for word in words[1:])
            except ValueError:
                raise CloudError(
                    f"{content.name}:{number}: a vertex must have three numbers, x, y and z; correct them"
                ) from None
            corners.extend((x, y, z))
    if len(corners) % 9:
        raise CloudError(
            f"{content.name}: the number of corners must be a multiple of 3, got {len(corners) // 3}; get the whole"
            " file"
        )
    return np.array(corners).reshape(-1, 3)
