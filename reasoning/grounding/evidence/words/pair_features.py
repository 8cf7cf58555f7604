"""Features of pairs of boxes in the frame of a relation word.

The axis of *left* is -x, those of *top left* are -x and y. The features have the same names for all words, so that
words that mirror each other share a model, and an inverse has the features of the exchanged pair.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.geometry.pairs import PairGeometry
from deixis.reasoning.geometry.poses import MIN_STRETCH, bearings, coaxial

Array = NDArray[np.float64]
View = Mapping[str, Array]

HEADINGS = {
    "left": (-1, 0),
    "right": (1, 0),
    "top": (0, 1),
    "bottom": (0, -1),
    "top_left": (-1, 1),
    "top_right": (1, 1),
    "bottom_left": (-1, -1),
    "bottom_right": (1, -1),
}

MIN_DIRECTION_OFFSET = 0.5
"""Offset of centres below which a direction is weakened: boxes with the same centre have a deviation of 90 degrees."""


def view(pairs: PairGeometry, word: str) -> View:
    """Return the features of every ordered pair for a word, or for ``saying``.

    Features of a direction: ``deviation`` (radians from the direction of the word), ``clear`` (distance of the near
    edges), ``trail`` and ``lead`` (the lesser and the greater of the offsets of starts and ends), ``forward`` and
    ``lateral`` (offsets along and across), ``abreast`` (share of the smaller extent across that the other covers),
    ``gap``, ``alike`` (difference of sizes). Features of support: see :func:`_support`. Features of saying: ``crowd``
    and ``figure``. Features of words beside the ten: see ``GRADED_VIEWS``.

    Parameters
    ----------
    pairs
        Geometry of the pairs.
    word
        Name of the word, or ``saying``.

    Returns
    -------
    dict
        Features by name, each of shape (n, n); angles in radians, all others without unit.
    """
    if word == "saying":
        return {"crowd": pairs.crowd, "figure": pairs.smaller}
    if word == "on":
        return _support(pairs)
    if word == "under":
        return {name: feature.T for name, feature in _support(pairs.reverse).items()}
    if word in HEADINGS:
        return _direction(pairs, HEADINGS[word])
    if word in GRADED_VIEWS:
        return GRADED_VIEWS[word](pairs)
    if word in REVERSED:
        return {name: feature.T for name, feature in view(pairs.reverse, REVERSED[word]).items()}
    return {"gap": pairs.gap}


def _direction(pairs: PairGeometry, heading: tuple[int, int]) -> View:
    axes = [axis for axis in (0, 1) if heading[axis]]
    to = np.array(heading) / np.hypot(*heading)
    forward = pairs.offset[:, :, 0] * to[0] + pairs.offset[:, :, 1] * to[1]

    def least(feature: Callable[[PairGeometry, int, int], Array]) -> Array:
        return reduce(np.minimum, (feature(pairs, axis, heading[axis]) for axis in axes))

    def deviation() -> Array:
        result: Array = np.arccos(np.clip(forward / np.maximum(pairs.distance, MIN_DIRECTION_OFFSET), -1.0, 1.0))
        return result

    def lateral() -> Array:
        off = np.abs(pairs.offset[:, :, 1] * to[0] - pairs.offset[:, :, 0] * to[1])
        result: Array = off / (1 + off)
        return result

    def abreast() -> Array:
        across = (0, 1) if len(axes) == 2 else (1 - axes[0],)
        shares = [(pairs.inside[:, :, axis], pairs.reverse.inside[:, :, axis].T) for axis in across]
        return reduce(np.maximum, [share for both in shares for share in both])

    return _Features(
        {
            "deviation": deviation,
            "clear": lambda: least(_clear),
            "trail": lambda: least(_trail),
            "lead": lambda: least(_lead),
            "forward": lambda: forward / (1 + np.abs(forward)),
            "lateral": lateral,
            "abreast": abreast,
            "gap": lambda: pairs.gap,
            "alike": lambda: np.abs(pairs.smaller),
        }
    )


class _Features(Mapping[str, Array]):
    """Features that are computed on access; most models use few of them."""

    def __init__(self, features: Mapping[str, Callable[[], Array]]) -> None:
        self._features = features

    def __getitem__(self, name: str) -> Array:
        return self._features[name]()

    def __contains__(self, name: object) -> bool:
        return name in self._features

    def __iter__(self) -> Iterator[str]:
        return iter(self._features)

    def __len__(self) -> int:
        return len(self._features)


def _clear(pairs: PairGeometry, axis: int, sign: int) -> Array:
    """Return the distances of the near edges along one axis."""
    return _along(pairs, 0, axis, sign)


def _trail(pairs: PairGeometry, axis: int, sign: int) -> Array:
    """Return the lesser of the offsets of starts and ends."""
    return np.minimum(_along(pairs, 1, axis, sign), _along(pairs, 2, axis, sign))


def _lead(pairs: PairGeometry, axis: int, sign: int) -> Array:
    """Return the greater of the offsets of starts and ends."""
    return np.maximum(_along(pairs, 1, axis, sign), _along(pairs, 2, axis, sign))


def _along(pairs: PairGeometry, edge: int, axis: int, sign: int) -> Array:
    """Return the distances of an edge along one axis; against the axis, those of the reversed pairs."""
    if sign < 0:
        return pairs.reverse.edges[edge, :, :, axis].T
    distances: Array = pairs.edges[edge, :, :, axis]
    return distances


def _support(pairs: PairGeometry) -> View:
    """Return the features of a subject that lies on an object.

    ``across`` and ``along``: shares of the subject's extents on x and y within the object's; ``bears`` and
    ``spans``: shares of the object's extents within the subject's. ``foot`` and, with heights, ``rise``: see the
    geometry. ``rest``: the subject's lower edge minus the object's upper edge; ``upper`` and ``lower``: minus the
    edge of the same side. ``level``: offset on y. ``gap``: distance of the boxes.
    """
    found = {
        "across": pairs.inside[:, :, 0],
        "along": pairs.inside[:, :, 1],
        "bears": pairs.reverse.inside[:, :, 0].T,
        "foot": pairs.foot,
        "rest": pairs.edges[0, :, :, 1],
        "upper": pairs.edges[1, :, :, 1],
        "lower": pairs.edges[2, :, :, 1],
        "spans": pairs.reverse.inside[:, :, 1].T,
        "level": pairs.offset[:, :, 1] / (1 + np.abs(pairs.offset[:, :, 1])),
        "gap": pairs.gap,
    }
    if pairs.rise is not None:
        found["rise"] = pairs.rise
    return found


def _quotient(lengths: Array, units: Array) -> Array:
    """Return lengths in units of other lengths; 0 where the unit is 0."""
    result: Array = np.divide(lengths, units, out=np.zeros(np.broadcast(lengths, units).shape), where=units > 0)
    return result


def _share_of_difference(subjects: Array, objects: Array) -> Array:
    """Return (a - b) / (a + b) of the lengths of subjects (n,) and objects (m,), in [-1, 1], above 0 if a is longer."""
    a, b = subjects[:, None], objects[None, :]
    total = a + b
    return _quotient(a - b, total)


def _extents(boxes: Array) -> Array:
    extents: Array = boxes[:, 1] - boxes[:, 0]
    return extents


def _compared(measure: Callable[[Array], Array]) -> Callable[[PairGeometry], View]:
    def features(pairs: PairGeometry) -> View:
        return {"excess": _share_of_difference(measure(_extents(pairs.boxes)), measure(_extents(pairs.objects)))}

    return features


def _coaxial(pairs: PairGeometry) -> Array:
    """Return how far the long axes agree, in [-1, 1]: 1 for thin parallel things, -1 for crossing ones."""
    return coaxial(*pairs.poses)


UNKNOWN_AIM = -1.0
"""Value of ``aim`` for pairs whose orientation is unknown."""


def _bearing(pairs: PairGeometry) -> Array:
    """Return unit vectors from the subjects to the objects, shape (n, m, 2); 0 for things at one place."""
    result: Array = np.nan_to_num(bearings(pairs.boxes, pairs.objects))
    return result


def _aim(angles: Array, known: NDArray[np.bool_]) -> View:
    return {"aim": np.where(known, angles, UNKNOWN_AIM)}


def _own_frame_angles(pairs: PairGeometry) -> Array:
    """Return the angle between the subject's front and the direction to the object; ``UNKNOWN_AIM`` without a front."""
    bearing, poses = _bearing(pairs), replace(pairs.poses[0], heads=None)
    return _aim(poses.aim_angles(bearing), poses.fronted[:, None] & bearing.any(axis=2))["aim"]


