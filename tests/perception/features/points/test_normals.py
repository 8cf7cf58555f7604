"""Normals: those of known surfaces, oriented towards the sensor, and none where there is no plane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from deixis.perception.errors import CloudError
from deixis.perception.features.points.normals import estimate_normals

WAYS: list[dict[str, Any]] = [{"radius": 0.12}, {"neighbours": 12}]


def bowl(seed: int = 0, n: int = 1500) -> NDArray[np.float64]:
    """Return the cap of the unit sphere around (0, 0, -1), seen from its centre."""
    rng = np.random.default_rng(seed)
    xy = rng.uniform(-0.5, 0.5, (n, 2))
    return np.column_stack([xy, -np.sqrt(1 - (xy**2).sum(axis=1))])


@pytest.mark.parametrize("way", WAYS)
def test_normals_of_a_sphere_point_to_its_centre(way: dict[str, Any]) -> None:
    points = bowl()
    normals = estimate_normals(points, **way)
    inner = np.abs(points[:, :2]).max(axis=1) < 0.4
    assert normals.dtype == np.float32
    assert ((normals * -points).sum(axis=1)[inner] > np.cos(0.06)).all()


@pytest.mark.parametrize("way", WAYS)
def test_the_sensor_on_the_other_side_flips_normals(way: dict[str, Any]) -> None:
    points = bowl()
    outside = estimate_normals(points, origin=(0, 0, -9), **way)
    np.testing.assert_array_equal(outside, -estimate_normals(points, **way))


@pytest.mark.parametrize("seed", range(3))
def test_normals_are_eigenvectors_of_the_covariance(seed: int) -> None:
    points = np.random.default_rng(seed).uniform(0, 1, (200, 3))
    normals = estimate_normals(points, radius=0.4, origin=(5, 5, 5))
    for i, members in enumerate(cKDTree(points).query_ball_point(points, 0.4)):
        expected = np.linalg.svd(points[members] - points[members].mean(axis=0))[2][2]
        assert abs(expected @ normals[i]) > 1 - 1e-6


@pytest.mark.parametrize("way", WAYS)
def test_normals_at_some_points_only(way: dict[str, Any]) -> None:
    points = bowl()
    at = np.array([7, 3, 1400])
    np.testing.assert_allclose(estimate_normals(points, at=at, **way), estimate_normals(points, **way)[at], atol=1e-6)
    assert estimate_normals(points, at=np.empty(0, np.int64), **way).shape == (0, 3)


@settings(max_examples=25, deadline=None)
@given(st.tuples(*[st.floats(-3, 3)] * 3), st.tuples(*[st.floats(-2, 2)] * 3), st.sampled_from(WAYS))
def test_normals_turn_with_cloud_and_sensor(
    turn: tuple[float, float, float], shift: tuple[float, float, float], way: dict[str, Any]
) -> None:
    points = bowl(n=300)
    rotation = Rotation.from_rotvec(turn).as_matrix()
    expected = estimate_normals(points, **way) @ rotation.T
    found = estimate_normals(points @ rotation.T + shift, origin=shift, **way)
    np.testing.assert_allclose(found, expected, atol=1e-4)


def test_lines_and_single_places_have_no_normals() -> None:
    line = np.arange(30.0)[:, None] * np.array([0.3, -0.2, 0.1]) + 5
    for points in (line, line.astype(np.float32), line[:2], line[:1], np.ones((9, 3))):
        for way in ({"radius": 2.0}, {"neighbours": 5}):
            assert np.isnan(estimate_normals(points, **way)).all()


def test_points_without_depth_are_ignored() -> None:
    points = bowl(n=300)
    holed = np.insert(points, 10, np.nan, axis=0)
    for way in WAYS:
        normals = estimate_normals(holed, **way)
        assert np.isnan(normals[10]).all()
        np.testing.assert_allclose(np.delete(normals, 10, axis=0), estimate_normals(points, **way), atol=1e-6)
    assert estimate_normals(np.empty((0, 3)), radius=1.0).shape == (0, 3)


def test_a_wall_seen_edge_on_has_a_positive_normal() -> None:
    y, z = (axis.ravel() for axis in np.meshgrid(np.arange(5.0), np.arange(5.0)))
    wall = np.column_stack([np.zeros(25), y, z])
    assert (estimate_normals(wall, radius=2.0)[:, 0] == 1).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "exactly one of `radius` and `neighbours`"),
        ({"radius": 1.0, "neighbours": 5}, "exactly one of `radius` and `neighbours`"),
        ({"radius": -1.0}, "length above 0"),
        ({"neighbours": 2}, "`neighbours` must be at least 3"),
        ({"radius": 1.0, "at": np.array([99])}, "must be from 0 to 3"),
    ],
)
def test_bad_input_is_a_cloud_error(options: dict[str, Any], message: str) -> None:
    with pytest.raises(CloudError, match=message):
        estimate_normals(np.eye(4, 3), **options)
