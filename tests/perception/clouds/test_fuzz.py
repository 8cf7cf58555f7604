"""Files damaged at random: read as a valid cloud or mesh, or refused with a CloudError, and never anything else."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud, write_cloud
from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.clouds.mesh_file import read_mesh
from deixis.perception.errors import CloudError

CAMERA = Intrinsics(4, 3, 1.0, 1.0, 1.0, 1.0)
WORDS = [b"0", b"-1", b"1e999", b"nan", b"400000000", b"99999999999999999999", b"\n", b" ", b"\0", b"\xff" * 4, b"list"]
MESH = """ply
format {} 1.0
element vertex 3
property float x
property float y
property float z
element face 2
property list uchar int vertex_indices
end_header
"""


def good_files(folder: Path) -> dict[str, bytes]:
    """One small file of each kind, by the name it has to have."""
    rng = np.random.default_rng(1)
    points = rng.normal(size=(12, 3)).astype(np.float32)
    colours, labels = rng.integers(0, 256, (12, 3), np.uint8), rng.integers(0, 9, 12).astype(np.int32)
    cloud = PointCloud(points, colours, labels, organised=(3, 4))
    files: dict[str, bytes] = {}
    for suffix, encoding in (
        *((".pcd", each) for each in ("ascii", "binary", "binary_compressed")),
        *((".ply", each) for each in ("ascii", "binary")),
    ):
        write_cloud(folder / f"made{suffix}", cloud, encoding)
        files[f"{encoding}{suffix}"] = (folder / f"made{suffix}").read_bytes()
    for order, name in ((">", "binary_big_endian"), ("<", "binary_little_endian")):
        faces = b"".join(b"\x03" + np.arange(3, dtype=f"{order}i4").tobytes() for _ in range(2))
        files[f"{name}.ply"] = MESH.format(name).encode() + np.arange(9, dtype=f"{order}f4").tobytes() + faces
    files["mesh.ply"] = MESH.format("ascii").encode() + b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n4 0 1 2 0\n"
    files["a.xyz"] = b"# x y z r g b\n0 0 1 255 0 7\n0.5 0.25 1e-3 1 2 3\n"
    files["a.obj"] = b"o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2//2 -1\n"
    files["a.stl"] = bytes(80) + b"\1\0\0\0" + np.arange(12, dtype="<f4").tobytes() + bytes(2)
    arrays, depth, picture = io.BytesIO(), io.BytesIO(), io.BytesIO()
    np.savez_compressed(arrays, points=points, colours=colours, labels=labels)
    np.save(depth, np.arange(12, dtype=np.uint16).reshape(3, 4))
    Image.fromarray(np.arange(12, dtype=np.uint16).reshape(3, 4)).save(picture, "PNG")
    return files | {"a.npz": arrays.getvalue(), "a.npy": depth.getvalue(), "a.png": picture.getvalue()}


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return good_files(tmp_path_factory.mktemp("good"))


def damaged(good: bytes, data: st.DataObject) -> bytes:
    """Bytes changed, cut out, repeated, put in, or the end cut off, some times over."""
    bad = bytearray(good)
    for _ in range(data.draw(st.integers(1, 4))):
        at, end = sorted(data.draw(st.tuples(*[st.integers(0, len(bad))] * 2)))
        how = data.draw(st.sampled_from(["change", "cut", "repeat", "put in", "replace word", "end"]))
        if how == "change" and at < len(bad):
            bad[at] ^= 1 << data.draw(st.integers(0, 7))
        elif how == "cut":
            del bad[at : min(end, at + 9)]
        elif how == "repeat":
            bad[at:at] = bad[at : min(end, at + 40)]
        elif how == "put in":
            bad[at:at] = data.draw(st.sampled_from(WORDS))
        elif how == "replace word":
            bad[at : at + 1 + bad[at : at + 20].find(b" ")] = data.draw(st.sampled_from(WORDS))
        elif how == "end":
            del bad[at:]
    return bytes(bad)


def read_damaged(file: Path, content: bytes, read: Callable[[Path], object]) -> object:
    file.write_bytes(content)
    try:
        return read(file)
    except CloudError as error:
        message = str(error)
    assert message.startswith(str(file)) and "\n" not in message
    return None


@given(data=st.data())
@settings(max_examples=300, deadline=None)
def test_a_damaged_file_is_a_cloud_or_refused(
    data: st.DataObject, files: dict[str, bytes], tmp_path_factory: pytest.TempPathFactory
) -> None:
    name = data.draw(st.sampled_from([name for name in files if not name.endswith((".obj", ".stl"))]))
    content = damaged(files[name], data)
    camera = CAMERA if name.endswith((".npy", ".png")) else None
    cloud = read_damaged(tmp_path_factory.getbasetemp() / name, content, lambda file: read_cloud(file, camera))
    if cloud is not None:
        assert isinstance(cloud, PointCloud)
        assert cloud.points.dtype == np.float32 and len(cloud) <= 100 * len(content)


@given(data=st.data())
@settings(max_examples=150, deadline=None)
def test_a_damaged_file_is_a_mesh_or_refused(
    data: st.DataObject, files: dict[str, bytes], tmp_path_factory: pytest.TempPathFactory
) -> None:
    names = ["a.obj", "a.stl", "mesh.ply", "binary_big_endian.ply", "binary_little_endian.ply"]
    name = data.draw(st.sampled_from(names))
    read_damaged(tmp_path_factory.getbasetemp() / name, damaged(files[name], data), read_mesh)


def test_the_files_to_be_damaged_are_good(files: dict[str, bytes], tmp_path: Path) -> None:
    for name, content in files.items():
        file = tmp_path / name
        file.write_bytes(content)
        if name.endswith((".obj", ".stl")):
            assert len(read_mesh(file).faces) > 0
        else:
            assert len(read_cloud(file, CAMERA if name.endswith((".npy", ".png")) else None)) > 0
