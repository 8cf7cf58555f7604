"""Parts of objects: pieces of surface, their boundaries, and their joining.

The evidence for one object comes from the patches of two parts: the length of their boundary, the height of one above
the other there, and their colours; and their arrangement: one inside the other as seen from above, apart, in one line,
or in one plane. Only pairs that meet or are near each other are examined, so the time grows with their number.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import SECTORS, circle_around, corners_of
from deixis.perception.detection.segmentation.boundaries import Boundaries
from deixis.perception.detection.segmentation.supervoxels import Supervoxels, sums
from deixis.perception.detection.settings import JoiningSettings
from deixis.reasoning.geometry.coordinates import coordinates

Measure = Callable[["Parts", int, int], float]
Known = TypeVar("Known")

_NONE = np.zeros(0, np.intp)


@dataclass(frozen=True, eq=False)
class Measures:
    """Measures of p parts; heights are above the table, colours have their lightness scaled down."""

    sizes: NDArray[np.float64]  # (p,): points
    areas: NDArray[np.float64]  # (p,): visible surface in square metres
    tops: NDArray[np.float64]  # (p,): the height of the highest patch
    bottoms: NDArray[np.float64]  # (p,): the height of the lowest patch
    middles: NDArray[np.float64]  # (p,): the mean height
    low: NDArray[np.float64]  # (p, 2): lower corner of the box around a part as seen from above
    high: NDArray[np.float64]  # (p, 2): its upper corner
    colours: NDArray[np.float64]  # (p, 3): the mean
    motley: NDArray[np.float64]  # (p,): standard deviation of the colours of the patches
    bulge: NDArray[np.float64]  # (p,): 1 a sphere from outside, 0 a plane, -1 a sphere from inside

    @classmethod
    def of(cls, part: NDArray[np.integer], patches: Supervoxels, chosen: NDArray[np.intp]) -> Measures:
        """Return the measures of the parts of the chosen patches.

        Parameters
        ----------
        part
            Part of each chosen patch, from 0, shape (k,).
        patches
            All patches of the surface.
        chosen
            Indices of k patches.

        Returns
        -------
        Measures
            One row for each part.
        """
        from deixis.perception.detection.kernels import measures_of_parts

        shape = (patches.sizes, patches.weights, patches.middles, patches.normals, patches.tints, patches.areas)
        low, high, centres, colours, totals = measures_of_parts(part.astype(np.int64), chosen, *shape)
        return cls(
            sizes=totals[0],
            areas=totals[1],
            tops=high[:, 2],
            bottoms=low[:, 2],
            middles=centres[:, 2],
            low=low[:, :2],
            high=high[:, :2],
            colours=colours,
            motley=totals[2],
            bulge=totals[3],
        )

    def put(self, part: int, other: Measures) -> None:
        """Replace the measures of a part by those of the only part of ``other``.

        Parameters
        ----------
        part
            Number of the part.
        other
            Measures of one part.
        """
        for each in fields(self):
            getattr(self, each.name)[part] = getattr(other, each.name)[0]

    @property
    def centres(self) -> NDArray[np.float64]:
        """Centre of the box of each part as seen from above, shape (p, 2)."""
        result: NDArray[np.float64] = (self.low + self.high) / 2
        return result

    @property
    def widths(self) -> NDArray[np.float64]:
        """Longer side of the box of each part as seen from above, shape (p,)."""
        result: NDArray[np.float64] = (self.high - self.low).max(axis=1)
        return result


@dataclass(frozen=True, eq=False)
class Pairs:
    """Ordered pairs of parts ``first`` and ``second`` (k,), and their boundaries ``met`` (k, 4).

    The columns of ``met`` are the length of the boundary in pairs of neighbours, its length without jumps in depth, and
    the sums along it of the evidence for two objects and of the height of the first part above the second.
    """

    first: NDArray[np.intp]
    second: NDArray[np.intp]
    met: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.first)

    def where(self, chosen: NDArray[np.bool_]) -> Pairs:
        """Return the pairs that a mask selects.

        Parameters
        ----------
        chosen
            Mask of shape (k,).

        Returns
        -------
        Pairs
            Selected pairs in the given order.
        """
        return Pairs(self.first[chosen], self.second[chosen], self.met[chosen])

    @property
    def length(self) -> NDArray[np.float64]:
        """Length of the boundary in pairs of neighbours, shape (k,)."""
        return self.met[:, 0]

    @property
    def evidence(self) -> NDArray[np.float64]:
        """Mean evidence for two objects along the boundary, shape (k,); infinite without a boundary."""
        length = self.length
        evidence: NDArray[np.float64] = np.divide(
            self.met[:, 2], length, out=np.full(len(self), np.inf), where=length > 0
        )
        return evidence

    @property
    def rise(self) -> NDArray[np.float64]:
        """Mean height of the first part above the second along the boundary, shape (k,); 0 without a boundary."""
        length = self.length
        rise: NDArray[np.float64] = np.divide(self.met[:, 3], length, out=np.zeros(len(self)), where=length > 0)
        return rise


class Parts:
    """Mutable partition of s patches into parts, given by ``of`` (s,).

    A joined part has the lower number of the two. ``measures`` holds the measures of each part, out of date for parts
    that were joined to one with a lower number.
    """

    def __init__(
        self, of: NDArray[np.integer], patches: Supervoxels, meeting: Boundaries, settings: JoiningSettings
    ) -> None:
        self.patches, self.settings, self._meeting = patches, settings, meeting
        self._start(of)

    def _start(self, of: NDArray[np.integer]) -> None:
        self._known: dict[tuple[object, ...], float] = {}
        self._of_parts: dict[tuple[object, int], tuple[int, Any]] = {}  # with the number of changes of the part
        count = int(of.max()) + 1 if len(of) else 0
        order = np.argsort(of, kind="stable")
        ends = np.cumsum(np.bincount(of, minlength=count)).tolist()
        self.members = [order[start:end] for start, end in pairwise([0, *ends])]
        self.measures = Measures.of(of, self.patches, np.arange(len(of)))
        self.there = np.ones(count, dtype=np.bool_)
        self._set_aside = np.zeros(count, dtype=np.bool_)
        self.changes = [0] * count
        self._all_meetings: Pairs | None = Pairs(*_between(of, self.patches, self._meeting))
        self._met: list[dict[int, NDArray[np.float64]]] | None = None

    @property
    def _around(self) -> list[dict[int, NDArray[np.float64]]]:
        """Parts that each part meets, with the rows of ``Pairs.met``; made when a boundary is first asked for."""
        if self._met is None:
            assert self._all_meetings is not None, "no parts were joined before"
            self._met, pairs = [{} for _ in self.members], self._all_meetings
            for a, b, row in zip(pairs.first.tolist(), pairs.second.tolist(), pairs.met, strict=True):
                self._met[a][b] = row
        return self._met

    def __len__(self) -> int:
        return int(self.there.sum())

    @property
    def of(self) -> NDArray[np.int32]:
        """Part of each patch, shape (s,), numbered from 0 in the order of their first patches."""
        result = np.zeros(sum(map(len, self.members)), np.int32)
        for number, part in enumerate(np.flatnonzero(self.there).tolist()):
            result[self.members[part]] = number
        return result

    def keep_largest(self, count: int) -> None:
        """Set all but the largest parts aside, so that they are no longer joined.

        A part with thousands of neighbours would be examined with each of them again whenever one is joined to it.

        Parameters
        ----------
        count
            Number of parts that can still be joined.
        """
        least = np.argsort(-self.measures.sizes, kind="stable")[count:]
        self._set_aside[least] = True
        if not len(least):
            return
        around, self._all_meetings = self._around, None
        for part in least.tolist():
            for other in around[part]:
                del around[other][part]
            around[part] = {}

    def join_all(self, first: NDArray[np.intp], second: NDArray[np.intp]) -> None:
        """Join the parts of each pair, and renumber all parts.

        Parameters
        ----------
        first, second
            Parts of each of k pairs, shape (k,). Chains of pairs become one part.
        """
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        of = np.zeros(sum(map(len, self.members)), np.int64)
        for part, members in enumerate(self.members):
            of[members] = part
        count = len(self.members)
        links = coo_array((np.ones(len(first)), (first, second)), shape=(count, count))
        self._start(np.unique(connected_components(links, directed=False)[1][of], return_inverse=True)[1])

    def join(self, a: int, b: int) -> int:
        """Join two parts, and return the number of the joined part.

        Parameters
        ----------
        a, b
            Numbers of the two parts.

        Returns
        -------
        int
            The lower of the two numbers.
        """
        a, b = min(a, b), max(a, b)
        self.members[a] = np.sort(np.concatenate([self.members[a], self.members[b]]))
        self.members[b] = _NONE
        self.there[b] = False
        self.changes[a] += 1
        self.changes[b] += 1
        self.measures.put(a, Measures.of(np.zeros(len(self.members[a]), np.intp), self.patches, self.members[a]))
        around, self._all_meetings = self._around, None
        own = around[a]
        own.pop(b, None)
        for c, row in around[b].items():
            if c != a:
                back = around[c]
                del back[b]
                own[c] = own[c] + row if c in own else row
                back[a] = own[c] * (1.0, 1.0, 1.0, -1.0)
        around[b] = {}
        return a

    def meetings(self, part: int | None = None) -> Pairs:
        """Return all pairs that meet, in both orders, or those with a given ``part``.

        Parameters
        ----------
        part
            If given, return only the pairs with this part.

        Returns
        -------
        Pairs
            Pairs in ascending order.
        """
        if part is not None:
            ends = [(part, other) for other in self._around[part]]
            ends += [(b, a) for a, b in ends]
            return self.pairs(np.array(sorted(ends), np.intp).reshape(-1, 2))
        if self._all_meetings is None:
            ends = [(a, b) for a, others in enumerate(self._around) for b in others]
            self._all_meetings = self.pairs(np.array(sorted(ends), np.intp).reshape(-1, 2))
        return self._all_meetings

    def near(self, gap: float, part: int | None = None) -> Pairs:
        """Return all pairs whose boxes seen from above are close to each other, in both orders.

        Patches of other pairs are at least ``gap`` apart. Parts of few points are left out.

        Parameters
        ----------
        gap
            Distance in metres that the boxes must be closer than.
        part
            If given, return only the pairs with this part.

        Returns
        -------
        Pairs
            Pairs, some of which do not meet.
        """
        large = self.measures.sizes >= self.settings.min_near_points
        there = np.flatnonzero(self.there & large & ~self._set_aside)
        low, high = self.measures.low[there], self.measures.high[there]
        if part is None:
            from deixis.perception.detection.kernels import near_boxes

            order = np.argsort(low[:, 0], kind="stable")
            ends = there[order][near_boxes(low[order], high[order], gap)]
            ends = np.concatenate([ends, ends[:, ::-1]])
            return self.pairs(ends[np.lexsort((ends[:, 1], ends[:, 0]))])
        apart = np.maximum(low - self.measures.high[part], self.measures.low[part] - high).clip(0.0)
        others = there[((apart**2).sum(axis=1) < gap**2) & (there != part)]
        if self._set_aside[part] or not large[part]:
            others = others[:0]
        ends = np.stack([np.full(len(others), part), others], axis=1)
        return self.pairs(np.concatenate([ends, ends[:, ::-1]]))

    def pairs(self, ends: NDArray[np.intp]) -> Pairs:
        """Return pairs of parts with their boundaries.

        Parameters
        ----------
        ends
            Numbers of two parts each, shape (k, 2).

        Returns
        -------
        Pairs
            Pairs in the given order; the boundary of parts that do not meet is 0.
        """
        nothing = np.zeros(4)
        met = [self._around[a].get(b, nothing) for a, b in ends.tolist()]
        return Pairs(ends[:, 0], ends[:, 1], np.array(met).reshape(-1, 4))

    def unlike(self, pairs: Pairs) -> NDArray[np.float64]:
        """Return the difference between the colours of the two parts of each pair, (k,).

        Parameters
        ----------
        pairs
            Pairs of parts.

        Returns
        -------
        ndarray
            Euclidean distances of shape (k,), with the lightness scaled down.
        """
        colours = self.measures.colours
        result: NDArray[np.float64] = np.linalg.norm(colours[pairs.first] - colours[pairs.second], axis=1)
        return result

    def hull(self, part: int) -> NDArray[np.float64] | None:
        """Return the half planes (k, 3) of the convex hull of a part seen from above; None for collinear patches.

        Parameters
        ----------
        part
            Number of the part.

        Returns
        -------
        ndarray or None
            Unit normal and offset of each side, shape (k, 3), negative for places inside.
        """
        return self._kept(_hull, part)

    def axes(self, part: int) -> NDArray[np.float64]:
        """Return the principal axes of a part seen from above.

        Parameters
        ----------
        part
            Number of the part.

        Returns
        -------
        ndarray
            Unit vectors as columns, shape (2, 2), the longer axis first.
        """
        return self._kept(_axes, part)

    def extents(self, part: int) -> NDArray[np.float64]:
        """Return the length and width of a part along its principal axes as seen from above.

        Parameters
        ----------
        part
            Number of the part.

        Returns
        -------
        ndarray
            Length and width in metres, shape (2,).
        """
        return self._kept(_extents, part)

    def plan_tree(self, part: int) -> Any:
        """Return a k-d tree of the patches of a part seen from above.

        Parameters
        ----------
        part
            Number of the part.

        Returns
        -------
        scipy.spatial.cKDTree
            Tree of the middles of the patches in plan, in metres.
        """
        return self._kept(_plan_tree, part)

    def _kept(self, measure: Callable[[Parts, int], Known], part: int) -> Known:
        """Return a measure of a part; it is computed once, until the part changes."""
        found = self._of_parts.get((measure, part))
        if found is None or found[0] != self.changes[part]:
            self._of_parts[measure, part] = found = (self.changes[part], measure(self, part))
        result: Known = found[1]
        return result

    def places(self, part: int) -> NDArray[np.float64]:
        """Return the middles of the patches of a part.

        Parameters
        ----------
        part
            Number of the part.

        Returns
        -------
        ndarray
            Places of shape (k, 3), in metres.
        """
        return self.patches.middles.take(self.members[part], axis=0)

    def once(self, measure: Measure, a: int, b: int) -> float:
        """Return a measure of the patches of two parts; it is computed once, until one of the parts changes.

        Parameters
        ----------
        measure
            Function of this partition and of both parts.
        a, b
            Numbers of the two parts.

        Returns
        -------
        float
            Value of the measure.
        """
        key = (measure, a, self.changes[a], b, self.changes[b])
        if key not in self._known:
            self._known[key] = measure(self, a, b)
        return self._known[key]


def _between(
    of: NDArray[np.integer], patches: Supervoxels, meeting: Boundaries
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.float64]]:
    """Return the pairs of parts that meet, in both orders, and their boundaries in the columns of :class:`Pairs`."""
    i, j = meeting.pairs.T
    a, b = of[i].astype(np.int64), of[j].astype(np.int64)
    apart = a != b
    a, b, i, j = a[apart], b[apart], i[apart], j[apart]
    length = meeting.lengths[apart]
    rise = (patches.middles[i, 2] - patches.middles[j, 2]) * length
    columns = [length, (1 - meeting.jumped[apart]) * length, meeting.evidence[apart] * length, rise]
    count = int(of.max()) + 1 if len(of) else 1
    codes, place = np.unique(np.concatenate([a * count + b, b * count + a]), return_inverse=True)
    both = [np.concatenate([column, column if k < 3 else -column]) for k, column in enumerate(columns)]
    met = np.stack([sums(place, column, len(codes)) for column in both], axis=1)
    return codes // count, codes % count, met


def _hull(parts: Parts, part: int) -> NDArray[np.float64] | None:
    from scipy.spatial import ConvexHull, QhullError

    if len(parts.members[part]) < 3:
        return None
    try:
        sides: NDArray[np.float64] = ConvexHull(parts.places(part)[:, :2]).equations
    except QhullError:
        return None
    return sides


def _plan_tree(parts: Parts, part: int) -> Any:
    from scipy.spatial import cKDTree

    return cKDTree(parts.places(part)[:, :2])


def _axes(parts: Parts, part: int) -> NDArray[np.float64]:
    plan = parts.places(part)[:, :2]
    apart = plan - plan.mean(axis=0)
    axes: NDArray[np.float64] = np.linalg.eigh(apart.T @ apart)[1][:, ::-1]
    return axes


def _extents(parts: Parts, part: int) -> NDArray[np.float64]:
    extents: NDArray[np.float64] = np.ptp(parts.places(part)[:, :2] @ parts.axes(part), axis=0)
    return extents


def inside(parts: Parts, inner: int, outer: int) -> float:
    """Return the fraction of the patches of a part inside the convex hull of another, as seen from above.

    Parameters
    ----------
    parts
        Partition of the patches.
    inner, outer
        Numbers of the two parts.

    Returns
    -------
    float
        Fraction in [0, 1]; 0 if the patches of ``outer`` are collinear.
    """
    hull = parts.hull(outer)
    if hull is None:
        return 0.0
    plan = parts.places(inner)[:, :2]
    return float(((coordinates(plan, hull[:, :2]) + hull[:, 2]).max(axis=1) <= parts.settings.inside_tolerance).mean())


def _covered(parts: Parts, cover: int, places: NDArray[np.float64]) -> bool:
    """Return True if a part can hide most of the places (k, 3).

    These are inside its outline, or no farther outside than the part is higher.
    """
    hull = parts.hull(cover)
    if hull is None:
        return True
    outside = (coordinates(places[:, :2], hull[:, :2]) + hull[:, 2]).max(axis=1)
    return bool((outside < parts.measures.tops[cover] - places[:, 2]).mean() > parts.settings.min_covered_share)


def apart(parts: Parts, a: int, b: int) -> float:
    """Return the smallest distance between the patches of two parts as seen from above, in metres.

    Parameters
    ----------
    parts
        Partition of the patches.
    a, b
        Numbers of the two parts.

    Returns
    -------
    float
        Distance between the middles of patches.
    """
    return float(parts.plan_tree(b).query(parts.places(a)[:, :2])[0].min())


def continues(parts: Parts, a: int, b: int, over: Iterable[int]) -> bool:
    """Return True if two parts are one surface that continues under a part on both.

    Where the two are nearest, their planes agree and the other part lies between them.

    Parameters
    ----------
    parts
        Partition of the patches.
    a, b
        Numbers of the two parts.
    over
        Numbers of the parts that lie on both.

    Returns
    -------
    bool
        False also if the two are not in one plane.
    """
    if parts.once(_share_of_one_plane, a, b) <= parts.settings.min_coplanar_share:
        return False
    p, q = _nearest(parts, parts.members[a], parts.members[b])
    between = (parts.patches.middles[p] + parts.patches.middles[q]) / 2
    return any(
        _covered(parts, part, between) for part in over
    )  # otherwise a fork and a knife beside a plate would match


def _share_of_one_plane(parts: Parts, one: int, two: int) -> float:
    """Return the fraction of the nearest patches of two parts that lie in one plane."""
    p, q = _nearest(parts, parts.members[one], parts.members[two])
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
    """Return pairs of patches of two parts where these are nearest and not too far apart."""
    from scipy.spatial import cKDTree

    middles = parts.patches.middles
    distance, nearest = cKDTree(middles[two]).query(middles[one])
    settings = parts.settings
    close = (distance < settings.max_hidden_gap) & (distance < distance.min() + settings.hidden_gap_spread)
    return one[close], two[nearest[close]]


def steepness(parts: Parts, upper: int, lower: int) -> float:
    """Return the fraction of the patches below a part that slope outwards from the middle of their part.

    Parameters
    ----------
    parts
        Partition of the patches.
    upper, lower
        Numbers of the two parts; the patches of ``lower`` that are nearest to ``upper`` count.

    Returns
    -------
    float
        Fraction in [0, 1]; 1 where nothing could rest on the surface, 0 if too few patches show it.
    """
    from scipy.spatial import cKDTree

    middles, normals, body = parts.patches.middles, parts.patches.normals, parts.places(lower)
    distance, nearest = cKDTree(body).query(parts.places(upper))
    below = np.unique(parts.members[lower][nearest[distance < distance.min() + parts.settings.patch_width]])
    if len(below) < parts.settings.min_shoulder_patches:
        return 0.0
    centre = (body[:, :2].min(axis=0) + body[:, :2].max(axis=0)) / 2
    outwards = ((middles[below, :2] - centre) * normals[below, :2]).sum(axis=1) > 0
    least, greatest = parts.settings.min_shoulder_normal, parts.settings.max_shoulder_normal
    return float((outwards & (normals[below, 2] > least) & (normals[below, 2] < greatest)).mean())


def roundness(parts: Parts, one: int, two: int) -> float:
    """Return the fraction of a circle that the edges of two parts cover seen from above; 0 if they do not fit one.

    Parameters
    ----------
    parts
        Partition of the patches.
    one, two
        Numbers of the two parts.

    Returns
    -------
    float
        Fraction in [0, 1].
    """
    plan = np.concatenate([parts.places(part)[:, :2] for part in (one, two)])
    tolerance = parts.settings.rim_tolerance
    circle = circle_around(corners_of(plan), tolerance)
    return 0.0 if circle is None else len(circle.sectors(plan, tolerance)) / SECTORS


def slenderness(parts: Parts, one: int, two: int) -> float:
    """Return the ratio of length to width of two parts together, if they lie end to end; else 0.

    Parameters
    ----------
    parts
        Partition of the patches.
    one, two
        Numbers of the two parts.

    Returns
    -------
    float
        Ratio without a unit; 0 also if the two are too long or too wide for cutlery.
    """
    longer = max((one, two), key=lambda part: parts.extents(part)[0])
    turned = [parts.places(part)[:, :2] @ parts.axes(longer) for part in (one, two)]
    low, high = (np.array([end(plan, axis=0) for plan in turned]) for end in (np.min, np.max))
    (length, width), (along, across) = high.max(axis=0) - low.min(axis=0), high.min(axis=0) - low.max(axis=0)
    settings = parts.settings
    overlap = settings.end_overlap_share * (high - low)[:, 0].min()
    if length > settings.max_cutlery_length or width > settings.max_cutlery_width or across < 0:
        return 0.0
    if not -settings.max_cutlery_gap < along < overlap:
        return 0.0
    return float(length / max(width, settings.patch_width))


def offset(parts: Parts, one: int, two: int) -> float:
    """Return the difference in height of two parts in a line in metres, each extrapolated to the middle between them.

    It is small if both are pieces of one straight object, level or leaning.

    Parameters
    ----------
    parts
        Partition of the patches.
    one, two
        Numbers of the two parts.

    Returns
    -------
    float
        Absolute difference in metres.
    """
    places = [parts.places(part) for part in (one, two)]
    longer = max((one, two), key=lambda part: parts.extents(part)[0])
    along = parts.axes(longer)[:, 0]
    near, far = sorted((place[:, :2] @ along for place in places), key=np.mean)
    between = (near.max() + far.min()) / 2
    heights = [_height_at(place[:, :2] @ along - between, place[:, 2], parts.settings.patch_width) for place in places]
    return abs(heights[0] - heights[1])


def _height_at(along: NDArray[np.float64], heights: NDArray[np.float64], width: float) -> float:
    """Return the height at position 0 of a line fitted to heights (n,) at positions (n,); the mean if it is short."""
    off = along - along.mean()
    slope = float(off @ heights) / max(float(off @ off), width**2)
    return float(heights.mean() - slope * along.mean())
