"""What sizes are learned from, in whole numbers: counts and sums that views are added to and taken out of again.

A logarithm is kept in steps of 2**-24, and counted in one of 64 buckets a unit: a bucket is 1.6 per cent of a length
wide. In it every view stands for the bucket's mean, so that few views are exact, and medians of many are off by less
than a bucket. How much is kept does not grow with the number of views; and since nothing is rounded along the way, any
order of adding and removing comes to the same.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

SCALE = 2**24
"""Steps of a logarithm that are told apart, a unit."""

BUCKET = 2**18
"""Steps in a bucket."""

Buckets = Mapping[int, tuple[int, int]]
"""By bucket, how many views it has, and the sum of their steps."""


def steps(logarithm: float) -> int:
    """Return the nearest step to a logarithm."""
    return round(float(logarithm) * SCALE)


class Distribution:
    """The values that some buckets stand for, with how often each; empty ones have no median."""

    def __init__(self, buckets: Buckets) -> None:
        filled = [pair for _, pair in sorted(buckets.items()) if pair[0]]
        self._counts: NDArray[np.int64] = np.array([count for count, _ in filled], dtype=np.int64)
        self._values: NDArray[np.float64] = np.array([total / count / SCALE for count, total in filled])
        self.size = int(self._counts.sum())

    def median(self) -> float:
        """Return the median."""
        return _median(self._values, self._counts)

    def median_deviation(self, centre: float) -> float:
        """Return the median absolute deviation from a value."""
        away = np.abs(self._values - centre)
        order = np.argsort(away, kind="stable")
        return _median(away[order], self._counts[order])

    def deviations(self, centre: float) -> float:
        """Return the sum of absolute deviations from a value."""
        return float(self._counts @ np.abs(self._values - centre))


def _median(values: NDArray[np.float64], counts: NDArray[np.int64]) -> float:
    """Return the median of sorted values, each so often."""
    upto = np.cumsum(counts)
    low, high = np.searchsorted(upto, [(upto[-1] - 1) // 2, upto[-1] // 2], side="right")
    return float(values[low] + values[high]) / 2
