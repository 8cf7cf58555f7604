"""Features of pairs of boxes in the frame of a relation word.

The axis of *left* is -x, those of *top left* are -x and y. The features have the same names for all words, so that
words that mirror each other share a model, and an inverse has the features of the exchanged pair.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.geometry.pairs import PairGeometry

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
    """Return the features of every ordered pair for one of the ten words, or for ``saying``; arrays of shape (n, n).

    Features of a direction: ``deviation`` (radians from the direction of the word), ``clear`` (distance of the near
    edges), ``trail`` and ``lead`` (the lesser and the greater of the offsets of starts and ends), ``forward`` and
    ``lateral`` (offsets along and across), ``abreast`` (share of the smaller extent across that the other covers),
    ``gap``, ``alike`` (difference of sizes). Features of support: see :func:`_support`. Features of saying: ``crowd``
    and ``figure``.
    """
    if word == "saying":
        return {"crowd": pairs.crowd, "figure": pairs.smaller}
    if word == "on":
        return _support(pairs)
    if word == "under":
        return {name: feature.T for name, feature in _support(pairs.reverse).items()}
    return _direction(pairs, HEADINGS[word])


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
