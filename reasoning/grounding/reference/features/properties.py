"""Features of single objects for each property word, among the rivals: colours, sizes, heights, places, orders.

Features are arrays that broadcast to (v, x): viewer and candidate.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.things.colours import Colours
from deixis.reasoning.grounding.reference.features.room import Room
from deixis.reasoning.grounding.reference.query import Person, Property

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Features = Mapping[str, Array]


Rivals = tuple[Indices, ...]
"""Positions of the candidates that compete with each other, such as all chairs, and then all red chairs.

Each candidate is compared within the last group that it is in.
"""


def order(values: Array, rivals: Rivals) -> Features:
    """Return features of having a large value among the rivals.

    Parameters
    ----------
    values
        Values of x candidates for v viewers, shape (v, x).
    rivals
        Positions of the candidates that compete with each other.

    Returns
    -------
    dict
        Features by name, each of shape (v, x).
    """
    standard, greatest, rank, lead = (np.zeros(values.shape) for _ in range(4))
    greatest[:] = 1.0
    for group in rivals:
        if len(group) == 1:
            standard[:, group], greatest[:, group], rank[:, group], lead[:, group] = 0.0, 1.0, 0.0, 0.0
            continue
        among = values[:, group]
        best = among.max(axis=1, keepdims=True)
        spread = np.maximum(among.std(axis=1, keepdims=True), 1e-6)
        standard[:, group] = np.clip((among - among.mean(axis=1, keepdims=True)) / spread, -3.0, 3.0)
        greatest[:, group] = among >= best - 1e-9
        rank[:, group] = among.argsort(axis=1).argsort(axis=1) / (len(group) - 1)
        lead[:, group] = np.maximum(among - best, -3.0)
    return {"standard": standard, "greatest": greatest, "rank": rank, "lead": lead}


def placed(values: Array, rivals: Rivals, place: int) -> Features:
    """Return features of being at a place of the order from the largest value.

    Parameters
    ----------
    values
        Values of x candidates for v viewers, shape (v, x).
    rivals
        Positions of the candidates that compete with each other.
    place
        Place, counted from 1; -1 for the last.

    Returns
    -------
    dict
        Features by name, each of shape (v, x).
    """
    off = np.zeros(values.shape)
    for group in rivals:
        rank = (-values[:, group]).argsort(axis=1).argsort(axis=1)
        off[:, group] = np.abs(rank - (place - 1 if place > 0 else len(group) + place))
    return {"at": (off == 0).astype(float), "off": -np.minimum(off, 4.0)}


def middling(values: Array, rivals: Rivals) -> Features:
    """Return features of being in the middle of an order.

    Parameters
    ----------
    values
        Values of x candidates for v viewers, shape (v, x).
    rivals
        Positions of the candidates that compete with each other.

    Returns
    -------
    dict
        Features by name, each of shape (v, x).
    """
    off = np.abs(order(values, rivals)["rank"] - 0.5)
    median = np.zeros(values.shape)
    for group in rivals:
        median[:, group] = off[:, group] <= off[:, group].min(axis=1, keepdims=True) + 1e-9
    return {"median": median, "off": -off}


def _heights(room: Room) -> Array:
    return room.centres[:, 2]


def _length(room: Room) -> Array:
    result: Array = np.log(np.maximum(room.extents.max(axis=1), 1e-6))
    return result


def _width(room: Room) -> Array:
    result: Array = np.log(np.maximum(room.extents[:, :2].max(axis=1), 1e-6))
    return result


def _depth(room: Room) -> Array:
    result: Array = np.log(np.maximum(room.extents[:, :2].min(axis=1), 1e-6))
    return result


def _tallness(room: Room) -> Array:
    result: Array = np.log(np.maximum(room.extents[:, 2], 1e-6))
    return result


def _volume(room: Room) -> Array:
    result: Array = np.log(np.maximum(room.extents, 0.02 * room.scale)).sum(axis=1)
    return result


def _elongation(room: Room) -> Array:
    sides = np.sort(np.maximum(room.extents, 0.02 * room.scale), axis=1)
    result: Array = np.log(sides[:, 2] / sides[:, 1])
    return result


def _roundness(room: Room) -> Array:
    sides = np.sort(np.maximum(room.extents[:, :2], 1e-6), axis=1)
    result: Array = sides[:, 0] / sides[:, 1]
    return result


def _apart(room: Room) -> Array:
    """Return the distance of each object from the nearest one with its label."""
    labels = np.array([label or "" for label in room.labels])
    same = (labels[:, None] == labels[None]) & ~np.eye(len(room), dtype=bool)
    result: Array = np.log(np.where(same, room.gaps, 20.0).min(axis=1, initial=20.0) + 0.1)
    return result


MEASURES: dict[str, Callable[[Room], Array]] = {
    "volume": _volume,
    "tallness": _tallness,
    "length": _length,
    "width": _width,
    "depth": _depth,
    "elongation": _elongation,
    "roundness": _roundness,
    "height": _heights,
    "apart": _apart,
    "middle": lambda room: -np.linalg.norm(room.centres[:, :2] - room.middle, axis=1),
    "corner": lambda room: -room.corner_gaps,
    "wall": lambda room: -room.wall_gaps,
}

SIZES: dict[str, tuple[str, float]] = {
    "big": ("volume", 1.0),
    "large": ("volume", 1.0),
    "huge": ("volume", 1.0),
    "giant": ("volume", 1.0),
    "great": ("volume", 1.0),
    "full": ("volume", 1.0),
    "small": ("volume", -1.0),
    "little": ("volume", -1.0),
    "tiny": ("volume", -1.0),
    "mini": ("volume", -1.0),
    "tall": ("tallness", 1.0),
    "short": ("tallness", -1.0),
    "high": ("height", 1.0),
    "upper": ("height", 1.0),
    "top": ("height", 1.0),
    "topmost": ("height", 1.0),
    "up": ("height", 1.0),
    "low": ("height", -1.0),
    "lower": ("height", -1.0),
    "bottom": ("height", -1.0),
    "bottommost": ("height", -1.0),
    "down": ("height", -1.0),
    "long": ("length", 1.0),
    "wide": ("width", 1.0),
    "broad": ("width", 1.0),
    "narrow": ("width", -1.0),
    "thin": ("depth", -1.0),
    "slim": ("depth", -1.0),
    "skinny": ("depth", -1.0),
    "thick": ("depth", 1.0),
    "deep": ("depth", 1.0),
    "shallow": ("depth", -1.0),
    "rectangular": ("elongation", 1.0),
    "square": ("elongation", -1.0),
    "round": ("roundness", 1.0),
    "circular": ("roundness", 1.0),
    "corner": ("corner", 1.0),
    "alone": ("apart", 1.0),
    "isolated": ("apart", 1.0),
    "lone": ("apart", 1.0),
    "separate": ("apart", 1.0),
    "single": ("apart", 1.0),
    "near_each_other": ("apart", -1.0),
    "together": ("apart", -1.0),
    "edge": ("wall", 1.0),
    "wall": ("wall", 1.0),
}
"""Measure and sign of the words that compare objects by one number."""

SIDES: dict[str, tuple[int, float]] = {
    "left": (0, -1.0),
    "leftmost": (0, -1.0),
    "right": (0, 1.0),
    "rightmost": (0, 1.0),
    "front": (1, -1.0),
    "near": (1, -1.0),
    "close": (1, -1.0),
    "nearest": (1, -1.0),
    "back": (1, 1.0),
    "rear": (1, 1.0),
    "far": (1, 1.0),
    "behind": (1, 1.0),
}
"""Axis (0 to the viewer's right, 1 away from the viewer) and sign of the words that place objects in a view."""

MIDDLE = frozenset({"middle", "centre", "center", "central"})

VIVID = 25.0
"""Minimum CIELAB chroma at which the mean colour of an object determines its colour term well."""

LIGHTNESS: dict[str, float] = {"dark": -1.0, "light": 1.0, "bright": 1.0, "pale": 1.0}


FLAT = {"high": "back", "upper": "back", "top": "back", "topmost": "back", "up": "back"}
FLAT |= {"low": "front", "lower": "front", "bottom": "front", "bottommost": "front", "down": "front"}
"""Sides of a scene that is seen from above, where all objects are at one height."""


def side_values(room: Room, candidates: Indices, axis: int, sign: float, person: Person | None = None) -> Array:
    """Return the coordinates of candidates along an axis of each view of a person, times the sign.

    Parameters
    ----------
    room
        The scene.
    candidates
        Positions of the x candidates.
    axis
        0 for left to right, 1 for near to far.
    sign
        1, or -1 for the opposite direction.
    person
        Person whose view counts; None for the viewer.

    Returns
    -------
    ndarray
        Coordinates in units of the scene's scale, shape (v, x).
    """
    views = room.heading(person)
    heading = np.stack([views[:, 1], -views[:, 0]], axis=1) if axis == 0 else views
    result: Array = sign * heading @ room.centres[candidates, :2].T / room.scale
    return result


def property_features(
    prop: Property, room: Room, candidates: Indices, rivals: Rivals, colours: Colours
) -> tuple[str, Features] | None:
    """Return the name of the weights of a property and its features, or None if nothing in a scene shows it.

    Parameters
    ----------
    prop
        The property.
    room
        The scene.
    candidates
        Positions of the x candidates.
    rivals
        Positions of the candidates that compete with each other.
    colours
        Known colour terms.

    Returns
    -------
    tuple or None
        Name of the weights, and features by name, each of shape (v, x) or (1, x).
    """
    word = prop.word
    if word in FLAT and room.is_flat:
        word = FLAT[word]
        prop = replace(prop, word=word)
    if prop.dimension == "rank" or prop.rank is not None:
        return _ranked(prop, room, candidates, rivals)
    if (term := colours.of_word(word)) is not None:
        return "colour", _colour(term.prototype, room, candidates, rivals)
    if word in LIGHTNESS:
        return "lightness", order(LIGHTNESS[word] * np.nan_to_num(room.lab[candidates, 0], nan=50.0)[None], rivals)
    degree = "" if prop.degree == "plain" else "est"
    if word in MIDDLE:
        across = middling(side_values(room, candidates, 0, 1.0), rivals)
        central = order(MEASURES["middle"](room)[candidates][None], rivals)
        high = middling(_heights(room)[candidates][None], rivals)
        return "middle", {
            **across,
            **{f"room_{name}": values for name, values in central.items()},
            "height": high["off"],
        }
    if word in SIDES:
        axis, sign = SIDES[word]
        seen = room.viewer or prop.person in room.headings  # the weights of depth are for an unknown viewer
        name = "side" if axis == 0 or seen else "depth"
        return name, order(side_values(room, candidates, axis, sign, prop.person), rivals)
    if word in SIZES:
        measure, sign = SIZES[word]
        return f"{measure}{degree}", order(sign * MEASURES[measure](room)[candidates][None], rivals)
    return None


def called_by(word: str, room: Room, colours: Colours) -> NDArray[np.bool_] | None:
    """Return which objects are vivid and likely to be called by a word for a colour; None for another word.

    Parameters
    ----------
    word
        The word.
    room
        The scene of n objects.
    colours
        Known colour terms.

    Returns
    -------
    ndarray or None
        Mask of shape (n,), or None.
    """
    from deixis.reasoning.grounding.evidence.properties.colours import colour_evidence

    term = colours.of_word(word)
    if term is None or np.isnan(room.colours).all():
        return None
    vivid = np.linalg.norm(room.lab[:, 1:], axis=1) > VIVID
    result: NDArray[np.bool_] = vivid & (colour_evidence([term.iri], room.colours, colours)[0] > 0)
    return result


def _ranked(prop: Property, room: Room, candidates: Indices, rivals: Rivals) -> tuple[str, Features]:
    place = prop.rank or 1
    if prop.word in SIZES:
        measure, sign = SIZES[prop.word]
        return "rank", placed(sign * MEASURES[measure](room)[candidates][None], rivals, place)
    axis, sign = SIDES.get(prop.word, (0, -1.0))
    return "rank", placed(side_values(room, candidates, axis, sign, prop.person), rivals, place)


def _colour(prototype: tuple[int, int, int], room: Room, candidates: Indices, rivals: Rivals) -> Features:
    from deixis.reasoning.grounding.evidence.properties.colours import lab_of_srgb

    lab = room.lab[candidates]
    wanted = lab_of_srgb(np.array(prototype, dtype=np.float64))
    known: NDArray[np.bool_] = np.logical_not(np.isnan(lab).any(axis=1))
    lab = np.where(known[:, None], lab, wanted)
    lightness = -np.abs(lab[:, 0] - wanted[0]) / 25
    tint = -np.linalg.norm(lab[:, 1:] - wanted[1:], axis=1) / 25
    chroma = np.linalg.norm(wanted[1:]) / 50
    hue = lab[:, 1:] @ wanted[1:] / np.maximum(np.linalg.norm(wanted[1:]) * 20, 1e-6) * min(chroma, 1.0)
    near = order((0.5 * lightness + tint + hue)[None], rivals)
    return {
        "lightness": lightness[None],
        "tint": tint[None],
        "hue": hue[None],
        "best": near["greatest"],
        "standard": near["standard"],
    }
