"""Clouds in plain text and in files of numpy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.errors import CloudError


def text_cloud(folder: Path, text: str, name: str = "a.xyz") -> PointCloud:
    file = folder / name
    file.write_text(text)
    return read_cloud(file)


@pytest.mark.parametrize(
    "text", ["1 2 3\n4 5 nan\n", "# x y z\n1,2,3\n\n4, 5, nan", "//X Y Z I\n1;2;3;9\r\n4;5;nan;8\r\n"]
)
def test_text_has_three_columns_or_a_fourth_that_is_skipped(text: str, tmp_path: Path) -> None:
    cloud = text_cloud(tmp_path, text)
    np.testing.assert_array_equal(cloud.points, np.array([[1, 2, 3], [4, 5, np.nan]], np.float32))
    assert cloud.colours is None


def test_six_columns_of_text_are_colours_as_bytes_or_as_shares(tmp_path: Path) -> None:
    for text in ("1 2 3 0 51 255\n", "1 2 3 0 0.2 1.0\n"):
        colours = text_cloud(tmp_path, text).colours
        assert colours is not None and colours.tolist() == [[0, 51, 255]]
    with pytest.raises(CloudError, match=r"point 0: red, green and blue must be from 0 to 1, .*got -1, 0, 0"):
        text_cloud(tmp_path, "1 2 3 -1 0 0\n")
    with pytest.raises(CloudError, match="point 1: red, green and blue must be from 0 to 255, got 300, 2, 3"):
        text_cloud(tmp_path, "1 2 3 0 0 0\n1 2 3 300 2 3\n")


def test_six_columns_of_xyzn_are_a_normal(tmp_path: Path) -> None:
    normals = text_cloud(tmp_path, "1 2 3 0 0 -1\n", "a.xyzn").normals
    assert normals is not None and normals.tolist() == [[0, 0, -1]]


def test_an_npz_file_holds_an_organised_cloud_with_all_arrays(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    points = rng.normal(size=(3, 4, 3))
    colours, labels = rng.integers(0, 256, (3, 4, 3), np.uint8), rng.integers(0, 9, (3, 4))
    file = tmp_path / "a.npz"
    np.savez_compressed(
        file, points=np.asfortranarray(points), colours=colours, labels=labels, normals=points, origin=[1.0, 2, 3], x=1
    )
    cloud = read_cloud(file)
    np.testing.assert_array_equal(cloud.points, points.reshape(-1, 3).astype(np.float32))
    np.testing.assert_array_equal(cloud.colours, colours.reshape(-1, 3))
    np.testing.assert_array_equal(cloud.labels, labels.reshape(-1))
    np.testing.assert_array_equal(cloud.normals, cloud.points)
    assert cloud.organised == (3, 4) and cloud.origin == (1, 2, 3)


def test_an_npz_file_may_hold_points_alone_and_colors_as_shares(tmp_path: Path) -> None:
    file = tmp_path / "a.npz"
    np.savez(file, points=np.zeros((2, 3), np.float32))
    assert read_cloud(file).organised is None
    np.savez(file, points=np.zeros((1, 3), ">f8"), colors=np.array([[0, 0.5, 1]]))
    colours = read_cloud(file).colours
    assert colours is not None and colours.tolist() == [[0, 128, 255]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1 2 3\n4 5\n", r"a\.xyz:2: this line has 2 of the 3 values of the first line; add the others"),
        ("1 2 3\n4 5", r"a\.xyz:2: this line has 2 of the 3 values of the first line"),
        ("1 2 3\n4 5 6 7\n", r"a\.xyz:2: this line has more than the 3 values of the first line"),
    ],
)
def test_a_line_with_another_number_of_columns_is_named(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(CloudError, match=message):
        text_cloud(tmp_path, text)
