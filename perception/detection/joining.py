"""What belongs together although its surfaces do not meet convexly: hollow, draped and partly hidden things.

A plate has a well, a cup an inside, a napkin hangs over an edge, a knife hides the middle of the plate that it lies on,
and from above the bowl of a glass hides its stem. Each of these has a rule; a rule gives pairs of parts that are one.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

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

GAP, ALONG = 0.11, 0.015
"""Metres of a surface of one colour that something on it hides: a napkin on a plate. It goes on where it is nearest, or
so much farther away."""

FOOT, STEM = 0.022, 0.006
"""Most of the foot of a glass is lower than the first, and what meets or hides it higher above it than the second."""

CLEAR, BESIDE = 0.012, 0.5
"""A handle begins so much higher (metres) than what it is on, and no more of it is within the outline of that."""

REACH = 0.02
"""Metres from a handle to what it is on, as seen from above; its ends may be too thin to be seen."""

SMALLER = 0.6
"""A handle is so much narrower than what it is on, at the most, and of so much less surface."""

LOW, NARROW, LONG = 0.03, 0.045, 3.0
"""Cutlery is no higher and no wider (metres, between the middles of patches), and so many times as long as wide."""

THIN = 0.01
"""Metres: what is narrower than a patch is taken to be as wide."""

NECK, OVERLAP = 0.03, 0.3
"""Metres of its neck that may not be seen, and the share of the shorter piece by which two pieces overlap at most."""

Pairs = NDArray[np.intp]


def whole_things(parts: Parts) -> Parts:
    """Parts joined until they are things, rule by rule."""
    parts = _without_fragments(parts)
    for rule in (
        of_one_colour,
        enclosed,
        bridged,
        enclosed,
        of_one_colour,
        insides,
        on_a_foot,
        handles,
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
    return _chosen(_pairs(low), lambda low, rim: _inside(parts, low, rim) > 0.8)


def insides(parts: Parts) -> Pairs:
    """The inside of a cup, with its outside: it is curved inwards, and its rim is as high."""
    deep = parts.tops - parts.bottoms > DEEP
    hollow = ((parts.bulge < HOLLOW) & deep)[:, None] & deep[None] & (parts.lengths > 0) & ~_differ(parts)
    return _pairs(hollow & (np.abs(parts.tops[:, None] - parts.tops[None]) < LEVEL) & (parts.rise < 0.0))


def bridged(parts: Parts) -> Pairs:
    """Two parts of one surface, parted by something narrow that lies on both."""
    under = (parts.rise < -0.0005) & (parts.lengths > 0)
    both = under.astype(np.float64) @ under.T.astype(np.float64) > 0
    pairs = _pairs(np.triu(both & _alike(parts) & (parts.gaps < GAP)))
    return _chosen(pairs, lambda a, b: _continues(parts, a, b, np.flatnonzero(under[a] & under[b])))


def on_a_foot(parts: Parts) -> Pairs:
    """Something high above a flat foot of its colour that is no wider: a glass, its stem hidden or not."""
    high = parts.middles > 2 * FOOT
    foot = (parts.middles < FOOT) & (parts.bottoms < FOOT / 2)
    same = (parts.rise > STEM) & ~_differ(parts)
    narrow = parts.widths[None] < 1.2 * parts.widths[:, None]
    pairs = _pairs(high[:, None] & foot[None] & same & narrow)
    return _chosen(pairs, lambda glass, foot: _inside(parts, foot, glass) > 0.1)


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
        pairs, lambda handle, body: _apart(parts, handle, body) < REACH and _inside(parts, handle, body) <= most[handle]
    )


def end_to_end(parts: Parts) -> Pairs:
    """Two low pieces of one colour in a line, together long and narrow: the head and the handle of a spoon."""
    low = parts.tops < LOW
    pairs = _pairs(np.triu(low[:, None] & low[None] & (parts.gaps < NECK) & ~_differ(parts)))
    return _chosen(pairs, lambda a, b: parts.once(_line, a, b) > LONG)


def sides(parts: Parts) -> Pairs:
    """A thin upright piece, and the thing of its colour whose side it is: seen so aslant that the edge is a jump."""
    beside = (parts.gaps < REACH) & (parts.tops[:, None] < parts.tops[None] + LIES_ON) & ~_differ(parts)
    sheets = np.array([_is_sheet(parts, part) for part in range(len(parts))], dtype=np.bool_)
    pairs = _pairs(sheets[:, None] & beside & (parts.areas[:, None] < parts.areas[None]))
    return _chosen(pairs, lambda side, thing: _apart(parts, side, thing) < REACH)


def _is_sheet(parts: Parts, part: int) -> bool:
    patches = parts.members(part)
    normal = parts.patches.normals[patches].mean(axis=0)
    upright = abs(normal[2]) < 0.5 * np.linalg.norm(normal)
    return bool(upright and _extents(parts.patches.middles[patches, :2])[1] < THIN)


def _line(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    """How often as long as wide two parts are together, if the one begins where the other, longer one ends; else 0."""
    plans = [parts.patches.middles[part, :2] for part in (one, two)]
    longer = max(plans, key=lambda plan: _extents(plan)[0])
    turned = [plan @ _axes(longer) for plan in plans]
    low, high = (np.array([end(plan, axis=0) for plan in turned]) for end in (np.min, np.max))
    (length, width), (along, across) = high.max(axis=0) - low.min(axis=0), high.min(axis=0) - low.max(axis=0)
    if width > NARROW or across < 0 or not -NECK < along < OVERLAP * (high - low)[:, 0].min():
        return 0.0
    return float(length / max(width, THIN))


def _axes(plan: NDArray[np.float64]) -> NDArray[np.float64]:
    """The principal axes of places (n, 2), the longer first, as columns (2, 2)."""
    apart = plan - plan.mean(axis=0)
    axes: NDArray[np.float64] = np.linalg.eigh(apart.T @ apart)[1][:, ::-1]
    return axes


def _extents(plan: NDArray[np.float64]) -> NDArray[np.float64]:
    """Length and width (2,) of places (n, 2) along their principal axes."""
    extents: NDArray[np.float64] = np.ptp(plan @ _axes(plan), axis=0)
    return extents


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


def _inside(parts: Parts, inner: int, outer: int) -> float:
    """The share of a part's patches that lie within the convex outline of another, as seen from above."""
    return parts.once(_share_inside, inner, outer)


