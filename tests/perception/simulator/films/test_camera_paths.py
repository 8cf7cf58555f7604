"""Paths of the camera of a film: a head that sways, and a person who walks."""

import numpy as np
import pytest

from deixis.perception.simulator.films.camera_paths import HeadMotion, Walk
from deixis.perception.simulator.films.stage import Rest, film
from deixis.perception.simulator.laying import Placement

PLATE = Placement("plate", "dinner plate", 0.0, 0.0, seed=1)


def test_camera_of_a_head_moves_slowly() -> None:
    story = film([PLATE], [Rest(3.0)], path=HeadMotion(seed=1))
    eyes = np.array([frame.camera.eye for frame in story.frames(5, scale=0.05)])
    steps = np.linalg.norm(np.diff(eyes, axis=0), axis=1)
    assert 0 < steps.max() < 0.05 and np.ptp(eyes, axis=0).max() > 0.01


def test_walking_camera_looks_at_one_place_from_one_distance() -> None:
    camera = film([PLATE], [Rest(1.0)]).camera
    walk = Walk(np.pi / 2, 4.0, sway=None)
    ahead = camera.pose[:3, 2]
    middle = camera.eye - ahead * camera.eye[2] / ahead[2]
    for at in (0.0, 1.0, 2.5, 4.0, 8.0):
        walked = walk.moved(camera, at)
        away = np.linalg.norm(walked.eye - middle)
        assert walked.eye + away * walked.pose[:3, 2] == pytest.approx(middle, abs=1e-9)
        assert away == pytest.approx(np.linalg.norm(camera.eye - middle))
    assert walk.moved(camera, 8.0).pose == pytest.approx(camera.pose)
