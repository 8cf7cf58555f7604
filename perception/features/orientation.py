"""Measure in which direction a thing lies and points: its long axis, its head, its handle.

All is measured in the plane of the table, from the points of the thing in the table's frame. A long thing has an axis,
which is known up to half a turn; its head (the tines of a fork, the bowl of a spoon, the blade of a knife) is the end
that its parts make more probable. A round thing with one narrow part that sticks out has a handle. Another round thing
has neither: it looks the same from all sides.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.keypoints import voxel_keypoints
from deixis.perception.features.upright import SPACING
from deixis.perception.scene import Heading, Scene

Array = NDArray[np.float64]

MIN_POINTS = 40
"""Minimum number of thinned points of a thing whose orientation is measured."""

LONG = 2.5
"""Ratio of length to width from which a thing has an axis with two different ends."""

SLICES = 12
"""Number of slices along a long thing in which its width and height are measured."""

MIN_SLICE, MIN_SLICES_SEEN = 3, 8
"""Minimum number of points of a slice that is measured, and of slices that are; the others are interpolated."""

RIM_SHARE = 0.12
"""Share of the height below the top in which the rim of a round thing is looked for."""

HANDLE_CLEARANCE = 0.006
"""Distance in metres beyond the rim from which points may belong to a handle."""

MIN_PROBABILITY = 0.6
"""Minimum probability of a heading that a scene is given."""

HANDLE_FEATURES = ("share", "narrowness", "reach", "misfit")
END_FEATURES = ("width", "widest", "height", "thickness", "gaps", "tip")
"""Names of the features of a handle, and of one end of a long thing against the other."""


@dataclass(frozen=True, slots=True)
class Orientation:
    """Direction of a thing in the plane of the table.

    Attributes
    ----------
    axis
        Angle of the long axis in radians, in [0, pi), counter-clockwise from x; None for a thing that is not long.
    front
        Unit vector towards the head or the handle; None for a thing with neither.
    part
        What the front is: ``head`` or ``handle``; None without a front.
    confidence
        Probability that the front is right; 0 without one.
    """

    axis: float | None = None
    front: tuple[float, float] | None = None
    part: str | None = None
    confidence: float = 0.0


def orientation(points: NDArray[np.floating]) -> Orientation:
    """Measure the orientation of a thing.

    Parameters
    ----------
    points
        Finite points, shape (n, 3), in metres, with z up and 0 on the table.

    Returns
    -------
    Orientation
        Axis and front, as far as the points show them.

    Examples
    --------
    >>> import math
    >>> from deixis.perception.simulator.tableware import make
    >>> from deixis.perception.simulator.views import views_of
    >>> fork = views_of(make("fork", seed=3).mesh, count=1, seed=2, upright=True)[0]
    >>> found = orientation(fork.points)
    >>> found.part, round(math.degrees(math.atan2(found.front[1], found.front[0])))
    ('head', 90)
    """
    kept = thinned(points)
    if len(kept) < MIN_POINTS:
        return Orientation()
    long = in_slices(kept)
    if long is None:
        return _round(kept)
    direction, features = long
    axis = float(np.arctan2(direction[1], direction[0]) % np.pi)
    if features is None:
        return Orientation(axis)
    odds = float(features @ _weights("head"))
    x, y = direction * (1.0 if odds >= 0 else -1.0)
    return Orientation(axis, (float(x), float(y)), "head", float(1 / (1 + np.exp(-abs(odds)))))


def thinned(points: NDArray[np.floating]) -> Array:
    """Return the points of a thing at an even density, so that the distance of the camera does not matter.

    Parameters
    ----------
    points
        Finite points, shape (n, 3), in metres.

    Returns
    -------
    ndarray
        Some of the points, shape (k, 3).
    """
    if not len(points):
        return np.zeros((0, 3))
    return points[voxel_keypoints(points, SPACING / 2)].astype(np.float64)


def in_slices(points: Array) -> tuple[Array, Array | None] | None:
    """Return the long axis of a thing and the features of the end that it points to; None for a thing that is not long.

    Parameters
    ----------
    points
        Points, shape (n, 3), in metres, z up.

    Returns
    -------
    tuple or None
        Unit vector along the axis, and the features of :func:`end_features` or None.
    """
    plan = points[:, :2] - points[:, :2].mean(axis=0)
    directions = np.linalg.svd(plan, full_matrices=False)[2]
    along, across = (plan @ directions.T).T
    length, width = (float(np.ptp(np.percentile(one, (1.0, 99.0)))) for one in (along, across))
    if length < LONG * max(width, 1e-6):
        return None
    return directions[0], end_features(along, across, points[:, 2])


def end_features(along: Array, across: Array, heights: Array) -> Array | None:
    """Return features of the end of a long thing with the larger coordinate, against the other end.

    Parameters
    ----------
    along, across
        Coordinates along and across the axis, shape (n,), in metres.
    heights
        Heights above the table, shape (n,), in metres.

    Returns
    -------
    ndarray or None
        Features in the order of ``END_FEATURES``, each of which changes its sign when the thing is turned by half a
        turn; None if too few slices have points.
    """
    low, high = np.percentile(along, (0.5, 99.5))
    place = np.clip(((along - low) / max(high - low, 1e-6) * SLICES).astype(int), 0, SLICES - 1)
    measured = np.full((4, SLICES), np.nan)
    for k in range(SLICES):
        inside = place == k
        if inside.sum() >= MIN_SLICE:
            sideways, up = np.sort(across[inside]), heights[inside]
            width = float(np.ptp(sideways))
            spread = float(np.ptp(np.percentile(up, (10, 90))))
            measured[:, k] = width, np.percentile(up, 90), spread, np.diff(sideways).max() / max(width, 1e-6)
    seen = np.flatnonzero(~np.isnan(measured[0]))
    if len(seen) < MIN_SLICES_SEEN:
        return None
    widths, tops, spreads, gaps = (np.interp(np.arange(SLICES), seen, row[seen]) for row in measured)
    ramp = np.linspace(-1.0, 1.0, SLICES)
    smooth = np.convolve(widths, np.ones(3) / 3, mode="same")
    return np.array(
        [
            4 * float((ramp * widths).sum() / max(widths.sum(), 1e-6)),
            float(ramp[int(smooth.argmax())]),
            float((ramp * (tops - tops.min())).sum() / max(np.ptp(tops) * SLICES / 4, 1e-6)),
            float((ramp * spreads).sum() / max(spreads.max() * SLICES / 4, 1e-6)),
            float((ramp * gaps).sum()),
            float((widths[-1] - widths[0]) / max(widths.max(), 1e-6)),
        ]
    )


def _round(points: Array) -> Orientation:
    """Return the orientation of a round thing, towards its handle if it has one."""
    features = handle_features(points)
    if features is None:
        return Orientation()
    known, direction = features
    odds = float(np.append(known, 1.0) @ _weights("handle"))
    confidence = 1 / (1 + np.exp(-odds))
    if confidence < 0.5:
        return Orientation()
    return Orientation(None, (float(direction[0]), float(direction[1])), "handle", float(confidence))


def handle_features(points: Array) -> tuple[Array, Array] | None:
    """Return features of what sticks out of a round thing, and its direction.

    Parameters
    ----------
    points
        Points, shape (n, 3), in metres, z up.

    Returns
    -------
    tuple or None
        Features in the order of ``HANDLE_FEATURES``, and a unit vector in the plane; None if nothing sticks out.
    """
    low, top = np.percentile(points[:, 2], (1.0, 99.5))
    rim = points[points[:, 2] > top - RIM_SHARE * max(top - max(low, 0.0), 0.01)][:, :2]
    circle = _circle(rim)
    if circle is None:
        return None
    centre, radius, misfit = circle
    away = points[:, :2] - centre
    distance = np.linalg.norm(away, axis=1)
    out = distance > radius + HANDLE_CLEARANCE
    if out.sum() < 5:
        return None
    units = away[out] / distance[out, None]
    mean = units.mean(axis=0)
    length = float(np.linalg.norm(mean))
    if length < 1e-6:
        return None
    reach = float(np.percentile(distance[out], 90) / radius - 1)
    features = np.array(
        [np.log(out.mean()), np.log(1 - length + 1e-3), min(reach, 2.0), min(misfit / radius, 1.0) * 10]
    )
    return features, mean / length


def _circle(plan: Array) -> tuple[Array, float, float] | None:
    """Return centre, radius and mean absolute misfit of the circle through most points, by trimmed least squares."""
    kept = plan
    for _ in range(6):
        if len(kept) < 8:
            return None
        design = np.column_stack([2 * kept, np.ones(len(kept))])
        solution = np.linalg.lstsq(design, (kept**2).sum(axis=1), rcond=None)[0]
        centre, radius = solution[:2], float(np.sqrt(max(solution[2] + solution[:2] @ solution[:2], 1e-12)))
        off = np.abs(np.linalg.norm(kept - centre, axis=1) - radius)
        close = off <= max(2.5 * float(np.median(off)), 1e-4)
        if close.all():
            break
        kept = kept[close]
    return centre, radius, float(off.mean())


def with_headings(scene: Scene) -> Scene:
    """Return a scene with the headings of the objects whose points are in memory.

    Parameters
    ----------
    scene
        Scene in the frame of a table, in metres.

    Returns
    -------
    Scene
        The scene; unchanged if its z axis is not vertical.
    """
    if scene.frame != "table" or scene.unit != "m":
        return scene
    things = []
    for thing in scene.objects:
        found = orientation(thing.cloud.points) if isinstance(thing.cloud, PointCloud) else Orientation()
        if found.front is not None and found.part is not None and found.confidence >= MIN_PROBABILITY:
            x, y = (round(each, 4) for each in found.front)
            thing = replace(thing, heading=Heading(found.part, (x, y), round(found.confidence, 4)))
        things.append(thing)
    return replace(scene, objects=tuple(things))


@cache
def _weights(part: str) -> Array:
    data = json.loads(files("deixis.perception.features").joinpath("orientation.json").read_text(encoding="utf-8"))
    return np.array(list(data[part].values()))
