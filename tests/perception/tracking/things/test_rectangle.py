"""Flat rectangular things of which something hides a corner or a part of a side."""

import numpy as np
import pytest

from deixis.perception.detection.outline import oriented_box
from deixis.perception.detection.settings import OutlineSettings
from deixis.perception.tracking.things.rectangle import is_rectangular

PLAN = np.random.default_rng(3).uniform(-0.1, 0.1, (6000, 2))


def rectangular(plan: np.ndarray, *, sides: tuple[float, float] = (1.0, 0.8), height: float = 0.01) -> bool:
    """Return whether points in plan, turned and stretched, fill their box."""
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    z = np.random.default_rng(4).uniform(0.0, height, len(plan))
    points = np.column_stack([(plan * sides) @ turn.T + (0.3, 0.2), z])
    return is_rectangular(points, oriented_box(points, OutlineSettings()))


def test_napkin_with_a_hidden_corner_is_rectangular() -> None:
    assert rectangular(PLAN)
    assert rectangular(PLAN[PLAN.sum(axis=1) < 0.1]), "a corner is cut off along the half of its sides"


def test_napkin_shows_three_corners_around_a_glass() -> None:
    before = (PLAN[:, 0] > -0.06) & (PLAN[:, 1] < 0.02)
    assert rectangular(PLAN[~before])


@pytest.mark.parametrize("least", [-0.2, 0.0, 0.04])
def test_plate_is_not_rectangular(least: float) -> None:
    plate = np.linalg.norm(PLAN, axis=1) < 0.1
    assert not rectangular(PLAN[plate & (PLAN[:, 0] > least)], sides=(1.0, 1.0))


def test_long_and_high_things_are_not_completed() -> None:
    assert not rectangular(PLAN, sides=(1.0, 0.1))
    assert not rectangular(PLAN, height=0.1)
