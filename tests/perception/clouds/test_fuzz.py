"""Randomly damaged files: the readers return a valid cloud or mesh, or raise a CloudError."""

from __future__ import annotations

import io
import struct
import tracemalloc
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from commands import deixis
from damaged_files import damaged
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image
from timing import processor_time_below

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud, write_cloud
from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.clouds.mesh_file import read_mesh
from deixis.perception.errors import CloudError

CAMERA = Intrinsics(4, 3, 1.0, 1.0, 1.0, 1.0)
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
    """Return one small file of each format by file name."""
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


def read_damaged(file: Path, content: bytes, read: Callable[[Path], object]) -> object:
    file.write_bytes(content)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return read(file)
    except CloudError as error:
        message = str(error)
    assert message.startswith(str(file)) and "\n" not in message
    return None


@given(data=st.data())
@settings(max_examples=80, deadline=None)
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
@settings(max_examples=80, deadline=None)
def test_a_damaged_file_is_a_mesh_or_refused(
    data: st.DataObject, files: dict[str, bytes], tmp_path_factory: pytest.TempPathFactory
) -> None:
    names = ["a.obj", "a.stl", "mesh.ply", "binary_big_endian.ply", "binary_little_endian.ply"]
    name = data.draw(st.sampled_from(names))
    read_damaged(tmp_path_factory.getbasetemp() / name, damaged(files[name], data), read_mesh)


def test_the_undamaged_files_can_be_read(files: dict[str, bytes], tmp_path: Path) -> None:
    for name, content in files.items():
        file = tmp_path / name
        file.write_bytes(content)
        if name.endswith((".obj", ".stl")):
            assert len(read_mesh(file).faces) > 0
        else:
            assert len(read_cloud(file, CAMERA if name.endswith((".npy", ".png")) else None)) > 0


PCD = (
    "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 {count}\nWIDTH {width}\nHEIGHT {height}\nDATA {data}\n"
)
PLY = "ply\nformat {} 1.0\nelement vertex {}\n{}end_header\n"
XYZ = "property float x\nproperty float y\nproperty float z\n"


def zipped(shape: tuple[int, ...], content: bytes) -> bytes:
    """Return a .npz file whose array 'points' declares this shape."""
    array, archive = io.BytesIO(), io.BytesIO()
    header = {"descr": "<f4", "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(array, header)
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as opened:
        opened.writestr("points.npy", array.getvalue() + content)
    return archive.getvalue()


HOSTILE: dict[str, bytes] = {
    **{
        f"{data}.pcd": PCD.format(count=1, width=2_000_000_000, height=2, data=data).encode() + bytes(80)
        for data in ("ascii", "binary")
    },
    "packed.pcd": PCD.format(count=1, width=10**8, height=1, data="binary_compressed").encode()
    + struct.pack("<II", 40, 1_200_000_000)
    + bytes(40),
    "count.pcd": PCD.format(count=999_999_999, width=1, height=1, data="binary").encode() + bytes(80),
    "fields.pcd": b"FIELDS " + b"f " * 200_000 + b"\n",
    "empty.ply": PLY.format("ascii", 10**14, "").encode(),
    "nothing.ply": PLY.format("binary_little_endian", 10**13, "").encode(),
    "text.ply": PLY.format("ascii", 10**12, XYZ).encode() + b"0 0 0\n",
    "bytes.ply": PLY.format("binary_big_endian", 10**12, XYZ).encode() + bytes(12),
    "list.ply": PLY.format("binary_little_endian", 2, "property list uint float x\n").encode() + b"\xff" * 12,
    "elements.ply": b"ply\nformat ascii 1.0\n" + b"".join(b"element a%d 0\n" % k for k in range(9_999)),
    "comments.ply": b"ply\nformat ascii 1.0\n" + b"comment x\n" * 100_000,
    "line.xyz": b"1 " * 500_000,
    "digits.xyz": b"1" * 1_000_000 + b" 2 3\n",
    "nan.xyz": b"nan nan nan\n" * 1_000,
    "newlines.xyz": b"\n" * 1_000_000,
    "zeros.xyz": bytes(1_000_000),
    "declared.npz": zipped((10**12, 3), bytes(64)),
    "bomb.npz": zipped((10**7, 3), bytes(120_000_000)),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_huge_declared_sizes_cost_little_memory_and_time(name: str, tmp_path: Path) -> None:
    file = tmp_path / name
    file.write_bytes(HOSTILE[name])
    with processor_time_below(10):
        tracemalloc.start()
        try:
            cloud = read_damaged(file, HOSTILE[name], read_cloud)
            peak = tracemalloc.get_traced_memory()[1]
        finally:
            tracemalloc.stop()
        assert cloud is None or name in ("nan.xyz", "bomb.npz")
        assert peak < (300_000_000 if name == "bomb.npz" else 32_000_000)


@pytest.mark.parametrize("name", ["binary.pcd", "bytes.ply", "fields.pcd", "declared.npz", "zeros.xyz"])
def test_the_command_reports_a_bad_cloud_in_one_line(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(HOSTILE[name])
    code, out, err = deixis("perceive", tmp_path / name)
    assert (code, out) == (2, "") and err.startswith(f"deixis: {tmp_path / name}") and err.count("\n") == 1
