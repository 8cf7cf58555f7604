"""How two parts lie to each other: one within the other as seen from above, apart, in one line, in one plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.circles import SECTORS, circle_around
from deixis.perception.detection.parts import Parts

GAP, ALONG = 0.11, 0.015
"""Metres of a surface of one colour that something on it hides: a napkin on a plate. It goes on where it is nearest, or
so much farther away."""

NARROW = 0.045
"""Metres: what lies in one line is no wider, between the middles of patches."""

THIN = 0.01
"""Metres: what is narrower than a patch is taken to be as wide."""

NECK, OVERLAP = 0.03, 0.3
"""Metres of its neck that may not be seen, and the share of the shorter piece by which two pieces overlap at most."""


RIM = 0.1
"""How far an edge may be off a circle, in its radius."""


def inside(parts: Parts, inner: int, outer: int) -> float:
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


def apart(parts: Parts, a: int, b: int) -> float:
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


def continues(parts: Parts, a: int, b: int, over: NDArray[np.intp]) -> bool:
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


def roundness(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    """The share of a circle around two parts, as seen from above, that their edges follow; 0 where they leave it."""
    plan = parts.patches.middles[np.concatenate([one, two]), :2]
    circle = circle_around(plan, RIM)
    return 0.0 if circle is None else len(circle.sectors(plan, RIM)) / SECTORS


def slenderness(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    """How often as long as wide two parts are together, if the one begins where the other, longer one ends; else 0."""
    plans = [parts.patches.middles[part, :2] for part in (one, two)]
    longer = max(plans, key=lambda plan: extents(plan)[0])
    turned = [plan @ _axes(longer) for plan in plans]
    low, high = (np.array([end(plan, axis=0) for plan in turned]) for end in (np.min, np.max))
    (length, width), (along, across) = high.max(axis=0) - low.min(axis=0), high.min(axis=0) - low.max(axis=0)
    if width > NARROW or across < 0 or not -NECK < along < OVERLAP * (high - low)[:, 0].min():
        return 0.0
    return float(length / max(width, THIN))


def offset(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    """Metres by which two pieces of one line miss each other in height, in the middle between them, if each goes on as
    it slopes: little where both are pieces of something straight, level or leaning."""
    places = [parts.patches.middles[part] for part in (one, two)]
    longer = max(places, key=lambda place: extents(place[:, :2])[0])
    along = _axes(longer[:, :2])[:, 0]
    near, far = sorted((place[:, :2] @ along for place in places), key=np.mean)
    between = (near.max() + far.min()) / 2
    heights = [_height_at(place[:, :2] @ along - between, place[:, 2]) for place in places]
    return abs(heights[0] - heights[1])


def _height_at(along: NDArray[np.float64], heights: NDArray[np.float64]) -> float:
    """Where a line through heights (n,) at places (n,) along it passes 0; of what is too short to slope, the mean."""
    off = along - along.mean()
    slope = float(off @ heights) / max(float(off @ off), THIN**2)
    return float(heights.mean() - slope * along.mean())


def _axes(plan: NDArray[np.float64]) -> NDArray[np.float64]:
    """The principal axes of places (n, 2), the longer first, as columns (2, 2)."""
    apart = plan - plan.mean(axis=0)
    axes: NDArray[np.float64] = np.linalg.eigh(apart.T @ apart)[1][:, ::-1]
    return axes


def extents(plan: NDArray[np.float64]) -> NDArray[np.float64]:
    """Length and width (2,) of places (n, 2) along their principal axes."""
    extents: NDArray[np.float64] = np.ptp(plan @ _axes(plan), axis=0)
    return extents
