"""Fit the three powers of the evidence that a description is of a scene to right and wrong pairs of the two.

:func:`likeliest_powers` is a logistic regression (Platt 1999) without an intercept, because no evidence leaves the
prior unchanged. It treats right and wrong pairs as equally likely. In use, a wrong pair has a prior of one in a
hundred, and right pairs must not be rejected. So the shipped powers are fitted in three steps (:func:`fit_powers`): the
power of facts by maximum likelihood on generated tables; that of chance (C there), so that at most ``ACCUSED`` of the
right tables are rejected under that prior (the criterion of Neyman and Pearson 1933); and the power of kinds, which do
not matter on such tables, by maximum likelihood on photographs.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.hypotheses.hypotheses import ANOTHER_PRIOR, FitEvidence

Array = NDArray[np.float64]

ACCUSED = 0.02
"""Maximum share of right tables that are taken for descriptions of another scene."""


def fit_powers(
    tables: Sequence[FitEvidence],
    right: NDArray[np.bool_],
    photographs: Sequence[FitEvidence],
    own: NDArray[np.bool_],
) -> Array:
    """Fit the powers of facts, of chance, and of kinds, shape (3,), in the three steps of this module.

    Parameters
    ----------
    tables, right
        Evidence of pairs of a description and a table, and whether they belong together.
    photographs, own
        Evidence of pairs of a description and a photograph, and whether they belong together.

    Returns
    -------
    ndarray
        Powers of facts, of chance, and of kinds, shape (3,).

    Raises
    ------
    SettingError
        Where there are not pairs of both sorts.

    Examples
    --------
    >>> told = [FitEvidence(facts, 10.0, 0.0) for facts in (9.0, 8.0, 4.0, 5.0, 1.0, -3.0)]
    >>> right = np.array([True, True, True, False, False, False])
    >>> fit_powers(told, right, told, right).round(2).tolist()[1:]
    [0.59, 0.0]
    """
    facts = likeliest_powers(tables, right)[0]
    prior_odds = math.log(ANOTHER_PRIOR / (1 - ANOTHER_PRIOR))
    margins = [(facts * one.facts - prior_odds) / one.chance for one in tables if one.most > 0]
    of_right = [fits for fits, one in zip(right, tables, strict=True) if one.most > 0]
    chance = max(0.0, float(np.quantile(np.array(margins)[of_right], ACCUSED)))
    kinds = likeliest_powers(photographs, own, held=(facts, chance))[2]
    return np.array([facts, chance, kinds])


def likeliest_powers(
    pairs: Sequence[FitEvidence],
    right: NDArray[np.bool_],
    weights: Array | None = None,
    held: tuple[float, ...] = (),
) -> Array:
    """Return the powers of maximum likelihood for right and wrong pairs, shape (3,), each in [0, 5].

    Parameters
    ----------
    pairs
        Evidence of n pairs of a description and a scene.
    right
        Whether the description is of the scene, shape (n,).
    weights
        Weight of each pair, shape (n,); by default, right and wrong pairs have the same total weight.
    held
        Known values of the first powers.

    Returns
    -------
    ndarray
        Powers of facts, of chance, and of kinds, shape (3,).

    Raises
    ------
    SettingError
        Where there are not pairs of both sorts.

    Examples
    --------
    >>> told = [FitEvidence(facts, 10.0, 0.0) for facts in (9.0, 8.0, 4.0, 5.0, 1.0, -3.0)]
    >>> powers = likeliest_powers(told, np.array([True, True, True, False, False, False]))
    >>> bool(powers[0] > powers[1] > 0)
    True
    """
    from scipy.optimize import minimize

    if right.all() or not right.any():
        raise SettingError("`right` must have right and wrong pairs; give both")
    design = np.array([one.terms for one in pairs])
    share = np.where(right, 0.5 / right.sum(), 0.5 / (~right).sum()) if weights is None else weights / weights.sum()

    def loss(powers: Array) -> tuple[float, Array]:
        odds = design @ powers
        losses = np.logaddexp(0.0, odds) - right * odds
        return float(share @ losses), design.T @ (share * (1 / (1 + np.exp(-np.clip(odds, -500, 500))) - right))

    bounds = [(power, power) for power in held] + [(0.0, 5.0)] * (3 - len(held))
    start = np.array([*held, *[0.1] * (3 - len(held))])
    found = minimize(loss, start, jac=True, method="L-BFGS-B", bounds=bounds)
    powers: Array = np.where(design.any(axis=0), found.x, 0.0)  # 0 for evidence that is 0 in all pairs
    return powers
