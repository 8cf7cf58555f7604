"""Malformed files: each raises a one-line error that names the file and the remedy, in bounded memory."""

from __future__ import annotations

import io
import struct
import tracemalloc
import zipfile
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from deixis.errors import DeixisError
from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.clouds.mesh_file import read_mesh
from deixis.perception.errors import CloudError

MANY = 400_000_000
MAX_PEAK = 50 * 2**20
CAMERA = Intrinsics(4, 3, 1.0, 1.0, 1.0, 1.0)

Made = tuple[str, bytes]


def pcd(body: bytes = b"0 0 1\n0 1 1\n", encoding: str = "ascii", **changes: str | int) -> bytes:
    """Return a PCD file of two points with changed entries of the header; an empty entry is left out."""
    entries: dict[str, str | int] = {
        **{"VERSION": "0.7", "FIELDS": "x y z", "SIZE": "4 4 4", "TYPE": "F F F", "COUNT": "1 1 1", "WIDTH": 2},
        **{"HEIGHT": 1, "VIEWPOINT": "0 0 0 1 0 0 0", "POINTS": 2, "DATA": encoding},
    }
    lines = [f"{key} {value}\n" for key, value in (entries | changes).items() if value != ""]
    return b"# .PCD v0.7\n" + "".join(lines).encode() + body


def packed(data: bytes, size: int | None = None, plain: int = 24) -> bytes:
    return struct.pack("<II", len(data) if size is None else size, plain) + data


def ply(body: bytes, vertices: int = 3, faces: str = "", kind: str = "ascii", more: str = "") -> bytes:
    coordinates = "".join(f"property float {axis}\n" for axis in "xyz")
    head = f"ply\nformat {kind} 1.0\n{more}element vertex {vertices}\n{coordinates}{faces}end_header\n"
    return head.encode() + body


def with_faces(count: int, length: str = "uchar", item: str = "int") -> str:
    return f"element face {count}\nproperty list {length} {item} vertex_indices\n"


def zipped(shape: str = "(2, 3)", descr: str = "<f4", data: bytes = bytes(24), name: str = "points.npy") -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, npy(shape, descr, data))
    return file.getvalue()


def npy(shape: str, descr: str, data: bytes) -> bytes:
    header = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + data


def lying_zip(size: int) -> bytes:
    """Return a .npz file whose directory declares ``size`` bytes for its only member."""
    whole = zipped()
    directory = whole.rindex(b"PK\x01\x02")
    return whole[: directory + 24] + struct.pack("<I", size) + whole[directory + 28 :]


def png(width: int, height: int, bits: int = 16, kind: int = 0, rows: bytes = b"") -> bytes:
    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def pcd_files() -> Iterator[Made]:
    yield "empty", b""
    yield "hundreds of millions of points declared", pcd(b"0 0 1\n", WIDTH=MANY, POINTS=MANY)
    yield "the same, binary", pcd(bytes(24), "binary", WIDTH=MANY, POINTS=MANY)
    yield "the same, compressed", pcd(packed(bytes(4), plain=12 * 10**8 % 2**32), "binary_compressed", POINTS=10**8,
                                      WIDTH=10**8)  # fmt: skip
    yield "no data line", pcd(b"", DATA="")
    yield "a comment of 2 MB", b"#" + b"x" * 2**21 + b"\n" + pcd()
    yield "2 MB of short comments", b"# again\n" * 2**18 + pcd()
    yield "a header without an end", b"VERSION 0.7\nFIELDS x y z"
    yield "an unknown entry", pcd(SCALE="1 1 1")
    yield "an entry twice", b"VERSION 0.7\n" + pcd()
    yield "an unknown version", pcd(VERSION="1.0")
    yield "an unknown encoding", pcd(DATA="utf8")
    yield "no fields", pcd(FIELDS="")
    yield "no x", pcd(FIELDS="a y z")
    yield "a field twice", pcd(FIELDS="x x z")
    yield "a size that no type has", pcd(SIZE="3 4 4")
    yield "an unknown type", pcd(TYPE="Q F F")
    yield "fewer sizes than fields", pcd(SIZE="4 4")
    yield "a negative count", pcd(COUNT="-1 1 1")
    yield "a count of zero", pcd(COUNT="1 0 1")
    yield "a point of a terabyte", pcd(COUNT="1 1 1000000000000")
    yield "a negative width", pcd(WIDTH=-2)
    yield "a width with a sign of digits", pcd(WIDTH="1_0")
    yield "a width of hundreds of digits", pcd(WIDTH="9" * 5000)
    yield "points that are not width by height", pcd(POINTS=3)
    yield "a viewpoint of six numbers", pcd(VIEWPOINT="0 0 0 1 0 0")
    yield "a viewpoint at infinity", pcd(VIEWPOINT="inf 0 0 1 0 0 0")
    yield "text cut short", pcd(b"0 0 1\n0 0")
    yield "a word for a number", pcd(b"0 0 1\n0 zero 1\n")
    yield "a value too many in a line", pcd(b"0 0 1 1\n0 0 1\n")
    yield "a line too many", pcd(b"0 0 1\n0 0 1\n0 0 1\n")
    yield "a number of a million digits", pcd(b"0 0 1\n0 0 " + b"7" * 10**6)
    yield "a colour that is not a whole number", pcd(b"0 0 1 0.5\n0 0 1 7\n", FIELDS="x y z rgb", SIZE="4 4 4 4",
                                                  TYPE="F F F U", COUNT="1 1 1 1")  # fmt: skip
    yield "binary data cut short", pcd(bytes(23), "binary")
    yield "more binary data than declared", pcd(b"\1" * 25, "binary")
    yield "compressed data cut short", pcd(packed(bytes(3), size=100), "binary_compressed")
    yield "no room for compressed sizes", pcd(bytes(7), "binary_compressed")
    yield (
        "a plain size that is not declared",
        pcd(packed(b"\x17" + bytes(24), plain=25), "binary_compressed"),
    )
    yield "compressed data that reaches back too far", pcd(packed(b"\x00a\xe0\x20\x10"), "binary_compressed")
    yield "compressed data that gives too little", pcd(packed(b"\x00a"), "binary_compressed")
    yield "compressed data that gives too much", pcd(packed(b"\x00a\xe0\xff\x00"), "binary_compressed")


