"""Fit the weights of :mod:`deixis.reasoning.grounding.matching.posterior.coincidences` to tables with known truth.

The score of a table is the mean log-probability of the truth, which makes all probabilities right, plus
``DECISION_WEIGHT`` times the mean worth of the decisions: 1 for a decided match that is right, ``-WRONG_COST`` for a
wrong one, 0 for an undecided one. The second part is there because the likelihood hardly depends on probabilities above
0.99, and *decided* depends on nothing else. Settings (sizes, shares of missing objects) have equal weights, however
many tables each has.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.matching.posterior.coincidences import SHIPPED_WEIGHTS, Coincidences, CoincidenceWeights
from deixis.reasoning.grounding.options import DECIDED, DECIDED_LOWER_BOUND

Array = NDArray[np.float64]

DECISION_WEIGHT, WRONG_COST = 0.5, 40.0
"""Weight of the decisions in the score, and the number of right decided matches that a wrong one costs."""

SHARPNESS = 4.0
"""Slope of the smoothed decision, per nat of the log-odds of a match."""

MIN_PROBABILITY = 1e-4
"""Minimum probability of the truth in the score, so that single errors of the search do not determine the fit."""


@dataclass(frozen=True, eq=False)
class JudgedTable:
    """Posterior of a table of n1 objects beside the truth.

    Attributes
    ----------
    found
        Possible coincidences of the objects.
    right
        Whether the most probable thing is the object, shape (n1,).
    missing
        Whether the object is absent from the table, shape (n1,).
    of_truth
        Probability of the thing that the object is, shape (n1,); unused where it is missing.
    errors
        Errors of the probabilities, shape (n1,).
    """

    found: Coincidences
    right: NDArray[np.bool_]
    missing: NDArray[np.bool_]
    of_truth: Array
    errors: Array

    def score(self, weights: CoincidenceWeights) -> float:
        """Return the score of the table with some weights.

        Parameters
        ----------
        weights
            Weights of the misfit and of the alternatives.

        Returns
        -------
        float
            Mean log probability of the true matches in nats, plus the weighted worth of the decisions; more is better.
        """
        remaining = self.found.remaining(weights)
        absent = 1.0 - (1.0 - self.found.absent) * remaining
        of_truth = np.where(self.missing, absent, self.of_truth * remaining)
        probability = np.clip(self.found.probability * remaining, 1e-12, 1 - 1e-12)
        margin = np.log(probability / (1 - probability)) - math.log(DECIDED / (1 - DECIDED))
        decided = (self.errors <= DECIDED - DECIDED_LOWER_BOUND) / (1 + np.exp(-SHARPNESS * margin))
        gains = decided * np.where(self.right, 1.0, -WRONG_COST)
        return float(np.log(np.maximum(of_truth, MIN_PROBABILITY)).mean() + DECISION_WEIGHT * gains.mean())


def fit_coincidences(settings: Sequence[Sequence[JudgedTable]], iterations: int = 200) -> CoincidenceWeights:
    """Fit the weights to tables, which are grouped by settings.

    Parameters
    ----------
    settings
        Tables of each setting.
    iterations
        Maximum number of steps of the search (Nelder and Mead 1965).

    Returns
    -------
    CoincidenceWeights
        The weights with the highest mean score, in which each setting counts the same.

    Raises
    ------
    SettingError
        There are no tables.
    """
    from scipy.optimize import minimize

    if not settings or not all(settings):
        raise SettingError("`settings` must have at least one table each; generate some")
    start = np.array([math.log(factor_or_power) for factor_or_power in SHIPPED_WEIGHTS])

    def loss(logs: Array) -> float:
        weights = CoincidenceWeights(*np.exp(np.clip(logs, -20.0, 5.0)).tolist())
        return -float(np.mean([np.mean([table.score(weights) for table in tables]) for tables in settings]))

    corners = np.vstack([start, start + np.diag([1.0, 0.4, 1.0, 0.3])])
    options = {"maxiter": iterations, "xatol": 0.02, "fatol": 1e-5, "initial_simplex": corners}
    found = minimize(loss, start, method="Nelder-Mead", options=options)
    return CoincidenceWeights(*np.exp(np.clip(found.x, -20.0, 5.0)).tolist())
