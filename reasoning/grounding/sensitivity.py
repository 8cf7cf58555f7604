"""Sensitivity of an answer to each fact: what would change without it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.exact import exact
from deixis.reasoning.grounding.matching.posterior import exact_posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem

MAX_OBJECTS = 30
"""Maximum number of objects of a problem that is solved anew without each fact."""

TIE_BREAK_BONUS = 1e-4
"""Bonus in nats for the matches of the present map, so that ties keep them."""


@dataclass(frozen=True, eq=False)
class WithoutFact:
    """The likeliest map (n1,) without a fact, whether it is better then than the present one and not just as good, and
    how probable each of its matches is then (nan: not known).
    """

    fact: int
    assignment: NDArray[np.int64]
    better: bool
    probability: NDArray[np.float64]


def leave_one_out(
    problem: Problem, assignment: NDArray[np.int64], probable: bool, deadline: Deadline
) -> Iterator[WithoutFact]:
    """Find the likeliest map without each fact in turn, until the deadline.

    Problems of more than ``MAX_OBJECTS`` objects are not solved. Of several maps as good it is one like the present
    ``assignment``. Probabilities are worked out where they are ``probable`` to be had exactly. The iterator ends early
    where there is no more time.

    >>> tables = np.array([[[0, 1], [0, 0]]], np.float32)
    >>> problem = Problem(np.array([[0, 1]]), np.array([0]), tables, np.array([[0, 0.5], [0, 0]]), np.full(2, -1.0))
    >>> [d.assignment.tolist() for d in leave_one_out(problem, np.array([0, 1]), True, Deadline.never())]
    [[1, 0]]
    """
    if len(problem.absent) > MAX_OBJECTS:
        return
    matched = np.flatnonzero(assignment != UNMATCHED)
    stay = np.zeros_like(problem.unary)
    stay[matched, assignment[matched]] = TIE_BREAK_BONUS
    for fact in range(len(problem.ends)):
        kept = np.arange(len(problem.ends)) != fact
        rest = replace(problem, ends=problem.ends[kept], kinds=problem.kinds[kept])
        found = exact(replace(rest, unary=rest.unary + stay), deadline)
        if not found.proved or deadline.passed:
            return
        better = rest.value(found.assignment) > rest.value(assignment) + TIE_BREAK_BONUS
        known = exact_posterior(rest, deadline, start=found.assignment) if probable else None
        probability = np.full(len(assignment), np.nan)
        if known is not None:
            probability = known.marginals[np.arange(len(assignment)), found.assignment]
        yield WithoutFact(fact, found.assignment, better, probability)
