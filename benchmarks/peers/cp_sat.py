"""Solve by CP-SAT (ortools): a Boolean for every match, and one for each level of every fact."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem

SCALE = 10_000  # the solver works with whole numbers
WORKERS = 2


@dataclass(frozen=True, eq=False)
class Solved:
    """The map, and True if the solver proved it the best."""

    assignment: NDArray[np.int64]
    proved: bool


def solve(problem: Problem, seconds: float) -> Solved:
    """Return the best map by CP-SAT; raise ImportError if ortools is not installed.

    A fact's level (above its least) may be claimed for a thing of its subject only where its object's thing gives that
    level there, and the reverse. That takes n2 clauses a level and fact, where pairs would take n2 squared.
    """
    from ortools.sat.python import cp_model  # type: ignore[import-not-found, unused-ignore]

    model = cp_model.CpModel()
    n1, n2 = problem.unary.shape
    x = [[model.new_bool_var("") for _ in range(n2)] for _ in range(n1)]
    terms: list[Any] = []
    for i in range(n1):
        model.add_at_most_one(x[i])
        for p in range(n2):
            if not problem.allowed[i, p]:
                model.add(x[i][p] == 0)
            else:
                terms.append(round(SCALE * float(problem.unary[i, p] - problem.absent[i])) * x[i][p])
    for p in range(n2):
        model.add_at_most_one(row[p] for row in x)
    for (s, o), kind in zip(problem.ends.tolist(), problem.kinds.tolist(), strict=True):
        terms += _fact(model, problem.tables[kind], x[s], x[o])
    model.maximize(sum(terms))
    solver = cp_model.CpSolver()
    solver.parameters.max_time_in_seconds = seconds
    solver.parameters.num_workers = WORKERS
    status = solver.solve(model)
    assignment = np.full(n1, UNMATCHED, dtype=np.int64)
    if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        for i in range(n1):
            assignment[i] = next((p for p in range(n2) if solver.value(x[i][p])), UNMATCHED)
    return Solved(assignment, status == cp_model.OPTIMAL)


def _fact(model: Any, table: NDArray[np.float32], subject: list[Any], object: list[Any]) -> list[Any]:
    """Add one Boolean per level: both ends match a pair of it or a higher one; its value adds to the one below.

    Without both ends a fact is worth 0, so that levels below 0 need a Boolean that is forced to be true.
    """
    levels = np.unique(np.concatenate([[0.0], table[~np.eye(len(table), dtype=bool)]]))
    terms = []
    for low, high in pairwise(levels):
        reached = model.new_bool_var("")
        terms.append(round(SCALE * float(high - low)) * reached)
        enough = table >= high
        np.fill_diagonal(enough, False)
        if high > 0:
            model.add(sum(subject) >= 1).only_enforce_if(reached)
            model.add(sum(object) >= 1).only_enforce_if(reached)
        for ends, others, allowed in ((subject, object, enough), (object, subject, enough.T)):
            for p, end in enumerate(ends):
                if high > 0:
                    model.add_bool_or(
                        [others[q] for q in np.flatnonzero(allowed[p])] + [end.negated(), reached.negated()]
                    )
                else:  # true unless a pair of a lower level is matched
                    low_ones = [others[q] for q in np.flatnonzero(~allowed[p]) if q != p]
                    for other in low_ones:
                        model.add_bool_or([end.negated(), other.negated(), reached.negated()])
    return terms
