"""Meshes as files: PLY, OBJ and STL, told by their content or suffix.

OBJ, Wavefront's format, has vertices (``v``), faces (``f``) and named parts (``o``, ``g``). Normals, texture and
materials are passed over, as are lines and points. A face's corners count vertices from 1, or back from the last one so
far where they are negative; polygons become fans. STL has triangles without names: binary (80 bytes, a count, 50 bytes
a triangle) or ascii (``vertex x y z``). Corners at one place become one vertex. Normals are passed over, since the
order of corners says the same.

The readers of OBJ and STL are our own. Those of trimesh 5.2 were measured beside them, on a sphere of 82,000 triangles
(medians): OBJ 72 ms against our 183 ms (188 ms where one face is a polygon), binary STL the same 138 ms, ascii STL
479 ms against 544 ms, with a peak of 177 MiB against 29 MiB for a file of 23 MiB. They are not taken because they read
wrong or damaged files without an error. OBJ: corner 0 is taken for the first vertex, and negative corners count back
from the last vertex of the file. Ascii STL: numbers of one line are taken for those of the next, a second solid that is
cut short is dropped, and a solid with the word vertex in its name is refused. Neither names the line of an error.
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
from deixis.perception.clouds.mesh import Mesh, fans
from deixis.perception.clouds.ply import read_ply_mesh
from deixis.perception.errors import CloudError

_STL_HEADER = 84
_STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_mesh(path: str | Path) -> Mesh:
    """Read a mesh in the file's own unit and frame; polygons become fans of triangles.

    Raises CloudError, with the file and the place in it, where it is none or is damaged.
    """
    content, suffix = content_of(path), Path(path).suffix.lower()
    if content.data[:4].tobytes() in (b"ply\n", b"ply\r") or suffix == ".ply":
        mesh = read_ply_mesh(content)
    elif suffix == ".obj":
        mesh = read_obj(content)
    elif suffix == ".stl":
        mesh = read_stl(content)
    else:
        raise CloudError(f"{content.name}: this is no mesh that is read; PLY, OBJ (.obj) and STL (.stl) are")
    finite = np.isfinite(mesh.vertices).all(axis=1)
    if not finite.all():
        raise CloudError(f"{content.name}: vertex {np.argmin(finite)} has a coordinate that is not finite; correct it")
    return mesh


@dataclass
class _ObjLines:
    """Arrays of plain numbers, so that memory stays near the size of the text."""

    vertices: array[float] = field(default_factory=lambda: array("d"))
    lengths: array[int] = field(default_factory=lambda: array("q"))
    corners: array[int] = field(default_factory=lambda: array("q"))
    parts: array[int] = field(default_factory=lambda: array("q"))
    names: dict[str, int] = field(default_factory=dict)
    part: int = -1


def read_obj(content: Content) -> Mesh:
    """Return the mesh in an OBJ file; raises CloudError, with the line, where it is malformed or has no face.

    The parts are those that have faces, by the last ``o`` or ``g`` before each; faces before any are in the part ''.
    """
    parsed = _ObjLines()
    for number, line in enumerate(io.BytesIO(content.data.data), start=1):
        if len(line) > MAX_LINE:
            raise CloudError(f"{content.name}:{number}: a line of more than {MAX_LINE} bytes; shorten it")
        _take_obj_line(line.decode("latin-1").split(), parsed, f"{content.name}:{number}")
    if not parsed.lengths:
        raise CloudError(f"{content.name}: there is no face (f) in this file; it is no mesh")
    faces, polygon = fans(np.array(parsed.lengths), np.array(parsed.corners))
    used, part = np.unique(np.array(parsed.parts)[polygon], return_inverse=True)
    names = list(parsed.names)
    vertices = np.array(parsed.vertices).reshape(-1, 3)
    return Mesh(vertices, faces, tuple(names[place] for place in used.tolist()), part.astype(np.int32))


def _take_obj_line(words: list[str], parsed: _ObjLines, where: str) -> None:
    """Take in one line."""
    keyword = words[0] if words else "#"
    if keyword == "v":
        try:
            x, y, z = (float(w) for w in words[1:][:3])
        except ValueError:
            raise CloudError(f"{where}: a vertex has three numbers, x, y and z") from None
        parsed.vertices.extend((x, y, z))
    elif keyword == "f":
        if len(words) < 4:
            raise CloudError(f"{where}: a face of {len(words) - 1} corners; it has 3 at the least")
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
        raise CloudError(f"{where}: '{shown(word)}' is no corner of a face; it is a vertex's number, from 1") from None
    row = number - 1 if number > 0 else vertices + number
    if number == 0 or not 0 <= row < vertices:
        raise CloudError(f"{where}: the corner '{shown(word)}' is none of the {vertices} vertices so far, from 1 on")
    return row


def read_stl(content: Content) -> Mesh:
    """Return the mesh in an STL file; raises CloudError, with the line or byte, where it is malformed or has no
    triangle."""
    # Binary files may begin with 'solid' too, so that their length, which the count gives, decides.
    declared = int(content.data[80:_STL_HEADER].view("<u4")[0]) if len(content) >= _STL_HEADER else 0
    if _STL_HEADER + declared * _STL_TRIANGLE.itemsize == len(content):
        corners = content.data[_STL_HEADER:].view(_STL_TRIANGLE)["corners"].reshape(-1, 3).astype(np.float64)
    elif content.data[:5].tobytes() == b"solid":
        corners = _ascii_corners(content)
    else:
        raise CloudError(
            f"{content.name}: byte 80: {declared} triangles are declared, and the file is {len(content)} bytes long,"
            f" not {_STL_HEADER + declared * _STL_TRIANGLE.itemsize}; correct the count, or get the whole file"
        )
    if not len(corners):
        raise CloudError(f"{content.name}: there is no triangle in this file; it is no mesh")
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
                raise CloudError(f"{content.name}:{number}: a vertex has three numbers, x, y and z") from None
            corners.extend((x, y, z))
    if len(corners) % 9:
        raise CloudError(f"{content.name}: {len(corners) // 3} corners make no triangles; get the whole file")
    return np.array(corners).reshape(-1, 3)
