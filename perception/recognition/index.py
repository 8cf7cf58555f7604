"""The nearest remembered view: exact, without looking at most of them; or, among very many, almost always it.

Exact: a lower bound of every view's D_V comes from reduced descriptors; views are compared in the order of bounds, and
none whose bound is above the best distance so far. A turn of the axes keeps all distances. Of the turned vectors the
coordinates along the first axes are kept, and the length of the rest: for x = (a, r) and y = (b, s),
|x - y|^2 >= |a - b|^2 + (|r| - |s|)^2. Axes are the principal ones of a sample, so that the bound is near the distance
where descriptors vary in few directions, as spin images do.

Approximate: the few views that are nearest by what an inverted file has in some of its lists are compared, and the best
of these is taken; its distance is exact in either case. The file holds descriptors in lists, each around a centre
(J. Sivic, A. Zisserman: Video Google, ICCV 2003). Centres are those of k-means (S. Lloyd: Least squares quantization in
PCM, IEEE Transactions on Information Theory 28(2), 1982) of reduced descriptors, of which a distance is 24 products.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.recognition.distances import Target
from deixis.perception.recognition.views import PackedViews, squared_lengths

AXES_SAMPLE = 20_000
"""Descriptors that principal axes are computed from, at most."""

REDUCED_BLOCK = 65_536
"""Descriptors reduced at a time, which bounds memory where views are mapped from a file."""


@dataclass(frozen=True, eq=False)
class Reduction:
    """The origin (d,) and p orthonormal axes (d, p) of reduced descriptors, p < ``kernels.AXES``.

    ``count`` is how many descriptors there were when they were chosen: bounds are right whatever they are, and looser
    where later descriptors vary in other directions. ``share`` of their variance lies along the axes.
    """

    origin: NDArray[np.float64]
    axes: NDArray[np.float64]
    count: int
    share: float

    @classmethod
    def of(cls, packs: list[PackedViews]) -> Reduction:
        """Return the principal axes of what the packs hold, from an even sample of it; at least one pack is not
        empty."""
        from deixis.perception.recognition.kernels import AXES

        count = sum(len(pack.descriptors) for pack in packs)
        step = -(-count // AXES_SAMPLE)
        sample = np.concatenate([pack.descriptors[::step] for pack in packs if len(pack)]).astype(np.float64)
        origin = sample.mean(axis=0)
        sample -= origin
        variances, vectors = np.linalg.eigh(sample.T @ sample)
        total = variances.sum()
        share = float(variances[1 - AXES :].sum() / total) if total > 0 else 1.0
        return cls(origin, np.ascontiguousarray(vectors[:, ::-1][:, : AXES - 1]), count, share)

    def __call__(self, descriptors: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return reduced descriptors (n, AXES + 1) of descriptors (n, d), the last column their squared lengths."""
        from deixis.perception.recognition.kernels import AXES

        out = np.zeros((len(descriptors), AXES + 1), np.float32)
        for low in range(0, len(descriptors), REDUCED_BLOCK):
            moved = descriptors[low : low + REDUCED_BLOCK] - self.origin
            along = moved @ self.axes
            rest = np.sqrt(np.maximum(np.square(moved).sum(axis=1) - np.square(along).sum(axis=1), 0.0))
            part = out[low : low + REDUCED_BLOCK]
            part[:, : along.shape[1]] = along
            part[:, AXES - 1] = rest
            part[:, AXES] = squared_lengths(part[:, :AXES])
        return out


def longest(reduced: NDArray[np.float32]) -> float:
    """Return the greatest length of reduced descriptors (n, AXES + 1)."""
    from deixis.perception.recognition.kernels import AXES

    return float(np.sqrt(reduced[:, AXES].max(initial=0.0)))


def slack(one: float, other: float) -> float:
    """Return by how much rounding can make a squared distance too large, of reduced descriptors of these lengths at
    most."""
    from deixis.perception.recognition.kernels import AXES, EPSILON

    return 4.0 * (AXES + 8) * EPSILON * (one + other) ** 2


CENTRE_BLOCK = 8_192
"""Descriptors that are compared with all centres at a time, which bounds memory."""

KMEANS_ROUNDS = 5
"""Rounds of k-means. Lists need not be the best ones: a search looks into several."""

LIST_SIZE = 50
"""Descriptors in a list, about, where they are few."""

MAX_LISTS = 512
"""Number of lists at the most."""

CENTRE_SAMPLE = 10_000
"""Descriptors that centres are computed from, at most."""


@dataclass(frozen=True)
class Effort:
    """How far an approximate search goes in a category.

    For each descriptor of the target the ``lists`` with the nearest centres are looked into; the ``few`` views that are
    nearest by what is found there are compared exactly.
    """

    lists: int = 6
    few: int = 10


