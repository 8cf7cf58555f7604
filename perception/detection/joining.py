"""What belongs together although its surfaces do not meet convexly: hollow, draped and partly hidden things.

A plate has a well, a cup an inside, a napkin hangs over an edge, a knife hides the middle of the plate that it lies on,
and from above the bowl of a glass hides its stem. Each of these has a rule; a rule gives pairs of parts that are one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.lying import (
    GAP,
    NECK,
    THIN,
    apart,
    continues,
    extents,
    inside,
    offset,
    roundness,
    slenderness,
)
from deixis.perception.detection.parts import Parts

FRAGMENT = 7e-4
"""Square metres: a smaller piece of surface is no thing of its own where it meets another."""

ALIKE, UNLIKE = 9.0, 12.0
"""Differences of colour below which parts are of one colour, and above which they are not, if plain."""

PLAIN = 7.0
"""A part whose colours vary less has one colour; the mean of a motley one says nothing."""

ONE_COLOUR = 1.15
"""Two parts of one colour are two things only where more evidence speaks for it, or where one lies on the other."""

LIES_ON = 0.005
"""Metres: where a part is by so much higher than another, on the average of where they meet, it lies on it."""

DEEP, LEVEL, HOLLOW = 0.03, 0.012, -0.1
"""A hollow is so deep (metres), its rim as high on both sides, and it bulges less: it is seen from inside."""

ROUND = 0.5
"""How much of a round rim is to be seen, in two pieces, for these to be one."""

FOOT, STEM = 0.022, 0.006
"""Most of the foot of a glass is lower than the first, and what meets or hides it higher above it than the second."""

TALL, CENTRED = 1.2, 0.2
"""A bottle is so many times as high as wide, and its neck is so much (of its width) off its middle at the most."""

SHOULDER = 0.02
"""Metres below the top of a bottle from which its neck begins."""

CLEAR, BESIDE = 0.012, 0.5
"""A handle begins so much higher (metres) than what it is on, and no more of it is within the outline of that."""

REACH = 0.02
"""Metres from a handle to what it is on, as seen from above; its ends may be too thin to be seen."""

SMALLER = 0.6
"""A handle is so much narrower than what it is on, at the most, and of so much less surface."""

LOW, LONG = 0.03, 3.0
"""Cutlery is no higher (metres), and so many times as long as wide."""

DOWN = 0.009
"""Metres: the lowest places of the head and the handle of what lies on one thing differ by less, however it is arched;
those of cutlery on the rim of a plate and of cutlery beside the plate by more."""

Pairs = NDArray[np.intp]


def whole_things(parts: Parts) -> Parts:
    """Parts joined until they are things, rule by rule."""
    parts = _without_fragments(parts)
    for rule in (
        of_one_colour,
        enclosed,
        bridged,
        round_rims,
        enclosed,
        of_one_colour,
        insides,
        on_a_foot,
        necks,
        handles,
        insides,
        end_to_end,
        sides,
    ):
        parts = _applied(rule, parts)
    return parts


def _applied(rule: Callable[[Parts], Pairs], parts: Parts) -> Parts:
    """A rule applied as long as it finds something, each time to the two that meet longest."""
    while len(pairs := rule(parts)):
        longest = int(np.argmax(parts.lengths[pairs[:, 0], pairs[:, 1]]))
        parts = parts.joined(pairs[longest : longest + 1])
    return parts


def _without_fragments(parts: Parts) -> Parts:
    while len(pairs := fragments(parts)):
        parts = parts.joined(pairs)
    return parts


def fragments(parts: Parts) -> Pairs:
    """Pieces that are too small, each with the part that it meets longest and most smoothly."""
    pull = parts.smooth * (2.0 - np.where(parts.lengths > 0, parts.evidence, 2.0))
    small = np.flatnonzero((parts.areas < FRAGMENT) & (pull.max(axis=1, initial=0.0) > 0))
    return np.stack([small, pull[small].argmax(axis=1)], axis=1)


def of_one_colour(parts: Parts) -> Pairs:
    """Parts of one colour that meet without much of a crease: the head and the handle of a fork, a draped napkin."""
    return _pairs(_alike(parts) & (parts.evidence < ONE_COLOUR) & (np.abs(parts.rise) < LIES_ON))


def enclosed(parts: Parts) -> Pairs:
    """A part within the outline of one that is above it where they meet, both of one colour: the well of a plate."""
    low = (parts.rise < 0.001) & (parts.lengths > 0) & ~_differ(parts)
    low &= (parts.tops[:, None] <= parts.tops[None] + 0.005) & (parts.bulge[:, None] < 0.1)
    return _chosen(_pairs(low), lambda low, rim: inside(parts, low, rim) > 0.8)


def insides(parts: Parts) -> Pairs:
    """The inside of a cup, with its outside: it is curved inwards, and its rim is as high."""
    deep = parts.tops - parts.bottoms > DEEP
    hollow = ((parts.bulge < HOLLOW) & deep)[:, None] & deep[None] & (parts.lengths > 0) & ~_differ(parts)
    return _pairs(hollow & (np.abs(parts.tops[:, None] - parts.tops[None]) < LEVEL) & (parts.rise < 0.0))


def bridged(parts: Parts) -> Pairs:
    """Two parts of one surface, parted by something narrow that lies on both."""
    under = _under(parts)
    pairs = _pairs(np.triu(_both(under) & _alike(parts) & (parts.gaps < GAP)))
    return _chosen(pairs, lambda a, b: continues(parts, a, b, np.flatnonzero(under[a] & under[b])))


def round_rims(parts: Parts) -> Pairs:
    """Two pieces of a rim that is round, parted by something that lies on both: a plate, and a napkin across it."""
    level = np.abs(parts.tops[:, None] - parts.tops[None]) < LEVEL
    pairs = _pairs(np.triu(_both(_under(parts)) & _alike(parts) & level))
    return _chosen(pairs, lambda a, b: parts.once(roundness, a, b) > ROUND)


def _under(parts: Parts) -> NDArray[np.bool_]:
    """Which parts others lie on, (p, p)."""
    return (parts.rise < -0.0005) & (parts.lengths > 0)


def _both(under: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """On which two parts (p, p) one and the same thing lies."""
    counted = under.astype(np.float64)
    both: NDArray[np.bool_] = counted @ counted.T > 0
    return both


def on_a_foot(parts: Parts) -> Pairs:
    """Something high above a flat foot of its colour that is no wider: a glass, its stem hidden or not."""
    high = parts.middles > 2 * FOOT
    foot = (parts.middles < FOOT) & (parts.bottoms < FOOT / 2)
    same = (parts.rise > STEM) & ~_differ(parts)
    narrow = parts.widths[None] < 1.2 * parts.widths[:, None]
    pairs = _pairs(high[:, None] & foot[None] & same & narrow)
    return _chosen(pairs, lambda glass, foot: inside(parts, foot, glass) > 0.1)


def necks(parts: Parts) -> Pairs:
    """Something narrow right on the middle of what is much higher than wide: the neck of a bottle, its cap."""
    narrow = parts.widths[:, None] < SMALLER * parts.widths[None]
    upright = parts.tops - parts.bottoms > TALL * parts.widths
    above = parts.bottoms[:, None] > parts.tops[None] - SHOULDER
    off = np.linalg.norm(parts.centres[:, None] - parts.centres[None], axis=2)
    pairs = _pairs(narrow & upright[None] & above & (off < CENTRED * parts.widths[None]) & (parts.lengths > 0))
    return _chosen(pairs, lambda neck, bottle: inside(parts, neck, bottle) > 0.8)


def handles(parts: Parts) -> Pairs:
    """Something small that stands on nothing, and the larger thing of its colour and height beside which it is."""
    small = (parts.widths[:, None] < SMALLER * parts.widths[None]) & (
        parts.areas[:, None] < SMALLER * parts.areas[None]
    )
    clear = parts.bottoms[:, None] > parts.bottoms[None] + CLEAR
    as_high = parts.tops[:, None] < parts.tops[None] + LEVEL
    pairs = _pairs(small & clear & as_high & ~_differ(parts) & (parts.gaps < REACH))
    most = np.where(parts.areas < FRAGMENT, 1.0, BESIDE)  # of a fragment all: the body may be seen around it
    return _chosen(
        pairs, lambda handle, body: apart(parts, handle, body) < REACH and inside(parts, handle, body) <= most[handle]
    )


def end_to_end(parts: Parts) -> Pairs:
    """Two low pieces of one colour in a line, together long and narrow: the head and the handle of a spoon."""
    low = parts.tops < LOW
    pairs = _pairs(np.triu(low[:, None] & low[None] & (parts.gaps < NECK) & ~_differ(parts)))
    return _chosen(pairs, lambda a, b: parts.once(slenderness, a, b) > LONG and _lie_as_one(parts, a, b))


def _lie_as_one(parts: Parts, a: int, b: int) -> bool:
    """Whether two pieces in a line can be one rigid thing for how high they lie: both come down to what it lies on, or
    it leans and its slope goes on from the one to the other. Cutlery on a plate does neither to cutlery beside it."""
    down = abs(parts.bottoms[a] - parts.bottoms[b]) < DOWN
    return bool(down or parts.once(offset, a, b) < LIES_ON)


def sides(parts: Parts) -> Pairs:
    """A thin upright piece, and the thing of its colour whose side it is: seen so aslant that the edge is a jump."""
    beside = (parts.gaps < REACH) & (parts.tops[:, None] < parts.tops[None] + LIES_ON) & ~_differ(parts)
    sheets = np.array([_is_sheet(parts, part) for part in range(len(parts))], dtype=np.bool_)
    pairs = _pairs(sheets[:, None] & beside & (parts.areas[:, None] < parts.areas[None]))
    return _chosen(pairs, lambda side, thing: apart(parts, side, thing) < REACH)


def _is_sheet(parts: Parts, part: int) -> bool:
    patches = parts.members(part)
    normal = parts.patches.normals[patches].mean(axis=0)
    upright = abs(normal[2]) < 0.5 * np.linalg.norm(normal)
    return bool(upright and extents(parts.patches.middles[patches, :2])[1] < THIN)


def _chosen(pairs: Pairs, belong: Callable[[int, int], bool]) -> Pairs:
    return pairs[np.array([belong(a, b) for a, b in pairs.tolist()], dtype=np.bool_)]


def _alike(parts: Parts) -> NDArray[np.bool_]:
    """Which parts are of one plain colour, (p, p)."""
    plain = parts.motley < PLAIN
    return (parts.unlike() < ALIKE) & plain[:, None] & plain[None]


def _differ(parts: Parts) -> NDArray[np.bool_]:
    """Which parts are surely not of one colour, (p, p): they differ by more than both vary in themselves."""
    varied = np.minimum(parts.motley[:, None], parts.motley[None])
    result: NDArray[np.bool_] = parts.unlike() >= np.maximum(UNLIKE, varied)
    return result


def _pairs(which: NDArray[np.bool_]) -> Pairs:
    """The pairs of different parts that are marked in (p, p)."""
    return np.argwhere(which & ~np.eye(len(which), dtype=np.bool_))
