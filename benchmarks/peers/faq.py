"""Solve by FAQ (Vogelstein et al. 2015), Frank-Wolfe over doubly stochastic matrices, for facts of several kinds.

``scipy.optimize.quadratic_assignment`` takes one pair of matrices; facts of k kinds are a sum over k pairs, so the same
steps are written out here for the sum, with scipy's linear assignment: start at the barycentre (or near it), find the
assignment that maximises the gradient, do an exact line search, and end with the assignment nearest to the last point.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem

ITERATIONS = 30  # scipy's default
STARTS = 10
RULED_OUT = -1e6


def solve(problem: Problem, *, starts: int = STARTS, seed: int = 0) -> NDArray[np.int64]:
    """Return the best map of ``starts`` starts, the first of them the barycentre."""
    from scipy.optimize import linear_sum_assignment

    rng = np.random.default_rng(seed)
    n1, n2 = problem.unary.shape
    unary = np.where(problem.allowed, problem.unary - problem.absent[:, None], RULED_OUT)
    unary = np.maximum(unary, RULED_OUT)
    unary = np.concatenate([unary, np.full((n1, n1), RULED_OUT)], axis=1)
    unary[np.arange(n1), n2 + np.arange(n1)] = 0.0
    best, best_value = np.full(n1, UNMATCHED), problem.value(np.full(n1, UNMATCHED))
    for start in range(starts):
        x = np.full((n1, n2 + n1), 1.0 / (n2 + n1))
        if start:
            vertex = np.zeros_like(x)
            vertex[np.arange(n1), rng.permutation(n2 + n1)[:n1]] = 1.0
            x = (x + vertex) / 2
        for _ in range(ITERATIONS):
            facts = _gradient(problem, x)
            gradient = unary + facts
            rows, columns = linear_sum_assignment(gradient, maximize=True)
            step = -x
            step[rows, columns] += 1.0
            slope = float((gradient * step).sum())
            curve = 0.5 * float((_gradient(problem, step) * step).sum())
            size = 1.0 if curve >= 0 else min(1.0, -slope / (2 * curve))
            if slope <= 1e-9 or size <= 0:
                break
            x = x + size * step
        rows, columns = linear_sum_assignment(x + np.where(unary <= RULED_OUT, -10.0, 0.0), maximize=True)
        found = np.where(columns < n2, columns, UNMATCHED).astype(np.int64)
        value = problem.value(found)
        if value > best_value:
            best, best_value = found, value
    return best


def _gradient(problem: Problem, x: NDArray[np.float64]) -> NDArray[np.float64]:
    n2 = problem.unary.shape[1]
    gradient = np.zeros_like(x)
    for kind, table in enumerate(problem.tables):
        facts = problem.ends[problem.kinds == kind]
        weights = table.astype(np.float64)
        np.fill_diagonal(weights, 0.0)
        np.add.at(gradient[:, :n2], facts[:, 0], x[facts[:, 1], :n2] @ weights.T)
        np.add.at(gradient[:, :n2], facts[:, 1], x[facts[:, 0], :n2] @ weights)
    return gradient
