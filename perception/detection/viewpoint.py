"""Whether a cloud is what one sensor sees from its origin, and what is done where it is not.

A file may hold no viewpoint, or a cloud that was moved to another frame, or one made of several views. As seen from
where a cloud was taken, points in nearly the same direction are near each other, but for the edges of things; as seen
from elsewhere they are not.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.plane import Outlook, Plane

SAMPLE = 10_000
"""Points that are looked at."""

COUNT, APART = 8, 3.0
"""Neighbours in direction; they are apart if so many times as far away as the farthest of as many nearest in space."""

MOST_APART = 0.05
"""The share that may be apart in one view: 0.002 to 0.02 was measured from the right place, 0.6 from a wrong one on the
table."""

LEAST_HEIGHT = 0.05
"""Metres above the table from which its top is seen at all."""

AWAY = 1.5
ROUND, ELEVATION = 8, np.deg2rad(45.0)
"""A viewpoint that is not known is looked for so many metres from the middle of the table: straight above it, and at
so many places around it, at one elevation."""


def believed(outlook: Outlook, points: NDArray[np.float64], seed: int) -> Outlook:
    """The outlook on the points (n, 3), if they may have been seen from there; else one from above, as not known."""
    few = _sample(points, seed)
    if outlook.known and apart(few, outlook.eye) < MOST_APART:
        return outlook
    above = np.median(few, axis=0) + np.array([0.0, 0.0, AWAY])
    return Outlook(above, upwards=outlook.upwards, known=False)


def likely(outlook: Outlook, points: NDArray[np.float64], plane: Plane, seed: int) -> Outlook:
    """The outlook, if it is known and above the table; else from where the points (n, 3) look most as if seen."""
    if outlook.known and plane.heights(outlook.eye[None])[0] > LEAST_HEIGHT:
        return outlook
    few = _sample(points, seed)
    on = few[np.abs(plane.heights(few)) < 0.01]
    places = _places_around((on if len(on) else few).mean(axis=0), plane)
    eye = min(places, key=lambda place: apart(few, place))
    return replace(outlook, eye=eye, up=None, right=None, known=False)


def _places_around(middle: NDArray[np.float64], plane: Plane) -> list[NDArray[np.float64]]:
    turns = np.arange(ROUND) * 2 * np.pi / ROUND
    level = np.column_stack([np.cos(turns), np.sin(turns)]) @ plane.across
    aslant = np.cos(ELEVATION) * level + np.sin(ELEVATION) * plane.normal
    return [middle + AWAY * direction for direction in (plane.normal, *aslant)]


def _sample(points: NDArray[np.float64], seed: int) -> NDArray[np.float64]:
    if len(points) <= SAMPLE:
        return points
    return points[np.random.default_rng(seed).choice(len(points), SAMPLE, replace=False)]


def apart(points: NDArray[np.float64], eye: NDArray[np.float64]) -> float:
    """The share of neighbours in direction, as seen from ``eye`` (3,), that are apart in space, of points (n, 3).

    >>> x, y = (axis.ravel() for axis in np.mgrid[-0.5:0.5:0.02, -0.5:0.5:0.02])
    >>> bowl = np.stack([x, y, x**2 + y**2], axis=1)
    >>> apart(bowl, np.array([0.0, 0.0, 2.0])), apart(bowl, np.array([0.0, -3.0, 0.01])) > 0.1
    (0.0, True)
    """
    from scipy.spatial import cKDTree

    if len(points) <= COUNT:
        return 0.0
    rays = directions(points, eye)
    near = cKDTree(rays).query(rays, k=COUNT + 1)[1][:, 1:]
    reach = cKDTree(points).query(points, k=COUNT + 1)[0][:, -1]
    away = np.linalg.norm(points[near] - points[:, None], axis=2)
    return float((away > APART * reach[:, None]).mean())


def directions(points: NDArray[np.float64], eye: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit vectors (n, 3) from the eye (3,) to points (n, 3)."""
    rays = points - eye
    result: NDArray[np.float64] = rays / np.maximum(np.linalg.norm(rays, axis=1, keepdims=True), 1e-9)
    return result
