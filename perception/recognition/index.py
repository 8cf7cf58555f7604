"""The nearest remembered view: exact, without looking at most of them; or, among very many, almost always it.

Exact: a lower bound of every view's D_V comes from reduced descriptors; views are compared in the order of bounds, and
none whose bound is above the best distance so far. Approximate: the few views that are nearest by what an inverted file
has in some of its lists are compared, and the best of these is taken; its distance is exact in either case.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.recognition.distances import Target
from deixis.perception.recognition.inverted import Effort, InvertedFile
from deixis.perception.recognition.reduction import Reduction, longest, slack
from deixis.perception.recognition.views import PackedViews

TELLING = 0.6
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
        """An index of one view at least."""
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
        """The nearest view to a target whose reduced descriptors are given; exact unless an effort is."""
        count = len(self.views)
        if effort is not None:
            few = np.argsort(self.filed.estimates(reduced, effort.lists), kind="stable")[: effort.few]
            return self._compared(target, few, np.zeros(len(few)))
        if self.reduction.share <= TELLING:
            return self._compared(target, np.arange(count), np.zeros(count))
        bounds = self._bounds(reduced)
        order = np.argsort(bounds, kind="stable")
        return self._compared(target, order, bounds[order])

    def _bounds(self, reduced: NDArray[np.float32]) -> NDArray[np.float64]:
        """Lower bounds (m,) of D_V between the target and each view."""
        from deixis.perception.recognition import kernels

        columns = np.zeros((kernels.AXES, -(-len(reduced) // kernels.LANES) * kernels.LANES), np.float32)
        columns[:, : len(reduced)] = -2.0 * reduced[:, : kernels.AXES].T
        squares, out = reduced[:, kernels.AXES].astype(np.float64), np.empty(len(self.views))
        error = slack(longest(reduced), self.longest)
        kernels.lower_bounds(columns, squares, self.reduced, self.views.starts, error, out)
        return out

    def _compared(self, target: Target, order: NDArray[np.intp], bounds: NDArray[np.float64]) -> Nearest:
        """The nearest of some views, in the order in which they are compared, with lower bounds of their D_V."""
        from deixis.perception.recognition import kernels

        views = self.views
        distance, place, seen = kernels.nearest_view(
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
    """An index for each pack that is not empty, all by one reduction."""
    full = [pack for pack in packs if len(pack)]
    if not full:
        return [None] * len(packs)
    shared = reduction or Reduction.of(full)
    return [ViewIndex.of(pack, shared) if len(pack) else None for pack in packs]
