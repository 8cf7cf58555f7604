"""Scenes from the fields of `vision_msgs/Detection3DArray`, and back."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from deixis.perception.errors import SceneError
from deixis.perception.scene import Scene

coordinates = st.floats(-5.0, 5.0)
lengths = st.floats(0.0, 2.0)


def detection(quaternion: tuple[float, ...] = (0.0, 0.0, 0.0, 1.0), **more: Any) -> dict[str, Any]:
    centre = {
        "position": {"x": 0.5, "y": 0.2, "z": 0.1},
        "orientation": dict(zip("xyzw", quaternion, strict=True)),
    }
    return {"bbox": {"center": centre, "size": {"x": 0.4, "y": 0.2, "z": 0.1}}, **more}


def as_message(data: Any) -> Any:
    """Return dictionaries as objects with attributes, as ROS messages are."""
    if isinstance(data, dict):
        return SimpleNamespace(**{name: as_message(value) for name, value in data.items()})
    return [as_message(value) for value in data] if isinstance(data, list) else data


@given(st.lists(st.tuples(coordinates, coordinates, coordinates, lengths, lengths, lengths), max_size=4))
def test_boxes_survive_a_round_trip(boxes: list[tuple[float, ...]]) -> None:
    low = np.array([box[:3] for box in boxes]).reshape(-1, 3)
    scene = Scene.from_boxes(low, low + np.array([box[3:] for box in boxes]).reshape(-1, 3))
    message = json.loads(json.dumps(scene.to_detections3d()))
    for again in (Scene.from_detections3d(message), Scene.from_detections3d(as_message(message))):
        assert again.ids == scene.ids
        if boxes:
            np.testing.assert_allclose(again.boxes, scene.boxes, atol=1e-8)


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1))
def test_turned_boxes_have_the_box_around_their_corners(a: float, b: float, c: float) -> None:
    turn = Rotation.from_euler("zyx", [a, b, c])
    scene = Scene.from_detections3d({"detections": [detection(tuple(turn.as_quat().tolist()))]})
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2
    corners = np.array([0.5, 0.2, 0.1]) + turn.apply(signs * [0.4, 0.2, 0.1])
    np.testing.assert_allclose(scene.boxes[0, 0], corners.min(axis=0), atol=1e-8)
    np.testing.assert_allclose(scene.boxes[0, 1], corners.max(axis=0), atol=1e-8)


def test_a_turn_about_the_vertical_is_kept() -> None:
    half = np.pi / 6
    scene = Scene.from_detections3d({"detections": [detection((0.0, 0.0, np.sin(half), np.cos(half)))]})
    oriented = scene.objects[0].oriented
    assert oriented is not None
    assert oriented.yaw == pytest.approx(np.pi / 3)
    assert scene.to_detections3d()["detections"][0]["bbox"]["center"]["orientation"]["z"] == pytest.approx(np.sin(half))


def test_the_best_hypothesis_is_the_label() -> None:
    results = [{"hypothesis": {"class_id": name, "score": score}} for name, score in (("cup", 0.2), ("mug", 0.7))]
    thing = Scene.from_detections3d({"detections": [detection(id="4", results=results)]})["4"]
    assert (thing.label, thing.confidence, thing.candidates) == ("mug", 0.7, (("cup", 0.2), ("mug", 0.7)))


def test_an_orientation_that_was_never_set_is_the_identity() -> None:
    zero = Scene.from_detections3d({"detections": [detection((0.0, 0.0, 0.0, 0.0))]})
    assert zero.boxes.tolist() == Scene.from_detections3d({"detections": [detection()]}).boxes.tolist()


@pytest.mark.parametrize(
    ("message", "error"),
    [
        ({}, "the field 'detections' is missing"),
        ({"detections": "none"}, "'detections' must be a list"),
        ({"detections": [{}]}, r"detections\[0\]: the field 'bbox' is missing"),
        ({"detections": [detection((0.0, 0.0, 0.0, float("nan")))]}, "orientation.w must be finite"),
        ({"detections": [{**detection(), "results": [{"class_id": "cup", "score": 3}]}]}, "score must be from 0 to 1"),
    ],
)
def test_bad_messages_are_refused_by_field(message: dict[str, Any], error: str) -> None:
    with pytest.raises(SceneError, match=error):
        Scene.from_detections3d(message)


def test_pixels_are_not_metres() -> None:
    with pytest.raises(SceneError, match="in pixels"):
        Scene.from_boxes([[0, 0]], [[1, 1]], unit="px").to_detections3d()
