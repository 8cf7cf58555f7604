"""Test the smoothing of organised clouds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.smoothing import smoothed

ROWS, COLUMNS, STEP = 60, 80, 0.008


def noisy_step(noise: float, coloured: bool = True) -> tuple[PointCloud, np.ndarray]:
    """Return a slanted plane with a lower half of another colour that is nearer, and its true points."""
    x, y = np.meshgrid(np.linspace(-0.2, 0.2, COLUMNS), np.linspace(-0.15, 0.15, ROWS))
    depth = 1.0 + 0.3 * y - np.where(y > 0, STEP, 0.0)
    true = np.stack([x * depth, y * depth, depth], axis=2).reshape(-1, 3)
    rng = np.random.default_rng(3)
    seen = true * (1 + noise * rng.standard_normal((len(true), 1)))
    shade = np.where(y > 0, 160.0, 90.0).reshape(-1, 1) + rng.normal(0, 2.5, (len(true), 3))
    colours = np.clip(shade, 0, 255).astype(np.uint8) if coloured else None
    return PointCloud(seen.astype(np.float32), colours, organised=(ROWS, COLUMNS)), true


def errors(cloud: PointCloud, true: np.ndarray) -> np.ndarray:
    found: np.ndarray = np.linalg.norm(cloud.points - true, axis=1).reshape(ROWS, COLUMNS)
    return found


def test_noise_falls_and_coloured_steps_stay() -> None:
    cloud, true = noisy_step(0.003)
    before, after = errors(cloud, true), errors(smoothed(cloud), true)
    edge = slice(ROWS // 2 - 1, ROWS // 2 + 1)
    assert after.mean() < 0.4 * before.mean()
    assert after[edge, 2:-2].mean() < 0.6 * before[edge, 2:-2].mean()


def test_noise_falls_without_colours_too() -> None:
    cloud, true = noisy_step(0.003, coloured=False)
    assert errors(smoothed(cloud), true).mean() < 0.6 * errors(cloud, true).mean()


def test_exact_clouds_and_loose_points_stay_as_they_are() -> None:
    cloud, _ = noisy_step(0.003)
    loose = replace(cloud, organised=None)
    assert smoothed(loose) is loose
    flat = replace(cloud, points=np.ones_like(cloud.points))
    assert smoothed(flat) is flat


def test_pixels_without_depth_keep_none() -> None:
    cloud, _ = noisy_step(0.003)
    points = cloud.points.copy()
    points[::7] = np.nan
    found = smoothed(replace(cloud, points=points))
    assert np.array_equal(found.finite, np.isfinite(points[:, 0]))
