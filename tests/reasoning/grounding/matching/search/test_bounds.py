"""The linear assignment against scipy's, its prices as a proof, and dual bounds that are never below the truth."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems
from scipy.optimize import linear_sum_assignment

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.problem import Problem, compile_problem
from deixis.reasoning.grounding.matching.search.assignment import assign_until, solve_assignment
from deixis.reasoning.grounding.matching.search.branch_and_bound import new_stack, node_at, tighten


@settings(max_examples=100, deadline=None)
@given(st.integers(0, 6), st.integers(0, 6), st.integers(0, 2**32 - 1), st.booleans())
def test_assignment_equals_scipy_with_prices_as_proof(rows: int, columns: int, seed: int, ties: bool) -> None:
    rng = np.random.default_rng(seed)
    gain = rng.integers(0, 4, (rows, columns + 1)).astype(float) if ties else rng.normal(0, 3, (rows, columns + 1))
    gain[:, :columns][rng.random((rows, columns)) < 0.2] = -np.inf
    column_of, price, profit = np.zeros(rows, np.int64), np.empty(columns), np.empty(rows)
    value = solve_assignment(gain, column_of, price, profit)
    square = np.full((rows, columns + rows), -1e6)
    square[:, :columns] = np.maximum(gain[:, :columns], -1e6)
    square[np.arange(rows), columns + np.arange(rows)] = gain[:, columns]
    chosen = linear_sum_assignment(square, maximize=True)
    assert value == pytest.approx(square[chosen].sum(), abs=1e-9)
    assert value == pytest.approx(gain[np.arange(rows), column_of].sum(), abs=1e-9)
    taken = column_of[column_of < columns]
    assert len(set(taken.tolist())) == len(taken)
    assert (price >= 0).all()
    assert price.sum() + profit.sum() == pytest.approx(value, abs=1e-9)
    assert (profit[:, None] >= gain - np.append(price, 0.0) - 1e-9).all()


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 6), st.integers(1, 6), st.integers(0, 2**32 - 1))
def test_assignment_with_time_has_the_best_value(rows: int, columns: int, seed: int) -> None:
    gain = np.random.default_rng(seed).normal(0, 3, (rows, columns + 1))
    value = solve_assignment(gain, np.zeros(rows, np.int64), np.empty(columns), np.empty(rows))
    column_of = assign_until(gain, Deadline.never())
    assert gain[np.arange(rows), column_of].sum() == pytest.approx(value, abs=1e-9)


def test_past_the_deadline_no_two_rows_share_a_column() -> None:
    gain = np.array([[3.0, 1.0, 0.0], [3.0, 2.0, 0.0], [1.0, 4.0, 0.0]])
    assert assign_until(gain, Deadline.after(-1.0)).tolist() == [0, 2, 1]  # the second row stays unassigned


def test_row_without_any_option_has_no_assignment() -> None:
    gain = np.array([[1.0, -np.inf], [2.0, -np.inf]])
    assert solve_assignment(gain, np.zeros(2, np.int64), np.empty(1), np.empty(2)) == -np.inf


@settings(max_examples=100, deadline=None)
@given(problems(), st.integers(1, 12))
def test_bounds_only_fall_and_never_below_the_best_map(problem: Problem, passes: int) -> None:
    n1, n2 = problem.unary.shape
    if n1 == 0 or n2 == 0:
        return
    best = max(every_map(problem).values())
    compiled = compile_problem(problem)
    root, bound = node_at(0, new_stack(compiled, 1e6)), np.inf
    for _ in range(passes):
        following = tighten(root, compiled, best - 1e-6, bound, 1, 0, np.empty(n1, np.int64))
        assert best - 1e-5 <= following <= bound + 1e-9
        bound = following


@settings(max_examples=100, deadline=None)
@given(problems())
def test_no_candidate_of_a_best_map_is_dropped(problem: Problem) -> None:
    n1, n2 = problem.unary.shape
    if n1 == 0 or n2 == 0:
        return
    values = every_map(problem)
    best = max(values.values())
    root = node_at(0, new_stack(compile_problem(problem), 1e6))
    tighten(root, compile_problem(problem), best - 1e-6, np.inf, 10, 1000, np.empty(n1, np.int64))
    for choice in (choice for choice, value in values.items() if value > best - 1e-9):
        for i, p in enumerate(choice):
            assert p % (n2 + 1) in root.candidates[i, : root.counts[i]]