def ply_files() -> Iterator[Made]:
    three, floats = b"0 0 1\n0 1 1\n1 1 1\n", struct.pack("<9f", *range(9))
    little, big = "binary_little_endian", "binary_big_endian"
    yield "a comment of 2 MB", ply(three, more=f"comment {'x' * 2**21}\n")
    yield "vertices by the hundred million", ply(three, MANY)
    yield "the same, binary", ply(floats, MANY, kind=little)
    yield "faces by the hundred million", ply(three + b"3 0 1 2\n", faces=with_faces(MANY))
    yield "the same, binary big endian", ply(floats + bytes(13), faces=with_faces(MANY), kind=big)
    yield "a face out of range", ply(three + b"3 0 1 3\n", faces=with_faces(1))
    yield "the same, binary", ply(floats + struct.pack("<B3i", 3, 0, 1, 99), faces=with_faces(1), kind=little)
    yield "a face before the first", ply(floats + struct.pack("<B3i", 3, 0, 1, -1), faces=with_faces(1), kind=little)
    yield "a face cut short", ply(floats + struct.pack("<B2i", 3, 0, 1), faces=with_faces(1), kind=little)
    yield "the same, text", ply(three + b"3 0 1\n", faces=with_faces(1))
    yield "a list of negative length", ply(three + b"-3 0 1 2\n", faces=with_faces(1))
    yield "the same, binary", ply(floats + b"\xff" + bytes(12), faces=with_faces(1, "char"), kind=little)
    yield "a list of billions", ply(floats + b"\xff" * 4 + bytes(12), faces=with_faces(1, "uint"), kind=little)
    yield "the same, text", ply(three + b"4000000000 0 1 2\n", faces=with_faces(1, "uint"))
    yield "a length that is not a whole number", ply(three, faces=with_faces(1, "float"))
    yield "vertices cut short", ply(floats[:-1], kind=little)
    yield "vertices cut short, text", ply(three[:-3])
    yield "data after the last element", ply(floats + b"more", kind=little)
    yield "no format", ply(three).replace(b"format ascii 1.0\n", b"")
    yield "two formats", ply(three, more="format ascii 1.0\n")
    yield "an unknown format", ply(three, kind="binary_middle_endian")
    yield "no vertices", b"ply\nformat ascii 1.0\nend_header\n"
    yield "vertices without z", ply(three).replace(b"property float z\n", b"")
    yield "a property before any element", ply(three, more="property float w\n")
    yield "an unknown type", ply(three).replace(b"float x", b"half x")
    yield "a property without a name", ply(three).replace(b"float x", b"float")
    yield "a property twice", ply(three).replace(b"float y", b"float x")
    yield "an element twice", ply(three, more="element vertex 0\n")
    yield "a negative number of vertices", ply(three, -3)
    yield "an unknown entry", ply(three, more="texture a.png\n")
    yield "a header without an end", ply(three).replace(b"end_header\n", b"")
    yield "no PLY at all", b"\x00\x01\x02" * 100
    yield "an indirect float for a corner", ply(three + b"3 0 1 nan\n", faces=with_faces(1))
    yield "a corner of 22 digits", ply(three + b"3 0 1 0000000000000000000002\n", faces=with_faces(1))
    yield "half a corner", ply(three + b"3 0 1 0.5\n", faces=with_faces(1, item="float"))


