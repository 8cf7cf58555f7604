"""Degrees of places in a region: its corners, edges, ends, sides, parts and its middle, of the surface or of a thing.

A place is read by the *lean* of a box in the region on each axis: 0 at its left (near) boundary, 1 at its right (far)
boundary. For the surface, the lean is the gap on one side as a share of the gaps on both sides, so that it does not
depend on the size of the thing. For places on a thing, it is the place of the centre.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.evidence.words.meaning import BORDER, EXTREME

Array = NDArray[np.float64]

X, Y = 0, 1
TOWARDS = {
    **dict.fromkeys(("left",), (X, -1)),
    **dict.fromkeys(("right",), (X, 1)),
    **dict.fromkeys(("far", "back", "behind", "top", "upper", "rear", "distant"), (Y, 1)),
    **dict.fromkeys(("near", "front", "bottom", "lower", "close", "closest", "nearest", "forward"), (Y, -1)),
}
"""Axis and sign of the direction words for the viewer: x to the right, y away."""

CENTRAL = frozenset({"middle", "centre", "center", "central"})

PART, END, MIDDLE = (
    # prototype: three quarters of the way; one half: the middle
    ((0.0, 0.5, 0.75), (EXTREME, BORDER, 0.0)),
    # prototype: the last seventh; one half: two thirds of the way
    ((1 / 3, 2 / 3, 6 / 7), (EXTREME, BORDER, 0.0)),
    # prototype: the middle fifth; one half: half of the way to the boundary
    ((0.1, 0.25, 0.5), (0.0, BORDER, EXTREME)),
)


MIN_SUPPORTED = 4
"""Minimum number of boxes on a box at which it is taken as the surface that they stand on."""
MIN_SUPPORTED_SHARE = 0.6
"""Share of the other boxes that stand on it."""


def supporting_box(boxes: Array) -> int | None:
    """Return the index of the box that most others stand on, such as a tray; None without one.

    A box stands on another if its centre is within the other's outline and its underside is not below the other's.

    Parameters
    ----------
    boxes
        Boxes of n things, shape (n, 2, 3); boxes with 2 axes have no support.

    Returns
    -------
    int or None
        Position of the box, or None.
    """
    if len(boxes) <= MIN_SUPPORTED or boxes.shape[2] < 3:
        return None
    low, high = boxes[:, 0], boxes[:, 1]
    middle = (low + high) / 2
    within = ((middle[None, :, :2] > low[:, None, :2]) & (middle[None, :, :2] < high[:, None, :2])).all(axis=2)
    flat = high[:, None, 2] <= middle[None, :, 2]
    stands = within & flat & (low[None, :, 2] >= low[:, None, 2]) & ~np.eye(len(boxes), dtype=bool)
    counts = stands.sum(axis=1)
    best = int(counts.argmax())
    held = int(counts[best])
    return best if held >= MIN_SUPPORTED and held >= MIN_SUPPORTED_SHARE * (len(boxes) - 1) else None


def lean_on_surface(boxes: Array, surface: int | None = None) -> Array:
    """Return the lean of boxes on the surface that holds them.

    Without a surface, it is their common bounding box with a margin of half of their mean spacing on every side.

    Parameters
    ----------
    boxes
        Boxes of n things, shape (n, 2, d).
    surface
        Index of the box that is the surface; None takes the box that most others stand on, if there is one.

    Returns
    -------
    ndarray
        Lean of each box, shape (n, 2), from 0 to 1: from left to right, and from near to far.
    """
    low, high = boxes[:, 0, :2], boxes[:, 1, :2]
    support = supporting_box(boxes) if surface is None else surface
    if support is not None:
        before, after = np.maximum(low - low[support], 0.0), np.maximum(high[support] - high, 0.0)
        held: Array = np.clip(before / np.maximum(before + after, 1e-9), 0.0, 1.0)
        return held
    least, most = low.min(axis=0), high.max(axis=0)
    margin = np.maximum((most - least) / (2 * len(boxes)), 1e-9)
    before, after = low - (least - margin), (most + margin) - high
    lean: Array = before / (before + after)
    return lean


def lean_in_things(boxes: Array) -> Array:
    """Return the lean of the centre of each box in each box.

    Parameters
    ----------
    boxes
        Boxes of n things, shape (n, 2, d).

    Returns
    -------
    ndarray
        Place of each centre (rows) in each box (columns) in [0, 1], shape (n, n, 2).
    """
    low, extent = boxes[:, 0, :2], boxes[:, 1, :2] - boxes[:, 0, :2]
    middle = low + extent / 2
    share = (middle[:, None] - low[None]) / np.maximum(extent[None], 1e-9)
    return np.clip(share, 0.0, 1.0)


def place_degree(term: str, value: str | None, lean: Array) -> Array | None:
    """Return the degree of a place for leans of shape (…, 2); None where the words name no place.

    ``far left`` of a part is the far left quarter or the extreme left: the degree is the mean of both readings. A
    place without a side (*at the edge*, *in a corner*) is the best of its sides.

    Parameters
    ----------
    term
        Kind of place, such as ``corner``, ``side``, ``edge`` or ``part``.
    value
        Words for the side, such as *far left*; None where none is named.
    lean
        Places in [0, 1] from left to right and from near to far, shape (…, 2).

    Returns
    -------
    ndarray or None
        Degrees in (0, 1], shape (…,), or None.

    Examples
    --------
    >>> place_degree("corner", "far left", np.array([[0.1, 0.9], [0.9, 0.9], [0.5, 0.5]])).round(2).tolist()
    [1.0, 0.05, 0.03]
    """
    words = (value or "").replace("-", " ").split()
    sides = {TOWARDS[word] for word in words if word in TOWARDS}
    if len({axis for axis, _ in sides}) < len(sides):
        return None
    if term == "middle" or (term == "part" and not sides and CENTRAL & set(words)):
        # the middle of the near edge is in the middle along the edge
        axes = [axis for axis in (X, Y) if axis not in {side for side, _ in sides}] or [X, Y]
        return _product([_term(MIDDLE, np.abs(lean[..., axis] - 0.5)) for axis in axes])
    if words and not sides:
        return None
    if term == "corner":
        choices = [{X: x, Y: y} for x in (-1, 1) for y in (-1, 1)]
        fitting = [one for one in choices if all(one[axis] == sign for axis, sign in sides)]
        return _best([_towards(END, lean, list(one.items())) for one in fitting])
    model = PART if term in ("part", "side") else END
    if not sides:
        if term == "part":
            return None
        bounded = (X,) if term in ("end", "side") else (X, Y)
        return _best([_towards(END, lean, [(axis, sign)]) for axis in bounded for sign in (-1, 1)])
    both = _towards(model, lean, sorted(sides))
    if len(sides) == 2 and words[0] == "far":
        last = TOWARDS[words[-1]]
        return np.asarray((both + _towards(END, lean, [last])) / 2)
    return both


def _towards(model: tuple[tuple[float, ...], tuple[float, ...]], lean: Array, sides: list[tuple[int, int]]) -> Array:
    return _product([_term(model, lean[..., axis] if sign > 0 else 1 - lean[..., axis]) for axis, sign in sides])


def _term(model: tuple[tuple[float, ...], tuple[float, ...]], feature: Array) -> Array:
    degree: Array = np.exp(np.interp(feature, *model))
    return degree


def _product(degrees: list[Array]) -> Array:
    return np.asarray(np.prod(degrees, axis=0))


def _best(degrees: list[Array]) -> Array:
    return np.asarray(np.max(degrees, axis=0))
