"""OBJ, Wavefront's mesh format: vertices (``v``), faces (``f``) and named parts (``o``, ``g``).

Normals, texture and materials are passed over, as are lines and points. A face's corners count vertices from 1, or back
from the last one where they are negative; polygons become fans.
"""

from __future__ import annotations

import io
from array import array
from dataclasses import dataclass, field

import numpy as np

from deixis.perception.checks import shown
from deixis.perception.clouds.content import MAX_LINE, Content
from deixis.perception.clouds.mesh import Mesh, fans
from deixis.perception.errors import CloudError


@dataclass
class _Parsed:
    """Arrays of plain numbers, so that memory stays near the size of the text."""

    vertices: array[float] = field(default_factory=lambda: array("d"))
    lengths: array[int] = field(default_factory=lambda: array("q"))
    corners: array[int] = field(default_factory=lambda: array("q"))
    parts: array[int] = field(default_factory=lambda: array("q"))
    names: dict[str, int] = field(default_factory=dict)
    part: int = -1


def read_obj(content: Content) -> Mesh:
    """The mesh in an OBJ file; raises CloudError, with the line, where it is malformed or has no face.

    The parts are those that have faces, by the last ``o`` or ``g`` before each; faces before any are in the part ''.
    """
    parsed = _Parsed()
    for number, line in enumerate(io.BytesIO(content.data.data), start=1):
        if len(line) > MAX_LINE:
            raise CloudError(f"{content.name}:{number}: a line of more than {MAX_LINE} bytes; shorten it")
        _take(line.decode("latin-1").split(), parsed, f"{content.name}:{number}")
    if not parsed.lengths:
        raise CloudError(f"{content.name}: there is no face (f) in this file; it is no mesh")
    faces, polygon = fans(np.array(parsed.lengths), np.array(parsed.corners))
    used, part = np.unique(np.array(parsed.parts)[polygon], return_inverse=True)
    names = list(parsed.names)
    vertices = np.array(parsed.vertices).reshape(-1, 3)
    return Mesh(vertices, faces, tuple(names[place] for place in used.tolist()), part.astype(np.int32))


def _take(words: list[str], parsed: _Parsed, where: str) -> None:
    """Takes in one line."""
    keyword = words[0] if words else "#"
    if keyword == "v":
        parsed.vertices.extend(_vertex(words[1:], where))
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


def _vertex(words: list[str], where: str) -> tuple[float, float, float]:
    try:
        x, y, z = (float(word) for word in words[:3])
    except ValueError:
        raise CloudError(f"{where}: a vertex has three numbers, x, y and z") from None
    return x, y, z


def _corner(word: str, vertices: int, where: str) -> int:
    """The row of the vertex that v, v/vt, v//vn or v/vt/vn names."""
    try:
        number = int(word.partition("/")[0])
    except ValueError:
        raise CloudError(f"{where}: '{shown(word)}' is no corner of a face; it is a vertex's number, from 1") from None
    row = number - 1 if number > 0 else vertices + number
    if number == 0 or not 0 <= row < vertices:
        raise CloudError(f"{where}: the corner '{shown(word)}' is none of the {vertices} vertices so far, from 1 on")
    return row
