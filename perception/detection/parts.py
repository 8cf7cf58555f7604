"""Parts: pieces of surface of which things consist, and how they meet.

What speaks for or against one thing is read off the patches: how long two parts meet, which of them is above the other
there, whether their colours are alike; and how two parts lie to each other: one within the other as seen from above,
apart, in one line, in one plane.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.boundaries import Boundaries
from deixis.perception.detection.outline import SECTORS, circle_around
from deixis.perception.detection.settings import JoiningSettings
from deixis.perception.detection.supervoxels import Supervoxels, means, sums

Measure = Callable[["Parts", NDArray[np.intp], NDArray[np.intp]], float]


@dataclass(frozen=True, eq=False)
class Parts:
    """``of`` (s,) is the part, 0 to p - 1, that each patch belongs to. Heights are those above the table."""

    of: NDArray[np.int32]
    patches: Supervoxels
    meeting: Boundaries
    settings: JoiningSettings
    known: dict[tuple[object, ...], float] = field(default_factory=dict, repr=False)

    def __len__(self) -> int:
        return int(self.of.max()) + 1 if len(self.of) else 0

    def members(self, part: int) -> NDArray[np.intp]:
        """Return its patches."""
        return np.flatnonzero(self.of == part)

    def once(self, measure: Measure, a: int, b: int) -> float:
        """Return what a function of the patches of two parts gives, worked out once: joining others does not change
        it."""
        key = (measure, *self._marks[a], *self._marks[b])
        if key not in self.known:
            self.known[key] = measure(self, self.members(a), self.members(b))
        return self.known[key]

    @cached_property
    def _marks(self) -> list[tuple[int, int]]:
        """The first patch of each part and how many it has: parts only grow, so that these tell one from all others."""
        _, first, count = np.unique(self.of, return_index=True, return_counts=True)
        return list(zip(first.tolist(), count.tolist(), strict=True))

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Square metres of surface that are seen, (p,)."""
        return sums(self.of, self.patches.areas)

    @cached_property
    def tops(self) -> NDArray[np.float64]:
        """The height of the highest patch, (p,)."""
        result = np.full(len(self), -np.inf)
        np.maximum.at(result, self.of, self.patches.middles[:, 2])
        return result

    @cached_property
    def bottoms(self) -> NDArray[np.float64]:
        """The height of the lowest patch, (p,)."""
        result = np.full(len(self), np.inf)
        np.minimum.at(result, self.of, self.patches.middles[:, 2])
        return result

    @cached_property
    def middles(self) -> NDArray[np.float64]:
        """The mean height, (p,)."""
        return means(self.of, self.patches.middles, self.patches.sizes)[:, 2]

    @cached_property
    def plans(self) -> NDArray[np.float64]:
        """The least and the greatest corner of the box around a part as seen from above, (2, p, 2)."""
        low, high = np.full((len(self), 2), np.inf), np.full((len(self), 2), -np.inf)
        np.minimum.at(low, self.of, self.patches.middles[:, :2])
        np.maximum.at(high, self.of, self.patches.middles[:, :2])
        return np.stack([low, high])

    @cached_property
    def centres(self) -> NDArray[np.float64]:
        """The middle of that box, (p, 2)."""
        result: NDArray[np.float64] = self.plans.mean(axis=0)
        return result

    @cached_property
    def widths(self) -> NDArray[np.float64]:
        """The longer side of that box, (p,)."""
        result: NDArray[np.float64] = (self.plans[1] - self.plans[0]).max(axis=1)
        return result

    @cached_property
    def gaps(self) -> NDArray[np.float64]:
        """How far those boxes are apart, (p, p): no patches of two parts are nearer, as seen from above."""
        low, high = self.plans
        apart = np.maximum(low[:, None] - high[None], low[None] - high[:, None]).clip(0.0)
        result: NDArray[np.float64] = np.linalg.norm(apart, axis=2)
        return result

    @cached_property
    def colours(self) -> NDArray[np.float64]:
        """The mean colour, lightness scaled down, (p, 3)."""
        return means(self.of, self.patches.tints, self.patches.weights)

    @cached_property
    def motley(self) -> NDArray[np.float64]:
        """How much the colours of its patches vary, a standard deviation, (p,)."""
        off, weights = ((self.patches.tints - self.colours[self.of]) ** 2).sum(axis=1), self.patches.weights
        return np.sqrt(sums(self.of, off * weights) / sums(self.of, weights))

    @cached_property
    def bulge(self) -> NDArray[np.float64]:
        """How convex a part is, (p,): 1 a sphere from outside, 0 a plane, -1 a sphere from inside."""
        out = self.patches.middles - means(self.of, self.patches.middles, self.patches.sizes)[self.of]
        along = sums(self.of, (out * self.patches.normals).sum(axis=1) * self.patches.sizes)
        return along / np.maximum(sums(self.of, np.linalg.norm(out, axis=1) * self.patches.sizes), 1e-9)

    @cached_property
    def lengths(self) -> NDArray[np.float64]:
        """How long two parts meet, in pairs of neighbours, (p, p)."""
        return self._between(np.ones(len(self.meeting.pairs)))

    @cached_property
    def smooth(self) -> NDArray[np.float64]:
        """How long they meet without a jump of depth, (p, p)."""
        return self._between(1 - self.meeting.jumped)

    @cached_property
    def evidence(self) -> NDArray[np.float64]:
        """What speaks for two things, a mean over where they meet, (p, p); infinite where they do not."""
        total = self._between(self.meeting.evidence)
        return np.divide(total, self.lengths, out=np.full_like(total, np.inf), where=self.lengths > 0)

    @cached_property
    def rise(self) -> NDArray[np.float64]:
        """How far the first part is above the second where they meet, a mean, (p, p); 0 where they do not."""
        i, j = self.meeting.pairs.T
        height = self.patches.middles[:, 2]
        total = self._between(height[i] - height[j], sign=-1.0)
        return np.divide(total, self.lengths, out=np.zeros_like(total), where=self.lengths > 0)

    def unlike(self) -> NDArray[np.float64]:
        """Return the difference between the colours of parts, (p, p)."""
        result: NDArray[np.float64] = np.linalg.norm(self.colours[:, None] - self.colours[None], axis=2)
        return result

    def joined(self, pairs: NDArray[np.intp]) -> Parts:
        """Return the same with the parts of each pair (k, 2) made one."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        count = len(self)
        links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
        of = connected_components(links, directed=False)[1][self.of].astype(np.int32)
        return replace(self, of=of)

    def _between(self, values: NDArray[np.float64], sign: float = 1.0) -> NDArray[np.float64]:
        """Return sums over where parts meet, weighted by length; the other way round with another ``sign``."""
        a, b = self.of[self.meeting.pairs].T.astype(np.int64)
        apart = a != b
        count, weighted = len(self), values * self.meeting.lengths
        total = sums(a[apart] * count + b[apart], weighted[apart], count * count).reshape(count, count)
        result: NDArray[np.float64] = total + sign * total.T
        return result


def inside(parts: Parts, inner: int, outer: int) -> float:
    """Return the share of a part's patches that lie within the convex outline of another, as seen from above."""
    return parts.once(_share_inside, inner, outer)


