"""Scenes made from arrays."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.perception.errors import SceneError
from deixis.perception.scene import Scene

angles = st.floats(-7.0, 7.0)
lengths = st.floats(0.01, 2.0)


def test_corners_are_kept() -> None:
    low, high = np.array([[0.0, 0.1, 0.2], [1.0, 1.1, 1.2]]), np.array([[0.5, 0.6, 0.7], [1.5, 1.6, 1.7]])
    scene = Scene.from_boxes(low, high, ids=[7, "cup"], labels=["fork", None], confidences=[0.8, 1.0])
    np.testing.assert_array_equal(scene.boxes, np.stack([low, high], axis=1))
    assert scene.ids == ("7", "cup")
    assert (scene["7"].label, scene["7"].confidence, scene["cup"].label) == ("fork", 0.8, None)


def test_objects_without_ids_are_numbered() -> None:
    assert Scene.from_boxes(np.zeros((3, 2)), np.ones((3, 2))).ids == ("o1", "o2", "o3")


def test_no_boxes_make_an_empty_scene() -> None:
    assert Scene.from_boxes([], []).objects == ()


@given(angles, lengths, lengths)
def test_boxes_around_turned_ones_touch_all_their_corners(yaw: float, length: float, width: float) -> None:
    scene = Scene.from_boxes(centre=[[0.3, -0.2, 0.1]], size=[[length, width, 0.2]], yaw=yaw)
    signs = np.array([[a, b] for a in (-1, 1) for b in (-1, 1)]) / 2
    turn = np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])
    corners = signs * [length, width] @ turn.T + [0.3, -0.2]
    np.testing.assert_allclose(scene.boxes[0, 0, :2], corners.min(axis=0), atol=1e-12)
    np.testing.assert_allclose(scene.boxes[0, 1, :2], corners.max(axis=0), atol=1e-12)
    oriented = scene.objects[0].oriented
    assert oriented is not None
    assert oriented.extents == (length, width, 0.2)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"min": [[0, 0]]}, "boxes must be given by `min` and `max`, or by `centre` and `size`"),
        ({"min": [[0, 0]], "max": [[1, 1]], "yaw": 0.0}, "boxes must be given by"),
        ({"min": [0, 0], "max": [1, 1]}, r"`min` must have shape \(n, 2\) or \(n, 3\), got \(2,\)"),
        ({"min": [[0, 0]], "max": [[1, 1, 1]]}, "must have the same shape"),
        ({"min": [["a", 0]], "max": [[1, 1]]}, "`min` must be an array of numbers"),
        ({"min": [[0, np.nan]], "max": [[1, 1]]}, "must be finite"),
        ({"min": [[2, 0]], "max": [[1, 1]]}, "above its max"),
        ({"centre": [[0, 0]], "size": [[-1, 1]]}, "`size` must be at least 0 on each axis, got -1"),
        ({"centre": [[0, 0]], "size": [[1, 1]], "yaw": [0.1, 0.2]}, "`yaw` must be one angle"),
        ({"min": [[0, 0]], "max": [[1, 1]], "ids": ["a", "b"]}, "`ids` must have one entry for each of the 1 boxes"),
        ({"min": [[0, 0]] * 2, "max": [[1, 1]] * 2, "ids": [1, "1"]}, "used twice"),
    ],
)
def test_bad_arrays_are_refused_by_name(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        Scene.from_boxes(**arguments)  # type: ignore[arg-type]


def test_open3d_boxes_and_clouds_make_a_scene() -> None:
    open3d = pytest.importorskip("open3d")
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector([[0.0, 0.0, 0.0], [0.1, 0.2, 0.3]]))
    box = open3d.geometry.AxisAlignedBoundingBox([1.0, 1.0, 0.0], [2.0, 2.0, 1.0])
    scene = Scene.from_open3d([cloud, box], ids=[1, 2], labels=["cup", None])
    expected = np.array([[[0.0, 0.0, 0.0], [0.1, 0.2, 0.3]], [[1.0, 1.0, 0.0], [2.0, 2.0, 1.0]]])
    np.testing.assert_allclose(scene.boxes, expected)
    assert len(scene.cloud_of("1")) == 2
    assert scene["2"].cloud is None


def test_coco_annotations_make_a_scene() -> None:
    annotations = {
        "images": [{"id": 1, "file_name": "table.jpg", "width": 640, "height": 480}],
        "categories": [{"id": 7, "name": "fork"}],
        "annotations": [{"id": 1, "image_id": 1, "category_id": 7, "bbox": [100, 80, 20, 200]}],
    }
    assert Scene.from_coco(annotations)["o1"].label == "fork"
