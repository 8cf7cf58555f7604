"""How recognition is set up; by default not quite as in the paper, which :data:`PAPER` is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.index import Effort
from deixis.perception.recognition.spread import PRIOR_SPREADS

SHRINKAGE = 30.0
"""Things that the median ICD counts for. From fewer things a category's own width says little, and a wide category that
is divided by its width swallows views of all others (docs/explanation/open_ended.md)."""

MIN_LABEL_PROBABILITY = 0.6
"""Probability from which a name is said; below it there are candidates, and no label."""


@dataclass(frozen=True)
class RecognitionSettings:
    """``exact_up_to``: with more views than that the search is approximate, with ``effort``.

    What equation 4 divides by (:mod:`deixis.perception.recognition.spread`): with ``over_things`` equation 3 is a mean
    over pairs of views of different things, else over all pairs; it is drawn to the median one of all categories as if
    that came from ``shrinkage`` things (0: it stays as it is). ``prior_spread`` stands in while no category has an ICD;
    the default is for spin images, and ``PRIOR_SPREADS`` has those of other descriptors.

    ``prior_unknown`` is the share of things seen that are of no category. With ``by_threshold`` the nearest category is
    the answer where its ND is not above the calibration's threshold, as in the paper; else where its probability is
    ``MIN_LABEL_PROBABILITY`` or more.
    """

    exact_up_to: int = 20_000
    effort: Effort = Effort()  # noqa: RUF009 (frozen)
    over_things: bool = True
    shrinkage: float = SHRINKAGE
    prior_spread: float = PRIOR_SPREADS["spin_images"]
    prior_unknown: float = 0.5
    by_threshold: bool = False

    def __post_init__(self) -> None:
        if not (np.isfinite(self.prior_spread) and self.prior_spread > 0):
            raise RecognitionError(f"the prior spread is a distance above 0, not {self.prior_spread}")
        if not 0.0 <= self.shrinkage < np.inf:
            raise RecognitionError(f"an ICD is shrunk by 0 things or more, not {self.shrinkage:g}")

    def effort_among(self, views: int) -> Effort | None:
        """Return what is spent on the search among so many views of all categories; None: it is exact."""
        return None if views <= self.exact_up_to else self.effort


DEFAULT = RecognitionSettings()

PAPER = RecognitionSettings(over_things=False, shrinkage=0.0, by_threshold=True)
"""Equations 3 and 4 as they stand, wherever they are defined, and the threshold of ND."""
