"""Compute means with intervals, and the significance of differences over the same cases."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

RESAMPLES = 9_999
LEVEL = 0.95


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean over independent cases and half the width of its t interval (nan for a single case)."""

    mean: float
    half: float
    count: int

    def __str__(self) -> str:
        return f"{self.mean:.2f}±{self.half:.2f}"


def interval(values: Sequence[float] | NDArray[np.float64]) -> Interval:
    """Return the mean of the known values (not nan), with its 95 per cent interval by Student's t.

    Parameters
    ----------
    values
        Figures of independent cases; nan stands for an unknown one.

    Returns
    -------
    Interval
        Mean, half width (nan for fewer than two known values) and number of known values.

    Notes
    -----
    Student, "The probable error of a mean", Biometrika 6, 1908.

    Examples
    --------
    >>> found = interval([0.0, 1.0, 1.0])
    >>> round(found.mean, 3), round(found.half, 3), found.count
    (0.667, 1.434, 3)
    """
    from scipy.stats import t

    known = np.asarray(values, dtype=float)
    known = known[~np.isnan(known)]
    if len(known) == 0:
        return Interval(float("nan"), float("nan"), 0)
    half = float("nan")
    if len(known) > 1:
        half = float(t.ppf((1 + LEVEL) / 2, len(known) - 1) * known.std(ddof=1) / np.sqrt(len(known)))
    return Interval(float(known.mean()), half, len(known))


def paired_p(differences: Sequence[float] | NDArray[np.float64], seed: int) -> float:
    """Return the two-sided p of a paired permutation test: how often random signs give a mean as far from 0.

    All signs are tried if there are few of them, otherwise 9,999 random ones.

    Parameters
    ----------
    differences
        Differences of paired cases; differences of 0 are left out.
    seed
        Seed of the random signs.

    Returns
    -------
    float
        p in [0, 1]; 1 for fewer than two differences.

    Examples
    --------
    >>> paired_p([0.1] * 6, seed=0)
    0.03125
    """
    from scipy.stats import permutation_test

    known = np.asarray(differences, dtype=float)
    known = known[np.abs(known) > 1e-12]  # a sign does not change 0
    if len(known) < 2:
        return 1.0
    found = permutation_test(
        (known,),
        np.mean,
        permutation_type="samples",
        vectorized=True,
        n_resamples=RESAMPLES,
        batch=1000,
        rng=np.random.default_rng(seed),
    )
    return float(found.pvalue)


def holm(ps: Sequence[float]) -> list[float]:
    """Return the p values adjusted for their number (Holm 1979), in the order given.

    Parameters
    ----------
    ps
        p values of the comparisons.

    Returns
    -------
    list of float
        Adjusted values, at most 1.

    Examples
    --------
    >>> [round(p, 3) for p in holm([0.01, 0.04, 0.03])]
    [0.03, 0.06, 0.06]
    """
    order = np.argsort(ps, kind="stable")
    adjusted = np.empty(len(order))
    least = 0.0
    for rank, index in enumerate(order):
        least = max(least, min(1.0, (len(order) - rank) * ps[index]))
        adjusted[index] = least
    return adjusted.tolist()
