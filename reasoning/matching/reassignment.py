"""The best things for many objects at once, of which no two share a fact; compiled.

What such objects are worth as each thing does not depend on one another while all others stay as they are, so that the
best way to deal out their things, and those that nobody has, is a linear assignment: the best of exponentially many
neighbours of a map (very large-scale neighbourhood search; Ahuja, Ergun, Orlin and Punnen 2002).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from deixis.reasoning.matching.climbing import gains_of
from deixis.reasoning.matching.linear_assignment import solve_assignment

BETTER = 1e-6  # what a map has to be better by


@njit(cache=True, nogil=True)
def reassign(labels, problem, patience, seed):  # type: ignore[no-untyped-def]
    """One random set of objects after another, until ``patience`` in a row do not help; returns what that gained."""
    np.random.seed(seed)
    n1, width = problem.unary.shape
    cells, row, things = np.empty(n1 * width), np.empty(width), np.empty(width, np.int64)
    column_of, profit, price = np.empty(n1, np.int64), np.empty(n1), np.empty(width)
    total, failed = 0.0, 0
    while failed < patience:
        chosen = _without_facts_between(problem)
        many = _free(labels, chosen, things)
        gain = cells[: len(chosen) * (many + 1)].reshape(len(chosen), many + 1)
        before = 0.0
        for a in range(len(chosen)):
            gains_of(chosen[a], labels, problem, row)
            before += row[labels[chosen[a]]]
            for b in range(many + 1):
                gain[a, b] = row[things[b]]
        columns = column_of[: len(chosen)]
        gained = solve_assignment(gain, columns, price[:many], profit[: len(chosen)]) - before
        failed += 1
        if gained > BETTER:
            labels[chosen] = things[columns]
            total, failed = total + gained, 0
    return total


@njit(cache=True)
def _without_facts_between(problem):  # type: ignore[no-untyped-def]
    """Objects of which no two share a fact, as many as a random order gives."""
    n1 = len(problem.unary)
    order, taken = np.random.permutation(n1), np.zeros(n1, np.bool_)
    chosen, count = np.empty(n1, np.int64), 0
    for i in order:
        if not taken[i]:
            chosen[count] = i
            count += 1
            for slot in range(problem.first[i], problem.first[i + 1]):
                taken[problem.other[slot]] = True
    return chosen[:count]


@njit(cache=True)
def _free(labels, chosen, things):  # type: ignore[no-untyped-def]
    """Lists what the chosen objects may be: what no other object is, and last of all nothing. Returns how many."""
    out = len(things) - 1
    held = np.zeros(out + 1, np.bool_)
    held[labels] = True
    held[labels[chosen]] = False
    count = 0
    for p in range(out):
        if not held[p]:
            things[count] = p
            count += 1
    things[count] = out
    return count
