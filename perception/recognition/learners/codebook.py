"""Words for local shapes: descriptors are put into clusters that nobody named."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.view_features import ViewFeatures, roots

SAMPLE = 8000
"""Descriptors that clusters are found from, at most."""

ROUNDS = 15


@dataclass(frozen=True, eq=False)
class Codebook:
    """The centres (w, d) of w words, in square roots of one descriptor."""

    descriptor: str
    centres: NDArray[np.float64]

    @classmethod
    def of(
        cls, views: Iterable[ViewFeatures], words: int = 80, descriptor: str = "spin_images", seed: int = 0
    ) -> Codebook:
        """Clusters of the views' descriptors, by k-means from k-means++ (Arthur and Vassilvitskii 2007).

        No categories are asked for. There are fewer words where there are fewer different descriptors. Raises
        RecognitionError for a number of words below 1, and for views without a descriptor.
        """
        from scipy.cluster.vq import kmeans2

        found = [view[descriptor] for view in views]
        rows = roots(np.concatenate(found)).astype(np.float64) if found else np.empty((0, 1))
        if words < 1 or not len(rows):
            raise RecognitionError(f"{words} words of '{descriptor}' cannot be found among {len(rows)} descriptors")
        rng = np.random.default_rng(seed)
        if len(rows) > SAMPLE:
            rows = rows[np.sort(rng.choice(len(rows), SAMPLE, replace=False))]
        count = min(words, len(np.unique(rows, axis=0)))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an empty cluster keeps its centre
            centres, _ = kmeans2(rows, count, iter=ROUNDS, minit="++", rng=rng)
        return cls(descriptor, centres)

    def __len__(self) -> int:
        return len(self.centres)

    def counts(self, view: ViewFeatures) -> NDArray[np.float64]:
        """How often each word occurs in a view, (w,): each descriptor is its nearest word."""
        rows = roots(view[self.descriptor])
        distances = (self.centres**2).sum(axis=1) - 2.0 * rows @ self.centres.T
        return np.bincount(distances.argmin(axis=1), minlength=len(self)).astype(np.float64)