def _share_inside(parts: Parts, inner: NDArray[np.intp], outer: NDArray[np.intp]) -> float:
    plan = parts.patches.middles[:, :2]
    hull = _hull(plan[outer])
    if hull is None:
        return 0.0
    return float((plan[inner] @ hull[:, :2].T + hull[:, 2] <= parts.settings.inside_tolerance).all(axis=1).mean())


def _covered(parts: Parts, cover: int, places: NDArray[np.float64]) -> bool:
    """Return whether most places (k, 3) are within a part's outline, or no farther from it than it is higher: hidden
    by it."""
    hull = _hull(parts.patches.middles[parts.members(cover), :2])
    if hull is None:
        return True
    outside = (places[:, :2] @ hull[:, :2].T + hull[:, 2]).max(axis=1)
    return bool((outside < parts.tops[cover] - places[:, 2]).mean() > parts.settings.min_covered_share)


def apart(parts: Parts, a: int, b: int) -> float:
    """Return the least distance between patches of two parts, as seen from above."""
    return parts.once(_least_distance, a, b)


def _least_distance(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    from scipy.spatial import cKDTree

    plan = parts.patches.middles[:, :2]
    return float(cKDTree(plan[two]).query(plan[one])[0].min())


def _hull(plan: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Return the half planes (k, 3) of a convex hull; None for points in a line."""
    from scipy.spatial import ConvexHull, QhullError

    if len(plan) < 3:
        return None
    try:
        result: NDArray[np.float64] = ConvexHull(plan).equations
    except QhullError:
        return None
    return result


def continues(parts: Parts, a: int, b: int, over: NDArray[np.intp]) -> bool:
    """Return whether one surface goes on in the other, under a part that is over both: where they are nearest, that
    part is between them, and their planes are the same."""
    if parts.once(_share_of_one_plane, a, b) <= parts.settings.min_coplanar_share:
        return False
    p, q = _nearest(parts, parts.members(a), parts.members(b))
    between = (parts.patches.middles[p] + parts.patches.middles[q]) / 2
    return any(_covered(parts, int(part), between) for part in over)  # else a fork and a knife beside a plate


def _share_of_one_plane(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    """Return the share of the nearest patches of two parts that lie in one plane."""
    p, q = _nearest(parts, one, two)
    if not len(p):
        return 0.0
    middles, normals = parts.patches.middles, parts.patches.normals
    normal = normals[p] + normals[q]
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
    step = np.abs((normal * (middles[p] - middles[q])).sum(axis=1))
    level = (normals[p] * normals[q]).sum(axis=1) > np.cos(parts.settings.coplanar_angle)
    same = (step < parts.settings.coplanar_step) & level
    return float(same.mean())


def _nearest(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return patches of two parts where these are nearest, and not too far apart: of the first, and of the second."""
    from scipy.spatial import cKDTree

    middles = parts.patches.middles
    distance, nearest = cKDTree(middles[two]).query(middles[one])
    settings = parts.settings
    close = (distance < settings.max_hidden_gap) & (distance < distance.min() + settings.hidden_gap_spread)
    return one[close], two[nearest[close]]


def roundness(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    """Return the share of a circle around two parts, as seen from above, that their edges follow; 0 where they leave
    it."""
    plan = parts.patches.middles[np.concatenate([one, two]), :2]
    tolerance = parts.settings.rim_tolerance
    circle = circle_around(plan, tolerance)
    return 0.0 if circle is None else len(circle.sectors(plan, tolerance)) / SECTORS


def slenderness(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    """Return how often as long as wide two parts are together, if the one begins where the other, longer one ends;
    else 0."""
    plans = [parts.patches.middles[part, :2] for part in (one, two)]
    longer = max(plans, key=lambda plan: extents(plan)[0])
    turned = [plan @ _axes(longer) for plan in plans]
    low, high = (np.array([end(plan, axis=0) for plan in turned]) for end in (np.min, np.max))
    (length, width), (along, across) = high.max(axis=0) - low.min(axis=0), high.min(axis=0) - low.max(axis=0)
    settings = parts.settings
    overlap = settings.end_overlap_share * (high - low)[:, 0].min()
    if width > settings.max_cutlery_width or across < 0 or not -settings.max_cutlery_gap < along < overlap:
        return 0.0
    return float(length / max(width, settings.patch_width))


def offset(parts: Parts, one: NDArray[np.intp], two: NDArray[np.intp]) -> float:
    """Return metres by which two pieces of one line miss each other in height, in the middle between them, if each
    goes on as it slopes: little where both are pieces of something straight, level or leaning."""
    places = [parts.patches.middles[part] for part in (one, two)]
    longer = max(places, key=lambda place: extents(place[:, :2])[0])
    along = _axes(longer[:, :2])[:, 0]
    near, far = sorted((place[:, :2] @ along for place in places), key=np.mean)
    between = (near.max() + far.min()) / 2
    heights = [_height_at(place[:, :2] @ along - between, place[:, 2], parts.settings.patch_width) for place in places]
    return abs(heights[0] - heights[1])


def _height_at(along: NDArray[np.float64], heights: NDArray[np.float64], width: float) -> float:
    """Return where a line through heights (n,) at places (n,) along it passes 0; of what is too short to slope, the
    mean."""
    off = along - along.mean()
    slope = float(off @ heights) / max(float(off @ off), width**2)
    return float(heights.mean() - slope * along.mean())


def _axes(plan: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the principal axes of places (n, 2), the longer first, as columns (2, 2)."""
    apart = plan - plan.mean(axis=0)
    axes: NDArray[np.float64] = np.linalg.eigh(apart.T @ apart)[1][:, ::-1]
    return axes


def extents(plan: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return length and width (2,) of places (n, 2) along their principal axes."""
    extents: NDArray[np.float64] = np.ptp(plan @ _axes(plan), axis=0)
    return extents
