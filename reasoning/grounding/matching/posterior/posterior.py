"""Posterior of matches: by enumeration where few maps matter, else by sampling.

The probability of a map is proportional to the exponential of its value. The sum over all maps is exact up to a stated
missing mass (``enumeration.py``). Cheap sums with a larger missing mass show whether the exact sum is feasible.
Otherwise, maps are drawn by ladders of Markov chains (``ladders.py``), and the difference of independent ladders is the
error of each object's marginals. Exchangeable objects have the same marginals, so that no chain has to visit all of
their orders.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.posterior.enumeration import add_up, factors
from deixis.reasoning.grounding.matching.posterior.exchangeable import averaged, exchangeable
from deixis.reasoning.grounding.matching.posterior.ladders import sampled_marginals
from deixis.reasoning.grounding.matching.posterior.sampling import map_value
from deixis.reasoning.grounding.matching.posterior.starts import starts_of
from deixis.reasoning.grounding.matching.problem import (
    MAX_PLACES,
    MIN_PLACES,
    MatchingError,
    Problem,
    to_assignment,
    to_labels,
)
from deixis.reasoning.grounding.matching.search.belief_propagation import belief_seconds, likeliest_map
from deixis.reasoning.grounding.matching.search.coarse_to_fine import is_large
from deixis.reasoning.grounding.matching.search.scalable import search_from

Marginals = NDArray[np.float64]

THRESHOLDS = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)  # share of the best map's weight below which maps are left out
NODE_GROWTH, ERROR_FALL = 5.0, 15.0  # approximate factors of nodes and error from one threshold to the next
SMALL_SEARCH_RATIO = 100  # a search with fewer nodes than the maximum over this ratio is not extrapolated
SUM_CELLS, FACTOR_CELLS = 6e7, 4e6  # maximum work of sums, and cells of facts; beyond, maps are sampled

MIN_PLACED_THINGS = 50
"""Minimum number of things for which absent objects have places: in small scenes they cost more than they decide."""

SECONDS_PER_PLACE, PLACES_SHARE = 3.3e-7, 0.3
"""Approximate seconds for the evidence of a place of absent objects, per table and thing; and share of the time that
all places may take. Where the time is short there are fewer places, and none where there would be fewer than the
minimum number."""

START_EFFORT = 0.1  # effort of the search for a first map

BOUND_CELLS, BOUND_WORK = 4e5, 1e6  # maximum cells of facts, and work per share, of a bound of the sum
BOUND_SHARES = (3e-3, 1e-4)  # shares of the sufficient bound below which partial maps are not extended
LOWEST_LOG = -600.0  # logarithm above which numbers are safely distinct from 0


@dataclass(frozen=True, eq=False)
class Posterior:
    """Posterior of the matches of n1 objects and n2 things.

    Attributes
    ----------
    marginals
        Probability of each thing for each object and, in the last column, of its absence, shape (n1, n2 + 1).
    exact
        Whether the marginals are exact up to ``error``.
    error
        Upper bound of the missing mass where ``exact``; otherwise the largest of ``errors``, infinite where ladders
        were not compared.
    errors
        Error of each object's marginals, shape (n1,), estimated from independent ladders without a guarantee; by
        default, ``error`` for all.
    is_propagated
        Whether the marginals are from belief propagation alone, so that their error is unknown.
    log_total
        Logarithm of the sum of the exponentials of all maps' values; nan where it is unknown.
    absent_counted
        Whether the number of absent objects was estimated by their places, so that coincidences do not estimate it
        again.
    likeliest
        In a sampled large scene, the most valuable known map by the model with the places of absent objects: the map
        from which the search for the posterior started, or that with the largest product of marginals; shape (n1,),
        with ``UNMATCHED`` for absent objects. None elsewhere.
    """

    marginals: Marginals
    exact: bool
    error: float
    errors: NDArray[np.float64] = field(default_factory=lambda: np.array(math.nan))
    is_propagated: bool = False
    log_total: float = math.nan
    absent_counted: bool = False
    likeliest: NDArray[np.int64] | None = None

    def __post_init__(self) -> None:
        if self.errors.ndim == 0:
            object.__setattr__(self, "errors", np.full(len(self.marginals), self.error))

    @property
    def is_unknown(self) -> bool:
        """True if the time limit was reached before any marginals were computed."""
        return not (math.isfinite(self.error) or self.is_propagated)

    @property
    def entropy(self) -> Marginals:
        """Entropy of each object's marginal in nats, shape (n1,): 0 where it is certain."""
        p = self.marginals
        logs = np.log(p, out=np.zeros_like(p), where=p > 0)
        entropy: Marginals = np.maximum(0.0, -(p * logs).sum(axis=1))
        return entropy


