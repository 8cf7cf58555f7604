"""Measure in which direction a thing lies and points: its long axis, its head, its handle.

All is measured in the plane of the table, from the points of the thing in the table's frame. A long thing has an axis,
which is known up to half a turn. Its head (the tines of a fork, the bowl of a spoon, the blade of a knife) may be at
either end, or it has none (a pen, a piece of a napkin, half a fork that another thing hides): a small neural network
gives the three probabilities from the profile of the thing along its axis and from what lies at its ends. It is the
same network for both ends, so that a thing that is turned around gets the opposite answer. A round thing with one
narrow part that sticks out has a handle, by a logistic regression with products of features. Both are fitted to things
on simulated tables (``benchmarks/fit_orientation.py``).
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.descriptors.upright import SPACING
from deixis.perception.features.points.keypoints import voxel_keypoints
from deixis.perception.scene import Heading, Scene

Array = NDArray[np.float64]

MIN_POINTS = 40
"""Minimum number of thinned points of a thing whose orientation is measured."""

LONG = 2.5
"""Minimum ratio of length to width at which a thing has an axis with two different ends."""

SLICES = 12
"""Number of slices along a long thing in which its profile is measured."""

MIN_SLICE, MIN_SLICES_SEEN = 3, 4
"""Minimum number of points of a slice that is measured, and of slices that are; the others are interpolated."""

END_REACH = 0.05
"""Distance in metres from the end of a long thing up to which the points of other things count."""

RIM_SHARE = 0.12
"""Share of the height below the top in which the rim of a round thing is looked for."""

HANDLE_CLEARANCE = 0.006
"""Minimum distance in metres beyond the rim at which points may belong to a handle."""

MIN_PROBABILITY = 0.6
"""Minimum probability of a heading that a scene is given."""

MIN_FRONT = 0.5
"""Minimum probability of a front that is returned."""


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


@dataclass(frozen=True, eq=False)
class EndNetwork:
    """Network that scores one end of a long thing: how well it fits a head, and how well the thing fits having none.

    Attributes
    ----------
    mean, scale
        Mean and standard deviation of the n features, shape (n,).
    hidden, bias
        Weights and biases of h hidden units, shapes (n, h) and (h,).
    out
        Weights of the two scores, shape (h, 2).
    none
        Constant of the score of having no head.
    """

    mean: Array
    scale: Array
    hidden: Array
    bias: Array
    out: Array
    none: float

    def probabilities(self, ends: Array) -> Array:
        """Return the probabilities that the head is at each end, or that the thing has none.

        Parameters
        ----------
        ends
            Features of a thing as seen from each of its ends, shape (..., 2, n).

        Returns
        -------
        ndarray
            Probabilities of the first end, the second and none, shape (..., 3).
        """
        scores = np.tanh((ends - self.mean) / self.scale @ self.hidden + self.bias) @ self.out
        odds = np.concatenate([scores[..., 0], scores[..., 1].sum(axis=-1, keepdims=True) + self.none], axis=-1)
        shares = np.exp(odds - odds.max(axis=-1, keepdims=True))
        result: Array = shares / shares.sum(axis=-1, keepdims=True)
        return result


def orientation(points: NDArray[np.floating], others: NDArray[np.floating] | None = None) -> Orientation:
    """Measure the orientation of a thing.

    Parameters
    ----------
    points
        Finite points, shape (n, 3), in metres, with z up and 0 on the table.
    others
        Points of other things near it, shape (m, 3): one at an end may hide a part of the thing. None if it is alone.

    Returns
    -------
    Orientation
        Axis and front, as far as the points show them.

    Examples
    --------
    >>> import math
    >>> from deixis.perception.simulator.cameras.views import views_of
    >>> from deixis.perception.simulator.meshes.tableware import make
    >>> fork = views_of(make("fork", seed=3).mesh, count=1, seed=2, upright=True)[0]
    >>> found = orientation(fork.points)
    >>> found.part, round(math.degrees(math.atan2(found.front[1], found.front[0])))
    ('head', 90)
    """
    kept = thinned(points)
    if len(kept) < MIN_POINTS:
        return Orientation()
    long = in_slices(kept, others)
    if long is None:
        return _round(kept)
    direction, ends = long
    axis = float(np.arctan2(direction[1], direction[0]) % np.pi)
    if ends is None:
        return Orientation(axis)
    ahead, behind, _ = end_network().probabilities(ends).tolist()
    confidence = max(ahead, behind)
    if confidence < MIN_FRONT:
        return Orientation(axis)
    x, y = direction * (1.0 if ahead >= behind else -1.0)
    return Orientation(axis, (float(x), float(y)), "head", confidence)


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


def in_slices(points: Array, others: NDArray[np.floating] | None = None) -> tuple[Array, Array | None] | None:
    """Return the long axis of a thing and the features of its two ends; None for a thing that is not long.

    Parameters
    ----------
    points
        Thinned points, shape (n, 3), in metres, z up.
    others
        Points of other things near it, shape (m, 3); None if it is alone.

    Returns
    -------
    tuple or None
        Unit vector along the axis, and the features as seen from the end that it points to and from the other, shape
        (2, k); None instead of these if too few slices have points.
    """
    middle = points[:, :2].mean(axis=0)
    plan = points[:, :2] - middle
    directions = np.linalg.svd(plan, full_matrices=False)[2]
    along, across = (plan @ directions.T).T
    low, high = np.percentile(along, (0.5, 99.5))
    left, right = np.percentile(across, (1.0, 99.0))
    length, width = float(high - low), float(right - left)
    if length < LONG * max(width, 1e-6):
        return None
    profile = _profile((along - low) / length, across, points[:, 2])
    if profile is None:
        return directions[0], None
    gaps = np.full(2, END_REACH)
    if others is not None and len(others):
        beyond, beside = ((others[:, :2] - middle) @ directions.T).T
        beyond = beyond[np.abs(beside - (left + right) / 2) < width / 2 + 0.01]
        for end, distances in enumerate((beyond - high, low - beyond)):
            distances = distances[distances > -0.02]
            gaps[end] = min(END_REACH, distances.min(initial=END_REACH))
    whole = np.log([length / 0.2, max(width, 1e-3) / 0.02, len(points) / 150])
    ends = [
        np.concatenate([rows.ravel(), two / END_REACH, whole])
        for rows, two in ((profile, gaps), (profile[:, ::-1], gaps[::-1]))
    ]
    return directions[0], np.array(ends)


MOST = 6.0
"""Maximum value of a feature of a slice."""


def _profile(share: Array, across: Array, heights: Array) -> Array | None:
    """Return the features of the slices of a long thing, shape (6, slices), each in its usual unit.

    These are the width, the height, the spread of heights, the largest gap across as a share of the width, the distance
    of the middle from the axis, and the number of points as a share of the mean.
    """
    place = np.clip((share * SLICES).astype(int), 0, SLICES - 1)
    counts = np.bincount(place, minlength=SLICES)
    measured = np.full((5, SLICES), np.nan)
    centre = np.percentile(across, (1.0, 99.0)).mean()
    for k in np.flatnonzero(counts >= MIN_SLICE):
        sideways, up = np.sort(across[place == k]), heights[place == k]
        width, (base, top) = float(np.ptp(sideways)), np.percentile(up, (10, 90))
        gap = np.diff(sideways).max() / max(width, 1e-6)
        measured[:, k] = width / 0.02, top / 0.02, (top - base) / 0.005, gap, abs(sideways.mean() - centre) / 0.005
    seen = np.flatnonzero(~np.isnan(measured[0]))
    if len(seen) < MIN_SLICES_SEEN:
        return None
    rows = [np.interp(np.arange(SLICES), seen, row[seen]) for row in measured]
    profile: Array = np.minimum(np.array([*rows, counts / counts.mean()]), MOST)
    return profile


def _round(points: Array) -> Orientation:
    """Return the orientation of a round thing, towards its handle if it has one."""
    known = handle_features(points)
    if known is None:
        return Orientation()
    features, direction = known
    confidence = float(1 / (1 + np.exp(-features @ _handle_weights())))
    if confidence < MIN_FRONT:
        return Orientation()
    return Orientation(None, (float(direction[0]), float(direction[1])), "handle", confidence)


def handle_features(points: Array) -> tuple[Array, Array] | None:
    """Return features of what sticks out of a round thing, and its direction.

    Parameters
    ----------
    points
        Points, shape (n, 3), in metres, z up.

    Returns
    -------
    tuple or None
        Features with their products and a constant, and a unit vector in the plane; None if nothing sticks out.

    Notes
    -----
    The features are the share of the points that stick out, how far their directions spread, how far they reach, how
    badly the rim fits a circle, the height and the radius, the part of the rim that is seen, and the number of points.
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
    around = np.unique(np.floor(np.arctan2(*(rim - centre).T) / (np.pi / 8)))
    features = np.array(
        [
            np.log(out.mean()),
            np.log(1 - length + 1e-3),
            min(float(np.percentile(distance[out], 90) / radius - 1), 2.0),
            min(misfit / radius, 1.0) * 10,
            np.log(max(top, 0.003) / 0.08),
            np.log(radius / 0.04),
            len(around) / 16,
            np.log(len(points) / 300),
        ]
    )
    products = np.outer(features, features)[np.triu_indices(len(features))]
    return np.concatenate([features, products, [1.0]]), mean / length


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
    clouds = [thinned(thing.cloud.points) if isinstance(thing.cloud, PointCloud) else None for thing in scene.objects]
    things = []
    for thing, points in zip(scene.objects, clouds, strict=True):
        found = Orientation()
        if points is not None and len(points) >= MIN_POINTS:
            found = orientation(points, near(points, [other for other in clouds if other is not points]))
        if found.front is not None and found.part is not None and found.confidence >= MIN_PROBABILITY:
            x, y = (round(each, 4) for each in found.front)
            thing = replace(thing, heading=Heading(found.part, (x, y), round(found.confidence, 4)))
        things.append(thing)
    return replace(scene, objects=tuple(things))


