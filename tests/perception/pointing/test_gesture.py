"""Holds of an arm that are found in skeletons."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.errors import PointingError
from deixis.perception.pointing.gesture import GestureDetector, gestures, speeds
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.scene import Scene
from deixis.perception.simulator.teacher import PointingNoise, Recording, Teacher

SCENE = Scene.from_boxes(
    centre=[[0.0, 0.0, 0.01], [0.3, 0.0, 0.05], [-0.3, 0.2, 0.05]], size=[[0.2, 0.2, 0.02], [0.1] * 3, [0.1] * 3]
)


@pytest.fixture(scope="module")
def recording() -> Recording:
    return Teacher(SCENE, seed=4).points_at(["o1", "o2", "o3"])


def test_each_simulated_hold_is_found(recording: Recording) -> None:
    found = gestures(recording.skeletons)
    for aim in recording.aims:
        same = [one for one in found if one.start < aim.finish and aim.start < one.finish]
        assert len(same) == 1
        assert same[0].start == pytest.approx(aim.start, abs=0.3)


def test_the_stream_yields_the_gestures_of_the_file(recording: Recording) -> None:
    detector = GestureDetector()
    live = [one for frame in recording.skeletons for one in detector.update(frame)]
    live += detector.finish()
    assert [one.start for one in live] == [one.start for one in gestures(recording.skeletons)]


def test_a_late_frame_is_counted_and_ignored(recording: Recording) -> None:
    detector = GestureDetector()
    frames = list(recording.skeletons)
    frames.insert(30, frames[3])
    live = [one for frame in frames for one in detector.update(frame)] + list(detector.finish())
    assert detector.late == 1
    assert len(live) == len(gestures(recording.skeletons))


def test_joints_that_are_missing_now_and_then_do_no_harm() -> None:
    noisy = PointingNoise(dropped=0.1)
    found = Teacher(SCENE, seed=4, noise=noisy).points_at(["o1", "o2"])
    times = [one.at for one in gestures(found.skeletons)]
    assert all(any(aim.start <= at <= aim.finish for at in times) for aim in found.aims)


def test_an_arm_that_never_moves_makes_no_gesture() -> None:
    joints = {"right_shoulder": (0.2, -0.5, 0.6), "right_elbow": (0.25, -0.3, 0.4), "right_wrist": (0.2, -0.1, 0.3)}
    assert gestures([Skeleton(0.1 * i, joints) for i in range(40)]) == ()


def test_speeds_are_those_of_a_straight_path() -> None:
    times = np.linspace(0.0, 2.0, 61)
    path = np.array([0.3, 0.4, 0.0]) * times[:, None]
    assert speeds(times, path) == pytest.approx(np.full(61, 0.5))


@pytest.mark.parametrize("place", [(0.0, float("nan"), 0.0), (0.0, 1e6, 0.0), (0.0, 1.0)])
def test_a_skeleton_refuses_invalid_places(place: tuple[float, ...]) -> None:
    with pytest.raises(PointingError, match="'head' must have 3 finite"):
        Skeleton(0.0, {"head": place})  # type: ignore[dict-item]
