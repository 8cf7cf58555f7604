"""Settings of recognition; the defaults differ from the paper, whose settings are :data:`PAPER`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.index import Effort
from deixis.perception.recognition.spread import PRIOR_SPREADS

SHRINKAGE = 30.0
"""Number of things that the median ICD counts as. The ICD of fewer things is unreliable, and a wide category that is
divided by its own ICD attracts the views of all others (docs/explanation/open_ended.md)."""

MIN_LABEL_PROBABILITY = 0.6
"""Minimum probability of a label; below it an answer has candidates, but no label."""


@dataclass(frozen=True)
class RecognitionSettings:
    """Settings of recognition.

    Parameters
    ----------
    exact_up_to
        Maximum number of views that are searched exactly; more are searched approximately, with ``effort``.
    effort
        Effort of the approximate search.
    over_things
        Take the mean of equation 3 over pairs of views of different things, instead of all pairs
        (:mod:`deixis.perception.recognition.spread`).
    shrinkage
        Number of things that the median ICD of all categories counts as when a category's ICD is shrunk towards it; 0
        for no shrinkage.
    prior_spread
        Divisor of equation 4 while no category has an ICD. The default is for spin images; ``PRIOR_SPREADS`` has those
        of other descriptors.
    prior_unknown
        Share of the things seen that belong to no category.
    by_threshold
        Answer with the nearest category if its ND is not above the calibration's threshold, as in the paper, instead of
        if its probability is at least ``MIN_LABEL_PROBABILITY``.
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
            raise RecognitionError(f"`prior_spread` must be a distance above 0, got {self.prior_spread}")
        if not 0.0 <= self.shrinkage < np.inf:
            raise RecognitionError(f"`shrinkage` must be at least 0 things, got {self.shrinkage:g}")

    def effort_among(self, views: int) -> Effort | None:
        """Return the effort of the search among a number of views; None for an exact search.

        Parameters
        ----------
        views
            Number of views of all categories.

        Returns
        -------
        Effort or None
            Effort if there are more than ``exact_up_to`` views.
        """
        return None if views <= self.exact_up_to else self.effort


DEFAULT = RecognitionSettings()

PAPER = RecognitionSettings(over_things=False, shrinkage=0.0, by_threshold=True)
"""Settings of the paper: equations 3 and 4 wherever they are defined, and the threshold of ND."""