def _facing(pairs: PairGeometry) -> View:
    """Return the angle between the subject's front, or its head, and the direction to the object."""
    bearing = _bearing(pairs)
    angles = pairs.poses[0].aim_angles(bearing, facing=True)
    return _aim(angles, ~np.isnan(angles) & bearing.any(axis=2))


def _pointing(pairs: PairGeometry) -> View:
    """Return the angle between the subject's front or head, or either end of its axis, and the way to the object."""
    poses, bearing = pairs.poses[0], _bearing(pairs)
    angles = poses.aim_angles(bearing)
    ends = np.arccos(np.clip(np.abs(np.einsum("nmd,nd->nm", bearing, poses.axes)), 0.0, 1.0))
    by_axis = np.isnan(angles) & (poses.stretch >= MIN_STRETCH)[:, None]
    return _aim(np.where(by_axis, ends, angles), (by_axis | ~np.isnan(angles)) & bearing.any(axis=2))


def _opposite(pairs: PairGeometry) -> View:
    """Return the angle by which two things miss being on opposite sides of the middle of the scene."""
    first, second = (boxes[:, :, :2].mean(axis=1) for boxes in (pairs.boxes, pairs.objects))
    middle = pairs.poses[0].middle
    apart = [side - middle for side in (first, second)]
    lengths = [np.linalg.norm(side, axis=1) for side in apart]
    size = np.maximum(lengths[0][:, None], lengths[1][None, :])
    known = np.minimum(lengths[0][:, None], lengths[1][None, :]) > 0.2 * size  # neither is in the middle
    product = np.maximum(lengths[0][:, None] * lengths[1][None, :], 1e-12)
    return _aim(np.arccos(np.clip(-(apart[0] @ apart[1].T) / product, -1.0, 1.0)), known)


