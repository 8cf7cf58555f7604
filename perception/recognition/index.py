"""The nearest remembered view: exact, without looking at most of them; or, among very many, almost always it.

Exact: a lower bound of every view's D_V comes from reduced descriptors; views are compared in the order of bounds, and
none whose bound is above the best distance so far. Approximate: bounds from every few descriptors of the target leave
some views, bounds from all of them a few, and the best of these is taken; its distance is exact in either case.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.recognition.distances import Target
from deixis.perception.recognition.reduction import Reduction, longest, slack
from deixis.perception.recognition.views import PackedViews

TELLING = 0.6
"""Where the axes have no larger share of the variance, bounds cost more than they save, and all views are compared."""


@dataclass(frozen=True)
class Effort:
    """How far an approximate search goes in a category of n views.

    Every ``stride``-th descriptor of the target is looked at first, ``least`` at least. What then remains is ``share``
    of the views, ``few`` at least, and in the end ``few`` are compared exactly.
    """

    stride: int = 6
    least: int = 16
    share: float = 0.1
    few: int = 12


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

    def nearest(self, target: Target, reduced: NDArray[np.float32], effort: Effort | None = None) -> Nearest:
        """The nearest view to a target whose reduced descriptors are given; exact unless an effort is."""
        chosen = np.arange(len(self.views))
        if effort is None:
            telling = self.reduction.share > TELLING
            bounds = self._bounds(reduced, chosen) if telling else np.zeros(len(chosen))
            return self._compared(target, chosen, bounds, len(chosen))
        stride = max(1, min(effort.stride, len(reduced) // effort.least))
        if stride > 1:
            left = max(effort.few, int(effort.share * len(chosen)))
            chosen = _lowest(chosen, self._bounds(reduced[::stride], chosen), left)
        return self._compared(target, chosen, self._bounds(reduced, chosen), effort.few)

    def _bounds(self, reduced: NDArray[np.float32], chosen: NDArray[np.int64]) -> NDArray[np.float64]:
        """Lower bounds (c,) of D_V between the target and the chosen views (c,)."""
        from deixis.perception.recognition import kernels

        columns = np.zeros((kernels.AXES, -(-len(reduced) // kernels.LANES) * kernels.LANES), np.float32)
        columns[:, : len(reduced)] = -2.0 * reduced[:, : kernels.AXES].T
        squares, out = reduced[:, kernels.AXES].astype(np.float64), np.empty(len(chosen))
        error = slack(longest(reduced), self.longest)
        kernels.lower_bounds(columns, squares, self.reduced, self.views.starts, chosen, error, out)
        return out

    def _compared(self, target: Target, chosen: NDArray[np.int64], bounds: NDArray[np.float64], most: int) -> Nearest:
        from deixis.perception.recognition import kernels

        order = np.argsort(bounds, kind="stable")
        views = self.views
        distance, place, seen = kernels.nearest_view(
            target.descriptors,
            target.columns,
            target.lengths,
            views.descriptors,
            views.starts,
            views.squares,
            chosen[order],
            bounds[order],
            most,
        )
        return Nearest(float(distance), int(place), int(seen))


def _lowest(chosen: NDArray[np.int64], bounds: NDArray[np.float64], count: int) -> NDArray[np.int64]:
    """The ``count`` of them with the lowest bounds, in their order."""
    return chosen if count >= len(chosen) else np.sort(chosen[np.argpartition(bounds, count)[:count]])


def indexes_of(packs: Sequence[PackedViews], reduction: Reduction | None = None) -> list[ViewIndex | None]:
    """An index for each pack that is not empty, all by one reduction."""
    full = [pack for pack in packs if len(pack)]
    if not full:
        return [None] * len(packs)
    shared = reduction or Reduction.of(full)
    return [ViewIndex.of(pack, shared) if len(pack) else None for pack in packs]
