"""Written clouds: read back exactly in every format and encoding, also by Open3D."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud, write_cloud
from deixis.perception.errors import CloudError

WAYS = [
    *((".pcd", encoding) for encoding in ("ascii", "binary", "binary_compressed")),
    *((".ply", encoding) for encoding in ("ascii", "binary")),
]


@st.composite
def clouds(draw: st.DrawFn) -> PointCloud:
    rows, columns = draw(st.integers(2, 4)), draw(st.integers(1, 4))
    n = rows * columns
    triples = arrays.arrays(np.float32, (n, 3), elements=st.floats(width=32))
    return PointCloud(
        draw(triples),
        draw(st.none() | arrays.arrays(np.uint8, (n, 3))),
        draw(st.none() | arrays.arrays(np.int32, (n,))),
        draw(st.none() | triples),
        draw(st.sampled_from([None, (rows, columns)])),
        draw(st.tuples(*[st.floats(-1e9, 1e9)] * 3)),
    )


def same(found: PointCloud, given: PointCloud) -> None:
    np.testing.assert_array_equal(found.points, given.points)
    for name in ("colours", "labels", "normals"):
        one, other = getattr(found, name), getattr(given, name)
        assert (one is None) == (other is None)
        if one is not None:
            np.testing.assert_array_equal(one, other)
            assert one.dtype == other.dtype


@pytest.mark.parametrize(("suffix", "encoding"), WAYS)
@given(cloud=clouds())
@settings(max_examples=30, deadline=None)
def test_a_written_cloud_is_read_back_exactly(
    suffix: str, encoding: str, tmp_path_factory: pytest.TempPathFactory, cloud: PointCloud
) -> None:
    file = tmp_path_factory.getbasetemp() / f"again{suffix}"
    write_cloud(file, cloud, encoding)
    found = read_cloud(file)
    same(found, cloud)
    if suffix == ".pcd":
        assert (found.organised, found.origin) == (cloud.organised, cloud.origin)


def test_clouds_that_cannot_be_written_are_refused(tmp_path: Path) -> None:
    cloud = PointCloud(np.zeros((1, 3), np.float32))
    with pytest.raises(CloudError, match=r"a\.xyz: the suffix must be \.pcd or \.ply, got '\.xyz'"):
        write_cloud(tmp_path / "a.xyz", cloud)
    with pytest.raises(CloudError, match=r"a\.ply: the encoding of PLY must be one of ascii, binary, got 'binary_co"):
        write_cloud(tmp_path / "a.ply", cloud, "binary_compressed")
    with pytest.raises(CloudError, match="cannot be written"):
        write_cloud(tmp_path / "nowhere" / "a.ply", cloud)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize(("suffix", "encoding"), WAYS)
def test_open3d_reads_our_files_and_we_read_its_files(suffix: str, encoding: str, tmp_path: Path) -> None:
    open3d = pytest.importorskip("open3d")
    rng = np.random.default_rng(11)
    n = 5000
    points = (rng.normal(size=(n, 3)) * 10.0 ** rng.integers(-6, 4, (n, 1))).astype(np.float32)
    cloud = PointCloud(points, rng.integers(0, 256, (n, 3), np.uint8), normals=points[::-1].copy())
    ours = tmp_path / f"ours{suffix}"
    write_cloud(ours, cloud, encoding)
    read = open3d.io.read_point_cloud(str(ours))
    np.testing.assert_array_equal(np.asarray(read.points).astype(np.float32), cloud.points)
    np.testing.assert_array_equal(np.asarray(read.normals).astype(np.float32), cloud.normals)
    np.testing.assert_array_equal(np.rint(np.asarray(read.colors) * 255), cloud.colours)
    theirs = tmp_path / f"theirs{suffix}"
    open3d.io.write_point_cloud(
        str(theirs), read, write_ascii=encoding == "ascii", compressed=encoding == "binary_compressed"
    )
    again = read_cloud(theirs)
    # In ascii, Open3D writes ten decimals in PCD and six digits in PLY.
    ascii_digits = 1e-5 if encoding == "ascii" else 0.0
    np.testing.assert_allclose(again.points, cloud.points, rtol=ascii_digits, atol=ascii_digits / 10**4)
    np.testing.assert_array_equal(again.colours, cloud.colours)
    assert again.normals is not None
