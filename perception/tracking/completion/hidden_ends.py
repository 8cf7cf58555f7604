"""Estimate how long a long thing is of which something hides an end.

The end lies behind what hides it: if the thing were longer, it would come into view on the other side. Between these
bounds, the usual lengths of the kinds of cutlery that are as wide and as high as what is seen say which length is
likely.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.tbox import default_ontology
from deixis.perception.oriented_box import turned_axes
from deixis.perception.tracking.completion.missing_parts import FLAT, MIN_BEFORE, MIN_SLENDERNESS, NEAREST
from deixis.perception.tracking.frames.image import TableView
from deixis.perception.tracking.table.reference import Reference
from deixis.perception.tracking.things.pipeline import Pipeline

STEP = 0.003
"""Distance in metres of the places beyond an end at which it is looked for what is seen there."""

MAX_GAP = 0.008
"""Distance in metres from an end, or from the last pixel that shows the thing, within which what hides it begins: two
pixels, which the noise of the table may take from a blade. Where more of the table is seen between the two, the end is
seen."""

END, ACROSS = 0.01, (0.1, 0.5, 0.9)
"""Length in metres of the end of a thing whose points say where across its box it goes on, and the quantiles of these
points at which that is looked at."""

MAX_ELONGATION, FOOT, MIN_FOOT_POINTS, MOST_OF_FOOT = 1.3, 0.01, 10, 0.95
"""Largest ratio of the sides of a thing that may be round, the height in metres above the long thing of the part of it
that counts as its foot, the minimum number of points of the foot, and their share within its radius."""

MAX_BEYOND = 0.3
"""Largest distance in metres beyond an end at which a thing is looked for."""

SIZE_NOISE = 0.003
"""Standard deviation in metres of the width and the height of what is seen."""

HANDLE = 0.3, 0.5, 0.85
"""Widths of a handle as shares of the least, the typical and the greatest width of the kind, which is that of the
head. Heads and handles are equally likely to be seen."""

LOW_PART = 0.3
"""Height of the lowest part of a thing, as a share of the least height of its kind."""

RIGHT = 0.014
"""Error in metres up to which a length is right. The middle is then right to 7 mm, which leaves 3 mm of a centimetre
for the errors of the end that is seen."""

LENGTHS, SIZES = np.arange(0.0, 0.4, 0.001), np.arange(0.0, 0.1, 0.0005)
"""Lengths in metres, and widths and heights, for which the prior probabilities are known."""


def hidden_lengths(
    thing: Pipeline, others: Iterable[Pipeline], reference: Reference, view: TableView
) -> tuple[float, float]:
    """Return how far a thing at rest may continue behind others at the two ends of its box.

    Parameters
    ----------
    thing
        The thing.
    others
        The other things at rest, into which it cannot continue.
    reference
        The table at rest.
    view
        View of the table in which the reference is.

    Returns
    -------
    tuple
        Lengths in metres beyond the end against the long axis of the box and beyond the one along it; 0 where the
        table is seen beyond the end, and for a thing that is not long and flat.
    """
    length, width, height = thing.oriented.extents
    if length < MIN_SLENDERNESS * width or height > FLAT:
        return 0.0, 0.0
    others = list(others)
    own = (reference.owner == thing.slot) | (reference.depth <= 0)  # it continues where it is seen, or nothing is known
    unless_own = np.where(own, NEAREST, reference.depth)
    steps = np.arange(STEP, MAX_BEYOND, STEP)
    found = []
    for sign in (-1, 1):
        lengths = []
        for start, direction in _lines_beyond(thing, sign):
            places = start + steps[:, None] * direction
            hidden = view.hides(places, reference.depth, MIN_BEFORE)
            goes_on = view.hides(places, unless_own, MIN_BEFORE)
            seen = float(steps[int((hidden | ~goes_on).argmax())]) - STEP
            near = steps < seen + MAX_GAP
            if not hidden[near].any():
                lengths.append(0.0)
                continue
            free = (~goes_on & ~near) | np.any([_stands_at(other, places) for other in others], axis=0)
            lengths.append(float(steps[int(free.argmax())] - STEP) if free.any() else MAX_BEYOND)
        found.append(float(np.median(lengths)))  # one line may pass an edge of what hides the end
    return found[0], found[1]


def _stands_at(other: Pipeline, places: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return a mask of the places (k, 3) at which a thing stands; below the rim of a bowl, only those at its foot."""
    inside = other.contains(places, 0.0)
    length, width, _ = other.oriented.extents
    if not inside.any() or length > MAX_ELONGATION * width:
        return inside
    points, middle = other.placed_points, other.placed_corners.mean(axis=0)
    away = np.linalg.norm(points[:, :2] - middle[:2], axis=1)[points[:, 2] < places[:, 2].max() + FOOT]
    if len(away) < MIN_FOOT_POINTS:
        return inside
    at_foot = np.linalg.norm(places[:, :2] - middle[:2], axis=1) < np.quantile(away, MOST_OF_FOOT)
    return np.asarray(inside & at_foot)


