"""Equations 1 and 2: how far a seen view is from a remembered one, and from a category.

The distance between two descriptors is Euclidean. The paper says only "d", and what its approximate kd-trees (Bentley
1975) look for is the nearest neighbour of that metric.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.views import PackedViews, checked, squared_lengths


@dataclass(frozen=True, eq=False)
class Target:
    """A seen view, prepared for comparison: q descriptors of d numbers."""

    descriptors: NDArray[np.float32]  # (q, d)
    columns: NDArray[np.float32]  # (d, q): the same, transposed
    lengths: NDArray[np.float64]  # (q,)

    @classmethod
    def of(cls, descriptors: NDArray[np.float32]) -> Target:
        """Raise RecognitionError unless the descriptors are finite rows, one at least."""
        size = descriptors.shape[-1] if isinstance(descriptors, np.ndarray) and descriptors.ndim else 0
        rows = checked("the target view", descriptors, size)
        if not len(rows):
            raise RecognitionError("the target view has no descriptor: equation 1 is a mean over none")
        return cls(rows, np.ascontiguousarray(rows.T), np.sqrt(squared_lengths(rows)))

    def require_fit(self, views: PackedViews) -> None:
        """Raise RecognitionError where views have descriptors of another length."""
        if len(views) and views.size != len(self.columns):
            raise RecognitionError(
                f"the target's descriptors have {len(self.columns)} numbers and the remembered views' {views.size};"
                " describe both with the same descriptor and settings"
            )


def view_distance(target: NDArray[np.float32], view: NDArray[np.float32]) -> float:
    """Return D_V (equation 1): the mean over the target's descriptors (q, d) of the least distance to the view's (k,
    d).

    It is not symmetric: every descriptor of the target needs a counterpart in the view, not the other way round.

    >>> one, two = np.array([[0, 0], [3, 4]], np.float32), np.array([[0, 0]], np.float32)
    >>> view_distance(one, two), view_distance(two, one)
    (2.5, 0.0)

    Raises RecognitionError where either has no descriptor, or they do not fit.
    """
    return float(view_distances(target, PackedViews.of([("the view", view)]))[0])


def view_distances(target: NDArray[np.float32] | Target, views: PackedViews) -> NDArray[np.float64]:
    """Return D_V (m,) between a target (q, d) and each of m views; raises RecognitionError where they do not fit."""
    from deixis.perception.recognition.kernels import fill_view_distances

    seen = target if isinstance(target, Target) else Target.of(target)
    seen.require_fit(views)
    out = np.empty(len(views))
    fill_view_distances(
        seen.descriptors, seen.columns, seen.lengths, views.descriptors, views.starts, views.squares, out
    )
    return out


def category_distance(target: NDArray[np.float32] | Target, views: PackedViews) -> tuple[float, int]:
    """Return D_C (equation 2): the least D_V over a category's views, and the place of the first view that has it.

    A category without a view is infinitely far, at place -1.
    """
    distances = view_distances(target, views)
    if not len(distances):
        return float("inf"), -1
    nearest = int(np.argmin(distances))
    return float(distances[nearest]), nearest