def _share_inside(parts: Parts, inner: NDArray[np.intp], outer: NDArray[np.intp]) -> float:
    plan = parts.patches.middles[:, :2]
    hull = _hull(plan[outer])
    if hull is None:
        return 0.0
    return float((plan[inner] @ hull[:, :2].T + hull[:, 2] <= 0.004).all(axis=1).mean())


def _covered(parts: Parts, cover: int, places: NDArray[np.float64]) -> bool:
    """Whether most places (k, 3) are within a part's outline, or no farther from it than it is higher: hidden by it."""
    hull = _hull(parts.patches.middles[parts.members(cover), :2])
    if hull is None:
        return True
    outside = (places[:, :2] @ hull[:, :2].T + hull[:, 2]).max(axis=1)
    return bool((outside < parts.tops[cover] - places[:, 2]).mean() > 0.5)


def _apart(parts: Parts, a: int, b: int) -> float:
    """The least distance between patches of two parts, as seen from above."""
    return parts.once(_least_distance, a, b)


def _least_distance(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    from scipy.spatial import cKDTree

    plan = parts.patches.middles[:, :2]
    return float(cKDTree(plan[two]).query(plan[one])[0].min())


def _hull(plan: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """The half planes (k, 3) of a convex hull; None for points in a line."""
    from scipy.spatial import ConvexHull, QhullError

    if len(plan) < 3:
        return None
    try:
        result: NDArray[np.float64] = ConvexHull(plan).equations
    except QhullError:
        return None
    return result


def _continues(parts: Parts, a: int, b: int, over: NDArray[np.intp]) -> bool:
    """Whether one surface goes on in the other, under a part that is over both: where they are nearest, that part is
    between them, and their planes are the same."""
    if parts.once(_share_of_one_plane, a, b) <= 0.5:
        return False
    p, q = _nearest(parts, parts.members(a), parts.members(b))
    between = (parts.patches.middles[p] + parts.patches.middles[q]) / 2
    return any(_covered(parts, int(part), between) for part in over)  # else a fork and a knife beside a plate


def _share_of_one_plane(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    """Of the nearest patches of two parts, the share that lie in one plane."""
    p, q = _nearest(parts, one, two)
    if not len(p):
        return 0.0
    middles, normals = parts.patches.middles, parts.patches.normals
    normal = normals[p] + normals[q]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    step = np.abs((normal * (middles[p] - middles[q])).sum(axis=1))
    same = (step < 0.004) & ((normals[p] * normals[q]).sum(axis=1) > np.cos(np.deg2rad(25.0)))
    return float(same.mean())


def _nearest(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Patches of two parts where these are nearest, and not too far apart: of the first, and of the second."""
    from scipy.spatial import cKDTree

    middles = parts.patches.middles
    distance, nearest = cKDTree(middles[two]).query(middles[one])
    close = (distance < GAP) & (distance < distance.min() + ALONG)
    return one[close], two[nearest[close]]
