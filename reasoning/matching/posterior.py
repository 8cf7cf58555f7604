"""How probable every match is: from all maps that count where they can be listed, else from samples, which says so.

The probability of a map is proportional to the exponential of its value. The listing is complete to a stated mass: with
N maps in all, those worth less than the best by log(N / mass) or more have less than that mass together. Where there
are too many maps for that, Markov chains exchange the things of two objects (Metropolis et al. 1953), from independent
starts, and what the chains disagree by is the stated error.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.matching.compiled import compile_problem
from deixis.reasoning.matching.exact import maps_within
from deixis.reasoning.matching.problem import UNMATCHED, MatchingError, Problem
from deixis.reasoning.matching.sampling import sample
from deixis.reasoning.matching.scalable import search_from

CHAINS = 8
SWEEPS = 4000  # proposals for every object and chain; the first quarter is left out
SHARE = 0.5  # of the time that the listing may take


@dataclass(frozen=True, eq=False)
class Posterior:
    """``marginals`` (n1, n2 + 1): the probability of each thing for each object; last, of its being left out.

    ``error``: at most so much mass is missing where ``exact``; otherwise the largest standard error of a marginal over
    the chains, which is no guarantee.
    """

    marginals: NDArray[np.float64]
    exact: bool
    error: float

    @property
    def entropy(self) -> NDArray[np.float64]:
        """Of each object's marginal, in nats, shape (n1,): 0 where it is certain."""
        p = self.marginals
        logs = np.log(p, out=np.zeros_like(p), where=p > 0)
        entropy: NDArray[np.float64] = np.maximum(0.0, -(p * logs).sum(axis=1))
        return entropy


def posterior(
    problem: Problem, deadline: float = math.inf, *, mass: float = 1e-6, limit: int = 10_000, seed: int = 0
) -> Posterior:
    """The posterior over maps by its marginals, until ``deadline`` (``time.perf_counter``).

    It is exact to ``mass`` where at most ``limit`` maps are within the margin which that takes, and sampled otherwise.
    Raises MatchingError for a mass that is not between 0 and 1.

    >>> problem = Problem(np.zeros((0, 2), np.int64), np.zeros(0, np.int64), np.zeros((0, 1, 1), np.float32),
    ...                   np.array([[np.log(3.0)]]), np.zeros(1))
    >>> found = posterior(problem)
    >>> found.marginals.round(3).tolist(), found.exact
    ([[0.75, 0.25]], True)
    """
    if not 0 < mass < 1:
        raise MatchingError(f"the mass that may be missing lies between 0 and 1, not at {mass}")
    n1, n2 = problem.unary.shape
    if n1 == 0 or n2 == 0:
        return Posterior(np.ones((n1, 1)) if n2 == 0 else np.zeros((0, n2 + 1)), exact=True, error=0.0)
    choices = (~np.isneginf(problem.unary)).sum(axis=1) + 1
    margin = float(np.log(choices).sum() - math.log(mass))
    now = time.perf_counter()
    maps = maps_within(problem, margin, now + SHARE * (deadline - now), limit=limit)
    if not maps.complete:
        return _sampled(problem, deadline, seed)
    weights = np.exp(maps.values - maps.values[0])
    return Posterior(_marginals(maps.assignments, weights / weights.sum(), n2), exact=True, error=mass)


def _marginals(assignments: NDArray[np.int64], weights: NDArray[np.float64], n2: int) -> NDArray[np.float64]:
    marginals = np.zeros((assignments.shape[1], n2 + 1))
    labels = np.where(assignments == UNMATCHED, n2, assignments)
    for i in range(assignments.shape[1]):
        np.add.at(marginals[i], labels[:, i], weights)
    return marginals


def _sampled(problem: Problem, deadline: float, seed: int) -> Posterior:
    compiled = compile_problem(problem)
    n1, n2 = problem.unary.shape
    chains = []
    for chain in range(CHAINS):
        labels, _ = search_from(np.full(n1, n2), compiled, deadline, seed + chain, 0.1, 1)
        counts = np.zeros((n1, n2 + 1))
        for part in range(20):
            if part == 5:
                counts[:] = 0.0
            sample(labels, counts, compiled, SWEEPS * n1 // 20, seed + 1000 * part + chain)
            if time.perf_counter() > deadline:
                break
        chains.append(counts / counts.sum(axis=1, keepdims=True))
        if time.perf_counter() > deadline:
            break
    error = np.std(chains, axis=0, ddof=1).max() / math.sqrt(len(chains)) if len(chains) > 1 else math.inf
    return Posterior(np.mean(chains, axis=0), exact=False, error=float(error))
