"""Boxes around points."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.perception.detection.outline import oriented_box, upright_box
from deixis.perception.detection.settings import OutlineSettings


@settings(max_examples=40, deadline=None)
@given(st.floats(-3.2, 3.2), st.floats(0.05, 0.3), st.floats(0.01, 0.04), st.integers(0, 999))
def test_a_turned_brick_has_its_own_sides(angle: float, length: float, width: float, seed: int) -> None:
    corners = np.array([(x, y, z) for x in (0, length) for y in (0, width) for z in (0, 0.05)])
    inside = np.random.default_rng(seed).uniform(0, 1, (50, 3)) * (length, width, 0.05)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    points = np.concatenate([corners, inside]) @ turn.T + (0.3, -0.2, 0.0)
    box = oriented_box(points, OutlineSettings())
    assert box.extents == pytest.approx([length, width, 0.05], abs=1e-9)
    assert box.centre == pytest.approx(turn @ (length / 2, width / 2, 0.025) + (0.3, -0.2, 0.0), abs=1e-9)
    assert np.allclose(box.axes @ box.axes.T, np.eye(3)) and np.linalg.det(box.axes) == pytest.approx(1)
    assert -np.pi / 2 < box.yaw <= np.pi / 2 and np.sin(box.yaw - angle) == pytest.approx(0, abs=1e-6)


def test_a_stray_point_in_a_thousand_does_not_stretch_a_box() -> None:
    points = np.random.default_rng(0).uniform(0, 0.1, (2000, 3))
    points[7] = (5, -5, 5)
    assert upright_box(points, OutlineSettings()) == pytest.approx(np.array([[0, 0, 0], [0.1, 0.1, 0.1]]), abs=0.001)


@pytest.mark.parametrize("points", [[[0.1, 0.2, 0.3]], [[0, 0, 0], [1, 1, 0.0]], [[0, 0, 0], [1, 0, 0], [2, 0, 0]]])
def test_points_in_a_line_have_a_flat_box(points: list[list[float]]) -> None:
    box = oriented_box(np.array(points, dtype=np.float64), OutlineSettings())
    assert np.isfinite(box.centre).all() and box.extents[1] == pytest.approx(0, abs=1e-9)
