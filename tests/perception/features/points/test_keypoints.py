"""Voxel keypoints: one per voxel, nearest to the centroid of its points, whatever their order."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.errors import CloudError
from deixis.perception.features.points.keypoints import voxel_keypoints


def plain(points: NDArray[np.floating], size: float) -> list[int]:
    """Return the keypoints by a loop over voxels, as a reference."""
    voxels: dict[tuple[int, ...], list[int]] = {}
    finite = [i for i, point in enumerate(points) if np.isfinite(point).all()]
    low = points[finite].min(axis=0).astype(float)
    for i in finite:
        voxels.setdefault(tuple(np.floor((points[i] - low) / size).astype(int)), []).append(i)
    chosen = []
    for _, members in sorted(voxels.items()):
        centroid = points[members].astype(float).mean(axis=0)
        distances = {i: round(float(((points[i] - centroid) ** 2).sum()) / size**2, 6) for i in members}
        chosen.append(min(members, key=lambda i: (distances[i], *points[i].tolist())))
    return chosen


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("size", [0.05, 0.3, 10.0])
def test_a_loop_over_voxels_finds_the_same_keypoints(seed: int, size: float) -> None:
    points = np.random.default_rng(seed).normal(size=(400, 3)).astype(np.float32)
    points[::17] = np.nan
    assert voxel_keypoints(points, size).tolist() == plain(points, size)


whole = st.lists(st.tuples(*[st.integers(-6, 6)] * 3), min_size=1, max_size=40)


@given(whole, st.randoms(use_true_random=False))
def test_the_order_of_points_does_not_matter(places: list[tuple[int, int, int]], random: object) -> None:
    """Shuffle points on a grid of whole numbers, where many are equally near to a centroid."""
    points = np.array(places, np.float64)
    shuffled = list(range(len(points)))
    random.shuffle(shuffled)  # type: ignore[attr-defined]
    there = points[shuffled]
    expected = points[voxel_keypoints(points, 2.5)]
    np.testing.assert_array_equal(there[voxel_keypoints(there, 2.5)], expected)


@given(whole, st.tuples(*[st.integers(-1000, 1000)] * 3))
def test_moving_the_cloud_moves_the_keypoints(places: list[tuple[int, int, int]], shift: tuple[int, int, int]) -> None:
    points = np.array(places, np.float64)
    np.testing.assert_array_equal(voxel_keypoints(points + shift, 2.5), voxel_keypoints(points, 2.5))


def test_the_first_of_coinciding_points_is_taken() -> None:
    assert voxel_keypoints(np.ones((5, 3)), 0.1).tolist() == [0]


def test_points_without_depth_are_ignored() -> None:
    points = np.array([[np.nan, 0, 0], [np.inf, 0, 0], [1, 1, 1], [0, -np.inf, 0]])
    assert voxel_keypoints(points, 0.1).tolist() == [2]
    assert voxel_keypoints(points[:2], 0.1).tolist() == []
    assert voxel_keypoints(np.empty((0, 3)), 0.1).tolist() == []


@pytest.mark.parametrize("size", [0.0, -1.0, float("nan"), float("inf")])
def test_an_edge_must_be_a_positive_length(size: float) -> None:
    with pytest.raises(CloudError, match="a voxel's edge must be a length above 0"):
        voxel_keypoints(np.zeros((1, 3)), size)


def test_a_voxel_too_small_for_the_cloud_is_an_error() -> None:
    with pytest.raises(CloudError, match="too small for a cloud of 1e"):
        voxel_keypoints(np.array([[0, 0, 0], [1e20, 0, 0]]), 1e-3)


def test_points_of_a_wrong_shape_are_an_error() -> None:
    with pytest.raises(CloudError, match=r"shape \(n, 3\), got \(4, 2\)"):
        voxel_keypoints(np.zeros((4, 2)), 0.1)
