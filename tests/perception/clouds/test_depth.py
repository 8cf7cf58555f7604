"""Depth images and intrinsics: the position of a pixel's point, and sizes that must agree."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from deixis.perception.clouds.cloud_file import read_cloud
from deixis.perception.clouds.depth import Intrinsics, read_intrinsics
from deixis.perception.errors import CloudError

CAMERA = Intrinsics(width=3, height=2, fx=2.0, fy=4.0, cx=1.0, cy=0.5)
MILLIMETRES = np.array([[1000, 0, 2000], [500, 1500, 65535]], np.uint16)


def saved(folder: Path, name: str, depth: NDArray[np.generic]) -> Path:
    file = folder / name
    if name.endswith(".png"):
        Image.fromarray(depth).save(file)
    elif name.endswith(".npy"):
        np.save(file, depth)
    else:
        np.savez(file, depth=depth)
    return file


@pytest.mark.parametrize("name", ["depth.png", "depth.npy", "depth.npz"])
def test_a_pixel_is_projected_back_through_the_pinhole(name: str, tmp_path: Path) -> None:
    cloud = read_cloud(saved(tmp_path, name, MILLIMETRES), CAMERA)
    assert cloud.organised == (2, 3)
    assert cloud.finite.tolist() == [True, False, True, True, True, True]
    # Column 2, row 0 at 2 m: x = (2 - 1) 2 / 2, y = (0 - 0.5) 2 / 4. The same formulas apply to column 0, row 1.
    np.testing.assert_array_equal(cloud.points[2], np.array([1, -0.25, 2], np.float32))
    np.testing.assert_array_equal(cloud.points[3], np.array([-0.25, 0.0625, 0.5], np.float32))


def test_floats_are_metres_unless_depth_scale_is_given(tmp_path: Path) -> None:
    metres = np.array([[1, np.nan, -1], [np.inf, 0, 2.5]], np.float32)
    cloud = read_cloud(saved(tmp_path, "a.npy", metres), CAMERA)
    assert cloud.points[cloud.finite][:, 2].tolist() == [1, 2.5]
    scaled = Intrinsics(3, 2, 2.0, 4.0, 1.0, 0.5, depth_scale=5000)
    assert read_cloud(saved(tmp_path, "a.png", MILLIMETRES), scaled).points[0, 2] == np.float32(0.2)


def test_intrinsics_are_read_from_json(tmp_path: Path) -> None:
    file = tmp_path / "camera.json"
    values = {"width": 3, "height": 2, "fx": 2, "fy": 4.0, "cx": 1, "cy": 0.5, "depth_scale": 1000}
    file.write_text(json.dumps(values))
    assert read_intrinsics(file) == Intrinsics(3, 2, 2.0, 4.0, 1.0, 0.5, 1000.0)
    assert len(read_cloud(saved(tmp_path, "a.png", MILLIMETRES), file)) == 6


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"width": None}, "'width' must be a whole number"),
        ({"width": 2.5}, "'width' must be a whole number"),
        ({"fx": 0}, "fx, fy and depth_scale must be above 0"),
        ({"fy": "2"}, "'fy' must be a number"),
        ({"cx": True}, "'cx' must be a number"),
        ({"depth_scale": -1}, "fx, fy and depth_scale must be above 0"),
        ({"height": 0}, "an image must have 1 to 33554432 pixels, got 3 by 0"),
        ({"height": 10**9}, "an image must have 1 to 33554432 pixels, got 3 by 1000000000"),
        ({"fx": 10**400}, "a number of 401 digits is too large"),
        ({"fx": 10**300}, "'fx' must be a number"),
        ({"fx": 1e-320}, "fx and fy must be in pixels, from 1 to 1000 times the size of the image"),
        ({"fx": 0.002}, "fx and fy must be in pixels, from 1 to 1000 times the size of the image, got 0.002 and 4"),
        ({"fy": 3001}, "fx and fy must be in pixels"),
    ],
)
def test_impossible_intrinsics_are_refused(change: dict[str, object], message: str, tmp_path: Path) -> None:
    file = tmp_path / "camera.json"
    file.write_text(json.dumps({"width": 3, "height": 2, "fx": 2, "fy": 4.0, "cx": 1, "cy": 0.5} | change))
    with pytest.raises(CloudError, match=r"camera\.json:") as raised:
        read_intrinsics(file)
    assert message in str(raised.value)


@pytest.mark.parametrize("text", ["[]", "{", '{"fx": NaN}', "\udc80", " " * 70_000])
def test_intrinsics_that_are_not_a_json_object_are_refused(text: str, tmp_path: Path) -> None:
    file = tmp_path / "camera.json"
    file.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(CloudError, match=r"camera\.json"):
        read_intrinsics(file)


def test_a_depth_image_and_its_intrinsics_go_together(tmp_path: Path) -> None:
    depth = saved(tmp_path, "a.png", MILLIMETRES)
    with pytest.raises(CloudError, match="give them too"):
        read_cloud(depth)
    with pytest.raises(CloudError, match=r"\(2, 3\) rows and columns, and the intrinsics are for \(3, 3\)"):
        read_cloud(depth, Intrinsics(3, 3, 1.0, 1.0, 1.0, 1.0))
    text = tmp_path / "a.xyz"
    text.write_text("1 2 3")
    with pytest.raises(CloudError, match="not a depth image"):
        read_cloud(text, CAMERA)