def posterior(
    problem: Problem,
    deadline: Deadline = Deadline.never(),
    *,
    mass: float = 1e-3,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
    chains: bool = True,
) -> Posterior:
    """Return the marginals of the posterior over maps.

    Parameters
    ----------
    problem
        Matching problem of n1 objects and n2 things.
    deadline
        End of the time limit. Past it, the answer is ``start`` with infinite error.
    mass
        Maximum missing mass of an exact sum, between 0 and 1. Where the sum takes too long, maps are sampled.
    seed
        Seed of the sampling.
    start
        Map of high value, shape (n1,); by default, all objects are absent.
    chains
        False to use belief propagation instead of sampling, which needs less memory.

    Returns
    -------
    Posterior
        Marginals, shape (n1, n2 + 1), whether they are exact, and their error.

    Raises
    ------
    MatchingError
        ``mass`` is not between 0 and 1, or ``start`` is not a map of the problem.

    Examples
    --------
    >>> problem = Problem(np.zeros((0, 2), np.int64), np.zeros(0, np.int64), np.zeros((0, 1, 1), np.float32),
    ...                   np.array([[np.log(3.0)]]), np.zeros(1))
    >>> found = posterior(problem)
    >>> found.marginals.round(3).tolist(), found.exact
    ([[0.75, 0.25]], True)
    """
    if start is not None:
        problem.require_map(start)
    exact = exact_posterior(problem, deadline, mass=mass, seed=seed, start=start)
    if exact is not None:
        return exact
    n1, n2 = problem.unary.shape
    if deadline.left <= deadline.slowness * belief_seconds(problem.compiled):
        labels = np.full(n1, n2) if start is None else to_labels(start, n2)
        return Posterior((labels[:, None] == np.arange(n2 + 1)).astype(np.float64), False, math.inf)
    if not chains:
        beliefs = starts_of(problem.compiled, None, deadline).beliefs
        return Posterior(beliefs, False, math.inf, is_propagated=True)
    places = None
    if problem.places is not None and len(problem.ends) and n2 >= MIN_PLACED_THINGS:
        each = deadline.slowness * SECONDS_PER_PLACE * len(problem.tables) * n2
        most = min(PLACES_SHARE * deadline.left / each, MAX_PLACES)
        places = problem.places(most=int(most)) if most >= MIN_PLACES else None
    found = sampled_marginals(problem.compiled, exchangeable(problem), deadline, seed, places)
    error, likeliest = float(found.errors.max(initial=0.0)), None
    if is_large(problem.compiled):
        maps = [likeliest_map(found.marginals.astype(np.float32), problem.compiled, deadline)]
        maps += [] if start is None else [to_labels(start, n2)]
        likeliest = to_assignment(max(maps, key=lambda labels: map_value(labels, found.problem)), n2)
    return Posterior(
        found.marginals,
        False,
        error,
        found.errors,
        is_propagated=not math.isfinite(error),
        absent_counted=places is not None,
        likeliest=likeliest,
    )


def exact_posterior(
    problem: Problem,
    deadline: Deadline = Deadline.never(),
    *,
    mass: float = 1e-3,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Posterior | None:
    """Return the posterior, exact up to a missing mass; None where that takes too long.

    Parameters
    ----------
    problem
        The problem of n1 objects and n2 things.
    deadline
        End of the time limit.
    mass
        Maximum share of the probability that may be missing from the sum, between 0 and 1.
    seed
        Seed of the search for a first map.
    start
        Map of high value, shape (n1,); by default, a short search finds one.

    Returns
    -------
    Posterior or None
        The posterior, or None where the sum is not complete in time.

    Raises
    ------
    MatchingError
        ``mass`` is not between 0 and 1, or ``start`` is not a map of the problem.
    """
    if not 0 < mass < 1:
        raise MatchingError(f"`mass` must be between 0 and 1, got {mass}")
    n1, n2 = problem.unary.shape
    if n1 == 0 or n2 == 0:
        unmatched = np.ones((n1, 1)) if n2 == 0 else np.zeros((0, n2 + 1))
        return Posterior(unmatched, True, 0.0, log_total=float(problem.absent.sum()))
    compiled, width = problem.compiled, n2 + 1
    if len(compiled.kind) * width * width > FACTOR_CELLS or deadline.passed:
        return None
    if start is None:
        labels, _ = search_from(np.full(n1, width - 1), compiled, deadline, seed, START_EFFORT, 2)
        start = to_assignment(labels, width - 1)
    parts = factors(compiled)
    top = math.exp(problem.value(start) - parts.log_scale)
    nodes = int(SUM_CELLS / (n1 * width))
    for threshold in THRESHOLDS:
        if deadline.passed:
            return None
        marginals, (total, missing, looked_at) = add_up(compiled, parts, threshold * top, nodes)
        if missing == math.inf or total <= 0:
            return None
        error = missing / (total + missing)
        if error <= mass:
            summed = math.log(total + missing) + parts.log_scale
            return Posterior(averaged(marginals / total, exchangeable(problem)), True, error, log_total=summed)
        if (
            looked_at * SMALL_SEARCH_RATIO > nodes
            and looked_at * NODE_GROWTH ** math.log(error / mass, ERROR_FALL) > nodes
        ):
            return None
    return None


def log_sum_bound(problem: Problem, enough: float) -> float:
    """Return an upper bound of the log sum over all maps; stop at a bound of at most ``enough``.

    Parameters
    ----------
    problem
        The problem.
    enough
        Bound in nats at which no tighter one is computed.

    Returns
    -------
    float
        Upper bound in nats.

    Examples
    --------
    >>> problem = Problem(np.zeros((0, 2), np.int64), np.zeros(0, np.int64), np.zeros((0, 1, 1), np.float32),
    ...                   np.array([[np.log(3.0)]]), np.zeros(1))
    >>> round(math.exp(log_sum_bound(problem, 0.0)), 6)
    4.0
    """
    n1, n2 = problem.unary.shape
    compiled, width = problem.compiled, n2 + 1
    if n1 == 0 or n2 == 0:
        return float(problem.absent.sum())
    if len(compiled.kind) * width * width > BOUND_CELLS:
        return math.inf
    parts = factors(compiled)
    loose = parts.log_scale + float(np.log(parts.weights.sum(axis=1)).sum())
    if loose <= enough or enough - parts.log_scale < LOWEST_LOG:
        return loose
    for share in BOUND_SHARES:
        threshold = share * math.exp(min(enough, loose) - parts.log_scale)
        _, (total, missing, _) = add_up(compiled, parts, threshold, int(BOUND_WORK / (n1 * width)))
        found = total + missing
        if 0 < found < math.inf:
            loose = min(loose, math.log(found) + parts.log_scale)
        if loose <= enough:
            break
    return loose
