"""Boxes around points, and partly hidden round objects."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.detection.outline import Circle, circle_around, corners_of, oriented_box, rim_of, upright_box
from deixis.perception.detection.settings import OutlineSettings

LIMITS = OutlineSettings()
NO_TABLE = np.zeros((0, 2))


@settings(max_examples=40, deadline=None)
@given(st.floats(-3.2, 3.2), st.floats(0.05, 0.3), st.floats(0.01, 0.04), st.integers(0, 999))
def test_a_turned_brick_has_its_own_sides(angle: float, length: float, width: float, seed: int) -> None:
    corners = np.array([(x, y, z) for x in (0, length) for y in (0, width) for z in (0, 0.05)])
    inside = np.random.default_rng(seed).uniform(0, 1, (50, 3)) * (length, width, 0.05)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    points = np.concatenate([corners, inside]) @ turn.T + (0.3, -0.2, 0.0)
    box = oriented_box(points, LIMITS)
    assert box.extents == pytest.approx([length, width, 0.05], abs=1e-9)
    assert box.centre == pytest.approx(turn @ (length / 2, width / 2, 0.025) + (0.3, -0.2, 0.0), abs=1e-9)
    assert np.allclose(box.axes @ box.axes.T, np.eye(3)) and np.linalg.det(box.axes) == pytest.approx(1)
    assert -np.pi / 2 < box.yaw <= np.pi / 2 and np.sin(box.yaw - angle) == pytest.approx(0, abs=1e-6)


def test_a_stray_point_in_a_thousand_does_not_stretch_a_box() -> None:
    points = np.random.default_rng(0).uniform(0, 0.1, (2000, 3))
    points[7] = (5, -5, 5)
    assert upright_box(points, LIMITS) == pytest.approx(np.array([[0, 0, 0], [0.1, 0.1, 0.1]]), abs=0.001)


@pytest.mark.parametrize("points", [[[0.1, 0.2, 0.3]], [[0, 0, 0], [1, 1, 0.0]], [[0, 0, 0], [1, 0, 0], [2, 0, 0]]])
def test_points_in_a_line_have_a_flat_box(points: list[list[float]]) -> None:
    box = oriented_box(np.array(points, dtype=np.float64), LIMITS)
    assert np.isfinite(box.centre).all() and box.extents[1] == pytest.approx(0, abs=1e-9)


def _disc(radius: float, step: float = 0.002) -> NDArray[np.float64]:
    axis = np.arange(-radius, radius + step, step)
    plan = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    disc: NDArray[np.float64] = plan[np.linalg.norm(plan, axis=1) <= radius]
    return disc


def _crescent(below: float) -> NDArray[np.float64]:
    """Return the visible part of a plate of 12 cm radius in front of an object on it."""
    disc = _disc(0.12)
    return disc[disc[:, 1] < below]


def _rim(plan: NDArray[np.float64], table: NDArray[np.float64]) -> Circle | None:
    return rim_of(plan, corners_of(plan), table, LIMITS)


@pytest.mark.parametrize("below", [-0.05, 0.0, 0.08])
def test_the_rim_of_a_plate_continues_behind_an_object(below: float) -> None:
    rim = _rim(_crescent(below) + np.array([0.3, 0.1]), NO_TABLE)
    assert rim is not None
    assert rim.centre == pytest.approx([0.3, 0.1], abs=0.003)
    assert rim.radius == pytest.approx(0.12, abs=0.003)


def test_a_box_at_any_yaw_includes_the_hidden_part_of_a_rim() -> None:
    plan = _crescent(-0.03) + np.array([0.2, 0.3])
    points, rim = np.column_stack([plan, np.full(len(plan), 0.02)]), _rim(plan, NO_TABLE)
    assert upright_box(points, LIMITS, rim)[:, :2] == pytest.approx(np.array([[0.08, 0.18], [0.32, 0.42]]), abs=0.004)
    turned = oriented_box(points, LIMITS, rim)
    assert turned.centre[:2] == pytest.approx([0.2, 0.3], abs=0.004)
    assert turned.extents[:2] == pytest.approx([0.24, 0.24], abs=0.006)


def test_a_rim_does_not_continue_over_the_visible_table() -> None:
    crescent = _crescent(-0.03)
    behind = _disc(0.12)[_disc(0.12)[:, 1] > 0.02]
    assert _rim(crescent, behind) is None
    assert _rim(crescent, behind + np.array([0.0, 0.3])) is not None


@pytest.mark.parametrize(
    "seen",
    [
        _crescent(-0.1),
        _disc(0.12) * (1.0, 0.2),
        _disc(0.12)[np.abs(_disc(0.12)[:, 0]) < 0.02],
        np.stack(np.meshgrid(np.arange(0, 0.2, 0.004), np.arange(0, 0.16, 0.004)), axis=-1).reshape(-1, 2),
        np.array([[0.0, 0.0], [0.1, 0.0], [0.2, 0.0]]),
        _disc(0.4, 0.01),
    ],
    ids=["too little of an edge", "a spoon", "a strip of a plate", "a napkin", "points in a line", "a round table"],
)
def test_a_doubtfully_round_object_has_no_rim(seen: NDArray[np.float64]) -> None:
    assert _rim(seen, NO_TABLE) is None


def test_a_circle_is_found_at_any_place_and_yaw() -> None:
    rng, turn = np.random.default_rng(0), 0.7
    axes = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    plan = _disc(0.08) + rng.normal(size=2)
    there, here = (circle_around(corners_of(places), LIMITS.rim_tolerance) for places in (plan @ axes.T, plan))
    assert there is not None and here is not None
    assert there.centre == pytest.approx(here.turned(axes).centre, abs=1e-6)
    assert there.radius == pytest.approx(here.radius, abs=1e-6)
