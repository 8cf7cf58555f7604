"""SM, RRWM and IPFP of pygmtools at their defaults, on the affinity of all pairs of matches (small problems only)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.assignment import assign
from deixis.reasoning.matching.problem import Problem

SOLVERS = ("sm", "rrwm", "ipfp")
MOST_CELLS = 2_000  # matches; the affinity has the square of it


def solve(problem: Problem, solver: str) -> NDArray[np.int64]:
    """One solver's map; raises ImportError where pygmtools is not installed.

    The solvers want affinities of at least 0 and match as many objects as they can: tables and unary terms are raised
    to 0 for them, and nothing is left out that need not be.
    """
    import pygmtools  # type: ignore[import-not-found, unused-ignore]

    n1, n2 = problem.unary.shape
    allowed = ~np.isneginf(problem.unary)
    affinity = np.zeros((n2, n1, n2, n1))  # pygmtools lists matches by thing, then by object
    tables = np.maximum(problem.tables, 0.0)
    for (s, o), kind in zip(problem.ends.tolist(), problem.kinds.tolist(), strict=True):
        affinity[:, s, :, o] += tables[kind]
        affinity[:, o, :, s] += tables[kind].T
    matches = affinity.reshape(n1 * n2, n1 * n2)
    np.fill_diagonal(matches, np.maximum(np.where(allowed, problem.unary, 0.0), 0.0).T.ravel())
    soft = getattr(pygmtools, solver)(matches.astype(np.float32), n1=n1, n2=n2, backend="numpy")
    return assign(np.asarray(soft, dtype=np.float64), allowed)
