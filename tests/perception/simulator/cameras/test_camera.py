"""The pinhole camera and its pose."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.cameras.camera import Camera, chair_camera, looking_pose
from deixis.perception.simulator.laying import LaidTable, Placement, TableTop, lay

coordinate = st.floats(-2, 2)
place = st.tuples(coordinate, coordinate, coordinate)


def test_pixels_follow_the_pinhole_formula() -> None:
    camera = Camera(looking_pose((0, 0, 1.0), (0, 0, 0)), Intrinsics(100, 80, 50.0, 60.0, 49.5, 39.5))
    (u, v), *_ = camera.pixels(np.array([[0.2, 0.1, 0.5]]))
    assert (u, v) == pytest.approx((49.5 + 50 * 0.2 / 0.5, 39.5 - 60 * 0.1 / 0.5))  # away from the viewer is up


@given(place, place)
def test_the_target_is_in_the_centre_of_the_image(eye: tuple[float, ...], target: tuple[float, ...]) -> None:
    assume(np.linalg.norm(np.subtract(eye, target)) > 1e-3)
    camera = Camera(looking_pose(eye, target))
    turn = camera.pose[:3, :3]
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(turn) == pytest.approx(1.0)
    assert camera.pixels(np.array([target]))[0] == pytest.approx([319.5, 239.5], abs=1e-6)
    assert turn[2, 1] <= 1e-9  # the image's down does not point up


@given(place)
def test_frames_convert_there_and_back(point: tuple[float, ...]) -> None:
    camera = Camera(looking_pose((0.3, -0.8, 0.7), (0, 0, 0)))
    there = camera.to_camera(np.array([point]))
    assert camera.to_table(there)[0] == pytest.approx(point, abs=1e-12)
    assert camera.to_camera(camera.eye[None])[0] == pytest.approx(np.zeros(3), abs=1e-12)


def test_rays_point_where_pixels_are() -> None:
    camera = Camera(looking_pose((0.3, -0.8, 0.7), (0, 0, 0)), Intrinsics(7, 5, 9.0, 8.0, 3.2, 1.9))
    seen = camera.to_table(camera.directions() * 2.5)
    v, u = np.mgrid[:5, :7]
    assert camera.pixels(seen) == pytest.approx(np.column_stack([u.ravel(), v.ravel()]))


def setting(*places: tuple[float, float]) -> LaidTable:
    return lay([Placement(f"cup_{i}", "cup", x, y) for i, (x, y) in enumerate(places)])


def test_the_chair_camera_is_above_the_near_edge() -> None:
    table = setting((-0.2, 0.1), (0.2, 0.3))
    camera = chair_camera(table)
    assert camera.eye == pytest.approx([0.0, table.top.low[1], 0.7], abs=0.01)
    assert camera.pose[:3, 0] == pytest.approx([1, 0, 0], abs=1e-9)  # its right is the viewer's right


def test_from_the_right_side_the_camera_looks_to_the_left() -> None:
    camera = chair_camera(setting((-0.2, 0.1), (0.2, 0.3)), azimuth=np.pi / 2)
    assert camera.pose[:3, 0] == pytest.approx([0, 1, 0], abs=1e-9)
    assert camera.eye[0] > 0.2


def test_a_wide_table_is_seen_from_farther_away() -> None:
    near, far = chair_camera(setting((-0.2, 0.0), (0.2, 0.0))), chair_camera(setting((-1.2, 0.0), (1.2, 0.0)))
    assert far.eye[2] > 1.2
    assert far.pose[:3, 2] == pytest.approx(near.pose[:3, 2], abs=0.05)
    corners = np.array([[x, 0.0, z] for x in (-1.24, 1.24) for z in (0.0, 0.05)])
    assert far.sees(corners)


def test_a_window_shows_the_same_pixels_as_the_whole_image() -> None:
    camera = Camera(looking_pose((0.3, -0.8, 0.7), (0, 0, 0)))
    points = np.array([[0.0, 0.0, 0.0], [0.05, 0.05, 0.1]])
    window = camera.windowed(points)
    assert window.sees(points)
    assert window.lens.width * window.lens.height < 0.1 * 640 * 480
    shift = camera.pixels(points) - window.pixels(points)
    assert shift == pytest.approx(np.rint(shift))
    assert shift == pytest.approx(np.tile(shift[:1], (2, 1)))


def test_impossible_cameras_are_an_error() -> None:
    empty = LaidTable(TableTop((0.0, 0.0), (1.0, 1.0)), ())
    for height in (0.0, -1.0, np.nan, 1e9):
        with pytest.raises(SimulationError, match="above the table"):
            chair_camera(empty, height)
    with pytest.raises(SimulationError, match="must be finite and different"):
        looking_pose((1, 1, 1), (1, 1, 1))
    with pytest.raises(SimulationError, match="must be in the image"):
        Camera(looking_pose((0, 0, 1), (0, 0, 2))).windowed(np.array([[0.0, 0.0, 0.0]]))