OWN_WORDS = frozenset({"in_front", "behind"})
"""Words that are judged by the viewer, or by the front of the object."""


def own_frame(pairs: PairGeometry, word: str) -> View | None:
    """Return the features of a word in the frames of things with a front; None if the word has no such frame.

    *In front of* and *behind* are judged by the front of the object, *opposite* by the fronts of both. ``aim`` is
    unknown for pairs whose fronts are not known.

    Parameters
    ----------
    pairs
        Geometry of the pairs of n subjects and m objects, with their poses.
    word
        Name of the word.

    Returns
    -------
    dict or None
        Features by name, each of shape (n, m), angles in radians; or None.
    """
    if word in OWN_WORDS:
        reverse = _own_frame_angles(pairs.reverse).T
        aim = np.where(reverse >= 0, np.pi - reverse, reverse) if word == "behind" else reverse
        return {"aim": aim, "gap": pairs.gap}
    if word == "opposite":
        there, back = _own_frame_angles(pairs), _own_frame_angles(pairs.reverse).T
        return {"aim": np.where((there >= 0) & (back >= 0), np.maximum(there, back), UNKNOWN_AIM)}
    return None


def _vertical_gap(pairs: PairGeometry) -> Array | None:
    """Return the vertical distance of the boxes as g / (1 + g), g in mean sizes of the pair; None in 2-D."""
    if pairs.boxes.shape[2] < 3:
        return None
    below = pairs.boxes[:, None, 0, 2] - pairs.objects[None, :, 1, 2]
    above = pairs.objects[None, :, 0, 2] - pairs.boxes[:, None, 1, 2]
    apart = np.maximum(np.maximum(below, above), 0.0)
    unit = np.maximum(pairs.pair_size, 1e-12)
    result: Array = apart / (apart + unit)
    return result


def _nearness(pairs: PairGeometry) -> View:
    return {"gap": pairs.gap, "crowd": pairs.crowd}


def _contact(pairs: PairGeometry) -> View:
    lift = _vertical_gap(pairs)
    return {"gap": pairs.gap} | ({} if lift is None else {"lift": lift})


def _height(pairs: PairGeometry) -> View:
    """Return ``rise`` where heights are known, else ``trail`` on y: upwards in a photograph."""
    return {"trail": _trail(pairs, 1, 1)} if pairs.rise is None else {"rise": pairs.rise}


def _containment(pairs: PairGeometry) -> View:
    """Return the shares of the subject within the object; with heights, how far it reaches below the rim.

    With heights, ``floor`` tells how far the underside of the subject is above that of the object, in units of the
    smaller height.
    """
    found = {"across": pairs.inside[:, :, 0], "along": pairs.inside[:, :, 1]}
    if pairs.boxes.shape[2] == 3:
        deep = pairs.objects[None, :, 1, 2] - pairs.boxes[:, None, 0, 2]
        height = _extents(pairs.objects)[None, :, 2]
        found["depth"] = np.clip(_quotient(deep, height), -1.0, 2.0)
        lower = np.minimum(height, _extents(pairs.boxes)[:, None, 2])
        above = pairs.boxes[:, None, 0, 2] - pairs.objects[None, :, 0, 2]
        found["floor"] = np.clip(_quotient(above, lower), -1.0, 1.0)
    return found


