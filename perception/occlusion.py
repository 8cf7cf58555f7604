"""Join the parts of things that other things hide in the middle, as seen from the camera.

A spoon that lies behind a glass is seen as two parts. Two parts are joined if they lie in one line, no wider together
than alone, and the table between them cannot be seen: each ray to it from the camera meets a third thing. What floats
above a part, such as the bowl of a glass whose stem is hidden, is joined with it too.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.outline import oriented_box
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.scene import PerceivedObject, Scene

Array = NDArray[np.float64]

MAX_HEIGHT = 0.05
"""Maximum height in metres of things whose parts are joined."""

MAX_LENGTH, MAX_WIDTH = 0.27, 0.06
"""Maximum length and width in metres of a joined thing that lies."""

MIN_HIDING_HEIGHT = 0.05
"""Minimum height in metres of a thing that hides the middle of another one."""

FLOATING = 0.03
"""Minimum height in metres of the gap below a thing at which it cannot rest on what is below."""

WIDER, WIDTH_ERROR = 1.3, 0.006
"""Maximum ratio of the width of a joined thing to that of its wider part, and metres beyond that."""

HIDDEN_SHARE = 0.8
"""Share of the places between two parts that must be hidden."""

PLACES = 9
"""Number of places between two parts at which the view is tested."""

GROWN = 0.004
"""Distance in metres by which boxes are grown when views are tested, since their edges are uncertain."""

MAX_POINTS = 400
"""Number of points by which the outline of a part is measured."""


def joined_behind_others(scene: Scene) -> Scene:
    """Join things of a scene that are parts of one thing, whose middle is hidden by another thing.

    Parameters
    ----------
    scene
        Scene in metres whose things have clouds in memory, with the camera's position as their origin.

    Returns
    -------
    Scene
        Scene in which joined parts are one thing with the id of the larger part; unchanged if there are none.
    """
    things, detection = list(scene.objects), scene.detection
    if scene.unit != "m" or any(not isinstance(thing.cloud, PointCloud) for thing in things):
        return scene
    while True:
        # A glass becomes whole before its foot is compared with what lies beside it.
        pairs = list(combinations(range(len(things)), 2))
        floating = (pair for pair in pairs if _float_together(things, *pair))
        pair = next(floating, None) or next((pair for pair in pairs if _one_thing(things, *pair)), None)
        if pair is None:
            break
        first, second = (things[place] for place in pair)
        if len(_cloud(first)) < len(_cloud(second)):
            first, second = second, first
        together = _joined(first, second)
        things = [together if thing is first else thing for thing in things if thing is not second]
        if detection is not None:
            detection = _relabelled(detection, second.id, first.id)
    return scene if len(things) == len(scene.objects) else replace(scene, objects=tuple(things), detection=detection)


def _relabelled(detection: Any, part: str, whole: str) -> Any:
    """Return a detection in which the points of a part belong to the whole."""
    labels = detection.labels.copy()
    labels[labels == int(part[1:]) - 1] = int(whole[1:]) - 1
    return replace(detection, labels=labels)


def _cloud(thing: PerceivedObject) -> PointCloud:
    assert isinstance(thing.cloud, PointCloud)
    return thing.cloud


def _outline(thing: PerceivedObject) -> Array:
    """Return some points of a thing in plan, shape (k, 2)."""
    cloud = _cloud(thing)
    points = cloud.points[cloud.finite][:, :2].astype(np.float64)
    return points[:: max(1, len(points) // MAX_POINTS)]


def _float_together(things: list[PerceivedObject], a: int, b: int) -> bool:
    return _floats(things[a], things[b]) or _floats(things[b], things[a])


def _one_thing(things: list[PerceivedObject], a: int, b: int) -> bool:
    first, second = things[a], things[b]
    low = np.minimum(first.minimum[:2], second.minimum[:2])
    high = np.maximum(first.maximum[:2], second.maximum[:2])
    if max(first.maximum[2], second.maximum[2]) > MAX_HEIGHT or np.linalg.norm(high - low) > 1.1 * MAX_LENGTH:
        return False
    parts = [_outline(first), _outline(second)]
    if min(map(len, parts)) < 5:
        return False
    both = np.concatenate(parts)
    middle = both.mean(axis=0)
    axis = np.linalg.svd(both - middle, full_matrices=False)[2][0]
    across = np.array([-axis[1], axis[0]])
    along = [np.percentile((part - middle) @ axis, [1, 99]) for part in parts]
    if along[0][0] > along[1][0]:
        along.reverse()
    start, end = along[0][1], along[1][0]
    if end <= start or along[1][1] - along[0][0] > MAX_LENGTH:
        return False
    widths = [_width(part) for part in parts]
    if max(widths) > MAX_WIDTH:
        return False
    if float(np.ptp(np.percentile((both - middle) @ across, [1, 99]))) > WIDER * max(widths) + WIDTH_ERROR:
        return False
    height = min(first.maximum[2], second.maximum[2]) / 2
    gap = middle + np.linspace(start, end, PLACES + 2)[1:-1, None] * axis
    places = np.column_stack([gap, np.full(PLACES, height)])
    others = [
        thing for place, thing in enumerate(things) if place not in (a, b) and thing.maximum[2] >= MIN_HIDING_HEIGHT
    ]
    eye = np.asarray(_cloud(first).origin, dtype=np.float64)
    return float(np.mean(hidden_places(places, eye, others))) >= HIDDEN_SHARE


def _floats(upper: PerceivedObject, lower: PerceivedObject) -> bool:
    """Return whether a thing is above another one in plan, and rests neither on it nor on the table."""
    if upper.minimum[2] < lower.maximum[2] + FLOATING:
        return False
    low = np.maximum(upper.minimum[:2], lower.minimum[:2])
    high = np.minimum(upper.maximum[:2], lower.maximum[:2])
    smaller = min(float(np.prod(np.subtract(thing.maximum[:2], thing.minimum[:2]))) for thing in (upper, lower))
    return bool((high > low).all()) and float(np.prod(high - low)) >= 0.5 * smaller


def _width(plan: Array) -> float:
    """Return the extent of places across their main direction, in metres."""
    centred = plan - plan.mean(axis=0)
    across = np.linalg.svd(centred, full_matrices=False)[2][1]
    return float(np.ptp(np.percentile(centred @ across, [1, 99])))


def hidden_places(places: Array, eye: Array, others: list[PerceivedObject]) -> NDArray[np.bool_]:
    """Return which places cannot be seen, because the ray to them from the eye meets the box of a thing.

    Parameters
    ----------
    places
        Places, shape (k, 3), in metres.
    eye
        Position of the camera, shape (3,).
    others
        Things that may hide them.

    Returns
    -------
    ndarray
        Mask of shape (k,).
    """
    hidden = np.zeros(len(places), dtype=bool)
    for thing in others:
        low, high = np.array(thing.minimum) - GROWN, np.array(thing.maximum) + GROWN
        low[2] = 0.0
        step = places - eye
        with np.errstate(divide="ignore", invalid="ignore"):
            one, two = (low - eye) / step, (high - eye) / step
        enter = np.nanmax(np.minimum(one, two), axis=1)
        leave = np.nanmin(np.maximum(one, two), axis=1)
        hidden |= (enter < leave) & (enter > 0) & (enter < 1)
    return hidden


def _joined(first: PerceivedObject, second: PerceivedObject) -> PerceivedObject:
    one, two = _cloud(first), _cloud(second)
    colours = None
    if one.colours is not None and two.colours is not None:
        colours = np.concatenate([one.colours, two.colours])
    cloud = PointCloud(np.concatenate([one.points, two.points]), colours, origin=one.origin)
    low = tuple(float(value) for value in np.minimum(first.minimum, second.minimum))
    high = tuple(float(value) for value in np.maximum(first.maximum, second.maximum))
    points = cloud.points[cloud.finite].astype(np.float64)
    box = oriented_box(points, DetectionSettings().outlines)
    return replace(first, minimum=low, maximum=high, cloud=cloud, oriented=box.rounded(6))
