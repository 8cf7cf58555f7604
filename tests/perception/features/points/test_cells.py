"""Runs of cells hold every point within reach, and few others."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.perception.features.points.kernels import ball_runs, cell_grid, cylinder_runs, in_axes_of


@settings(max_examples=80, deadline=None)
@given(st.integers(0, 10**6), st.sampled_from([0.02, 0.1, 0.5]), st.booleans(), st.booleans())
def test_no_point_within_reach_is_missed(seed: int, cell: float, upright: bool, flat: bool) -> None:
    """Include axes along the grid, where the bounds of a cylinder have special cases."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-1, 1, (400, 3)) * [1.0, 0.6, 0.0 if flat else 0.3]
    axis = np.eye(3)[seed % 3] if upright else rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    grid, reach = cell_grid(points, cell), 0.3
    place, turned = in_axes_of(grid, points[:1])[0], in_axes_of(grid, axis[None])[0]
    offsets = points - points[0]
    beta = offsets @ axis
    alpha = np.sqrt(np.maximum((offsets**2).sum(axis=1) - beta**2, 0.0))
    near = np.flatnonzero((np.abs(beta) < reach) & (alpha < reach))
    close = np.flatnonzero((offsets**2).sum(axis=1) <= reach**2)
    runs = np.empty((grid.shape[0] * grid.shape[1], 2), np.int64)
    for count, wanted in ((cylinder_runs(grid, place, turned, reach, runs), near), (None, close)):
        found = ball_runs(grid, place, reach, runs) if count is None else count
        held = np.concatenate([grid.order[first:last] for first, last in runs[:found]])
        assert len(np.unique(held)) == len(held)
        assert set(wanted) <= set(held)


def test_runs_hold_a_small_part_of_a_large_cloud() -> None:
    points = np.random.default_rng(0).uniform(0, 1, (20_000, 3))
    grid = cell_grid(points, 0.02)
    runs = np.empty((grid.shape[0] * grid.shape[1], 2), np.int64)
    found = ball_runs(grid, np.full(3, 0.5), 0.1, runs)
    inside = int((np.linalg.norm(in_axes_of(grid, points) - 0.5, axis=1) <= 0.1).sum())
    assert inside <= np.diff(runs[:found]).sum() < 2.5 * inside


def test_a_far_outlier_does_not_cost_memory() -> None:
    points = np.array([[0, 0, 0], [1e30, -1e30, 1e30], [0.1, 0, 0]])
    assert len(cell_grid(points, 1e-3).starts) < 5000
