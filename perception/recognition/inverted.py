"""An inverted file: descriptors in lists, each list around a centre, of which a search looks into a few.

J. Sivic, A. Zisserman: Video Google, ICCV 2003. Centres are those of k-means (S. Lloyd: Least squares quantization in
PCM, IEEE Transactions on Information Theory 28(2), 1982) of reduced descriptors, of which a distance is 24 products.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

BLOCK = 8_192
"""Descriptors that are compared with all centres at a time, which bounds memory."""

ROUNDS = 5
"""Of k-means. Lists need not be the best ones: a search looks into several."""

IN_A_LIST = 50
"""Descriptors in a list, about, where they are few."""

MOST_LISTS = 512

SAMPLE = 10_000
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
        """Files reduced descriptors of m views, which ``view_starts`` (m + 1,) tells apart."""
        centres = _centres(reduced[:: -(-len(reduced) // SAMPLE)], max(1, min(MOST_LISTS, len(reduced) // IN_A_LIST)))
        lists = _nearest(reduced, centres)
        order = np.argsort(lists, kind="stable")
        starts = np.searchsorted(lists[order], np.arange(len(centres) + 1))
        count = len(view_starts) - 1
        views = np.repeat(np.arange(count, dtype=np.int32), np.diff(view_starts))
        return cls(centres, starts, reduced[order], views[order], count)

    def estimates(self, reduced: NDArray[np.float32], count: int) -> NDArray[np.float64]:
        """About D_V (m,) between a target, by its reduced descriptors (q, AXES + 1), and every view: by the nearest
        descriptors in ``count`` lists. What has nothing there counts as far as the farthest centre of these."""
        from deixis.perception.recognition import kernels

        out = np.zeros(self.count)
        squares = _squares(reduced, self.centres)
        kernels.estimates(reduced, squares, min(count, len(self.centres)), self.reduced, self.starts, self.views, out)
        return out / len(reduced)


def _centres(sample: NDArray[np.float32], count: int) -> NDArray[np.float32]:
    """So many centres (count, AXES) of a sample (n, AXES + 1), n >= count, by k-means."""
    from scipy.cluster.vq import kmeans2

    rows = np.ascontiguousarray(sample[:, :-1])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # an empty cluster keeps its centre
        centres: NDArray[np.float32] = kmeans2(rows, count, iter=ROUNDS, minit="points", rng=0)[0]
    return centres


def _nearest(reduced: NDArray[np.float32], centres: NDArray[np.float32]) -> NDArray[np.int64]:
    """The nearest centre (n,) of each reduced descriptor."""
    lows = range(0, len(reduced), BLOCK)
    return np.concatenate([_squares(reduced[low : low + BLOCK], centres).argmin(axis=1) for low in lows])


def _squares(reduced: NDArray[np.float32], centres: NDArray[np.float32]) -> NDArray[np.float32]:
    """Squared distances (n, l), less the squared lengths of the descriptors."""
    squares: NDArray[np.float32] = reduced[:, :-1] @ (-2.0 * centres.T)
    squares += np.square(centres).sum(axis=1)
    return squares
