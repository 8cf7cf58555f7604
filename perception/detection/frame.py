"""The frame of a table: z up from it, x to the right and y away from the viewer."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.plane import Outlook, Plane
from deixis.perception.detection.settings import DetectionSettings

UNEVEN, MOST = 0.05, 0.9
"""The share by which the angle from pixel to pixel changes to the next, for most of them: 0.002 to 0.014 was measured
from where images were taken, 0.3 and more from 30 cm beside it. Noise is along the rays, and from elsewhere across."""

LINES = 100
"""Rows and columns of an image that are looked at."""


def outlook_of(cloud: PointCloud, settings: DetectionSettings) -> Outlook:
    """From where a cloud was seen, and which way up: the rows of its image go down as seen from its origin."""
    eye = np.asarray(cloud.origin, dtype=np.float64)
    upwards = None
    if settings.up is not None:
        upwards = np.asarray(settings.up, dtype=np.float64)
        upwards = upwards / np.linalg.norm(upwards)
    if cloud.organised is None or min(cloud.organised) < 2:
        return Outlook(eye, upwards=upwards)
    image = cloud.points.reshape(*cloud.organised, 3)
    columns, rows = _rays(image, eye), _rays(image.swapaxes(0, 1), eye)
    if max(_uneven(columns), _uneven(rows)) > UNEVEN:
        return Outlook(eye, upwards=upwards, known=False)
    down, right = _direction(columns), _direction(rows)
    if down is None or right is None:
        return Outlook(eye, upwards=upwards)
    return Outlook(eye, -down, right, upwards)


def _rays(image: NDArray[np.float32], eye: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit vectors from the eye to the pixels of an image (r, c, 3), in about ``LINES`` of its columns."""
    rays = image[:, :: max(1, image.shape[1] // LINES)] - eye
    with np.errstate(invalid="ignore", divide="ignore"):
        unit: NDArray[np.float64] = rays / np.linalg.norm(rays, axis=2, keepdims=True)
    return unit


def _uneven(rays: NDArray[np.float64]) -> float:
    """By what share most steps from ray to ray along the first axis of (r, c, 3) change to the next, at most, beyond
    what those of a pinhole camera do: up to 45 degrees aside, twice the step's angle."""
    steps = np.diff(rays, axis=0)
    angles = np.linalg.norm(steps[1:], axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        change = np.linalg.norm(np.diff(steps, axis=0), axis=2) / angles - 2 * angles
    return float(np.quantile(change[np.isfinite(change)], MOST)) if np.isfinite(change).any() else 0.0


def _direction(rays: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Where the first axis of an image leads, from rays (r, c, 3): the direction that is in the planes of all columns.

    The mean step from ray to ray is aslant where more of one side of the image is seen.
    """
    one, other = rays[:-1].reshape(-1, 3), rays[1:].reshape(-1, 3)
    both = np.isfinite(one + other).all(axis=1)
    if both.sum() < 2:
        return None
    across = np.cross(one[both], other[both])
    along: NDArray[np.float64] = np.linalg.eigh(across.T @ across)[1][:, 0]
    step = (other[both] - one[both]).mean(axis=0) @ along
    return along * np.sign(step) if abs(step) > 0 else None


def table_frame(
    plane: Plane, on: NDArray[np.float64], outlook: Outlook, viewer: tuple[float, float, float] | None
) -> NDArray[np.float64]:
    """The transform (4, 4) that takes points of the cloud's frame to the table's.

    z is the height above the plane. y points away from the viewer: from a ``viewer`` that is given to the middle of
    the table's points ``on`` (n, 3); else upwards in the image, as whoever holds the camera sees it; else from the
    sensor to the middle. x is to the right. The origin is the middle of the rectangle around the table's points, on
    the table.
    """
    up = plane.normal
    away = _across(up, _away(plane, on.mean(axis=0), outlook, viewer))
    right = np.cross(away, up)
    turn = np.stack([right, away, up])
    plan = on @ turn[:2].T
    low, high = np.percentile(plan, (0.5, 99.5), axis=0)
    origin = np.append((low + high) / 2, plane.offset)
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = turn, -origin
    return frame


def _away(
    plane: Plane, middle: NDArray[np.float64], outlook: Outlook, viewer: tuple[float, float, float] | None
) -> list[NDArray[np.float64]]:
    """Directions away from the viewer, the best first; not all need to be of use."""
    if viewer is not None:
        return [middle - np.asarray(viewer, dtype=np.float64)]
    if not outlook.known:
        return []
    if outlook.right is not None:
        return [np.cross(plane.normal, outlook.right)]
    return [middle - outlook.eye]


def _across(up: NDArray[np.float64], wanted: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """The first direction that is not along ``up``, made level; else y or x of the cloud's frame."""
    for direction in (*wanted, np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])):
        level = direction - (direction @ up) * up
        length = float(np.linalg.norm(level))
        if length > 0.02:
            return level / length
    raise AssertionError("one of two axes is not along a third direction")


def moved(points: NDArray[np.floating], frame: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (n, 3) taken by a transform (4, 4); what is not finite stays so."""
    with np.errstate(invalid="ignore"):  # infinity times nothing
        result: NDArray[np.float64] = points @ frame[:3, :3].T + frame[:3, 3]
    return result
