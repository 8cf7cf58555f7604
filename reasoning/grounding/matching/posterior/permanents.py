"""Sum over all maps of the unary evidence without facts: a permanent of partial maps.

It is the total evidence of kinds, sizes, colours and labels. Up to ``MAX_EXACT`` objects or things, with not too many
on the other side, it is exact, by dynamic programming over subsets of the smaller side (Ryser's problem; Held and Karp
1962). Beyond, belief propagation gives the Bethe approximation of the permanent (Huang and Jebara 2009,
arXiv:0908.1769; Vontobel 2013, IEEE Trans. Inf. Theory 59), corrected by its error for matches without evidence.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.problem import Problem

Array = NDArray[np.float64]

MAX_EXACT, MAX_STEPS = 12, 3e7
"""Maximum size of the smaller side, and maximum number of terms, of an exact sum."""

ITERATIONS, TOLERANCE, MAX_CELLS = 200, 1e-5, 1e7
"""Maximum number of rounds of messages, change of log messages at convergence, and maximum number of messages."""

STEP = 1e-3
"""Step of the power for the numerical derivative."""

LOWEST = -700.0
"""Logarithm used for matches that are not allowed."""


def log_prior(problem: Problem) -> float:
    """Return the log sum over all maps of the exponential of the values of absent objects alone.

    Parameters
    ----------
    problem
        The problem; only the costs of absence and the number of things count.

    Returns
    -------
    float
        Logarithm of the sum, in nats.

    Examples
    --------
    >>> none = np.zeros((0, 2), np.int64)
    >>> problem = Problem(none, none[:, 0], np.zeros((0, 2, 2), np.float32), np.ones((2, 2)), np.zeros(2))
    >>> round(float(np.exp(log_prior(problem))))  # 2 maps that match both, 4 that match one, 1 that matches none
    7
    """
    return _log_prior(problem.absent, problem.unary.shape[1])


def log_sum_without_facts(problem: Problem) -> float:
    """Return the logarithm of the sum over all maps of the exponential of their value without facts.

    Parameters
    ----------
    problem
        The problem; its facts are ignored.

    Returns
    -------
    float
        Logarithm of the sum, in nats: exact for small problems, the corrected Bethe approximation for large ones.

    Examples
    --------
    >>> none = np.zeros((0, 2), np.int64)
    >>> unary = np.log(np.array([[2.0, 1.0], [1.0, 1.0]]))
    >>> problem = Problem(none, none[:, 0], np.zeros((0, 2, 2), np.float32), unary, np.zeros(2))
    >>> round(float(np.exp(log_sum_without_facts(problem))))  # 2 * 1 + 1 * 1, 2 + 1 + 1 + 1, and 1
    9
    """
    n1, n2 = problem.unary.shape
    if problem.allowed.all() and not problem.unary.any():
        return log_prior(problem)
    gains = np.where(problem.allowed, problem.unary - problem.absent[:, None], LOWEST)  # against leaving out
    if min(n1, n2) <= MAX_EXACT and n1 * n2 << min(n1, n2) <= MAX_STEPS:
        total = _by_subsets(gains if n2 <= n1 else gains.T)
    else:
        nothing = np.broadcast_to(-problem.absent[:, None], gains.shape)
        error = _log_prior(problem.absent, n2) - problem.absent.sum() - _bethe(nothing)
        total = _bethe(gains) + error
    return float(total + problem.absent.sum())


def entropy_without_facts(problem: Problem) -> float:
    """Return the entropy in nats of the maps without facts: the logarithm of the effective number of maps.

    It is the log sum minus the mean value of the maps.

    Parameters
    ----------
    problem
        The problem; its facts are ignored.

    Returns
    -------
    float
        Entropy in nats, at least 0.

    Examples
    --------
    >>> none = np.zeros((0, 2), np.int64)
    >>> problem = Problem(none, none[:, 0], np.zeros((0, 3, 3), np.float32), np.zeros((3, 3)), np.full(3, -30.0))
    >>> round(float(np.exp(entropy_without_facts(problem))))  # three things in any order
    6
    """
    return max(0.0, log_sum_without_facts(problem) - mean_without_facts(problem, problem.unary))


def mean_without_facts(problem: Problem, unary: Array) -> float:
    """Return the mean of a part of the value over all maps, weighted by the exponential of their value without facts.

    It is the derivative of the log sum by a power to which the weights of this part are raised.

    Parameters
    ----------
    problem
        The problem of n1 objects and n2 things; its facts are ignored.
    unary
        Part of the evidence of each match, shape (n1, n2); the costs of absence count too.

    Returns
    -------
    float
        Mean in nats.

    Examples
    --------
    >>> none = np.zeros((0, 2), np.int64)
    >>> unary = np.log(np.array([[3.0]]))
    >>> problem = Problem(none, none[:, 0], np.zeros((0, 1, 1), np.float32), unary, np.zeros(1))
    >>> round(float(mean_without_facts(problem, unary) / np.log(3.0)), 6)  # one map of weight 3, one of weight 1
    0.75
    """

    def raised(power: float) -> float:
        more = power - 1.0
        return log_sum_without_facts(
            replace(problem, unary=problem.unary + more * unary, absent=power * problem.absent)
        )

    return (raised(1 + STEP) - raised(1 - STEP)) / (2 * STEP)


def _log_prior(absent: Array, n2: int) -> float:
    matched = np.zeros(1)  # by how many objects are matched, the sum over which they are
    for one in absent.tolist():
        matched = np.logaddexp(np.append(matched + one, -np.inf), np.append(-np.inf, matched))
    k = np.arange(min(len(matched), n2 + 1))
    ways = [math.lgamma(n2 + 1) - math.lgamma(n2 + 1 - matches) for matches in k.tolist()]
    return float(np.logaddexp.reduce(matched[k] + ways))


def _by_subsets(gains: Array) -> float:
    """Return the logarithm of the sum over partial matchings of rows with k columns (n, k), of few columns."""
    k = gains.shape[1]
    above = np.maximum(gains.max(axis=1, initial=0.0), 0.0)
    weights, unmatched = np.exp(gains - above[:, None]), np.exp(-above)
    totals, scale = np.zeros(1 << k), float(above.sum())  # by the set of columns that are taken, times exp(scale)
    totals[0] = 1.0
    for row, alone in zip(weights.tolist(), unmatched.tolist(), strict=True):
        following = alone * totals
        for column, weight in enumerate(row):
            free, taken = totals.reshape(-1, 2, 1 << column)[:, 0], following.reshape(-1, 2, 1 << column)[:, 1]
            taken += weight * free
        most = float(following.max())
        totals = following / most
        scale += math.log(most)
    return float(np.log(totals.sum())) + scale


def _bethe(gains: Array) -> float:
    """Return the Bethe approximation of the log sum over partial matchings: minus the free energy at convergence."""
    wanted = np.zeros_like(gains)  # log message of each thing to each object: how free it is
    for _ in range(int(np.clip(MAX_CELLS / max(gains.size, 1), 1, ITERATIONS))):
        offers = gains - _sum_of_others(gains + wanted)
        following = -_sum_of_others(offers.T).T
        change = np.abs(following - wanted).max(initial=0.0)
        wanted = (wanted + following) / 2
        if change < TOLERANCE:
            break
    offers = gains - _sum_of_others(gains + wanted)
    rows = np.logaddexp(0.0, np.logaddexp.reduce(gains + wanted, axis=1)).sum()
    columns = np.logaddexp(0.0, np.logaddexp.reduce(offers, axis=0)).sum()
    return float(rows + columns - np.logaddexp(0.0, offers + wanted).sum())


def _sum_of_others(terms: Array) -> Array:
    """Return log(1 + the sum of the exponentials of the other terms of the row), shape (n, k)."""
    most = np.maximum(terms.max(axis=1, keepdims=True), 0.0)
    weights = np.exp(terms - most)
    result: Array = most + np.log(np.maximum(np.exp(-most) + weights.sum(axis=1, keepdims=True) - weights, 1e-300))
    return result
