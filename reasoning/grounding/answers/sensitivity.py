"""Sensitivity of an answer to each fact: what would change without it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.posterior.coincidences import discounted
from deixis.reasoning.grounding.matching.posterior.posterior import exact_posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem
from deixis.reasoning.grounding.matching.search.exact import exact

MAX_OBJECTS = 30
"""Maximum number of objects of a problem that is solved again without each fact."""

TIE_BREAK_BONUS = 1e-4
"""Bonus in nats for the current matches, so that ties keep them."""


@dataclass(frozen=True, eq=False)
class WithoutFact:
    """Solution of the problem without one fact."""

    fact: int  # index of the fact
    assignment: NDArray[np.int64]  # (n1,) the likeliest map without the fact
    better: bool  # whether it is then strictly likelier than the current map
    probability: NDArray[np.float64]  # (n1,) probability of each of its matches without the fact; nan: unknown


def leave_one_out(
    problem: Problem, assignment: NDArray[np.int64], probable: bool, deadline: Deadline, facts: int | None = None
) -> Iterator[WithoutFact]:
    """Yield the likeliest map without each fact in turn, until the deadline.

    Problems of more than ``MAX_OBJECTS`` objects are not solved. Among equally likely maps, the one closest to the
    current one is taken.

    Parameters
    ----------
    problem
        The matching problem.
    assignment
        The current map, shape (n1,).
    probable
        True to compute probabilities where they can be exact.
    deadline
        Time limit, at which the iterator ends early.
    facts
        Number of the first facts to leave out in turn; default: all.

    Yields
    ------
    WithoutFact
        The map without a fact, and its probabilities.

    Examples
    --------
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
    for fact in range(len(problem.ends) if facts is None else facts):
        kept = np.arange(len(problem.ends)) != fact
        rest = replace(problem, ends=problem.ends[kept], kinds=problem.kinds[kept])
        found = exact(replace(rest, unary=rest.unary + stay), deadline)
        if not found.proved or deadline.passed:
            return
        better = rest.value(found.assignment) > rest.value(assignment) + TIE_BREAK_BONUS
        known = exact_posterior(rest, deadline, start=found.assignment) if probable else None
        probability = np.full(len(assignment), np.nan)
        if known is not None:
            probability = discounted(rest, known).marginals[np.arange(len(assignment)), found.assignment]
        yield WithoutFact(fact, found.assignment, better, probability)
