"""What belongs together although its surfaces do not meet convexly: hollow, draped and partly hidden things.

A plate has a well, a cup an inside, a napkin hangs over an edge, a knife hides the middle of the plate that it lies on,
and from above the bowl of a glass hides its stem. Each of these has a rule; a rule gives pairs of parts that are one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.parts import (
    Parts,
    apart,
    continues,
    extents,
    inside,
    offset,
    roundness,
    slenderness,
)

Pairs = NDArray[np.intp]


def whole_things(parts: Parts) -> Parts:
    """Return parts joined until they are things, rule by rule."""
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
    """Return a rule applied as long as it finds something, each time to the two that meet longest."""
    while len(pairs := rule(parts)):
        longest = int(np.argmax(parts.lengths[pairs[:, 0], pairs[:, 1]]))
        parts = parts.joined(pairs[longest : longest + 1])
    return parts


def _without_fragments(parts: Parts) -> Parts:
    while len(pairs := fragments(parts)):
        parts = parts.joined(pairs)
    return parts


def fragments(parts: Parts) -> Pairs:
    """Return pieces that are too small, each with the part that it meets longest and most smoothly."""
    pull = parts.smooth * (2.0 - np.where(parts.lengths > 0, parts.evidence, 2.0))
    small = np.flatnonzero((parts.areas < parts.settings.fragment_area) & (pull.max(axis=1, initial=0.0) > 0))
    return np.stack([small, pull[small].argmax(axis=1)], axis=1)


def of_one_colour(parts: Parts) -> Pairs:
    """Return parts of one colour that meet without much of a crease: the head and the handle of a fork, a draped
    napkin."""
    smooth = parts.evidence < parts.settings.same_colour_evidence
    return _pairs(_alike(parts) & smooth & (np.abs(parts.rise) < parts.settings.resting_rise))


def enclosed(parts: Parts) -> Pairs:
    """Return a part within the outline of one that is above it where they meet, both of one colour: the well of a
    plate."""
    limits = parts.settings
    low = (parts.rise < limits.well_rise) & (parts.lengths > 0) & ~_differ(parts)
    low &= parts.tops[:, None] <= parts.tops[None] + limits.well_top_tolerance
    low &= parts.bulge[:, None] < limits.max_well_bulge
    return _chosen(_pairs(low), lambda low, rim: inside(parts, low, rim) > limits.min_inside_share)


def insides(parts: Parts) -> Pairs:
    """Return the inside of a cup, with its outside: it is curved inwards, and its rim is as high."""
    bent = parts.bulge < -parts.settings.min_cavity_bend
    deep = parts.tops - parts.bottoms > parts.settings.min_cavity_depth
    hollow = (bent & deep)[:, None] & deep[None] & (parts.lengths > 0) & ~_differ(parts)
    return _pairs(hollow & _level(parts) & (parts.rise < 0.0))


def bridged(parts: Parts) -> Pairs:
    """Return two parts of one surface, parted by something narrow that lies on both."""
    under = _under(parts)
    pairs = _pairs(np.triu(_both(under) & _alike(parts) & (parts.gaps < parts.settings.max_hidden_gap)))
    return _chosen(pairs, lambda a, b: continues(parts, a, b, np.flatnonzero(under[a] & under[b])))


def round_rims(parts: Parts) -> Pairs:
    """Return two pieces of a rim that is round, parted by something that lies on both: a plate, and a napkin across
    it."""
    pairs = _pairs(np.triu(_both(_under(parts)) & _alike(parts) & _level(parts)))
    return _chosen(pairs, lambda a, b: parts.once(roundness, a, b) > parts.settings.min_rim_share)


def _level(parts: Parts) -> NDArray[np.bool_]:
    """Return which parts are equally high, (p, p)."""
    result: NDArray[np.bool_] = np.abs(parts.tops[:, None] - parts.tops[None]) < parts.settings.level_tolerance
    return result


def _under(parts: Parts) -> NDArray[np.bool_]:
    """Return which parts others lie on, (p, p)."""
    return (parts.rise < -parts.settings.covering_rise) & (parts.lengths > 0)


def _both(under: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return on which two parts (p, p) one and the same thing lies."""
    counted = under.astype(np.float64)
    both: NDArray[np.bool_] = counted @ counted.T > 0
    return both


def on_a_foot(parts: Parts) -> Pairs:
    """Return something high above a flat foot of its colour that is no wider: a glass, its stem hidden or not."""
    limits = parts.settings
    high = parts.middles > 2 * limits.foot_height
    foot = (parts.middles < limits.foot_height) & (parts.bottoms < limits.foot_height / 2)
    same = (parts.rise > limits.stem_rise) & ~_differ(parts)
    narrow = parts.widths[None] < limits.foot_width_ratio * parts.widths[:, None]
    pairs = _pairs(high[:, None] & foot[None] & same & narrow)
    return _chosen(pairs, lambda glass, foot: inside(parts, foot, glass) > limits.min_foot_inside_share)


