"""PCD files written by hand, byte by byte, and the clouds that they hold."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.errors import CloudError

HEADER = """# .PCD v0.7 - Point Cloud Data file format
VERSION 0.7
FIELDS x y z
SIZE 4 4 4
TYPE F F F
COUNT 1 1 1
WIDTH 2
HEIGHT 1
VIEWPOINT 0.5 -1 2 1 0 0 0
POINTS 2
DATA """


def pcd(folder: Path, header: str, body: bytes) -> PointCloud:
    file = folder / "cloud.pcd"
    file.write_bytes(header.encode() + b"\n" + body)
    return read_cloud(file)


def fields(names: str, sizes: str, types: str, counts: str, encoding: str, points: int = 2) -> str:
    return (
        f"VERSION 0.7\nFIELDS {names}\nSIZE {sizes}\nTYPE {types}\nCOUNT {counts}\nWIDTH {points}\nHEIGHT 1\n"
        f"POINTS {points}\nDATA {encoding}"
    )


def test_ascii_gives_points_and_the_viewpoint_as_origin(tmp_path: Path) -> None:
    cloud = pcd(tmp_path, HEADER + "ascii", b"1 2 3\n-0.5 1e-3 +.25\n")
    np.testing.assert_array_equal(cloud.points, np.array([[1, 2, 3], [-0.5, 1e-3, 0.25]], np.float32))
    assert cloud.origin == (0.5, -1.0, 2.0)
    assert cloud.organised is None and cloud.colours is None and cloud.labels is None and cloud.normals is None


def test_binary_gives_the_same_as_ascii(tmp_path: Path) -> None:
    cloud = pcd(tmp_path, HEADER + "binary", struct.pack("<6f", 1, 2, 3, -0.5, 1e-3, 0.25))
    np.testing.assert_array_equal(cloud.points, np.array([[1, 2, 3], [-0.5, 1e-3, 0.25]], np.float32))


def test_compressed_data_is_one_field_after_the_other(tmp_path: Path) -> None:
    # Three fields of two points each: x is 1.0 twice, the second time as a back-reference with distance 4.
    one, rest = struct.pack("<f", 1), struct.pack("<4f", 2, 3, 4, 5)
    packed = b"\x03" + one + bytes([(2 << 5) | 0, 3]) + b"\x0f" + rest
    cloud = pcd(tmp_path, HEADER + "binary_compressed", struct.pack("<II", len(packed), 24) + packed)
    np.testing.assert_array_equal(cloud.points, [[1, 2, 4], [1, 3, 5]])


def test_points_without_depth_stay_in_their_place_in_the_image(tmp_path: Path) -> None:
    header = HEADER.replace("WIDTH 2\nHEIGHT 1", "WIDTH 1\nHEIGHT 2") + "ascii"
    cloud = pcd(tmp_path, header, b"nan NaN nan\n0 0 1\n")
    assert cloud.organised == (2, 1)
    assert cloud.finite.tolist() == [False, True]


@pytest.mark.parametrize("name", ["rgb", "rgba"])
@pytest.mark.parametrize("kind", ["F", "U", "I"])
def test_a_packed_colour_is_read_whatever_its_type(name: str, kind: str, tmp_path: Path) -> None:
    header = fields(f"x y z {name}", "4 4 4 4", f"F F F {kind}", "1 1 1 1", "binary", 1)
    cloud = pcd(tmp_path, header, struct.pack("<3fI", 0, 0, 1, 0x00102030))
    assert cloud.colours is not None and cloud.colours.tolist() == [[0x10, 0x20, 0x30]]


@pytest.mark.parametrize(
    ("kind", "text"),
    [
        ("F", repr(float(np.uint32(0x00102030).view(np.float32)))),
        ("U", str(0xFF102030)),
        ("I", str(0xFF102030 - 2**32)),
    ],
)
def test_a_packed_colour_in_text_is_a_number_of_its_type(kind: str, text: str, tmp_path: Path) -> None:
    header = fields("x y z rgb", "4 4 4 4", f"F F F {kind}", "1 1 1 1", "ascii", 1)
    cloud = pcd(tmp_path, header, f"0 0 1 {text}\n".encode())
    assert cloud.colours is not None and cloud.colours.tolist() == [[0x10, 0x20, 0x30]]


def test_fields_of_any_type_size_and_count_are_read_or_skipped(tmp_path: Path) -> None:
    header = fields("label _ x fpfh y z normal_x normal_y normal_z", "2 1 8 4 2 8 4 4 4", "I U F F I F F F F",
                    "1 3 1 33 1 1 1 1 1", "binary", 1)  # fmt: skip
    body = struct.pack("<h3Bd33fhd3f", -7, 1, 2, 3, 0.5, *range(33), 4, 0.25, 0, 0, 1)
    cloud = pcd(tmp_path, header, body)
    assert cloud.points.tolist() == [[0.5, 4, 0.25]]
    assert cloud.labels is not None and cloud.labels.tolist() == [-7]
    assert cloud.normals is not None and cloud.normals.tolist() == [[0, 0, 1]]


def test_a_field_of_several_values_takes_several_columns(tmp_path: Path) -> None:
    cloud = pcd(tmp_path, fields("x y _ z", "4 4 1 4", "F F U F", "1 1 4 1", "ascii", 1), b"1 2 0 0 128 63 3")
    assert cloud.points.tolist() == [[1, 2, 3]]


@pytest.mark.parametrize("padded", [True, False])
def test_padding_may_be_left_out_of_compressed_data(padded: bool, tmp_path: Path) -> None:
    header = fields("x _ y z", "4 1 4 4", "F U F F", "1 4 1 1", "binary_compressed", 1)
    plain = struct.pack("<f", 1) + (b"\0" * 4 if padded else b"") + struct.pack("<2f", 2, 3)
    packed = bytes([len(plain) - 1]) + plain
    cloud = pcd(tmp_path, header, struct.pack("<II", len(packed), len(plain)) + packed)
    assert cloud.points.tolist() == [[1, 2, 3]]


@pytest.mark.parametrize("version", ["0.5", ".5", "0.6", ".6", "0.7", ".7"])
def test_older_versions_may_leave_entries_out(version: str, tmp_path: Path) -> None:
    cloud = pcd(tmp_path, f"VERSION {version}\nCOLUMNS x y z\nPOINTS 1\nDATA ascii", b"1 2 3\n")
    assert cloud.points.tolist() == [[1, 2, 3]]
    assert cloud.origin == (0, 0, 0)


def test_a_label_beyond_32_signed_bits_keeps_its_bits(tmp_path: Path) -> None:
    header = fields("x y z label", "4 4 4 4", "F F F U", "1 1 1 1", "ascii", 1)
    assert pcd(tmp_path, header, b"0 0 1 4294967295").labels == [-1]


def test_trailing_zeros_are_skipped_and_other_bytes_refused(tmp_path: Path) -> None:
    body = struct.pack("<6f", 1, 2, 3, 4, 5, 6)
    assert len(pcd(tmp_path, HEADER + "binary", body + b"\0" * 4096)) == 2
    with pytest.raises(CloudError, match="more data than the header declares"):
        pcd(tmp_path, HEADER + "binary", body + b"\0" * 20 + b"\1")


def test_windows_line_ends_are_line_ends(tmp_path: Path) -> None:
    header = HEADER.replace("\n", "\r\n") + "ascii\r"
    assert pcd(tmp_path, header, b"1 2 3\r\n\r\n4 5 6\r\n").points.tolist() == [[1, 2, 3], [4, 5, 6]]


def test_a_cloud_may_have_no_points(tmp_path: Path) -> None:
    header = HEADER.replace("WIDTH 2", "WIDTH 0").replace("POINTS 2", "POINTS 0")
    for encoding, body in (("ascii", b""), ("binary", b""), ("binary_compressed", bytes(8))):
        assert len(pcd(tmp_path, header + encoding, body)) == 0


def test_errors_name_the_line_or_the_byte(tmp_path: Path) -> None:
    with pytest.raises(CloudError, match=r"cloud\.pcd:13: expected a number, got 'one'"):
        pcd(tmp_path, HEADER + "ascii", b"1 2 3\n1 one 3\n")
    with pytest.raises(CloudError, match=r"cloud\.pcd:5: there is no type 'F' of 2 bytes|:4: there is no type"):
        pcd(tmp_path, HEADER.replace("SIZE 4", "SIZE 2") + "ascii", b"1 2 3\n4 5 6\n")
    size = len(HEADER) + len("binary\n")
    with pytest.raises(CloudError, match=rf"cloud\.pcd: byte {size}: the header declares 24 bytes of data, but 20"):
        pcd(tmp_path, HEADER + "binary", bytes(20))