@dataclass(frozen=True, eq=False)
class InvertedFile:
    """Reduced descriptors (n, AXES + 1) of m views in the order of their lists, list i from ``starts[i]`` to
    ``starts[i + 1]``, and the place of the view that each is of."""

    centres: NDArray[np.float32]  # (l, AXES)
    starts: NDArray[np.int64]  # (l + 1,)
    reduced: NDArray[np.float32]
    views: NDArray[np.int32]  # (n,)
    count: int

    @classmethod
    def of(cls, reduced: NDArray[np.float32], view_starts: NDArray[np.int64]) -> InvertedFile:
        """File reduced descriptors of m views, which ``view_starts`` (m + 1,) tells apart."""
        from scipy.cluster.vq import kmeans2

        rows = np.ascontiguousarray(reduced[:: -(-len(reduced) // CENTRE_SAMPLE)][:, :-1])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an empty cluster keeps its centre
            centres: NDArray[np.float32] = kmeans2(
                rows, max(1, min(MAX_LISTS, len(reduced) // LIST_SIZE)), iter=KMEANS_ROUNDS, minit="points", rng=0
            )[0]
        lows = range(0, len(reduced), CENTRE_BLOCK)
        lists = np.concatenate([_squares(reduced[low : low + CENTRE_BLOCK], centres).argmin(axis=1) for low in lows])
        order = np.argsort(lists, kind="stable")
        starts = np.searchsorted(lists[order], np.arange(len(centres) + 1))
        count = len(view_starts) - 1
        views = np.repeat(np.arange(count, dtype=np.int32), np.diff(view_starts))
        return cls(centres, starts, reduced[order], views[order], count)

    def estimates(self, reduced: NDArray[np.float32], count: int) -> NDArray[np.float64]:
        """Return about D_V (m,) between a target, by its reduced descriptors (q, AXES + 1), and every view: by the
        nearest descriptors in ``count`` lists. What has nothing there counts as far as the farthest centre of these."""
        from deixis.perception.recognition.kernels import estimates

        out = np.zeros(self.count)
        squares = _squares(reduced, self.centres)
        estimates(reduced, squares, min(count, len(self.centres)), self.reduced, self.starts, self.views, out)
        return out / len(reduced)


def _squares(reduced: NDArray[np.float32], centres: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return squared distances (n, l), less the squared lengths of the descriptors."""
    squares: NDArray[np.float32] = reduced[:, :-1] @ (-2.0 * centres.T)
    squares += np.square(centres).sum(axis=1)
    return squares


MIN_AXES_SHARE = 0.6
"""Where the axes have no larger share of the variance, bounds cost more than they save, and all views are compared."""


@dataclass(frozen=True)
class Nearest:
    """D_C (equation 2), the place of the view that has it (-1: there is none), and how many views were compared."""

    distance: float
    place: int
    compared: int


@dataclass(frozen=True, eq=False)
class ViewIndex:
    """Views and, by a reduction that several indexes share, their reduced descriptors (n, AXES + 1)."""

    views: PackedViews
    reduction: Reduction
    reduced: NDArray[np.float32]

    @classmethod
    def of(cls, views: PackedViews, reduction: Reduction | None = None) -> ViewIndex:
        """Return an index of one view at least."""
        turned = reduction or Reduction.of([views])
        return cls(views, turned, turned(views.descriptors))

    @cached_property
    def longest(self) -> float:
        """The greatest length of a reduced descriptor."""
        return longest(self.reduced)

    @cached_property
    def filed(self) -> InvertedFile:
        """The reduced descriptors in lists, worked out when they are first wanted."""
        return InvertedFile.of(self.reduced, self.views.starts)

    def nearest(self, target: Target, reduced: NDArray[np.float32], effort: Effort | None = None) -> Nearest:
        """Return the nearest view to a target whose reduced descriptors are given; exact unless an effort is."""
        count = len(self.views)
        if effort is not None:
            few = np.argsort(self.filed.estimates(reduced, effort.lists), kind="stable")[: effort.few]
            return self._compared(target, few, np.zeros(len(few)))
        if self.reduction.share <= MIN_AXES_SHARE:
            return self._compared(target, np.arange(count), np.zeros(count))
        bounds = self._bounds(reduced)
        order = np.argsort(bounds, kind="stable")
        return self._compared(target, order, bounds[order])

    def _bounds(self, reduced: NDArray[np.float32]) -> NDArray[np.float64]:
        """Lower bounds (m,) of D_V between the target and each view."""
        from deixis.perception.recognition.kernels import AXES, LANES, lower_bounds

        columns = np.zeros((AXES, -(-len(reduced) // LANES) * LANES), np.float32)
        columns[:, : len(reduced)] = -2.0 * reduced[:, :AXES].T
        squares, out = reduced[:, AXES].astype(np.float64), np.empty(len(self.views))
        error = slack(longest(reduced), self.longest)
        lower_bounds(columns, squares, self.reduced, self.views.starts, error, out)
        return out

    def _compared(self, target: Target, order: NDArray[np.intp], bounds: NDArray[np.float64]) -> Nearest:
        """Return the nearest of some views, in the order in which they are compared, with lower bounds of their D_V."""
        from deixis.perception.recognition.kernels import nearest_view

        views = self.views
        distance, place, seen = nearest_view(
            target.descriptors,
            target.columns,
            target.lengths,
            views.descriptors,
            views.starts,
            views.squares,
            order,
            bounds,
        )
        return Nearest(float(distance), int(place), int(seen))


def indexes_of(packs: Sequence[PackedViews], reduction: Reduction | None = None) -> list[ViewIndex | None]:
    """Return an index for each pack that is not empty, all by one reduction."""
    full = [pack for pack in packs if len(pack)]
    if not full:
        return [None] * len(packs)
    shared = reduction or Reduction.of(full)
    return [ViewIndex.of(pack, shared) if len(pack) else None for pack in packs]
