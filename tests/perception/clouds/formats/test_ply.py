"""PLY files written by hand, in all three formats, read as clouds and as meshes."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.clouds.mesh_file import read_mesh
from deixis.perception.errors import CloudError

ORDERS = [("binary_little_endian", "<"), ("binary_big_endian", ">")]

SQUARE = """ply
format {format} 1.0
comment a square and a triangle
obj_info by hand
element vertex 5
property double x
property float y
property short z
property uchar red
property uchar green
property uchar blue
property list uchar ushort near
element edge 1
property list int float weights
property int number
element face 3
property uchar flags
property list uchar int vertex_indices
property float area
element nothing 0
property int x
end_header
"""
VERTICES = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)]
FACES = [(0, 1, 2, 3), (0, 1, 4), (2, 3)]


def square(kind: str, order: str) -> bytes:
    parts = []
    for k, vertex in enumerate(VERTICES):
        near = list(range(k))
        if order:
            parts.append(struct.pack(f"{order}dfh3BB{k}H", *vertex[:2], vertex[2], 10 * k, 20, 30, k, *near))
        else:
            parts.append(" ".join(map(str, [*vertex, 10 * k, 20, 30, k, *near])).encode() + b"\n")
    parts.append(struct.pack(f"{order}i2fi", 2, 0.5, 1.5, 9) if order else b"2 0.5 1.5 9\n")
    for face in FACES:
        n = len(face)
        if order:
            parts.append(struct.pack(f"{order}BB{n}if", 7, n, *face, 0.5))
        else:
            parts.append(" ".join(map(str, [7, n, *face, 0.5])).encode() + b"\n")
    return SQUARE.format(format=kind).encode() + b"".join(parts)


@pytest.mark.parametrize(("kind", "order"), [("ascii", ""), *ORDERS])
def test_all_three_formats_give_one_cloud_and_one_mesh(kind: str, order: str, tmp_path: Path) -> None:
    file = tmp_path / "square.ply"
    file.write_bytes(square(kind, order))
    cloud, mesh = read_cloud(file), read_mesh(file)
    np.testing.assert_array_equal(cloud.points, np.array(VERTICES, np.float32))
    assert cloud.colours is not None and cloud.colours.tolist() == [[10 * k, 20, 30] for k in range(5)]
    np.testing.assert_array_equal(mesh.vertices, VERTICES)
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 4]]


@pytest.mark.parametrize(("kind", "order"), ORDERS)
def test_a_list_may_be_as_long_as_its_length_type_allows(kind: str, order: str, tmp_path: Path) -> None:
    header = (
        f"ply\nformat {kind} 1.0\nelement vertex 300\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list short uint vertex_index\nend_header\n"
    )
    file = tmp_path / "long.ply"
    file.write_bytes(
        header.encode() + struct.pack(f"{order}900f", *range(900)) + struct.pack(f"{order}h300I", 300, *range(300))
    )
    assert len(read_mesh(file).faces) == 298


@pytest.mark.parametrize("types", ["float x|float y|float z", "float32 x|float32 y|float32 z|int8 extra"])
def test_both_sets_of_type_names_and_windows_line_ends_are_read(types: str, tmp_path: Path) -> None:
    properties = "\r\n".join(f"property {each}" for each in types.split("|"))
    header = f"ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\n{properties}\r\nend_header\r\n"
    file = tmp_path / "a.ply"
    file.write_bytes(header.encode() + struct.pack("<3f", 1, 2, 3) + bytes(types.count("extra")))
    assert read_cloud(file).points.tolist() == [[1, 2, 3]]


def test_normals_labels_and_colours_as_shares_are_read(tmp_path: Path) -> None:
    names = ["x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "alpha"]
    properties = "".join(f"property float {name}\n" for name in names)
    file = tmp_path / "a.ply"
    file.write_text(
        f"ply\nformat ascii 1.0\nelement vertex 1\n{properties}property int label\nend_header\n"
        "1 2 3 0 0 1 0 0.5 1 1 42\n"
    )
    cloud = read_cloud(file)
    assert cloud.normals is not None and cloud.normals.tolist() == [[0, 0, 1]]
    assert cloud.colours is not None and cloud.colours.tolist() == [[0, 128, 255]]
    assert cloud.labels is not None and cloud.labels.tolist() == [42]


def test_a_cloud_without_faces_is_not_a_mesh(tmp_path: Path) -> None:
    file = tmp_path / "cloud.ply"
    file.write_text(
        "ply\nformat ascii 1.0\nelement vertex 1\n"
        "property float x\nproperty float y\nproperty float z\nend_header\n0 0 0"
    )
    assert len(read_cloud(file)) == 1
    with pytest.raises(CloudError, match="it is a cloud and not a mesh"):
        read_mesh(file)


def test_a_face_out_of_range_is_named(tmp_path: Path) -> None:
    file = tmp_path / "bad.ply"
    file.write_bytes(square("binary_big_endian", ">").replace(struct.pack(">3i", 0, 1, 4), struct.pack(">3i", 0, 1, 5)))
    for read in (read_cloud, read_mesh):
        with pytest.raises(CloudError, match=r"bad\.ply: the corners of face 1 must be vertices from 0 to 4, got 5"):
            read(file)
