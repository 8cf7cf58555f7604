"""Many objects given their best things at once: never worse, a map, and past where moves and swaps are stuck."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems

from deixis.reasoning.grounding.matching.problem import Problem, compile_problem, to_assignment, to_labels
from deixis.reasoning.grounding.matching.search.local_search import climb, reassign

NONE = np.zeros((0, 2), np.int64)


@settings(max_examples=60, deadline=None)
@given(problems(), st.data(), st.integers(0, 99))
def test_it_is_a_map_that_is_worth_more_by_what_is_said(problem: Problem, data: st.DataObject, seed: int) -> None:
    values, n2 = every_map(problem), problem.unary.shape[1]
    start = data.draw(st.sampled_from(sorted(values)))
    labels = to_labels(np.array(start, dtype=np.int64), n2)
    gained = reassign(labels, compile_problem(problem), 5, seed)
    assert gained >= 0.0
    assert values[tuple(to_assignment(labels, n2).tolist())] - values[start] == pytest.approx(gained, abs=1e-5)


@settings(max_examples=60, deadline=None)
@given(problems(), st.data())
def test_without_facts_it_finds_the_best_map(problem: Problem, data: st.DataObject) -> None:
    alone = Problem(NONE, NONE[:, 0], problem.tables[:0], problem.unary, problem.absent)
    values, n2 = every_map(alone), problem.unary.shape[1]
    labels = to_labels(np.array(data.draw(st.sampled_from(sorted(values))), dtype=np.int64), n2)
    reassign(labels, compile_problem(alone), 1, 0)
    best = max(values.values())
    assert values[tuple(to_assignment(labels, n2).tolist())] == pytest.approx(best, abs=1e-5)


def test_a_round_of_three_helps_where_no_move_and_no_swap_does() -> None:
    unary = np.array([[3.0, 4.0, 0.0], [0.0, 3.0, 4.0], [4.0, 0.0, 3.0]])
    problem = Problem(NONE, NONE[:, 0], np.zeros((0, 3, 3), np.float32), unary, np.full(3, -9.0))
    compiled, labels = compile_problem(problem), np.arange(3)
    climb(labels, compiled)
    assert labels.tolist() == [0, 1, 2]
    assert reassign(labels, compiled, 1, 0) == 3.0
    assert labels.tolist() == [1, 2, 0]
