"""Backs of upright round things, from the arcs of their fronts."""

import numpy as np
import pytest

from deixis.perception.tracking.things.revolution import circle_around, revolution_around


def front(radius: float, *, height: float = 0.2) -> np.ndarray:
    """Return points of the front of a bottle whose radius falls to a third at the neck, about (0.1, 0.2)."""
    rng = np.random.default_rng(1)
    angle, z = rng.uniform(-1.3, 1.3, 3000) - np.pi / 2, rng.uniform(0.0, height, 3000)
    away = np.where(z < 0.7 * height, radius, radius / 3) + rng.normal(0, 0.001, 3000)
    return np.column_stack([0.1 + away * np.cos(angle), 0.2 + away * np.sin(angle), z])


@pytest.mark.parametrize("radius", [0.03, 0.05])
def test_axis_of_a_bottle_is_found_from_its_front(radius: float) -> None:
    circle = circle_around(front(radius))
    assert circle is not None and circle.centre == pytest.approx((0.1, 0.2), abs=0.003)
    assert circle.radius == pytest.approx(radius, abs=0.003)


def test_handle_does_not_shift_the_axis() -> None:
    mug, rng = front(0.04, height=0.1), np.random.default_rng(2)
    handle = np.array([0.14, 0.18, 0.03]) + rng.uniform(0, [0.03, 0.008, 0.05], (120, 3))
    circle = circle_around(np.concatenate([mug, handle]))
    assert circle is not None and circle.centre == pytest.approx((0.1, 0.2), abs=0.003)


def test_box_and_flat_thing_have_no_axis() -> None:
    rng = np.random.default_rng(3)
    side, z = rng.uniform(0, 0.08, (2, 1500)), rng.uniform(0, 0.2, 1500)
    faces = np.concatenate([np.column_stack([side[0], 0 * z, z]), np.column_stack([0 * z, side[1], z])])
    assert circle_around(faces) is None
    assert circle_around(front(0.04, height=0.03)) is None
    assert circle_around(np.zeros((0, 3))) is None


def test_circle_of_a_narrow_arc_is_within_the_true_one() -> None:
    points = front(0.04)
    points = points[np.abs(points[:, 0] - 0.1) < 0.01]
    circle = circle_around(points)
    assert circle is None or circle.centre[1] + circle.radius < 0.24, "within the true back"


@pytest.mark.parametrize("direction", [0.7, -2.0])
def test_direction_of_a_handle_is_found_about_the_axis(direction: float) -> None:
    mug, rng = front(0.04, height=0.1), np.random.default_rng(5)
    away, across, z = rng.uniform((0.042, -0.004, 0.03), (0.07, 0.004, 0.08), (120, 3)).T
    cosine, sine = np.cos(direction), np.sin(direction)
    handle = np.column_stack([0.1 + cosine * away - sine * across, 0.2 + sine * away + cosine * across, z])
    found = revolution_around(np.concatenate([mug, handle]))
    assert found is not None and found.handle(mug) is None
    assert found.handle(np.concatenate([mug, handle])) == pytest.approx(direction, abs=0.1)
    assert found.is_handle(handle).mean() > 0.8 and not found.is_handle(mug).any()


def test_surface_is_found_again_beside_its_place() -> None:
    found = revolution_around(front(0.04))
    assert found is not None
    moved = found.moved_to(front(0.04) + np.array([0.012, -0.009, 0.0]))
    assert moved.centre - found.centre == pytest.approx((0.012, -0.009), abs=0.003)