def other_files() -> Iterator[tuple[str, str, bytes]]:
    yield "xyz", "empty", b""
    yield "xyz", "comments alone", b"# nothing\n"
    yield "xyz", "two columns", b"1 2\n3 4\n"
    yield "xyz", "names for columns", b"x y z\n1 2 3\n"
    yield "xyz", "lines of several lengths", b"1 2 3\n1 2 3 4\n"
    yield "xyz", "no text", bytes(range(256))
    yield "xyz", "one line of 2 MB", b"1" * 2**21
    yield "xyz", "colours out of range", b"1 2 3 0 0 256\n"
    yield "xyz", "colours that are not finite", b"1 2 3 0 nan 0\n"
    yield "npz", "empty", b""
    yield "npz", "no zip", b"PK\x03\x04 and no more"
    yield "npz", "cut short", zipped()[:-30]
    yield "npz", "no points", zipped(name="dots.npy")
    yield "npz", "points by the hundred million", zipped(f"({MANY}, 3)")
    yield "npz", "a member that declares gigabytes", lying_zip(2**32 - 2)
    yield "npz", "a member of more zeros than are read", zipped("(80000000, 3)", data=bytes(2**28 + 1))
    yield "npz", "a shape that overflows", zipped("(999999999999999, 999999999999999, 3)")
    yield "npz", "a negative shape", zipped("(-2, 3)")
    yield "npz", "pickled objects", zipped(descr="|O")
    yield "npz", "code in the header", zipped("(__import__('os').system('true'), 3)")
    yield "npz", "structured data", zipped(descr="<f4', 'x")
    yield "npz", "points in the plane", zipped("(3, 2)")
    yield "npz", "an array cut short", zipped(data=bytes(23))
    yield "npz", "no array", zipped()[:30] + bytes(60)
    yield "png", "a depth image cut short", png(4, 3, rows=bytes(27))[:-30]
    yield "png", "too few rows", png(4, 3, rows=bytes(9))
    yield "png", "pixels by the hundred million", png(20_000, 20_000)
    yield "png", "pixels beyond counting", png(2**31 - 1, 2**31 - 1)
    yield "png", "no pixels", png(0, 3)
    yield "png", "colours for depth", png(4, 3, 8, 2, bytes(39))
    yield "png", "another size than the camera's", png(3, 4, rows=bytes(28))
    yield "png", "a signature and no more", b"\x89PNG\r\n\x1a\n"
    yield "npy", "depth as a list", npy("(12,)", "<u2", bytes(24))
    yield "npy", "depth by the hundred million", npy(f"({MANY}, 2)", "<u2", bytes(24))
    yield "npy", "depth of a negative size", npy("(-3, -4)", "<u2", bytes(24))
    yield "npy", "a header of brackets", npy("(" * 9000, "<u2", bytes(24))
    yield "npy", "a header of signs", npy("-" * 9000 + "1", "<u2", bytes(24))
    yield "npy", "a type without a name", npy("(3, 4)", "', (), '", bytes(24))
    yield "npy", "more dimensions than there are", npy("(" + "0, " * 100 + ")", "<u2", b"")
    yield "npy", "pickled objects", npy("(3, 4)", "|O", bytes(24))
    yield "jpg", "a picture", b"\xff\xd8\xff\xe0" + bytes(100)


def mesh_files() -> Iterator[tuple[str, str, bytes]]:
    square = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    yield "obj", "empty", b""
    yield "obj", "no faces", square
    yield "obj", "a corner beyond the last", square + b"f 1 2 4\n"
    yield "obj", "a corner before the first", square + b"f 1 2 -4\n"
    yield "obj", "corner zero", square + b"f 0 1 2\n"
    yield "obj", "a corner that is a word", square + b"f 1 2 three\n"
    yield "obj", "a face of two corners", square + b"f 1 2\n"
    yield "obj", "a vertex of two numbers", b"v 0 0\nf 1 1 1\n"
    yield "obj", "a vertex at infinity", b"v 0 0 inf\nf 1 1 1\n"
    yield "obj", "a line of 2 MB", b"#" * 2**21 + b"\n" + square + b"f 1 2 3\n"
    yield "obj", "a corner of thousands of digits", square + b"f 1 2 " + b"9" * 5000 + b"\n"
    yield "stl", "empty", b""
    yield "stl", "triangles by the hundred million", bytes(80) + struct.pack("<I", MANY) + bytes(50)
    yield "stl", "a triangle cut short", bytes(80) + struct.pack("<I", 1) + bytes(49)
    yield "stl", "no triangles", bytes(84)
    yield "stl", "a coordinate that is not finite", bytes(80) + struct.pack("<I12fH", 1, *[float("nan")] * 12, 0)
    yield "stl", "corners that make no triangle", b"solid a\nvertex 0 0 0\n"
    yield "stl", "numbers shifted between lines", b"solid a\nvertex 0 0\nvertex 1 0 0 7\nvertex 0 1 0\nendsolid a\n"
    yield "stl", "a vertex of words", b"solid a\nvertex a b c\n"
    yield "dae", "another format", b"<COLLADA/>"


