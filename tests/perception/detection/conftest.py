"""Clouds of a table with boxes on it, as a pinhole camera or a scanner sees them, with the true label of each point."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud

Box = tuple[tuple[float, float, float], tuple[float, float, float]]
ROWS, COLUMNS, FOCAL = 180, 240, 197.0
EYE = np.array([0.0, -0.65, 0.7])
Look = Callable[..., PointCloud]


def look(
    boxes: Sequence[Box],
    noise: float = 5e-4,
    seed: int = 0,
    colours: Sequence[tuple[int, int, int]] | None = None,
    half: float = 0.5,
) -> PointCloud:
    """Return the cloud in the frame of the camera; label 0 is the table, a square around the origin, k the k-th box."""
    directions, pose = rays()
    slabs: list[Box] = [((-half, -half, -0.03), (half, half, 0.0)), *boxes]
    depths = np.stack([_depths(directions @ pose.T, box) for box in slabs])
    nearest = depths.argmin(axis=0)
    depth = depths.min(axis=0)
    seen = np.isfinite(depth)
    rng = np.random.default_rng(seed)
    depth = np.where(seen, depth, np.nan) + rng.normal(0, noise, len(depth))
    painted = None
    if colours is not None:
        painted = np.array([(150, 112, 78), *colours], np.uint8)[nearest]
    points = (directions * depth[:, None]).astype(np.float32)
    labels = np.where(seen, nearest, -1).astype(np.int32)
    return PointCloud(points, colours=painted, labels=labels, organised=(ROWS, COLUMNS))


def rays() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the directions of the pixels (z = 1) in the frame of the camera, and its rotation to that of the table."""
    v, u = np.mgrid[:ROWS, :COLUMNS]
    directions = np.stack(
        [(u - COLUMNS / 2 + 0.5) / FOCAL, (v - ROWS / 2 + 0.5) / FOCAL, np.ones(u.shape)], axis=-1
    ).reshape(-1, 3)
    forward = -EYE / np.linalg.norm(EYE)
    right = np.array([1.0, 0.0, 0.0])
    return directions, np.stack([right, np.cross(forward, right), forward], axis=1)


def in_table_frame(points: NDArray[np.floating]) -> NDArray[np.float64]:
    result: NDArray[np.float64] = points @ rays()[1].T + EYE
    return result


def _depths(directions: NDArray[np.float64], box: Box) -> NDArray[np.float64]:
    """Return the depths at which rays from the eye enter a box, by its slabs; infinite for a miss."""
    with np.errstate(divide="ignore"):
        meets = (np.array(box)[:, None] - EYE) / directions
    enter, leave = meets.min(axis=0).max(axis=1), meets.max(axis=0).min(axis=1)
    return np.where((enter <= leave) & (enter > 0), enter, np.inf)


def scan(boxes: Sequence[Box], table: float, things: float, noise: float = 3e-4, seed: int = 0) -> PointCloud:
    """Return bare points of a table of one metre and of boxes on it, each on a grid of its own spacing.

    The table is 80 cm below the origin. Of the boxes, all sides but the bottom are scanned.
    """
    half, rng = 0.5, np.random.default_rng(seed)
    faces = [(0, _grid((-half, -half, 0.0), (half, half, 0.0), 2, table))]
    for number, (low, high) in enumerate(boxes, start=1):
        for axis, at in ((2, high), (0, low), (0, high), (1, low), (1, high)):
            face = np.array([low, high])
            face[:, axis] = at[axis]
            faces.append((number, _grid(face[0].tolist(), face[1].tolist(), axis, things)))
    labels = np.repeat([number for number, _ in faces], [len(face) for _, face in faces])
    points = np.concatenate([face for _, face in faces])
    seen = np.ones(len(points), dtype=np.bool_)
    for number, (low, high) in enumerate(boxes, start=1):
        seen &= (labels == number) | ~((points >= np.array(low)) & (points <= np.array(high))).all(axis=1)
    points = points[seen] + rng.normal(0, noise, (seen.sum(), 3)) - (0.0, 0.0, 0.8)
    return PointCloud(points.astype(np.float32), labels=labels[seen].astype(np.int32))


def _grid(low: Sequence[float], high: Sequence[float], axis: int, spacing: float) -> NDArray[np.float64]:
    """Return the points of a grid on the face of a box that is orthogonal to an axis."""
    sides = [np.arange(low[k], high[k], spacing) if k != axis else np.array([low[k]]) for k in range(3)]
    return np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 3)


@pytest.fixture
def boxes_scanned() -> Callable[..., PointCloud]:
    return scan


@pytest.fixture
def boxes_seen() -> Look:
    return look


@pytest.fixture
def to_table() -> Callable[[NDArray[np.floating]], NDArray[np.float64]]:
    return in_table_frame
