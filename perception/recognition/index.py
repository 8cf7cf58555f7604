"""Search for the nearest remembered view: exactly, or approximately among very many views.

The exact search computes a lower bound of every view's D_V from reduced descriptors, compares the views in the order of
bounds, and stops at the first bound above the best distance so far. Rotating the axes keeps all distances. Of the
rotated vectors, the coordinates along the first axes are kept, and the length of the rest: for x = (a, r) and
y = (b, s), |x - y|^2 >= |a - b|^2 + (|r| - |s|)^2. The axes are the principal axes of a sample, so that the bound is
close to the distance if descriptors vary in few directions, as spin images do.

The approximate search compares the few views that are nearest according to some lists of an inverted file, and returns
the best of them; its distance is exact, too. The file holds descriptors in lists, each around a centre (J. Sivic,
A. Zisserman: Video Google, ICCV 2003). The centres are found by k-means (S. Lloyd: Least squares quantization in PCM,
IEEE Transactions on Information Theory 28(2), 1982) on reduced descriptors, whose distance costs 24 products.
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
"""Maximum number of descriptors from which principal axes are computed."""

REDUCED_BLOCK = 65_536
"""Number of descriptors that are reduced at a time, which bounds memory if views are mapped from a file."""


@dataclass(frozen=True, eq=False)
class Reduction:
    """Projection to reduced descriptors: the origin (d,) and p orthonormal axes (d, p), p < ``kernels.AXES``.

    ``count`` is the number of descriptors when the axes were chosen: bounds hold for any axes, and are looser if later
    descriptors vary in other directions. ``share`` is the share of the variance along the axes.
    """

    origin: NDArray[np.float64]
    axes: NDArray[np.float64]
    count: int
    share: float

    @classmethod
    def of(cls, packs: list[PackedViews]) -> Reduction:
        """Return the reduction to the principal axes of an even sample of views.

        Parameters
        ----------
        packs
            Views, of which one pack must not be empty.

        Returns
        -------
        Reduction
            Reduction with the ``AXES`` - 1 axes of the largest variances.
        """
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
        """Return reduced descriptors (n, AXES + 1) of descriptors (n, d); the last column holds squared lengths."""
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
    """Return the greatest length of reduced descriptors.

    Parameters
    ----------
    reduced
        Reduced descriptors of shape (n, AXES + 1), whose last column is the squared length.

    Returns
    -------
    float
        Length; 0 without descriptors.
    """
    from deixis.perception.recognition.kernels import AXES

    return float(np.sqrt(reduced[:, AXES].max(initial=0.0)))


def slack(one: float, other: float) -> float:
    """Return a bound of the rounding error of squared distances between reduced descriptors.

    Parameters
    ----------
    one, other
        Greatest lengths of the descriptors on either side.

    Returns
    -------
    float
        Bound in squared units of the descriptors.
    """
    from deixis.perception.recognition.kernels import AXES, EPSILON

    return 4.0 * (AXES + 8) * EPSILON * (one + other) ** 2


CENTRE_BLOCK = 8_192
"""Number of descriptors that are compared with all centres at a time, which bounds memory."""

KMEANS_ROUNDS = 5
"""Number of iterations of k-means; lists need not be optimal, since a search reads several of them."""

LIST_SIZE = 50
"""Approximate number of descriptors in a list, below ``MAX_LISTS`` lists."""

MAX_LISTS = 512
"""Maximum number of lists."""

CENTRE_SAMPLE = 10_000
"""Maximum number of descriptors from which centres are computed."""


@dataclass(frozen=True)
class Effort:
    """Effort of an approximate search in a category.

    The search reads, for each descriptor of the target, the ``lists`` with the nearest centres, and then compares the
    ``few`` views exactly that are nearest according to these lists.
    """

    lists: int = 6
    few: int = 10


@dataclass(frozen=True, eq=False)
class InvertedFile:
    """Reduced descriptors (n, AXES + 1) of ``count`` views in the order of their lists.

    List i runs from ``starts[i]`` to ``starts[i + 1]``; ``views`` holds the index of each descriptor's view.
    """

    centres: NDArray[np.float32]  # (l, AXES)
    starts: NDArray[np.int64]  # (l + 1,)
    reduced: NDArray[np.float32]
    views: NDArray[np.int32]  # (n,)
    count: int

    @classmethod
    def of(cls, reduced: NDArray[np.float32], view_starts: NDArray[np.int64]) -> InvertedFile:
        """Build the file of the reduced descriptors of m views.

        Parameters
        ----------
        reduced
            Reduced descriptors of shape (n, AXES + 1).
        view_starts
            Index of the first descriptor of each view, and n, shape (m + 1,).

        Returns
        -------
        InvertedFile
            File whose lists are the cells of k-means.
        """
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
        """Estimate the distance D_V (equation 1) to every view from the nearest descriptors in a number of lists.

        The distance to a view without a descriptor in these lists counts as that of their farthest centre.

        Parameters
        ----------
        reduced
            Reduced descriptors of the target, shape (q, AXES + 1).
        count
            Number of lists that are searched for each descriptor.

        Returns
        -------
        ndarray
            Estimated distances of the m views, shape (m,).
        """
        from deixis.perception.recognition.kernels import estimates

        out = np.zeros(self.count)
        squares = _squares(reduced, self.centres)
        estimates(reduced, squares, min(count, len(self.centres)), self.reduced, self.starts, self.views, out)
        return out / len(reduced)


def _squares(reduced: NDArray[np.float32], centres: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return squared distances (n, l) to the centres, minus the squared lengths of the descriptors."""
    squares: NDArray[np.float32] = reduced[:, :-1] @ np.multiply(centres.T, -2.0, dtype=np.float32)
    squares += np.square(centres).sum(axis=1)
    return squares


