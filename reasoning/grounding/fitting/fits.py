"""Fits what tells whether a description is of a scene: three powers, by right and wrong pairs of the two.

A logistic regression (Platt 1999) without an intercept, since no evidence leaves the prior as it is.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.hypotheses import FitEvidence

Array = NDArray[np.float64]


def fit_powers(pairs: Sequence[FitEvidence], right: NDArray[np.bool_], weights: Array | None = None) -> Array:
    """Return the powers by which facts, what they could say, and kinds weigh, shape (3,), each at least 0.

    Parameters
    ----------
    pairs
        The evidence of n pairs of a description and a scene.
    right
        Whether the description is of the scene, shape (n,).
    weights
        How much each pair counts, shape (n,); by default right and wrong ones count as much in all.

    Raises
    ------
    SettingError
        Where there are not pairs of both sorts.

    Examples
    --------
    >>> told = [FitEvidence(facts, 10.0, 0.0) for facts in (9.0, 8.0, 4.0, 5.0, 1.0, -3.0)]
    >>> powers = fit_powers(told, np.array([True, True, True, False, False, False]))
    >>> bool(powers[0] > powers[1] > 0)
    True
    """
    from scipy.optimize import minimize

    if right.all() or not right.any():
        raise SettingError("powers are fitted to right and wrong pairs: give both")
    design = np.array([(one.facts, -one.most, one.kinds) for one in pairs])
    share = np.where(right, 0.5 / right.sum(), 0.5 / (~right).sum()) if weights is None else weights / weights.sum()

    def loss(powers: Array) -> tuple[float, Array]:
        odds = design @ powers
        said = np.logaddexp(0.0, odds) - right * odds
        return float(share @ said), design.T @ (share * (1 / (1 + np.exp(-np.clip(odds, -500, 500))) - right))

    found = minimize(loss, np.full(3, 0.1), jac=True, method="L-BFGS-B", bounds=[(0.0, 5.0)] * 3)
    powers: Array = found.x
    return powers