CLOUDS = [
    *(("pcd", *made) for made in pcd_files()),
    *(("ply", *made) for made in ply_files()),
    *other_files(),
]


def peak_while(read: Callable[[], object]) -> tuple[str, int]:
    """Return the message of the error that reading raises, and the peak memory in bytes."""
    tracemalloc.start()
    try:
        with pytest.raises(CloudError) as raised:
            read()
        return str(raised.value), tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def check(read: Callable[[], object], file: Path) -> None:
    message, peak = peak_while(read)
    assert message.startswith(str(file)) and "\n" not in message
    assert len(message) - len(str(file)) < 350
    assert any(mark in message[len(str(file)) :] for mark in (";", ":"))
    assert peak < MAX_PEAK


@pytest.fixture(scope="module", autouse=True)
def compiled(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Compile the kernels first, because compiling takes memory of its own."""
    folder = tmp_path_factory.mktemp("compiled")
    for name, content in (
        ("a.pcd", pcd()),
        ("b.pcd", pcd(packed(b"\x17" + bytes(24)), "binary_compressed")),
        ("a.xyz", b"1 2 3\n"),
        ("a.ply", ply(struct.pack("<9fB3i", *range(9), 3, 0, 1, 2), 3, with_faces(1), "binary_little_endian")),
    ):
        (folder / name).write_bytes(content)
        read_cloud(folder / name)


@pytest.mark.parametrize(("suffix", "what", "content"), CLOUDS, ids=[f"{made[0]}: {made[1]}" for made in CLOUDS])
def test_a_malformed_cloud_gets_one_line_in_bounded_memory(
    suffix: str, what: str, content: bytes, tmp_path: Path
) -> None:
    file = tmp_path / f"cloud.{suffix}"
    file.write_bytes(content)
    check(lambda: read_cloud(file, CAMERA if suffix in ("png", "npy") else None), file)


MESHES = [*(("ply", *made) for made in ply_files()), *mesh_files()]


@pytest.mark.parametrize(("suffix", "what", "content"), MESHES, ids=[f"{made[0]}: {made[1]}" for made in MESHES])
def test_a_malformed_mesh_gets_one_line_in_bounded_memory(
    suffix: str, what: str, content: bytes, tmp_path: Path
) -> None:
    file = tmp_path / f"mesh.{suffix}"
    file.write_bytes(content)
    check(lambda: read_mesh(file), file)


@pytest.mark.parametrize("read", [read_cloud, read_mesh])
def test_a_path_that_is_not_a_file_gets_one_line(read: Callable[[Path], object], tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "nothing.ply", Path("/dev/zero"), tmp_path / "nul\0.ply"):
        with pytest.raises(CloudError) as raised:
            read(path)
        assert "\n" not in str(raised.value)
    assert issubclass(CloudError, DeixisError) and issubclass(CloudError, ValueError)


def test_a_file_larger_than_any_cloud_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("deixis.perception.clouds.content.MAX_BYTES", 10)
    file = tmp_path / "large.xyz"
    file.write_text("1 2 3\n4 5 6\n")
    with pytest.raises(CloudError, match=r"large\.xyz: the file is larger than"):
        read_cloud(file)


def test_reading_a_good_file_takes_bounded_memory(tmp_path: Path) -> None:
    """Check that reading takes a few times the memory of the points, not of the file's bounds."""
    file = tmp_path / "cloud.pcd"
    file.write_bytes(pcd(b"0.25 0.5 0.75\n" * 100_000, WIDTH=100_000, POINTS=100_000))
    tracemalloc.start()
    cloud = read_cloud(file)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert np.all(cloud.points == np.array([0.25, 0.5, 0.75], np.float32))
    assert peak < 8 * cloud.points.nbytes
