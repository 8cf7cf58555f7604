"""What would change in an answer if one fact were dropped."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.exact import exact
from deixis.reasoning.grounding.matching.posterior import added_up
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem

MOST = 30
"""Objects up to which a problem is solved anew without each fact."""

STAY = 1e-4
"""What a match of the present map is worth more than its equals, so that nothing changes that need not."""


@dataclass(frozen=True, eq=False)
class Dropped:
    """The likeliest map (n1,) without a fact, whether it is better then than the present one and not just as good, and
    how probable each of its matches is then (nan: not known).
    """

    fact: int
    assignment: NDArray[np.int64]
    better: bool
    probability: NDArray[np.float64]


def without_each(problem: Problem, assignment: NDArray[np.int64], probable: bool, deadline: float) -> Iterator[Dropped]:
    """The likeliest map without each fact in turn, up to ``MOST`` objects, until the deadline (``time.perf_counter``).

    Of several as good it is one like the present ``assignment``. Probabilities are worked out where they are
    ``probable`` to be had exactly. The iterator ends early where there is no more time.

    >>> tables = np.array([[[0, 1], [0, 0]]], np.float32)
    >>> problem = Problem(np.array([[0, 1]]), np.array([0]), tables, np.array([[0, 0.5], [0, 0]]), np.full(2, -1.0))
    >>> [d.assignment.tolist() for d in without_each(problem, np.array([0, 1]), True, float("inf"))]
    [[1, 0]]
    """
    if len(problem.absent) > MOST:
        return
    matched = np.flatnonzero(assignment != UNMATCHED)
    stay = np.zeros_like(problem.unary)
    stay[matched, assignment[matched]] = STAY
    for fact in range(len(problem.ends)):
        kept = np.arange(len(problem.ends)) != fact
        rest = replace(problem, ends=problem.ends[kept], kinds=problem.kinds[kept])
        found = exact(replace(rest, unary=rest.unary + stay), deadline)
        if not found.proved or time.perf_counter() > deadline:
            return
        better = rest.value(found.assignment) > rest.value(assignment) + STAY
        yield Dropped(fact, found.assignment, better, _probability(rest, found.assignment, probable, deadline))


def _probability(
    problem: Problem, assignment: NDArray[np.int64], probable: bool, deadline: float
) -> NDArray[np.float64]:
    found = added_up(problem, deadline) if probable else None
    if found is None:
        return np.full(len(assignment), np.nan)
    probability: NDArray[np.float64] = found.marginals[np.arange(len(assignment)), assignment]
    return probability
