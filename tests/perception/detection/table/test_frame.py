"""Frame of a table: right-handed, level, and oriented to the viewer."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.table.plane import CameraPose, Plane
from deixis.perception.detection.table.viewpoint import camera_pose_of, moved, table_frame

LEVEL = Plane(np.array([0.0, 0.0, 1.0]), 0.7)
SQUARE = np.array([[0.0, 0.0, 0.7], [1.0, 0.0, 0.7], [1.0, 1.0, 0.7], [0.0, 1.0, 0.7]])


@settings(max_examples=50, deadline=None)
@given(st.tuples(*[st.floats(-2, 2)] * 3))
def test_the_frame_is_right_handed_with_y_away_from_the_viewer(
    viewer: tuple[float, float, float],
) -> None:
    frame = table_frame(LEVEL, SQUARE, CameraPose(np.array([0.5, -1.0, 1.5])), DetectionSettings(viewer=viewer))
    turn = frame[:3, :3]
    assert np.allclose(turn @ turn.T, np.eye(3), atol=1e-12) and np.linalg.det(turn) > 0
    assert np.allclose(turn[2], LEVEL.normal)
    seen_from = moved(np.array([viewer]), frame)[0]
    level = np.hypot(viewer[0] - 0.5, viewer[1] - 0.5)
    if level > 0.1:
        assert seen_from[1] < 0 and abs(seen_from[0]) < 1e-9


def test_the_origin_is_in_the_middle_of_the_table_and_on_it() -> None:
    frame = table_frame(LEVEL, SQUARE, CameraPose(np.array([0.5, -1.0, 1.5])), DetectionSettings())
    assert np.allclose(moved(np.array([[0.5, 0.5, 0.7]]), frame), 0.0, atol=1e-9)
    assert np.allclose(moved(np.array([[0.8, 0.6, 0.9]]), frame), [[0.3, 0.1, 0.2]], atol=1e-9)


def test_another_viewer_sees_left_and_right_the_other_way_round() -> None:
    pose = CameraPose(np.array([0.5, -1.0, 1.5]))
    near = moved(SQUARE, table_frame(LEVEL, SQUARE, pose, DetectionSettings(viewer=(0.5, -1.0, 1.0))))
    far = moved(SQUARE, table_frame(LEVEL, SQUARE, pose, DetectionSettings(viewer=(0.5, 2.0, 1.0))))
    assert np.allclose(near[:, :2], -far[:, :2], atol=1e-9)


@settings(max_examples=50, deadline=None)
@given(st.floats(-np.pi, np.pi), st.tuples(*[st.floats(-0.5, 0.5)] * 2), st.floats(-0.1, 0.1))
def test_a_known_frame_keeps_places_on_a_tilted_plane(turn: float, shift: tuple[float, float], tilt: float) -> None:
    pose = CameraPose(np.array([0.5, -1.0, 1.5]))
    cosine, sine = np.cos(turn), np.sin(turn)
    known = np.eye(4)
    known[:2, :2], known[:3, 3] = [[cosine, -sine], [sine, cosine]], (*shift, -0.7)
    settings = DetectionSettings(frame=tuple(map(tuple, known.tolist())))
    assert np.allclose(table_frame(LEVEL, SQUARE, pose, settings), known, atol=1e-9)
    normal = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    frame = table_frame(Plane(normal, float(normal @ (0.0, 0.0, 0.7))), SQUARE, pose, settings)
    assert np.allclose(frame[2, :3], normal) and np.isclose(np.linalg.det(frame[:3, :3]), 1.0)
    apart = moved(SQUARE, frame)[:, :2] - moved(SQUARE, known)[:, :2]
    assert np.abs(apart).max() < 0.3 * abs(tilt) + 1e-9


def test_an_image_defines_up_and_right() -> None:
    v, u = np.mgrid[:8, :10]
    points = np.stack([(u - 4.5) / 10, (v - 3.5) / 10, np.ones(u.shape)], axis=-1).reshape(-1, 3)
    pose = camera_pose_of(PointCloud(points.astype(np.float32), organised=(8, 10)), DetectionSettings())
    assert pose.up is not None and pose.right is not None
    assert np.allclose(pose.up, [0, -1, 0], atol=0.02) and np.allclose(pose.right, [1, 0, 0], atol=0.02)


def test_the_image_of_a_camera_above_has_its_top_at_the_far_side() -> None:
    plane = Plane(np.array([0.0, 0.0, -1.0]), -1.0)
    pose = CameraPose(np.zeros(3), up=np.array([0.0, -1.0, 0.0]), right=np.array([1.0, 0.0, 0.0]))
    frame = table_frame(plane, np.array([[-1.0, -1, 1], [1, 1, 1]]), pose, DetectionSettings())
    assert np.allclose(moved(np.array([[0.3, -0.2, 0.9]]), frame), [[0.3, 0.2, 0.1]])
