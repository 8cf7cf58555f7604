"""What equation 4 divides by: how far apart views of a category lie.

Equation 3, the ICD, is the mean of D_V over pairs of views of a category. Views of one thing are near each other
whatever else bears its name, so that many views of few things make the ICD a measure of how many things there are. By
default the mean is therefore over pairs of views of different things. From few things it is still mostly chance, and a
category that is divided by a large ICD swallows views of all others: it is drawn to the median of all categories.

Equation 3 is undefined for one view (or thing) and zero for identical ones. Then the category is taken to be as wide as
others are: the median. Where none has an ICD, a shipped constant stands in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

MIN_ICD_SHARE = 0.05
"""An ICD below this share of the median one is no measure of a category's width: its views are copies of each other."""

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
"""By a descriptor's name, with its default settings: the median ICD over things of 16 kinds of simulated tableware, six
things of each, two views of each thing (benchmarks/bench_recognition.py --constants), by colour over what is found on
six laid tables. Roots of spin images are those of :data:`deixis.learning.views.SPIN_IMAGE_ROOTS`."""


@dataclass(frozen=True)
class Width:
    """A category's ICD, None where it is undefined, and the number of things (or views) that it is taken over."""

    icd: float | None
    count: int
    over_things: bool = True

    @classmethod
    def of(cls, distances: NDArray[np.floating], things: NDArray[np.int64] | None = None) -> Width:
        """Return from D_V (n, n) between views; ``things`` (n,) are numbers of what they show. None: equation 3 as it
        stands.

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
    """Where the number comes from that D_C is divided by."""

    MEASURED = "measured"  # equation 3
    SHRUNK = "shrunk"  # equation 3, drawn to the median of all categories
    POOLED = "pooled"  # that median
    PRIOR = "prior"  # a constant


@dataclass(frozen=True)
class Spread:
    """What D_C is divided by, above 0, where it comes from, and the category's own width."""

    value: float
    source: SpreadSource
    width: Width


def spreads(widths: Sequence[Width], prior: float, shrinkage: float = 0.0) -> list[Spread]:
    """Return the spread of each category: (n ICD + s M) / (n + s), M being the median ICD, n things and s the
    shrinkage.

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
