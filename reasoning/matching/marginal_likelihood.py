"""Whether a problem's evidence speaks for its objects being among its things at all."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import gammaln

from deixis.reasoning.matching.posterior import FACTOR_CELLS
from deixis.reasoning.matching.problem import Problem
from deixis.reasoning.matching.summing import add_up, factors

LEFT_OUT = (1e-3, 1e-5, 1e-7, 1e-10, 1e-15, 1e-25)
"""Shares of the most that all maps can sum up to, below which partial maps are not looked into, one after another."""

NEAR = 0.01
"""The share of a sum that may be missing of it for the bound to be near enough."""

NODES = 5_000
"""Partial maps that are looked at for each share at the most."""


def log_marginal_likelihood(problem: Problem) -> float:
    """At most by how much likelier, in nats, the evidence is than by chance, over all maps by what leaving out costs.

    An upper bound: what the search turns back from counts in full. Infinite where there is no object or no thing, and
    for a problem that is too large for the sum.

    >>> ends, nothing = np.zeros((0, 2), np.int64), np.zeros((0, 1, 1), np.float32)
    >>> alone = Problem(ends, ends[:, 0], nothing, np.array([[-2.0]]), np.array([-9.0]))
    >>> round(log_marginal_likelihood(alone), 2)
    -2.0
    """
    n1, n2 = problem.unary.shape
    slots = len(problem.compiled.kind)
    if not n1 or not n2 or slots * (n2 + 1) ** 2 > FACTOR_CELLS:
        return math.inf
    parts = factors(problem.compiled)
    most = least = float(np.log(parts.weights.sum(axis=1)).sum())
    for share in LEFT_OUT:
        _, (found, missing, _) = add_up(problem.compiled, parts, share * math.exp(min(most, 600.0)), NODES)
        if missing == math.inf:
            break
        least = min(least, math.log(max(found + missing, 1e-300)))
        if missing <= NEAR * found:
            break
    return least + parts.log_scale - _log_prior(problem)


def _log_prior(problem: Problem) -> float:
    """The logarithm of the sum over all maps of what is left out alone."""
    n2 = problem.unary.shape[1]
    matched = np.zeros(1)  # by how many objects are matched, the sum over which they are
    for absent in problem.absent.tolist():
        matched = np.logaddexp(np.append(matched + absent, -np.inf), np.append(-np.inf, matched))
    k = np.arange(min(len(matched), n2 + 1))
    return float(np.logaddexp.reduce(matched[k] + gammaln(n2 + 1) - gammaln(n2 - k + 1)))