def necks(parts: Parts) -> Pairs:
    """Return something narrow right on the middle of what is much higher than wide: the neck of a bottle, its cap."""
    limits = parts.settings
    narrow = parts.widths[:, None] < limits.attachment_ratio * parts.widths[None]
    upright = parts.tops - parts.bottoms > limits.bottle_slenderness * parts.widths
    above = parts.bottoms[:, None] > parts.tops[None] - limits.shoulder_depth
    off = np.linalg.norm(parts.centres[:, None] - parts.centres[None], axis=2)
    centred = off < limits.neck_offset_ratio * parts.widths[None]
    pairs = _pairs(narrow & upright[None] & above & centred & (parts.lengths > 0))
    return _chosen(pairs, lambda neck, bottle: inside(parts, neck, bottle) > limits.min_inside_share)


def handles(parts: Parts) -> Pairs:
    """Return something small that stands on nothing, and the larger thing of its colour and height beside which it
    is."""
    limits = parts.settings
    small = parts.widths[:, None] < limits.attachment_ratio * parts.widths[None]
    small &= parts.areas[:, None] < limits.attachment_ratio * parts.areas[None]
    clear = parts.bottoms[:, None] > parts.bottoms[None] + limits.handle_clearance
    as_high = parts.tops[:, None] < parts.tops[None] + limits.level_tolerance
    pairs = _pairs(small & clear & as_high & ~_differ(parts) & (parts.gaps < limits.attachment_gap))
    # Of a fragment all may be within the outline: the body may be seen around it.
    most = np.where(parts.areas < limits.fragment_area, 1.0, limits.max_handle_inside_share)

    def belong(handle: int, body: int) -> bool:
        near = apart(parts, handle, body) < limits.attachment_gap
        return bool(near and inside(parts, handle, body) <= most[handle])

    return _chosen(pairs, belong)


def end_to_end(parts: Parts) -> Pairs:
    """Return two low pieces of one colour in a line, together long and narrow: the head and the handle of a spoon."""
    limits = parts.settings
    low = parts.tops < limits.max_cutlery_height
    pairs = _pairs(np.triu(low[:, None] & low[None] & (parts.gaps < limits.max_cutlery_gap) & ~_differ(parts)))

    def belong(a: int, b: int) -> bool:
        return parts.once(slenderness, a, b) > limits.min_cutlery_slenderness and _lie_as_one(parts, a, b)

    return _chosen(pairs, belong)


def _lie_as_one(parts: Parts, a: int, b: int) -> bool:
    """Return whether two pieces in a line can be one rigid thing for how high they lie: both come down to what it
    lies on, or it leans and its slope goes on from the one to the other. Cutlery on a plate does neither to cutlery
    beside it."""
    down = abs(parts.bottoms[a] - parts.bottoms[b]) < parts.settings.resting_difference
    return bool(down or parts.once(offset, a, b) < parts.settings.resting_rise)


def sides(parts: Parts) -> Pairs:
    """Return a thin upright piece, and the thing of its colour whose side it is: seen so aslant that the edge is a
    jump."""
    limits = parts.settings
    low = parts.tops[:, None] < parts.tops[None] + limits.resting_rise
    beside = (parts.gaps < limits.attachment_gap) & low & ~_differ(parts)
    sheets = np.array([_is_sheet(parts, part) for part in range(len(parts))], dtype=np.bool_)
    pairs = _pairs(sheets[:, None] & beside & (parts.areas[:, None] < parts.areas[None]))
    return _chosen(pairs, lambda side, thing: apart(parts, side, thing) < limits.attachment_gap)


def _is_sheet(parts: Parts, part: int) -> bool:
    patches = parts.members(part)
    normal = parts.patches.normals[patches].mean(axis=0)
    upright = abs(normal[2]) < parts.settings.max_sheet_normal * np.linalg.norm(normal)
    return bool(upright and extents(parts.patches.middles[patches, :2])[1] < parts.settings.patch_width)


def _chosen(pairs: Pairs, belong: Callable[[int, int], bool]) -> Pairs:
    return pairs[np.array([belong(a, b) for a, b in pairs.tolist()], dtype=np.bool_)]


def _alike(parts: Parts) -> NDArray[np.bool_]:
    """Return which parts are of one plain colour, (p, p)."""
    plain = parts.motley < parts.settings.max_plain_variation
    return (parts.unlike() < parts.settings.max_same_colour) & plain[:, None] & plain[None]


def _differ(parts: Parts) -> NDArray[np.bool_]:
    """Return which parts are surely not of one colour, (p, p): they differ by more than both vary in themselves."""
    varied = np.minimum(parts.motley[:, None], parts.motley[None])
    result: NDArray[np.bool_] = parts.unlike() >= np.maximum(parts.settings.min_other_colour, varied)
    return result


def _pairs(which: NDArray[np.bool_]) -> Pairs:
    """Return the pairs of different parts that are marked in (p, p)."""
    return np.argwhere(which & ~np.eye(len(which), dtype=np.bool_))
