"""Clouds, boxes and scenes converted to Open3D: equal numbers, in classes that its drawing functions accept."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import write_cloud
from deixis.perception.errors import SceneError
from deixis.perception.open3d import open3d
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import PerceivedObject, Scene

CLOUD = PointCloud(
    np.array([[0, 0, 1], [np.nan, 0, 0], [0.1, 0.2, 0.3]], np.float32),
    colours=np.array([[255, 0, 51], [1, 2, 3], [0, 255, 0]], np.uint8),
    normals=np.array([[0, 0, 1], [0, 0, 1], [1, 0, 0]], np.float32),
)


def test_a_cloud_keeps_its_points_colours_and_normals() -> None:
    cloud = CLOUD.to_open3d()
    np.testing.assert_allclose(cloud.points, CLOUD.points[[0, 2]], atol=1e-7)
    np.testing.assert_allclose(cloud.colors, [[1.0, 0.0, 0.2], [0.0, 1.0, 0.0]])
    np.testing.assert_allclose(cloud.normals, [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


def test_missing_arrays_of_a_cloud_are_left_out() -> None:
    cloud = PointCloud(np.zeros((2, 3), np.float32)).to_open3d()
    assert (cloud.has_points(), cloud.has_colors(), cloud.has_normals()) == (True, False, False)
    assert not PointCloud(np.full((2, 3), np.nan, np.float32)).to_open3d().has_points()


def test_a_box_has_the_corners_of_its_object() -> None:
    box = PerceivedObject("o1", (0.0, 1.0, 2.0), (0.5, 1.5, 2.5)).to_open3d()
    assert (box.min_bound.tolist(), box.max_bound.tolist()) == ([0, 1, 2], [0.5, 1.5, 2.5])
    flat = PerceivedObject("o1", (0.0, 1.0), (0.5, 1.5)).to_open3d()
    assert (flat.min_bound.tolist(), flat.max_bound.tolist()) == ([0, 1, 0], [0.5, 1.5, 0])


@pytest.mark.parametrize("yaw", [0.0, 0.3, -2.0])
def test_an_oriented_box_contains_its_points(yaw: float) -> None:
    box = OrientedBox((0.3, 0.2, 0.1), yaw, (0.4, 0.1, 0.2))
    signs = np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, -1).T
    corners = np.array(box.centre) + signs * np.array(box.extents) / 2 @ box.axes
    theirs = np.asarray(box.to_open3d().get_box_points())
    order, wanted = np.lexsort(theirs.round(6).T), np.lexsort(corners.round(6).T)
    np.testing.assert_allclose(theirs[order], corners[wanted], atol=1e-9)


def test_a_scene_becomes_its_clouds_and_boxes(tmp_path: Path) -> None:
    write_cloud(tmp_path / "o2.pcd", CLOUD)
    turned = OrientedBox((0.5, 0.5, 0.5), 0.2, (1.0, 1.0, 1.0))
    low, high = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)
    things = (
        PerceivedObject("o1", low, high, cloud=CLOUD, colour=(255, 0, 0)),
        PerceivedObject("o2", low, high, cloud="o2.pcd", oriented=turned),
        PerceivedObject("o3", low, high),
    )
    shapes = Scene(things, file=str(tmp_path / "table.scene.json")).to_open3d()
    kinds = ["PointCloud", "AxisAlignedBoundingBox", "PointCloud", "OrientedBoundingBox", "AxisAlignedBoundingBox"]
    assert [type(shape).__name__ for shape in shapes] == kinds
    assert shapes[1].color.tolist() == [1, 0, 0] and shapes[4].color.tolist() == [0, 0, 0]
    assert len(shapes[0].points) == len(shapes[2].points) == 2
    assert all(isinstance(shape, open3d().geometry.Geometry3D) for shape in shapes)
    with pytest.raises(SceneError, match="the cloud of 'o2'"):
        Scene(things).to_open3d()


def test_the_classes_are_those_of_the_whole_library() -> None:
    """Import all of open3d in another process, because that takes a second, and compare the classes."""
    code = (
        "import numpy as np\n"
        "from deixis.perception.clouds.cloud import PointCloud\n"
        "import sys; assert 'open3d.cpu.pybind' not in sys.modules\n"
        "cloud = PointCloud(np.zeros((2, 3), np.float32)).to_open3d()\n"
        "import open3d\n"
        "assert type(cloud) is open3d.geometry.PointCloud\n"
        "assert cloud.get_axis_aligned_bounding_box().volume() == 0\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
