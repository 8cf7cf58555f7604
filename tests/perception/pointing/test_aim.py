"""Things that gestures point at."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.perception.errors import PointingError
from deixis.perception.pointing.aim import misses, pointed_at, shipped_aim
from deixis.perception.pointing.gesture import Gesture, gestures
from deixis.perception.scene import Scene
from deixis.perception.simulator.teacher import Teacher

SIZES = [[0.08, 0.08, 0.1]] * 3
SCENE = Scene.from_boxes(centre=[[0.0, 0.3, 0.05], [0.3, 0.3, 0.05], [-0.3, 0.3, 0.05]], size=SIZES)


def straight_at(place: tuple[float, float, float], reach: float = 0.15) -> Gesture:
    """Return a gesture whose eye, elbow, wrist and fingertip are in one line with a place."""
    eye, target = np.array([0.05, -0.3, 0.5]), np.array(place)
    line = (target - eye) / np.linalg.norm(target - eye)
    tip = target - reach * line
    wrist = tip - 0.18 * line
    return Gesture("anna", "right", 1.0, 2.0, eye, wrist - 0.25 * line, wrist, tip, np.full(3, 0.01))


def test_a_ray_through_a_thing_decides_it() -> None:
    found = pointed_at(straight_at((0.3, 0.3, 0.08)), SCENE)
    assert found.decided == "o2"
    assert found.question is None and found.refused is None
    assert sum(found.probabilities.values()) + found.none == pytest.approx(1.0)


def test_the_middle_between_two_near_things_asks_which() -> None:
    near = Scene.from_boxes(centre=[[-0.03, 0.3, 0.05], [0.03, 0.3, 0.05]], size=[[0.05, 0.05, 0.1]] * 2)
    found = pointed_at(straight_at((0.0, 0.3, 0.05)), near)
    assert found.decided is None
    assert found.question in ("Which one do you mean: o1 or o2?", "Which one do you mean: o2 or o1?")


def test_an_empty_place_matches_no_thing() -> None:
    found = pointed_at(straight_at((0.15, 0.6, 0.0)), SCENE)
    assert found.decided is None and found.none > 0.9
    assert "none of them" in str(found.refused)


def test_without_an_eye_the_arm_still_points() -> None:
    seen = straight_at((0.3, 0.3, 0.08), 0.05)
    blind = Gesture("anna", "right", 1.0, 2.0, np.full(3, np.nan), seen.elbow, seen.wrist, seen.tip, np.full(3, np.nan))
    found = pointed_at(blind, SCENE)
    assert next(iter(found.probabilities)) == "o2"
    assert found.probabilities["o2"] < pointed_at(seen, SCENE).probabilities["o2"]


def test_a_prior_settles_what_the_ray_leaves_open() -> None:
    near = Scene.from_boxes(centre=[[-0.03, 0.3, 0.05], [0.03, 0.3, 0.05]], size=[[0.05, 0.05, 0.1]] * 2)
    assert pointed_at(straight_at((0.0, 0.3, 0.08)), near, prior={"o1": 0.001}).decided == "o2"


def test_a_scene_without_things_refuses() -> None:
    assert pointed_at(straight_at((0.0, 0.3, 0.0)), Scene(())).refused == "the scene has no things"


def test_a_scene_without_heights_is_an_error() -> None:
    flat = Scene.from_boxes(min=[[0.0, 0.0]], max=[[0.1, 0.1]])
    with pytest.raises(PointingError, match="heights"):
        pointed_at(straight_at((0.0, 0.3, 0.0)), flat)


@settings(max_examples=25, deadline=None)
@given(st.floats(-3.1, 3.1), st.floats(-1, 1), st.floats(-1, 1))
def test_turning_the_world_changes_no_probability(angle: float, x: float, y: float) -> None:
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    shift, gesture, place = np.array([x, y, 0.0]), straight_at((0.3, 0.3, 0.08)), np.array([[0.2, 0.4, 0.0]])
    eye, elbow, wrist, tip = (turn @ part + shift for part in (gesture.eye, gesture.elbow, gesture.wrist, gesture.tip))
    turned = Gesture("anna", "right", 1.0, 2.0, eye, elbow, wrist, tip, gesture.scatter)
    before = shipped_aim().log_densities(gesture, place)
    assert shipped_aim().log_densities(turned, place @ turn.T + shift) == pytest.approx(before, abs=1e-6)


def test_misses_are_the_angles_between_ray_and_place() -> None:
    gesture = straight_at((0.0, 0.3, 0.05), reach=0.5)
    place = gesture.tip + 0.5 * gesture.rays[0] + np.array([0.0, 0.0, 0.05])
    off, distance = misses(gesture, place[None])
    ahead = (place - gesture.tip) / np.linalg.norm(place - gesture.tip)
    assert np.linalg.norm(off[0, :, 0]) == pytest.approx(np.arccos(ahead @ gesture.rays[0]), rel=0.01)
    assert distance == pytest.approx(np.linalg.norm(place - gesture.tip))


def test_simulated_teachers_are_understood() -> None:
    decided = []
    for seed in range(8):
        recording = Teacher(SCENE, seed).points_at(["o1", "o2", "o3"])
        for gesture in gestures(recording.skeletons):
            target = [aim.target for aim in recording.aims if aim.start < gesture.finish and gesture.start < aim.finish]
            found = pointed_at(gesture, SCENE).decided
            assert found is None or target == [found]
            decided += [found] if target else []
    assert sum(one is not None for one in decided) >= 20
