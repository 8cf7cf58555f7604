"""STL, triangles without names: binary (80 bytes, a count, 50 bytes a triangle) and ascii (``vertex x y z``).

Corners at one place become one vertex. Normals are passed over, since the order of corners says the same.
"""

from __future__ import annotations

import io
from array import array

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.content import MAX_LINE, Content
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import CloudError

_HEADER = 84
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_stl(content: Content) -> Mesh:
    """The mesh in an STL file; raises CloudError, with the line or byte, where it is malformed or has no triangle."""
    # Binary files may begin with 'solid' too, so that their length, which the count gives, decides.
    declared = int(content.data[80:_HEADER].view("<u4")[0]) if len(content) >= _HEADER else 0
    if _HEADER + declared * _TRIANGLE.itemsize == len(content):
        corners = content.data[_HEADER:].view(_TRIANGLE)["corners"].reshape(-1, 3).astype(np.float64)
    elif content.data[:5].tobytes() == b"solid":
        corners = _ascii(content)
    else:
        raise CloudError(
            f"{content.name}: byte 80: {declared} triangles are declared, and the file is {len(content)} bytes long,"
            f" not {_HEADER + declared * _TRIANGLE.itemsize}; correct the count, or get the whole file"
        )
    if not len(corners):
        raise CloudError(f"{content.name}: there is no triangle in this file; it is no mesh")
    vertices, faces = np.unique(corners, axis=0, return_inverse=True)
    return Mesh(vertices, faces.reshape(-1, 3).astype(np.int32))


def _ascii(content: Content) -> NDArray[np.float64]:
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
