"""Join parts of one object whose surfaces do not meet convexly: hollow, draped and partly hidden objects.

A plate has a well, a cup has an inside, a napkin hangs over an edge, a knife hides the middle of the plate under it,
and the bowl of a glass hides its stem from above. Each case has a rule that returns pairs of parts of one object.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.segmentation.parts import (
    Pairs,
    Parts,
    apart,
    continues,
    inside,
    offset,
    roundness,
    slenderness,
    steepness,
)

Rule = Callable[[Parts, int | None], Pairs]
"""Function that returns the pairs of parts of one object, among all pairs or those with a given part.

The decision on a pair depends on its two parts only.
"""


def whole_things(parts: Parts) -> Parts:
    """Join parts into objects, rule by rule, and return them.

    Parameters
    ----------
    parts
        Regions of patches. It is changed in place.

    Returns
    -------
    Parts
        The given partition, with a part for each object.
    """
    while len(pairs := fragments(parts)):
        parts.join_all(pairs.first, pairs.second)
    parts.keep_largest(parts.settings.max_parts)
    _apply(of_one_colour, parts)
    _apply(enclosed, parts)
    for rule in (bridged, round_rims):
        while len(pairs := rule(parts)):
            longest = int(np.argmax(pairs.length))
            parts.join(int(pairs.first[longest]), int(pairs.second[longest]))
    for each in (enclosed, of_one_colour, insides, on_a_foot, necks, unsupported, lips, handles, insides):
        _apply(each, parts)
    for each in (half_hidden_handles, enclosed, end_to_end, sides):
        _apply(each, parts)
    _apply(above_a_foot, parts)  # last: in the image, a foot also meets the glass before it, in other ways than a bowl
    return parts


def _apply(rule: Rule, parts: Parts) -> None:
    """Join the pair with the longest boundary of those that a rule returns, until the rule returns none."""
    heap: list[tuple[float, int, int, int, int]] = []

    def push(pairs: Pairs) -> None:
        rows = zip(pairs.length.tolist(), pairs.first.tolist(), pairs.second.tolist(), strict=True)
        for length, a, b in rows:
            heapq.heappush(heap, (-length, a, b, parts.changes[a], parts.changes[b]))

    push(rule(parts, None))
    while heap:
        _, a, b, *changes = heapq.heappop(heap)
        if changes == [parts.changes[a], parts.changes[b]]:
            push(rule(parts, parts.join(a, b)))


def fragments(parts: Parts) -> Pairs:
    """Return the parts that are too small, each with the part of its longest and smoothest boundary.

    Parameters
    ----------
    parts
        Partition of the patches.

    Returns
    -------
    Pairs
        At most one pair for each small part, which comes first in it.
    """
    pairs = parts.meetings()
    pull = pairs.met[:, 1] * (2.0 - pairs.evidence)
    small = (parts.measures.areas[pairs.first] < parts.settings.fragment_area) & (pull > 0)
    pairs, pull = pairs.where(small), pull[small]
    order = np.lexsort((pairs.second, -pull, pairs.first))
    best = np.zeros(len(pairs), dtype=np.bool_)
    best[order[np.unique(pairs.first[order], return_index=True)[1]]] = True
    return pairs.where(best)


def of_one_colour(parts: Parts, part: int | None = None) -> Pairs:
    """Return pairs of one colour without a strong crease: the head and handle of a fork, a draped napkin.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs that meet, in both orders.
    """
    pairs = parts.meetings(part)
    smooth = pairs.evidence < parts.settings.same_colour_evidence
    return pairs.where(smooth & (np.abs(pairs.rise) < parts.settings.resting_rise) & _alike(parts, pairs))


def enclosed(parts: Parts, part: int | None = None) -> Pairs:
    """Return parts within the outline of a higher part of the same colour: the well of a plate in its rim.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the enclosed part and the part around it.
    """
    limits, seen, pairs = parts.settings, parts.measures, parts.meetings(part)
    low = (pairs.rise < limits.well_rise) & ~_differ(parts, pairs)
    low &= seen.tops[pairs.first] <= seen.tops[pairs.second] + limits.well_top_tolerance
    low &= seen.bulge[pairs.first] < limits.max_well_bulge
    return _chosen(pairs.where(low), lambda low, rim: inside(parts, low, rim) > limits.min_inside_share)


def insides(parts: Parts, part: int | None = None) -> Pairs:
    """Return the inside and outside of cups: the inside is concave, and both rims are equally high.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the inside and the outside.
    """
    pairs = _hollow(parts, part)
    return pairs.where(_level(parts, pairs) & (pairs.rise < 0.0))


def lips(parts: Parts, part: int | None = None) -> Pairs:
    """Return the inside and outside of jugs: from above, the lip hides the top of the outside below it.

    The outside stands on the table, below the inside and its lip.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the inside, which begins a little higher, and the outside.
    """
    limits, seen, pairs = parts.settings, parts.measures, _hollow(parts, part)
    higher = seen.tops[pairs.first] - seen.tops[pairs.second]
    stands = seen.bottoms[pairs.second] < limits.foot_height
    pairs = pairs.where((higher > 0.0) & (higher < limits.max_lip_height) & (pairs.rise > 0.0) & stands)
    return _chosen(pairs, lambda within, outside: inside(parts, outside, within) > limits.min_below_lip_share)


def _hollow(parts: Parts, part: int | None) -> Pairs:
    """Return pairs of a deep concave part and a deep part of no other colour, which may be its outside.

    The two are near each other in plan: in the image, the inside of a glass also meets another glass behind it.
    """
    limits, seen, pairs = parts.settings, parts.measures, parts.meetings(part)
    bent = seen.bulge < -limits.min_cavity_bend
    deep = seen.tops - seen.bottoms > limits.min_cavity_depth
    near = _gaps(parts, pairs) < limits.max_attachment_gap
    return pairs.where((bent & deep)[pairs.first] & deep[pairs.second] & near & ~_differ(parts, pairs))


def bridged(parts: Parts) -> Pairs:
    """Return pairs of parts of one surface that a narrow object on both divides.

    The foot of a glass is a part of that glass, and not of a surface that continues behind it.

    Parameters
    ----------
    parts
        Partition of the patches.

    Returns
    -------
    Pairs
        Pairs of parts of one colour that do not meet, with a part that lies on both.
    """
    pairs, over = _below_one(parts)
    feet = on_a_foot(parts).second
    surfaces = ~np.isin(pairs.first, feet) & ~np.isin(pairs.second, feet)
    near = _gaps(parts, pairs) < parts.settings.max_hidden_gap
    pairs = pairs.where(surfaces & near & _alike(parts, pairs))
    return _chosen(pairs, lambda a, b: continues(parts, a, b, over[a, b]))


def round_rims(parts: Parts) -> Pairs:
    """Return pairs of parts of one round rim that an object on both divides, such as a napkin across a plate.

    Parameters
    ----------
    parts
        Partition of the patches.

    Returns
    -------
    Pairs
        Pairs of parts of one colour and height that fit one circle.
    """
    pairs, _ = _below_one(parts)
    pairs = pairs.where(_alike(parts, pairs) & _level(parts, pairs))
    return _chosen(pairs, lambda a, b: parts.once(roundness, a, b) > parts.settings.min_rim_share)


def _below_one(parts: Parts) -> tuple[Pairs, dict[tuple[int, int], list[int]]]:
    """Return pairs of parts with a common part on top, the lower number first, and these parts for each pair."""
    met = parts.meetings()
    met = met.where(met.rise < -parts.settings.covering_rise)
    below: dict[int, list[int]] = {}
    for low, cover in zip(met.first.tolist(), met.second.tolist(), strict=True):
        below.setdefault(cover, []).append(low)
    over: dict[tuple[int, int], list[int]] = {}
    for cover in sorted(below):
        for k, a in enumerate(below[cover]):
            for b in below[cover][k + 1 :]:
                over.setdefault((a, b), []).append(cover)
    return parts.pairs(np.array(sorted(over), np.intp).reshape(-1, 2)), over


def on_a_foot(parts: Parts, part: int | None = None) -> Pairs:
    """Return high parts above a flat foot of the same colour that is not wider: glasses, with a visible stem or not.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the high part and its foot.
    """
    limits, seen, pairs = parts.settings, parts.measures, parts.meetings(part)
    high = seen.middles > 2 * limits.foot_height
    foot = (seen.middles < limits.foot_height) & (seen.bottoms < limits.foot_height / 2)
    same = (pairs.rise > limits.stem_rise) & ~_differ(parts, pairs)
    narrow = seen.widths[pairs.second] < limits.foot_width_ratio * seen.widths[pairs.first]
    pairs = pairs.where(high[pairs.first] & foot[pairs.second] & same & narrow)
    return _chosen(pairs, lambda glass, foot: inside(parts, foot, glass) > limits.min_foot_inside_share)


def above_a_foot(parts: Parts, part: int | None = None) -> Pairs:
    """Return high parts that nothing seems to hold, above a foot of the same colour: the stem is too thin to be seen.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the high part and its foot, which do not meet.
    """
    limits, seen, pairs = parts.settings, parts.measures, parts.near(parts.settings.patch_width, part)
    glass, foot, middles = pairs.first, pairs.second, seen.middles
    floats = seen.bottoms[glass] > np.maximum(2 * limits.foot_height, seen.tops[foot])
    flat = (middles[foot] < limits.foot_height) & (seen.bottoms[foot] < limits.foot_height / 2)
    narrow = seen.widths[foot] < limits.foot_width_ratio * seen.widths[glass]
    pairs = pairs.where((pairs.length == 0) & floats & flat & narrow & ~_differ(parts, pairs))
    return _chosen(pairs, lambda glass, foot: inside(parts, foot, glass) > limits.min_below_bowl_share)


def necks(parts: Parts, part: int | None = None) -> Pairs:
    """Return narrow parts on the middle of tall, slender ones: the neck or the cap of a bottle.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the narrow part and the body of the bottle.
    """
    limits, seen, pairs = parts.settings, parts.measures, parts.meetings(part)
    neck, bottle, widths = pairs.first, pairs.second, seen.widths
    narrow = widths[neck] < limits.attachment_ratio * widths[bottle]
    upright = seen.tops - seen.bottoms > limits.bottle_slenderness * widths
    above = seen.bottoms[neck] > seen.tops[bottle] - limits.shoulder_depth
    pairs = pairs.where(narrow & upright[bottle] & above & _in_the_middle(parts, pairs))
    return _chosen(pairs, lambda neck, bottle: inside(parts, neck, bottle) > limits.min_inside_share)


def unsupported(parts: Parts, part: int | None = None) -> Pairs:
    """Return parts on the middle of others that are too steep to carry anything, one of them round: a lid on a pot.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the upper and the lower part.
    """
    limits, seen, pairs = parts.settings, parts.measures, parts.meetings(part)
    upper, lower = pairs.first, pairs.second
    above = (pairs.rise > 0.0) & (seen.tops[upper] > seen.tops[lower])
    above &= seen.bottoms[upper] > seen.bottoms[lower] + limits.handle_clearance
    touches = pairs.met[:, 1] > limits.min_touching_share * pairs.length
    pairs = pairs.where(above & touches & _in_the_middle(parts, pairs) & ~_differ(parts, pairs))

    def belong(upper: int, lower: int) -> bool:
        within = inside(parts, upper, lower) > limits.min_inside_share
        # A spout may be a part of the body, and a knob one of the lid.
        one_round = any(parts.once(roundness, part, part) > limits.min_rim_share for part in (upper, lower))
        return within and one_round and parts.once(steepness, upper, lower) > limits.min_steep_share

    return _chosen(pairs, belong)


def handles(parts: Parts, part: int | None = None) -> Pairs:
    """Return small parts that do not stand on anything, with the larger part of their colour and height beside them.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the handle and the body.
    """
    return _attached(parts, parts.near(parts.settings.attachment_gap, part), parts.settings.attachment_gap)


def half_hidden_handles(parts: Parts, part: int | None = None) -> Pairs:
    """Return handles and spouts that meet their body in the image, which hides how they are attached.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the handle or the spout, and the body.
    """
    gap = parts.settings.max_attachment_gap
    pairs = parts.near(gap, part)
    return _attached(parts, pairs.where(pairs.length > 0), gap)


def _attached(parts: Parts, pairs: Pairs, gap: float) -> Pairs:
    """Return the pairs of a handle and its body that are less than ``gap`` metres apart."""
    limits, seen = parts.settings, parts.measures
    handle, body, widths = pairs.first, pairs.second, seen.widths
    small = widths[handle] < limits.attachment_ratio * widths[body]
    small &= seen.areas[handle] < limits.attachment_ratio * seen.areas[body]
    # Of a round body, what is visible may begin higher than where it stands.
    clear = seen.bottoms[handle] > np.minimum(seen.bottoms[body] + limits.handle_clearance, limits.foot_height)
    as_high = seen.tops[handle] < seen.tops[body] + limits.level_tolerance
    # A fragment may be entirely within the outline, because the body may be visible around it.
    most = np.where(seen.areas < limits.fragment_area, 1.0, limits.max_handle_inside_share)

    pairs = pairs.where(small & clear & as_high & ~_differ(parts, pairs))

    def belong(handle: int, body: int) -> bool:
        near = apart(parts, handle, body) < gap
        return bool(near and inside(parts, handle, body) <= most[handle])

    return _chosen(pairs, belong)


def end_to_end(parts: Parts, part: int | None = None) -> Pairs:
    """Return two low parts of one colour in a line that are long and narrow together: head and handle of a spoon.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs in the order of their numbers.
    """
    limits, pairs = parts.settings, parts.near(parts.settings.max_cutlery_gap, part)
    low = parts.measures.tops < limits.max_cutlery_height
    ordered = pairs.first < pairs.second
    pairs = pairs.where(ordered & low[pairs.first] & low[pairs.second] & ~_differ(parts, pairs))

    def belong(a: int, b: int) -> bool:
        return parts.once(slenderness, a, b) > limits.min_cutlery_slenderness and _lie_as_one(parts, a, b)

    return _chosen(pairs, belong)


def _lie_as_one(parts: Parts, a: int, b: int) -> bool:
    """Return True if the heights of two parts in a line allow one rigid object.

    Either both come down to the same support, or the object leans and its slope continues from one part to the other.
    Neither holds for cutlery on a plate and cutlery beside it.
    """
    bottoms = parts.measures.bottoms
    down = abs(bottoms[a] - bottoms[b]) < parts.settings.resting_difference
    return bool(down or parts.once(offset, a, b) < parts.settings.resting_rise)


def sides(parts: Parts, part: int | None = None) -> Pairs:
    """Return thin upright parts with the part of their colour whose side they are.

    A side is seen at such a flat angle that the depth jumps at its edge.

    Parameters
    ----------
    parts
        Partition of the patches.
    part
        If given, return only the pairs with this part.

    Returns
    -------
    Pairs
        Pairs of the side and the object that it belongs to, which has the larger area.
    """
    limits, seen, pairs = parts.settings, parts.measures, parts.near(parts.settings.attachment_gap, part)
    low = seen.tops[pairs.first] < seen.tops[pairs.second] + limits.resting_rise
    less = seen.areas[pairs.first] < seen.areas[pairs.second]
    pairs = pairs.where(low & less & ~_differ(parts, pairs))
    sheet = {part: _is_sheet(parts, part) for part in set(pairs.first.tolist())}
    near = limits.attachment_gap
    return _chosen(pairs, lambda side, thing: sheet[side] and apart(parts, side, thing) < near)


def _is_sheet(parts: Parts, part: int) -> bool:
    normal = parts.patches.normals[parts.members[part]].mean(axis=0)
    upright = abs(normal[2]) < parts.settings.max_sheet_normal * np.linalg.norm(normal)
    return bool(upright and parts.extents(part)[1] < parts.settings.patch_width)


def _chosen(pairs: Pairs, belong: Callable[[int, int], bool]) -> Pairs:
    rows = zip(pairs.first.tolist(), pairs.second.tolist(), strict=True)
    return pairs.where(np.array([belong(a, b) for a, b in rows], dtype=np.bool_))


def _level(parts: Parts, pairs: Pairs) -> NDArray[np.bool_]:
    """Return a mask of the pairs with equal heights, shape (k,)."""
    tops = parts.measures.tops
    result: NDArray[np.bool_] = np.abs(tops[pairs.first] - tops[pairs.second]) < parts.settings.level_tolerance
    return result


def _gaps(parts: Parts, pairs: Pairs) -> NDArray[np.float64]:
    """Return the distances of the boxes of each pair as seen from above, in metres, shape (k,)."""
    low, high = parts.measures.low, parts.measures.high
    gaps = np.maximum(low[pairs.first] - high[pairs.second], low[pairs.second] - high[pairs.first]).clip(0.0)
    result: NDArray[np.float64] = np.linalg.norm(gaps, axis=1)
    return result


def _in_the_middle(parts: Parts, pairs: Pairs) -> NDArray[np.bool_]:
    """Return a mask of the pairs in which the first part is on the middle of the second, shape (k,)."""
    centres, widths = parts.measures.centres, parts.measures.widths
    off = np.linalg.norm(centres[pairs.first] - centres[pairs.second], axis=1)
    result: NDArray[np.bool_] = off < parts.settings.neck_offset_ratio * widths[pairs.second]
    return result


def _alike(parts: Parts, pairs: Pairs) -> NDArray[np.bool_]:
    """Return a mask of the pairs in which both parts have the same plain colour, shape (k,)."""
    plain = parts.measures.motley < parts.settings.max_plain_variation
    return (parts.unlike(pairs) < parts.settings.max_same_colour) & plain[pairs.first] & plain[pairs.second]


def _differ(parts: Parts, pairs: Pairs) -> NDArray[np.bool_]:
    """Return a mask of the pairs whose colours differ by more than they vary within both parts, shape (k,)."""
    motley = parts.measures.motley
    varied = np.minimum(motley[pairs.first], motley[pairs.second])
    result: NDArray[np.bool_] = parts.unlike(pairs) >= np.maximum(parts.settings.min_other_colour, varied)
    return result
