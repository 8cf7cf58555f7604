"""Plane of a table in noise, among outliers and beside other planes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.table.plane import CameraPose, Plane, refined, table_plane


def _turn(seed: int) -> NDArray[np.float64]:
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    right_handed: NDArray[np.float64] = turn * np.sign(np.linalg.det(turn))
    return right_handed


def _table(rng: np.random.Generator, count: int = 4000, noise: float = 0.002) -> NDArray[np.float64]:
    return np.column_stack([rng.uniform(-0.5, 0.5, (count, 2)), rng.normal(0, noise, count)])


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10**6))
def test_a_noisy_plane_among_outliers_is_recovered(seed: int) -> None:
    rng = np.random.default_rng(seed)
    outliers = rng.uniform((-0.5, -0.5, 0.0), (0.5, 0.5, 0.5), (1500, 3))
    turn, shift = _turn(seed), rng.uniform(-1, 1, 3)
    points = np.concatenate([_table(rng), outliers]) @ turn.T + shift
    eye = np.array([0.0, -0.6, 0.8]) @ turn.T + shift
    plane = table_plane(points, CameraPose(eye), DetectionSettings())
    assert plane is not None
    assert float(plane.normal @ turn[:, 2]) > np.cos(np.radians(0.3))
    assert abs(float(plane.normal @ shift) - plane.offset) < 0.001


def test_refinement_of_near_points_is_least_squares() -> None:
    points = _table(np.random.default_rng(3), 500, 0.001)
    found = refined(Plane(np.array([0.0, 0.0, 1.0]), 0.0), points, np.full(500, 0.1))
    expected = np.linalg.svd(points - points.mean(axis=0))[2][2]
    assert abs(abs(found.normal @ expected) - 1) < 1e-12
    assert found.offset == pytest.approx(found.normal @ points.mean(axis=0))


def test_the_table_is_found_although_the_floor_is_larger() -> None:
    rng = np.random.default_rng(1)
    floor = np.column_stack([rng.uniform(-1.5, 1.5, (9000, 2)), np.full(9000, -0.75)])
    things = rng.uniform((-0.2, -0.2, 0.02), (0.2, 0.2, 0.2), (1200, 3))
    points = np.concatenate([floor, _table(rng), things])
    plane = table_plane(points, CameraPose(np.array([0.0, -1.0, 0.9])), DetectionSettings())
    assert plane is not None and abs(plane.offset) < 0.005


@pytest.mark.parametrize("wall", [False, True])
def test_a_table_with_few_objects_is_preferred_to_a_larger_floor(wall: bool) -> None:
    rng = np.random.default_rng(4)
    things = rng.uniform((-0.1, -0.1, 0.02), (0.0, 0.0, 0.1), (150, 3))
    floor = rng.uniform((-3, 0.6, 0), (3, 3, 0), (20_000, 3)) - [0.0, 0.0, 0.75]
    behind = rng.uniform((-3, 3, -0.75), (3, 3, 1.5), (20_000, 3))
    points = np.concatenate([_table(rng), things, floor, *([behind] if wall else [])])
    camera = CameraPose(np.array([0.0, -0.7, 0.8]), up=np.array([0.0, 0.5, 0.85]), right=np.array([1.0, 0.0, 0.0]))
    found = table_plane(points, camera, DetectionSettings())
    assert found is not None and abs(found.offset) < 0.01


def test_an_upright_camera_does_not_take_a_wall_for_a_table() -> None:
    rng = np.random.default_rng(1)
    wall = np.column_stack([rng.uniform(-1.5, 1.5, 9000), np.full(9000, 0.6), rng.uniform(0, 1.5, 9000)])
    points = np.concatenate([wall, _table(rng)])
    up, right = np.array([0.0, 0.6, 0.8]), np.array([1.0, 0.0, 0.0])
    plane = table_plane(points, CameraPose(np.array([0.0, -0.8, 0.8]), up, right), DetectionSettings())
    assert plane is not None and plane.normal[2] > 0.999
    only_wall = table_plane(wall, CameraPose(np.array([0.0, -0.8, 0.8]), up, right), DetectionSettings())
    assert only_wall is None


def test_points_without_a_plane_have_no_table() -> None:
    assert table_plane(np.zeros((50, 3)), CameraPose(np.array([0.0, 0.0, 1.0])), DetectionSettings()) is None
    line = np.outer(np.linspace(0, 1, 50), [1.0, 2.0, 3.0])
    assert table_plane(line, CameraPose(np.array([0.0, 0.0, 1.0])), DetectionSettings()) is None


def test_the_edge_of_a_table_does_not_stand_on_its_underside() -> None:
    rng = np.random.default_rng(0)
    edge = np.column_stack([rng.uniform(-0.5, 0.5, 200), np.full(200, -0.5), rng.uniform(-0.03, -0.01, 200)])
    speck = rng.uniform((0.1, 0.1, 0.01), (0.12, 0.12, 0.03), (100, 3))
    turn = np.array([[np.cos(0.5), -np.sin(0.5), 0.0], [np.sin(0.5), np.cos(0.5), 0.0], [0.0, 0.0, 1.0]])
    points = np.concatenate([_table(rng, 9000), edge, speck]) @ turn.T
    plane = table_plane(points, CameraPose(np.array([0.0, -0.6, 0.8])), DetectionSettings())
    assert plane is not None and plane.normal[2] > 0.99
