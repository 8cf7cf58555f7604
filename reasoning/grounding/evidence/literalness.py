"""How literally a description is meant, judged from the description itself.

People say *left of* where a list of names would say *top left of*; a program, or somebody who copies names from a plan,
says the name. Which of the two speaks is seen by how well the best map does for either (empirical Bayes, Robbins 1956):
what facts weigh is a likelihood ratio against the same chance for both, so the values of their best maps can be
compared, and the difference adds to the log-odds of a literal speaker. What nothing makes true literally is not meant
so; a few facts that a scene happens to satisfy do not say much, and the answer stays near the prior.
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
"""The share of facts that a literal speaker means literally; of all others none is."""

LITERAL_PRIOR = 0.2
"""How many speakers are taken to be literal before they are heard: one in five."""

SEARCH_EFFORT, FULL_EFFORT_OBJECTS = 0.05, 30
"""The scalable search's effort for a judgement, up to so many objects; in larger descriptions, the less for each."""

MAX_PROVED_OBJECTS = 8
"""Objects up to which proving the best map takes less time than a search."""

MAX_JUDGED_OBJECTS = 60
"""Of larger descriptions a connected part of so many objects is judged."""


def literal_share(either: Iterable[Problem], objects: Order, deadline: Deadline = Deadline.never()) -> float:
    """Return the share of facts to be taken literally: that of a literal speaker times the probability that one speaks.

    ``either`` are the same problem with the facts of a graded and of a literal speaker, one after the other, so that
    both need not be held at once. ``objects`` (n1,) lists one side in an order that does not depend on how it was
    given, and the problems' things stand in such an order: the search is one, and its result is then the same for the
    same scene. Past the ``deadline`` it is what is taken before anybody is heard.

    >>> there, order = np.array([[[0, 1], [0, 0]]], np.float32), np.arange(2)
    >>> problem = Problem(np.array([[0, 1]]), np.array([0]), there, np.zeros((2, 2)), np.full(2, -9.0))
    >>> round(literal_share((problem, replace(problem, tables=3 * there)), order), 2)
    0.58
    """
    worth = [
        _best_value(_part(problem, objects), deadline) if len(problem.ends) and not deadline.passed else 0.0
        for problem in either
    ]
    if deadline.passed:
        return LITERAL * LITERAL_PRIOR
    odds = LITERAL_PRIOR / (1 - LITERAL_PRIOR) * np.exp(np.clip(worth[1] - worth[0], -500, 500))
    return float(LITERAL * odds / (1 + odds))


def _part(problem: Problem, order: Order) -> Problem:
    """Return the problem with its objects in that order, or a connected part of it, and its facts sorted."""
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
    """Return the first ``MAX_JUDGED_OBJECTS`` objects that facts lead to, breadth first, from the one that has most
    facts."""
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
    """Return what the best map is worth; of many objects about, by a short search."""
    from deixis.reasoning.grounding.matching.exact import exact
    from deixis.reasoning.grounding.matching.scalable import scalable

    if len(problem.absent) <= MAX_PROVED_OBJECTS:
        return exact(problem, deadline).value
    effort = SEARCH_EFFORT * min(1.0, FULL_EFFORT_OBJECTS / len(problem.absent))
    return scalable(problem, deadline, effort=effort).value
