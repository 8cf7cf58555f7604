"""Equations 1 and 2: the distances of a seen view from a remembered view, and from a category.

The distance between two descriptors is Euclidean. The paper writes only "d", and its approximate kd-trees (Bentley
1975) search for the nearest neighbour in that metric.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.views import PackedViews, checked, squared_lengths


@dataclass(frozen=True, eq=False)
class Target:
    """A seen view prepared for comparison: q descriptors of d numbers."""

    descriptors: NDArray[np.float32]  # (q, d)
    columns: NDArray[np.float32]  # (d, q): the same, transposed
    lengths: NDArray[np.float64]  # (q,)

    @classmethod
    def of(cls, descriptors: NDArray[np.float32]) -> Target:
        """Return the target of descriptors.

        Parameters
        ----------
        descriptors
            Descriptors of shape (q, d).

        Returns
        -------
        Target
            Target with the descriptors in the order that the kernels need.

        Raises
        ------
        RecognitionError
            If there is no descriptor, or one is not finite.
        """
        size = descriptors.shape[-1] if isinstance(descriptors, np.ndarray) and descriptors.ndim else 0
        rows = checked("the target view", descriptors, size)
        if not len(rows):
            raise RecognitionError("the target view must have at least one descriptor, got none")
        return cls(rows, np.ascontiguousarray(rows.T), np.sqrt(squared_lengths(rows)))

    def require_fit(self, views: PackedViews) -> None:
        """Raise RecognitionError if the views have descriptors of another length.

        Parameters
        ----------
        views
            Views with which the target is compared.

        Raises
        ------
        RecognitionError
            If their descriptors do not have d numbers. No views fit every target.
        """
        if len(views) and views.size != len(self.columns):
            raise RecognitionError(
                f"the target's descriptors have {len(self.columns)} numbers, and the remembered views' {views.size};"
                " describe both with the same descriptor and settings"
            )


def view_distance(target: NDArray[np.float32], view: NDArray[np.float32]) -> float:
    """Compute D_V (equation 1), the distance of a target from a view.

    It is the mean over the target's descriptors of the least distance to a descriptor of the view. It is not symmetric:
    every descriptor of the target needs a counterpart in the view, but not the other way round.

    Parameters
    ----------
    target
        Descriptors of shape (q, d).
    view
        Descriptors of shape (k, d).

    Returns
    -------
    float
        Mean Euclidean distance.

    Raises
    ------
    RecognitionError
        If either has no descriptor, or their lengths differ.

    Examples
    --------
    >>> one, two = np.array([[0, 0], [3, 4]], np.float32), np.array([[0, 0]], np.float32)
    >>> view_distance(one, two), view_distance(two, one)
    (2.5, 0.0)
    """
    return float(view_distances(target, PackedViews.of([("the view", view)]))[0])


def view_distances(target: NDArray[np.float32] | Target, views: PackedViews) -> NDArray[np.float64]:
    """Return D_V (equation 1) between a target and each of m views.

    Parameters
    ----------
    target
        Descriptors of shape (q, d), or the target made of them.
    views
        The m views.

    Returns
    -------
    ndarray
        Distances of shape (m,).

    Raises
    ------
    RecognitionError
        If descriptors are not valid, or differ in length.
    """
    from deixis.perception.recognition.kernels import fill_view_distances

    seen = target if isinstance(target, Target) else Target.of(target)
    seen.require_fit(views)
    out = np.empty(len(views))
    fill_view_distances(
        seen.descriptors, seen.columns, seen.lengths, views.descriptors, views.starts, views.squares, out
    )
    return out


def category_distance(target: NDArray[np.float32] | Target, views: PackedViews) -> tuple[float, int]:
    """Return D_C (equation 2), the least D_V over a category's views, and the index of the first view that has it.

    Parameters
    ----------
    target
        Descriptors of shape (q, d), or the target made of them.
    views
        Views of the category.

    Returns
    -------
    tuple
        Distance and index; infinity and -1 for a category without views.

    Raises
    ------
    RecognitionError
        If descriptors are not valid, or differ in length.
    """
    distances = view_distances(target, views)
    if not len(distances):
        return float("inf"), -1
    nearest = int(np.argmin(distances))
    return float(distances[nearest]), nearest
