"""Fits what tells whether a description is of a scene: three powers, by right and wrong pairs of the two.

:func:`likeliest_powers` is a logistic regression (Platt 1999) without an intercept, since no evidence leaves the prior
as it is. It takes right and wrong pairs as equally likely, which they are not: a wrong one is to be noticed against a
prior of one in a hundred, and a right one must not be accused. So what is shipped is fitted in three steps, each for
what it does (:func:`fit_powers`): the power of facts as likely as pairs on generated tables make it; what another scene
is granted, as much as leaves at most ``ACCUSED`` of the right tables accused under that prior (the criterion of Neyman
and Pearson 1933); and the power of kinds, which tell nothing on such tables, as likely as photographs make it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.hypotheses import ANOTHER_PRIOR, FitEvidence

Array = NDArray[np.float64]

ACCUSED = 0.02
"""Share of right tables that may be taken for descriptions of another scene: one in fifty."""


def fit_powers(
    tables: Sequence[FitEvidence],
    right: NDArray[np.bool_],
    photographs: Sequence[FitEvidence],
    own: NDArray[np.bool_],
    another: float = ANOTHER_PRIOR,
) -> Array:
    """Return the powers by which facts, what they could say, and kinds weigh, shape (3,), in the steps of the module.

    Parameters
    ----------
    tables, right
        The evidence of pairs of a description and a table, and whether they belong together.
    photographs, own
        The same of photographs.
    another
        Prior probability of another scene.

    Raises
    ------
    SettingError
        Where there are not pairs of both sorts.

    Examples
    --------
    >>> told = [FitEvidence(facts, 10.0, 0.0) for facts in (9.0, 8.0, 4.0, 5.0, 1.0, -3.0)]
    >>> right = np.array([True, True, True, False, False, False])
    >>> fit_powers(told, right, told, right).round(2).tolist()[1:]
    [0.78, 0.0]
    """
    facts = likeliest_powers(tables, right)[0]
    margins = [(facts * one.facts - math.log(another / (1 - another))) / one.most for one in tables if one.most > 0]
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
    """Return the powers under which pairs are as likely to be what they are as can be, shape (3,), each 0 to 5.

    Parameters
    ----------
    pairs
        The evidence of n pairs of a description and a scene.
    right
        Whether the description is of the scene, shape (n,).
    weights
        How much each pair counts, shape (n,); by default right and wrong ones count as much in all.
    held
        The first of the powers, where they are known.

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
        raise SettingError("powers are fitted to right and wrong pairs: give both")
    design = np.array([(one.facts, -one.most, one.kinds) for one in pairs])
    share = np.where(right, 0.5 / right.sum(), 0.5 / (~right).sum()) if weights is None else weights / weights.sum()

    def loss(powers: Array) -> tuple[float, Array]:
        odds = design @ powers
        said = np.logaddexp(0.0, odds) - right * odds
        return float(share @ said), design.T @ (share * (1 / (1 + np.exp(-np.clip(odds, -500, 500))) - right))

    bounds = [(power, power) for power in held] + [(0.0, 5.0)] * (3 - len(held))
    start = np.array([*held, *[0.1] * (3 - len(held))])
    found = minimize(loss, start, jac=True, method="L-BFGS-B", bounds=bounds)
    powers: Array = np.where(design.any(axis=0), found.x, 0.0)  # of what is never told, nothing is known
    return powers
