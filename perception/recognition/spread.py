"""What equation 4 divides by, where equation 3 gives nothing to divide by.

Equation 3 is undefined for one view and zero for identical ones. Then the category is taken to be as wide as others
are: the median ICD of the categories that have one. Where none has, a shipped constant stands in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType

import numpy as np

FLOOR = 0.05
"""An ICD below this share of the median one is no measure of a category's width: its views are copies of each other."""

PRIOR_SPREADS: Mapping[str, float] = MappingProxyType(
    {"spin_images": 0.106, "spin_image_roots": 0.36, "fpfh": 48.8, "good": 0.245, "d2_extents": 0.0473}
)
"""By a descriptor's name, with its default settings: the median ICD of 16 kinds of simulated tableware, six things of
each, two views of each thing. Roots of spin images: of a support of 0.2, keypoints 2.5 cm apart."""


class SpreadSource(StrEnum):
    """Where the number comes from that D_C is divided by."""

    MEASURED = "measured"  # equation 3
    POOLED = "pooled"  # the median of the other categories' ICD
    PRIOR = "prior"  # a constant


@dataclass(frozen=True)
class Spread:
    """What stands for a category's ICD, above 0, and where it comes from."""

    value: float
    source: SpreadSource


def spreads(measured: Sequence[float | None], prior: float) -> list[Spread]:
    """The spread of each category from its ICD (None: fewer than two views).

    >>> [spread.value for spread in spreads([2.0, None, 0.0, 4.0], prior=1.0)]
    [2.0, 3.0, 3.0, 4.0]
    >>> spreads([None], prior=1.0)
    [Spread(value=1.0, source=<SpreadSource.PRIOR: 'prior'>)]
    """
    wide = [value for value in measured if value is not None and value > 0]
    if not wide:
        return [Spread(prior, SpreadSource.PRIOR)] * len(measured)
    pooled = float(np.median(wide))
    fallback = Spread(pooled, SpreadSource.POOLED)
    return [
        fallback if value is None or value < FLOOR * pooled else Spread(value, SpreadSource.MEASURED)
        for value in measured
    ]
