"""Meshes from OBJ and STL files, and arrays that a mesh refuses."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from deixis.perception.clouds.mesh import Mesh, fans
from deixis.perception.clouds.mesh_file import read_mesh
from deixis.perception.errors import CloudError

OBJ = """# a square plate and a fork of one triangle
mtllib none.mtl
v 0 0 0
v 1 0 0 1.0
v 1 1 0
v 0 1 0
vt 0 0
vn 0 0 1
o plate
usemtl china
f 1/1/1 2/1/1 3//1 4
g fork left
v 2 0 0
v 3 0 0
v 2 0.5 -1e-1
f -3 -2 -1
l 1 2
"""
TRIANGLES = [[(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0), (0, 1, 0)]]


def mesh_in(folder: Path, name: str, content: bytes) -> Mesh:
    file = folder / name
    file.write_bytes(content)
    return read_mesh(file)


def test_obj_faces_become_fans_and_keep_their_parts(tmp_path: Path) -> None:
    mesh = mesh_in(tmp_path, "table.obj", OBJ.encode())
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [4, 5, 6]]
    assert mesh.names == ("plate", "fork left")
    fork = mesh.part_named("fork left")
    assert fork.vertices.shape == (3, 3)
    np.testing.assert_array_equal(fork.vertices[fork.faces[0]], [[2, 0, 0], [3, 0, 0], [2, 0.5, -0.1]])
    with pytest.raises(CloudError, match="no part 'spoon'; its parts are: plate, fork left"):
        mesh.part_named("spoon")


def test_obj_faces_before_any_name_are_in_a_part_without_one(tmp_path: Path) -> None:
    assert mesh_in(tmp_path, "a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").names == ("",)


def test_obj_counts_back_from_the_last_vertex_so_far(tmp_path: Path) -> None:
    lines = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n"
    assert mesh_in(tmp_path, "a.obj", lines).faces.tolist() == [[0, 1, 2], [3, 4, 5]]


def binary_stl(triangles: list[list[tuple[int, int, int]]], header: bytes = b"") -> bytes:
    body = b"".join(struct.pack("<12fH", 0, 0, 1, *(x for corner in t for x in corner), 0) for t in triangles)
    return header.ljust(80, b"\0") + struct.pack("<I", len(triangles)) + body


def ascii_stl(triangles: list[list[tuple[int, int, int]]]) -> bytes:
    facets = "".join(
        "facet normal 0 0 1\nouter loop\n" + "".join(f"  vertex {x} {y} {z}\n" for x, y, z in t) + "endloop\nendfacet\n"
        for t in triangles
    )
    return f"solid square\n{facets}endsolid square\n".encode()


@pytest.mark.parametrize("content", [binary_stl(TRIANGLES), binary_stl(TRIANGLES, b"solid"), ascii_stl(TRIANGLES)])
def test_stl_corners_at_one_place_are_one_vertex(content: bytes, tmp_path: Path) -> None:
    mesh = mesh_in(tmp_path, "square.stl", content)
    assert mesh.vertices.shape == (4, 3)
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], TRIANGLES)


def test_all_solids_of_an_stl_file_are_one_mesh(tmp_path: Path) -> None:
    solid = ascii_stl(TRIANGLES[:1]).replace(b"square", b"vertex buffer")
    mesh = mesh_in(tmp_path, "two.stl", solid + ascii_stl(TRIANGLES[1:]))
    np.testing.assert_array_equal(mesh.vertices[mesh.faces], TRIANGLES)


def test_fans_leave_out_polygons_of_fewer_than_three_corners() -> None:
    faces, polygon = fans(np.array([2, 0, 5, 3]), np.array([9, 9, 0, 1, 2, 3, 4, 5, 6, 7]))
    assert faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 3, 4], [5, 6, 7]]
    assert polygon.tolist() == [2, 2, 2, 3]


@pytest.mark.parametrize(
    ("faces", "names", "part"),
    [
        (np.array([[0, 1, 3]], np.int32), (), None),
        (np.array([[-1, 1, 2]], np.int32), (), None),
        (np.array([0, 1, 2], np.int32), (), None),
        (np.array([[0, 1, 2]], np.int32), ("a",), np.array([1], np.int32)),
        (np.array([[0, 1, 2]], np.int32), ("a",), np.array([0, 0], np.int32)),
    ],
)
def test_a_mesh_refuses_arrays_that_do_not_fit(
    faces: np.ndarray[tuple[int, ...], np.dtype[np.int32]],
    names: tuple[str, ...],
    part: np.ndarray[tuple[int, ...], np.dtype[np.int32]] | None,
) -> None:
    with pytest.raises(CloudError):
        Mesh(np.eye(3), faces, names, part)