MIN_AXES_SHARE = 0.6
"""Share of the variance along the axes up to which bounds cost more than they save, and all views are compared."""


@dataclass(frozen=True)
class Nearest:
    """Distance D_C to a category (equation 2), index of its view (-1 without views), and number of views compared."""

    distance: float
    place: int
    compared: int


@dataclass(frozen=True, eq=False)
class ViewIndex:
    """Index of views: their reduced descriptors (n, AXES + 1), by a reduction that several indexes share."""

    views: PackedViews
    reduction: Reduction
    reduced: NDArray[np.float32]

    @classmethod
    def of(cls, views: PackedViews, reduction: Reduction | None = None) -> ViewIndex:
        """Return an index of views.

        Parameters
        ----------
        views
            At least one view.
        reduction
            Reduction to use; by default one is computed from the views.

        Returns
        -------
        ViewIndex
            Index with the reduced descriptors.
        """
        turned = reduction or Reduction.of([views])
        return cls(views, turned, turned(views.descriptors))

    @cached_property
    def longest(self) -> float:
        """Maximum length of a reduced descriptor."""
        return longest(self.reduced)

    @cached_property
    def filed(self) -> InvertedFile:
        """Inverted file of the reduced descriptors, built on first use."""
        return InvertedFile.of(self.reduced, self.views.starts)

    def nearest(self, target: Target, reduced: NDArray[np.float32], effort: Effort | None = None) -> Nearest:
        """Return the nearest view to a target.

        Parameters
        ----------
        target
            Target of the same descriptor.
        reduced
            Its reduced descriptors, shape (q, AXES + 1).
        effort
            Limits of an approximate search; exact without them.

        Returns
        -------
        Nearest
            Nearest view with its D_V.
        """
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
        """Return lower bounds (m,) of D_V between the target and each view."""
        from deixis.perception.recognition.kernels import AXES, LANES, lower_bounds

        columns = np.zeros((AXES, -(-len(reduced) // LANES) * LANES), np.float32)
        columns[:, : len(reduced)] = -2.0 * reduced[:, :AXES].T
        squares, out = reduced[:, AXES].astype(np.float64), np.empty(len(self.views))
        error = slack(longest(reduced), self.longest)
        lower_bounds(columns, squares, self.reduced, self.views.starts, error, out)
        return out

    def _compared(self, target: Target, order: NDArray[np.intp], bounds: NDArray[np.float64]) -> Nearest:
        """Return the nearest of the views ``order``, compared in this order, given lower bounds of their D_V."""
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


def indexes_of(packs: Sequence[PackedViews]) -> list[ViewIndex | None]:
    """Return an index for each pack of views; all share the reduction that is computed from them.

    Parameters
    ----------
    packs
        Views of each category.

    Returns
    -------
    list of ViewIndex or None
        Indexes in the order of the packs; None for an empty pack.
    """
    full = [pack for pack in packs if len(pack)]
    if not full:
        return [None] * len(packs)
    shared = Reduction.of(full)
    return [ViewIndex.of(pack, shared) if len(pack) else None for pack in packs]
