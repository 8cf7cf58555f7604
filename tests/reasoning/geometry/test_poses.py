"""Fronts and long axes of things."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.reasoning.geometry.poses import Poses, coaxial

KNIFE, PLATE = [[0.0, 0.0], [0.02, 0.2]], [[0.1, 0.0], [0.3, 0.2]]


def test_a_square_has_no_axis() -> None:
    poses = Poses.of_boxes(np.array([KNIFE, PLATE]))
    assert poses.stretch == pytest.approx([0.818, 0.0], abs=1e-3)
    assert coaxial(poses, poses)[0, 1] == pytest.approx(0.0, abs=1e-6)


@given(st.floats(-math.pi, math.pi))
def test_half_a_turn_leaves_the_axis(yaw: float) -> None:
    square = Poses.of_boxes(np.array([PLATE, PLATE]))
    poses = square.with_oriented([0, 1], [yaw, yaw + math.pi], [(0.2, 0.02), (0.2, 0.02)])
    assert coaxial(poses, poses)[0, 1] == pytest.approx(poses.stretch[0])


@given(st.floats(-math.pi, math.pi), st.booleans())
def test_turning_a_scene_keeps_the_angles_between_things(angle: float, mirrored: bool) -> None:
    fronts = np.array([[1.0, 0.0], [0.6, 0.8]])
    poses = Poses.of_boxes(np.array([KNIFE, KNIFE]), fronts)
    after = poses.turned(angle, mirrored)
    assert after.fronts[0] @ after.fronts[1] == pytest.approx(0.6)
    assert coaxial(after, after)[0, 1] == pytest.approx(coaxial(poses, poses)[0, 1])


@given(st.floats(-math.pi, math.pi), st.floats(-math.pi, math.pi), st.booleans(), st.booleans())
def test_aim_angles_do_not_depend_on_the_frame(way: float, turn: float, facing: bool, handle: bool) -> None:
    head, aim = (np.array([math.cos(way + off), math.sin(way + off)]) for off in (0.0, 1.0))
    poses = replace(Poses.of_boxes(np.array([KNIFE, PLATE])), heads=np.array([head, [np.nan, np.nan]]))
    turned = poses.turned(turn)
    wanted = replace(poses, fronts=np.array([aim, aim])).turned(turn).fronts[0]
    before, after = poses.aim_angles(aim, facing, handle), turned.aim_angles(wanted, facing, handle)
    assert after == pytest.approx(before, abs=1e-6, nan_ok=True)
    assert np.isnan(before[1]) and (np.isnan(before[0]) or before[0] == pytest.approx(math.pi - 1 if handle else 1.0))
