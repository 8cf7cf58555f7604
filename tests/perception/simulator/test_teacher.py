"""The simulated teacher who points."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.errors import SimulationError
from deixis.perception.scene import Scene
from deixis.perception.simulator.teacher import FOREARM, UPPER_ARM, PointingNoise, Teacher

SCENE = Scene.from_boxes(centre=[[0.0, 0.0, 0.05], [0.4, 0.2, 0.05]], size=[[0.1] * 3] * 2)
EXACT = PointingNoise(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_a_seed_always_gives_one_recording() -> None:
    first, second = (Teacher(SCENE, 7).points_at(["o1", "o2"]) for _ in range(2))
    assert first == second
    assert first != Teacher(SCENE, 8).points_at(["o1", "o2"])


def test_bones_keep_their_length_while_the_arm_moves() -> None:
    teacher = Teacher(SCENE, 3, EXACT)
    for frame in teacher.points_at(["o1", "o2"]).skeletons:
        for side in ("left", "right"):
            shoulder, elbow, wrist = (
                np.array(frame.joints[f"{side}_{name}"]) for name in ("shoulder", "elbow", "wrist")
            )
            lengths = np.linalg.norm(elbow - shoulder), np.linalg.norm(wrist - elbow)
            assert lengths[0] / lengths[1] == pytest.approx(UPPER_ARM / FOREARM, rel=0.02)


def test_without_noise_the_line_of_sight_meets_the_place() -> None:
    misses = []
    for seed in range(20):
        recording = Teacher(SCENE, seed, EXACT).points_at(["o1", "o2"])
        for aim in recording.aims:
            frame = next(one for one in recording.skeletons if one.at > (aim.start + aim.finish) / 2)
            tips = [np.array(frame.joints[f"{side}_hand_tip"]) for side in ("left", "right")]
            tip = min(tips, key=lambda one: float(np.linalg.norm(one - np.array(aim.place))))
            line = (tip - np.array(frame.joints["head"])) / np.linalg.norm(tip - np.array(frame.joints["head"]))
            away = np.array(aim.place) - tip
            misses.append(np.arccos(line @ away / np.linalg.norm(away)))
    assert np.median(misses) < np.deg2rad(4)


def test_a_place_without_a_thing_is_off_all_things() -> None:
    for seed in range(10):
        place = np.array(Teacher(SCENE, seed).points_at([None]).aims[0].place)
        inside = ((place[:2] > SCENE.boxes[:, 0, :2]) & (place[:2] < SCENE.boxes[:, 1, :2])).all(axis=1)
        assert not inside.any()


@pytest.mark.parametrize(
    ("scene", "targets", "message"),
    [
        (Scene(()), ["o1"], "at least one object"),
        (Scene.from_boxes(min=[[0, 0]], max=[[1, 1]]), ["o1"], "with heights"),
        (SCENE, ["o9"], "there is no thing 'o9'"),
    ],
)
def test_a_scene_that_cannot_be_shown_is_an_error(scene: Scene, targets: list[str | None], message: str) -> None:
    with pytest.raises(SimulationError, match=message):
        Teacher(scene).points_at(targets)
