"""Statistics of sizes as integers: counts and sums to which views can be added and from which they can be removed.

A logarithm is stored in steps of 2**-24 and counted in one of 64 buckets per unit; the width of a bucket is 1.6 per
cent of a length. All views of a bucket count as its mean, so that medians of few views are exact, and the error of
medians of many views is less than a bucket. The storage does not grow with the number of views. The result does not
depend on the order of additions and removals, because nothing is rounded.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

SCALE = 2**24
"""Number of steps per unit of a logarithm."""

BUCKET = 2**18
"""Number of steps per bucket."""

Buckets = Mapping[int, tuple[int, int]]
"""Number of views, and sum of their steps, by bucket."""


def steps(logarithm: float) -> int:
    """Return the nearest step to a logarithm.

    Parameters
    ----------
    logarithm
        Natural logarithm of a size or of a ratio.

    Returns
    -------
    int
        Number of steps of ``1 / SCALE``.
    """
    return round(float(logarithm) * SCALE)


class Distribution:
    """Distribution of the mean values of buckets by their counts; an empty one has no median."""

    def __init__(self, buckets: Buckets) -> None:
        filled = [pair for _, pair in sorted(buckets.items()) if pair[0]]
        self._counts: NDArray[np.int64] = np.array([count for count, _ in filled], dtype=np.int64)
        self._values: NDArray[np.float64] = np.array([total / count / SCALE for count, total in filled])
        self.size = int(self._counts.sum())

    def median(self) -> float:
        """Return the median.

        Returns
        -------
        float
            Median, a natural logarithm. There must be a value.
        """
        return _median(self._values, self._counts)

    def median_deviation(self, centre: float) -> float:
        """Return the median absolute deviation from a value.

        Parameters
        ----------
        centre
            The value: the natural logarithm of a size or of a ratio.

        Returns
        -------
        float
            Median of the distances from ``centre``.
        """
        away = np.abs(self._values - centre)
        order = np.argsort(away, kind="stable")
        return _median(away[order], self._counts[order])

    def deviations(self, centre: float) -> float:
        """Return the sum of absolute deviations from a value.

        Parameters
        ----------
        centre
            The value: the natural logarithm of a size or of a ratio.

        Returns
        -------
        float
            Sum over all values with their counts.
        """
        return float(self._counts @ np.abs(self._values - centre))


def _median(values: NDArray[np.float64], counts: NDArray[np.int64]) -> float:
    """Return the median of sorted values with counts."""
    upto = np.cumsum(counts)
    low, high = np.searchsorted(upto, [(upto[-1] - 1) // 2, upto[-1] // 2], side="right")
    return float(values[low] + values[high]) / 2