def beneath(pairs: PairGeometry) -> View | None:
    """Return the features of a subject that stands below an object, between its legs; None without heights.

    Parameters
    ----------
    pairs
        Geometry of the pairs of n subjects and m objects.

    Returns
    -------
    View or None
        Shares of the subject within the object, ``across`` and ``along``; how far its top is below that of the object
        (``roof``) and its underside above that of the object (``floor``), as shares of the object's height in [-1, 1].
        Arrays of shape (n, m).
    """
    if pairs.boxes.shape[2] < 3:
        return None
    height = _extents(pairs.objects)[None, :, 2]
    found = {"across": pairs.inside[:, :, 0], "along": pairs.inside[:, :, 1]}
    offsets = {
        "roof": pairs.objects[None, :, 1, 2] - pairs.boxes[:, None, 1, 2],
        "floor": pairs.boxes[:, None, 0, 2] - pairs.objects[None, :, 0, 2],
    }
    for name, offset in offsets.items():
        found[name] = np.clip(_quotient(offset, height), -1.0, 1.0)
    return found


def _alignment(pairs: PairGeometry) -> View:
    least = np.abs(pairs.offset).min(axis=2)
    return {"lateral": least / (1 + least)}


def _level(pairs: PairGeometry) -> View:
    off = np.abs(pairs.offset[:, :, 1]) if pairs.rise is None else np.abs(_middle_offset(pairs))
    return {"lateral": off / (1 + off)}


def _middle_offset(pairs: PairGeometry) -> Array:
    """Return the offset of the undersides in units of the mean height."""
    heights = (_extents(pairs.boxes)[:, None, 2] + _extents(pairs.objects)[None, :, 2]) / 2
    off = pairs.boxes[:, None, 0, 2] - pairs.objects[None, :, 0, 2]
    return _quotient(off, heights)


GRADED_VIEWS: Mapping[str, Callable[[PairGeometry], View]] = {
    "near": _nearness,
    "next_to": _nearness,
    "far": _nearness,
    "around": _nearness,
    "in_front": lambda pairs: _direction(pairs, HEADINGS["bottom"]),
    "behind": lambda pairs: _direction(pairs, HEADINGS["top"]),
    "above": _height,
    "inside": _containment,
    "touching": _contact,
    "against": _contact,
    "leaning": _contact,
    "stacked": _support,
    "along": lambda pairs: {"gap": pairs.gap, "coaxial": _coaxial(pairs)},
    "across": lambda pairs: {"gap": pairs.gap, "coaxial": _coaxial(pairs)},
    "facing": _facing,
    "pointing": _pointing,
    "opposite": _opposite,
    "parallel": lambda pairs: {"coaxial": _coaxial(pairs)},
    "aligned": _alignment,
    "level_with": _level,
    "bigger": _compared(lambda extents: np.prod(extents, axis=1) ** (1 / extents.shape[1])),
    "taller": _compared(lambda extents: extents[:, -1]),
    "longer": _compared(lambda extents: extents.max(axis=1)),
    "wider": _compared(lambda extents: extents[:, 0]),
}
"""Features of words beside the ten. ``excess`` is the difference of a measure of both as a share of the sum,
``coaxial`` the agreement of their long axes, ``aim`` an angle in radians (``UNKNOWN_AIM`` if unknown), ``lateral`` an
offset across, ``lift`` a vertical gap, ``depth`` the share of the object's height that the subject reaches down, and
``floor`` the height of the subject's underside above that of the object."""

STATURE_WORDS = frozenset({"taller", "shorter"})
"""Words that compare the heights of things. A photograph shows heights on y; boxes seen from above do not show them."""

REVERSED = {
    "below": "above",
    "containing": "inside",
    "faced_by": "facing",
    "pointed_at_by": "pointing",
    "leaned_on_by": "leaning",
    "crossed_by": "across",
    "stacked_under": "stacked",
    "ringed_by": "around",
    "smaller": "bigger",
    "shorter": "taller",
    "less_long": "longer",
    "narrower": "wider",
}
"""Words with the features of their inverse for the reversed pair."""
