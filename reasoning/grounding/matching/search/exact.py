"""Exact search: the best map with a proof or a bound of its gap, and all maps within a margin of the best."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.problem import Compiled, MatchingError, Problem, to_assignment
from deixis.reasoning.grounding.matching.search.branch_and_bound import (
    BUDGET,
    DONE,
    FULL,
    Record,
    Stack,
    child_bound,
    evaluate,
    new_stack,
    node_at,
    search,
    tighten,
)
from deixis.reasoning.grounding.matching.search.scalable import search_from

SLACK = 1e-7
"""Difference in nats below which values count as equal."""

MAX_STACK_CELLS = 6e7
"""Maximum size of the search's stack, in numbers of 8 bytes."""

MAX_PASS_CELLS = 1e9
"""Maximum number of table cells of one pass over the facts; beyond it, only a loose bound is given."""

ROOT_PASSES, ROOT_PATIENCE = 200, 100
"""Maximum number of passes over the root, and of further passes that must promise to close it."""

START_EFFORT_PER_SQUARE = 3e-4
"""Effort of the scalable search before the proof, per square of the number of objects, as proofs get harder."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """Result of an exact search."""

    assignment: NDArray[np.int64]  # (n1,) the best map found
    value: float
    bound: float  # upper bound on the value of any map
    nodes: int  # nodes of the search

    @property
    def proved(self) -> bool:
        """True where no map is better by more than SLACK."""
        return self.bound <= self.value + 2 * SLACK

    @property
    def gap(self) -> float:
        """Upper bound, in nats, on how much better another map may be."""
        return max(0.0, self.bound - self.value)


@dataclass(frozen=True, eq=False)
class Maps:
    """Different maps within a margin of the best, best first."""

    assignments: NDArray[np.int64]  # (c, n1)
    values: NDArray[np.float64]  # (c,)
    complete: bool  # whether these are all maps within the margin
    limited: bool  # if not complete: the limit on the number of maps was reached, and not the deadline


def exact(problem: Problem, deadline: Deadline = Deadline.never(), *, seed: int = 0) -> Optimum:
    """Find the best map by branch and bound, and prove it as far as the time until ``deadline`` allows.

    Parameters
    ----------
    problem
        The problem of n1 objects and n2 things.
    deadline
        End of the time limit.
    seed
        Seed of the search for a first map.

    Returns
    -------
    Optimum
        The best map found, an upper bound on the value of any map, and the size of the search.

    Notes
    -----
    Branch and bound is due to A. H. Land and A. G. Doig, "An automatic method of solving discrete programming
    problems", Econometrica 28, 1960; the bounds are those of
    :mod:`deixis.reasoning.grounding.matching.search.branch_and_bound`.

    Examples
    --------
    >>> tables = np.array([[[0, 1], [0, 0]]], np.float32)
    >>> problem = Problem(np.array([[0, 1]]), np.array([0]), tables, np.zeros((2, 2)), np.full(2, -1.0))
    >>> best = exact(problem)
    >>> best.assignment.tolist(), best.value, best.proved
    ([0, 1], 1.0, True)
    """
    n1, n2 = problem.unary.shape
    if n1 == 0 or n2 == 0:
        unmatched = np.full(n1, -1)
        return Optimum(unmatched, problem.value(unmatched), problem.value(unmatched), 0)
    compiled = problem.compiled
    labels, _ = search_from(np.full(n1, n2), compiled, deadline, seed, min(1.0, START_EFFORT_PER_SQUARE * n1**2), 1)
    step = max(_grid(problem) - 1e-3, 0.0) or SLACK
    value = evaluate(labels, compiled)
    record = _record(1, n1, value + step, step)
    record.labels[0], record.values[0], record.found[0] = labels, value, 1
    bound = loose_bound(problem)
    if bound >= record.sought[0]:
        bound, _ = _run(compiled, record, deadline, bound)
    assignment = to_assignment(record.labels[0], n2)
    value = problem.value(assignment)
    return Optimum(assignment, value, value if bound < record.sought[0] else bound, int(record.nodes[0]))


def maps_within(
    problem: Problem, margin: float = 0.0, deadline: Deadline = Deadline.never(), *, limit: int = 10_000
) -> Maps:
    """Find all maps whose value is at most ``margin`` nats below the best, up to a limit and a deadline.

    Parameters
    ----------
    problem
        The problem of n1 objects and n2 things.
    margin
        Largest difference from the best value, in nats; 0 gives all optima.
    deadline
        End of the time limit.
    limit
        Maximum number of maps.

    Returns
    -------
    Maps
        The maps, best first, and whether they are all. Where the best map is not proved in time, only this map.

    Raises
    ------
    MatchingError
        ``margin`` is below 0, or ``limit`` is below 1.

    Examples
    --------
    >>> problem = Problem(np.zeros((0, 2), np.int64), np.zeros(0, np.int64), np.zeros((0, 2, 2), np.float32),
    ...                   np.array([[1.0, 1.0]]), np.zeros(1))
    >>> maps_within(problem).assignments.tolist(), maps_within(problem, 1.0).values.tolist()
    ([[0], [1]], [1.0, 1.0, 0.0])
    """
    if not margin >= 0 or limit < 1:
        raise MatchingError(f"`margin` must be at least 0 and `limit` at least 1, got {margin} and {limit}")
    best = exact(problem, deadline)
    n1, n2 = problem.unary.shape
    if n1 == 0 or n2 == 0 or not best.proved:
        return Maps(best.assignment[None], np.array([best.value]), complete=best.proved, limited=False)
    record = _record(limit, n1, best.value - margin - SLACK, np.inf)
    _, state = _run(problem.compiled, record, deadline, loose_bound(problem))
    count = int(record.found[0])
    if count == 0 or (state != DONE and record.values[:count].max() < best.value - SLACK):
        return Maps(best.assignment[None], np.array([best.value]), complete=False, limited=state == FULL)
    found, values = to_assignment(record.labels[:count], n2), record.values[:count]
    order = np.lexsort([*found.T[::-1], -np.round(values / SLACK)])
    return Maps(found[order], values[order], complete=state == DONE, limited=state == FULL)


def warm() -> None:
    """Compile the engine, or load its compiled code, so that a time limit is spent on searching."""
    tables = np.array([[[0, 1], [0, 0]]], np.float32)
    problem = Problem(np.array([[0, 1]]), np.array([0]), tables, np.zeros((2, 2)), np.full(2, -1.0))
    maps_within(problem, 5.0)


def loose_bound(problem: Problem) -> float:
    """Return an upper bound on the value of any map: the sum of the best value of each object and of each fact.

    Parameters
    ----------
    problem
        The problem.

    Returns
    -------
    float
        Upper bound in nats.
    """
    alone = np.maximum(problem.unary.max(axis=1, where=problem.allowed, initial=-np.inf), problem.absent)
    facts = np.maximum(problem.tables.max(axis=(1, 2), initial=0.0), 0.0)[problem.kinds]
    return float(alone.sum() + facts.sum(dtype=np.float64))


def _record(limit: int, n1: int, sought: float, step: float) -> Record:
    return Record(
        np.zeros((limit, n1), dtype=np.int64),
        np.zeros(limit),
        np.zeros(1, dtype=np.int64),
        np.array([sought]),
        np.array([step]),
        np.zeros(1, dtype=np.int64),
    )


def _run(compiled: Compiled, record: Record, deadline: Deadline, bound: float) -> tuple[float, int]:
    """Search until the end or the deadline; return an upper bound on the maps not found, and the final state."""
    work = len(compiled.kind) * compiled.unary.shape[1] ** 2
    if work > MAX_PASS_CELLS or deadline.passed:
        return bound, BUDGET
    stack = new_stack(compiled, MAX_STACK_CELLS)
    _tighten_root(compiled, stack, record, deadline)
    state = BUDGET
    while state == BUDGET and not deadline.passed:
        state = search(compiled, stack, record, max(1, int(2e6 / (work + 1000))))
    return min(bound, _open_bound(stack)), state


def _tighten_root(compiled: Compiled, stack: Stack, record: Record, deadline: Deadline) -> None:
    """Tighten the root by more passes than other nodes get: candidates dropped there are dropped everywhere."""
    root, column_of = node_at.interpretation(0, stack), np.empty(len(compiled.unary), dtype=np.int64)
    for _ in range(ROOT_PASSES):
        before = stack.bound[0]
        stack.bound[0] = tighten(root, compiled, record.sought[0], before, 2, 0, column_of)
        left = stack.bound[0] - record.sought[0]
        if left < 0 or (before - stack.bound[0]) * ROOT_PATIENCE < left or deadline.passed:
            return


def _open_bound(stack: Stack) -> float:
    """Return an upper bound on the maps that a stopped search has not visited: that of its open nodes."""
    bound = -np.inf
    for d in range(int(stack.depth[0]) + 1):
        bound = max(bound, child_bound(d, stack) if stack.branch[d] >= 0 else stack.bound[d])
    return float(bound)


def _grid(problem: Problem) -> float:
    """Return the largest of a few steps that divides all numbers, or 0; values then differ by multiples of it."""
    for step in (1.0, 0.5, 0.25, 0.2, 0.1, 0.05):
        parts = (problem.absent, *(row for table in problem.tables for row in table), problem.unary[problem.allowed])
        if all(np.abs(part / step - np.round(part / step)).max(initial=0.0) < 1e-6 for part in parts):
            return step
    return 0.0
