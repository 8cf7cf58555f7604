"""The divisor of equation 4: the spread of a category's views.

Equation 3, the intra-category distance (ICD), is the mean of D_V over pairs of views of a category. Views of one thing
are near each other, whatever other things have its name, so that the ICD of many views of few things depends mostly on
the number of things. By default the mean is therefore over pairs of views of different things. The ICD of few things is
still unreliable, and a category that is divided by a large ICD attracts the views of all others: the ICD is therefore
shrunk towards the median of all categories.

Equation 3 is undefined for one view (or thing), and 0 for identical ones. Then the median of the other categories is
used, or a shipped constant if no category has an ICD.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

MIN_ICD_SHARE = 0.05
"""Minimum ratio of an ICD to the median ICD; below it a category's views are copies of each other."""

PRIOR_SPREADS: Mapping[str, float] = MappingProxyType(
    {
        "spin_images": 0.108,
        "spin_image_roots": 0.384,
        "upright": 0.465,
        "form": 1.05,
        "colour": 0.195,
        "fpfh": 49.5,
        "good": 0.249,
        "d2_extents": 0.0495,
    }
)
"""Median ICD by descriptor, with default settings, over 16 kinds of simulated tableware, six things of each kind and
two views of each thing (benchmarks/bench_recognition.py --constants); for colour, over the things found on six laid
tables. The roots of spin images are those of :data:`deixis.learning.views.views.SPIN_IMAGE_ROOTS`."""


@dataclass(frozen=True)
class Width:
    """Intra-category distance (ICD) of a category, None if undefined, and the number of things (or views) in it."""

    icd: float | None
    count: int
    over_things: bool = True

    @classmethod
    def of(cls, distances: NDArray[np.floating], things: NDArray[np.int64] | None = None) -> Width:
        """Return the width of a category from the distances between its views.

        Parameters
        ----------
        distances
            D_V between n views, shape (n, n).
        things
            Number of the thing that each view shows, shape (n,). Without it, the mean is over all pairs of views, as in
            equation 3.

        Returns
        -------
        Width
            Mean distance between views of different things; None if there is only one.

        Examples
        --------
        >>> distances = np.array([[0.0, 1.0, 4.0], [1.0, 0.0, 6.0], [4.0, 6.0, 0.0]])
        >>> Width.of(distances, np.array([0, 0, 1])).icd, round(Width.of(distances).icd, 2)
        (5.0, 3.67)
        """
        shown = np.arange(len(distances)) if things is None else things
        apart = shown[:, None] != shown
        pairs = int(apart.sum())
        total = float(np.sum(distances, where=apart, dtype=np.float64))
        return cls(total / pairs if pairs else None, len(np.unique(shown)), things is not None)


class SpreadSource(StrEnum):
    """Source of the divisor of the distance D_C (equation 4)."""

    MEASURED = "measured"  # equation 3
    SHRUNK = "shrunk"  # equation 3, shrunk towards the median of all categories
    POOLED = "pooled"  # the median of all categories
    PRIOR = "prior"  # a constant


@dataclass(frozen=True)
class Spread:
    """Divisor of the distance D_C (equation 4), above 0, with its source and the category's own width."""

    value: float
    source: SpreadSource
    width: Width


def spreads(widths: Sequence[Width], prior: float, shrinkage: float = 0.0) -> list[Spread]:
    """Return the spread of each category: its intra-category distance, shrunk, (n ICD + s M) / (n + s).

    n is the category's number of things, M the median ICD of all categories, and s the shrinkage.

    Parameters
    ----------
    widths
        Width of each category.
    prior
        Spread if no category has an ICD.
    shrinkage
        Number s of things that the median is worth.

    Returns
    -------
    list of Spread
        Spreads in the order of the widths, each with its source.

    Examples
    --------
    >>> widths = [Width(1.0, 5), Width(3.0, 5), Width(8.0, 15), Width(None, 1)]
    >>> [spread.value for spread in spreads(widths, prior=1.0)]
    [1.0, 3.0, 8.0, 3.0]
    >>> [spread.value for spread in spreads(widths, prior=1.0, shrinkage=5.0)]
    [2.0, 3.0, 6.75, 3.0]
    """
    wide = [width.icd for width in widths if width.icd is not None and width.icd > 0]
    if not wide:
        return [Spread(prior, SpreadSource.PRIOR, width) for width in widths]
    median = float(np.median(wide))
    return [_spread(width, median, shrinkage) for width in widths]


def _spread(width: Width, median: float, shrinkage: float) -> Spread:
    if width.icd is None or width.icd < MIN_ICD_SHARE * median:
        return Spread(median, SpreadSource.POOLED, width)
    if not shrinkage:
        return Spread(width.icd, SpreadSource.MEASURED, width)
    value = (width.count * width.icd + shrinkage * median) / (width.count + shrinkage)
    return Spread(value, SpreadSource.SHRUNK, width)
