"""Estimate how literally a description is meant, from the description itself.

People say *left of* where the exact relation is *top left of*; a program, or a person who copies relations from a plan,
states the exact relation. The best maps under both assumptions show which speaker is likelier (empirical Bayes, Robbins
1956): the evidence of facts is a likelihood ratio against the same chance for both, so that the values of the best maps
can be compared, and their difference is added to the log-odds of a literal speaker. If no map makes the facts literally
true, they are not meant literally; a few facts that a scene satisfies by chance leave the estimate near the prior.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.problem import Problem

Order = NDArray[np.int64]

LITERAL = 0.9
"""Share of the facts of a literal speaker that are meant literally; a graded speaker means none literally."""

LITERAL_PRIOR = 0.02
"""Prior probability that a speaker is literal: a long description by a program overcomes it, one sentence does not."""

SEARCH_EFFORT, FULL_EFFORT_OBJECTS = 0.05, 30
"""Effort of the scalable search up to this number of objects; larger descriptions get less effort per object."""

MAX_PROVED_OBJECTS = 8
"""Maximum number of objects for which proving the best map takes less time than the scalable search."""

MAX_JUDGED_OBJECTS = 60
"""Maximum number of objects for the estimate; of a larger description, a connected part is used."""


def literal_share(either: Iterable[Problem], objects: Order, deadline: Deadline = Deadline.never()) -> float:
    """Return the expected share of literal facts: ``LITERAL`` times the probability that the speaker is literal.

    Parameters
    ----------
    either
        The problem with the facts of a graded speaker, then that of a literal speaker; an iterator needs to hold only
        one of them at a time. Their things must be in an order that does not depend on the input.
    objects
        Order of the objects that does not depend on the input, shape (n1,), so that the search always has the same
        result.
    deadline
        Time after which the prior share is returned.

    Returns
    -------
    float
        Share in [0, ``LITERAL``].

    Examples
    --------
    >>> there, order = np.array([[[0, 1], [0, 0]]], np.float32), np.arange(2)
    >>> problem = Problem(np.array([[0, 1]]), np.array([0]), there, np.zeros((2, 2)), np.full(2, -9.0))
    >>> round(literal_share((problem, replace(problem, tables=3 * there)), order), 2)
    0.12
    """
    best_values = [
        _best_value(_part(problem, objects), deadline) if len(problem.ends) and not deadline.passed else 0.0
        for problem in either
    ]
    if deadline.passed:
        return LITERAL * LITERAL_PRIOR
    odds = LITERAL_PRIOR / (1 - LITERAL_PRIOR) * np.exp(np.clip(best_values[1] - best_values[0], -500, 500))
    return float(LITERAL * odds / (1 + odds))


def _part(problem: Problem, order: Order) -> Problem:
    """Return the problem with its objects in ``order``, or a connected part of it, and its facts sorted."""
    chosen = _connected(problem.ends, order) if len(order) > MAX_JUDGED_OBJECTS else order
    place = np.full(len(order), -1)
    place[chosen] = np.arange(len(chosen))
    ends = place[problem.ends]
    kept = (ends >= 0).all(axis=1)
    ends, kinds = ends[kept], problem.kinds[kept]
    by = np.lexsort([kinds, ends[:, 1], ends[:, 0]])
    return replace(
        problem,
        ends=ends[by],
        kinds=kinds[by],
        unary=problem.unary[chosen],
        absent=problem.absent[chosen],
        allowed=problem.allowed[chosen],
    )


def _connected(ends: NDArray[np.int64], order: Order) -> Order:
    """Return the first ``MAX_JUDGED_OBJECTS`` objects of a breadth-first search from the object with most facts."""
    near: dict[int, list[int]] = {i: [] for i in order.tolist()}
    for a, b in ends.tolist():
        near[a].append(b)
        near[b].append(a)
    rank = {i: place for place, i in enumerate(order.tolist())}
    starts = sorted(near, key=lambda i: (-len(near[i]), rank[i]))
    reached: dict[int, None] = {}
    for start in starts:
        waiting = [start]
        for i in waiting:
            if i not in reached and len(reached) < MAX_JUDGED_OBJECTS:
                reached[i] = None
                waiting += sorted(near[i], key=rank.__getitem__)
    return np.array(list(reached), dtype=np.int64)


def _best_value(problem: Problem, deadline: Deadline) -> float:
    """Return the value of the best map; for many objects, an estimate by a short search."""
    from deixis.reasoning.grounding.matching.search.exact import exact
    from deixis.reasoning.grounding.matching.search.scalable import scalable

    if len(problem.absent) <= MAX_PROVED_OBJECTS:
        return exact(problem, deadline).value
    effort = SEARCH_EFFORT * min(1.0, FULL_EFFORT_OBJECTS / len(problem.absent))
    return scalable(problem, deadline, effort=effort).value