def near(points: Array, others: Sequence[Array | None]) -> Array:
    """Return the points of other things that are near a thing in plan.

    Parameters
    ----------
    points
        Points of the thing, shape (n, 3), in metres.
    others
        Points of each other thing, shape (k, 3); None for one without points.

    Returns
    -------
    ndarray
        Shape (m, 3).
    """
    low, high = points[:, :2].min(axis=0) - END_REACH, points[:, :2].max(axis=0) + END_REACH
    found = [one[((one[:, :2] > low) & (one[:, :2] < high)).all(axis=1)] for one in others if one is not None]
    return np.concatenate([np.zeros((0, 3)), *found])


@cache
def _weights() -> dict[str, Any]:
    data: dict[str, Any] = json.loads(
        files("deixis.perception.features").joinpath("orientation.json").read_text(encoding="utf-8")
    )
    return data


@cache
def end_network() -> EndNetwork:
    """Return the shipped network for the ends of long things.

    Returns
    -------
    EndNetwork
        Network, read once.
    """
    known = _weights()["ends"]
    arrays = {name: np.array(known[name]) for name in ("mean", "scale", "hidden", "bias", "out")}
    return EndNetwork(**arrays, none=float(known["none"]))


@cache
def _handle_weights() -> Array:
    return np.array(_weights()["handle"])