def _lines_beyond(thing: Pipeline, sign: int) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Return the starts and the directions of lines beyond one end of a thing, across the width that is seen there.

    A bent or unevenly wide thing, such as a spoon, does not end in the middle of its box.
    """
    length, _, _ = thing.oriented.extents
    axes = turned_axes(thing.oriented.yaw)
    own = (thing.cloud.points.astype(np.float64) - np.array(thing.oriented.centre)) @ axes.T
    last = own[sign * own[:, 0] > length / 2 - END]
    if not len(last):
        last = np.zeros((1, 3))
    across, height = np.quantile(last[:, 1], ACROSS), float(np.median(last[:, 2]))
    starts = np.column_stack([np.full(len(across), sign * length / 2), across, np.full(len(across), height)])
    places = (np.array(thing.oriented.centre) + starts @ axes) @ thing.pose[:3, :3].T + thing.pose[:3, 3]
    direction = sign * thing.pose[:3, :3] @ axes[0]
    return [(place, direction) for place in places]


def likely_length(seen: float, width: float, height: float, most: float) -> tuple[float, float]:
    """Return the likeliest length of a piece of cutlery of which a part is seen, and its standard deviation.

    Parameters
    ----------
    seen, width, height
        Length, width and height in metres of what is seen: with the head of the piece, or of its handle only.
    most
        Greatest possible length in metres.

    Returns
    -------
    tuple
        Length that is right to ``RIGHT`` with the largest probability, and the standard deviation, in metres; the seen
        length, and 0, if no piece of cutlery has a possible length.

    Examples
    --------
    >>> length, spread = likely_length(0.1, 0.02, 0.008, 0.4)
    >>> 0.15 < length < 0.2, 0.02 < spread < 0.06
    (True, True)
    >>> likely_length(0.39, 0.02, 0.008, 0.4)
    (0.39, 0.0)
    """
    weights = np.zeros(len(LENGTHS))
    for kind in _kinds():
        likelihood = _density(width, kind.head) + _density(width, kind.handle)
        weights += likelihood * _density(height, kind.height) * kind.lengths
    possible = (seen <= LENGTHS) & (most >= LENGTHS)
    weights = np.where(possible, weights, 0.0)
    total = float(weights.sum())
    if total <= 0:
        return seen, 0.0
    within = np.convolve(weights, np.ones(2 * round(RIGHT / LENGTHS[1]) + 1), "same")
    length = float(LENGTHS[possible][within[possible].argmax()])
    return length, float(np.sqrt((LENGTHS - length) ** 2 @ weights / total))


@dataclass(frozen=True, eq=False)
class _Kind:
    """Prior probabilities of a kind of cutlery: of its ``LENGTHS``, and of ``SIZES`` across the parts that are seen."""

    lengths: NDArray[np.float64]
    head: NDArray[np.float64]
    handle: NDArray[np.float64]
    height: NDArray[np.float64]


@cache
def _kinds() -> tuple[_Kind, ...]:
    """Return the most special kinds of cutlery."""
    ontology = default_ontology()
    cutlery = ontology.kinds.of_word("cutlery")
    assert cutlery is not None, "the TBox has cutlery"
    kinds = [kind for kind in ontology.kinds if cutlery.iri in kind.broader and ontology.kinds.in_tbox(kind.iri)]
    broader = {iri for kind in kinds for iri in kind.broader if iri != kind.iri}
    found = []
    for kind in kinds:
        size = ontology.sizes.of(kind.iri)
        if kind.iri in broader or size.stated_of != kind.iri:
            continue
        length, width, height = (
            (each.least, each.typical, each.greatest) for each in (size.length, size.width, size.height)
        )
        handle = tuple(share * value for share, value in zip(HANDLE, width, strict=True))
        low = (LOW_PART * height[0], *height[1:])  # of a part
        found.append(_Kind(_prior(LENGTHS, length), *(_prior(SIZES, each) for each in (width, handle, low))))
    return tuple(found)


def _prior(values: NDArray[np.float64], bounds: tuple[float, ...]) -> NDArray[np.float64]:
    """Return the triangular distribution at values between the least, the typical and the greatest one."""
    prior = np.interp(values, bounds, [0.0, 1.0, 0.0], left=0.0, right=0.0)
    return np.asarray(prior / max(float(prior.sum()), 1e-9))


def _density(measured: float, prior: NDArray[np.float64]) -> float:
    """Return the likelihood of a measured size under a prior of ``SIZES``."""
    return float(prior @ np.exp(-0.5 * ((SIZES - measured) / SIZE_NOISE) ** 2))
