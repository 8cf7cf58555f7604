"""Incremental gains of local search equal recomputed ones."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems

from deixis.reasoning.grounding.matching.problem import Problem, compile_problem, to_assignment, to_labels
from deixis.reasoning.grounding.matching.search.local_search import exchange, keep, move_pairs
from deixis.reasoning.grounding.matching.search.scalable import scalable


@settings(max_examples=80, deadline=None)
@given(problems(), st.integers(0, 2**32 - 1))
def test_exchanges_keep_the_gains(problem: Problem, seed: int) -> None:
    rng, (n1, n2) = np.random.default_rng(seed), problem.unary.shape
    compiled = compile_problem(problem)
    state = keep(np.full(n1, n2), compiled)
    for _ in range(20 if n1 else 0):
        i, p = int(rng.integers(n1)), int(rng.integers(n2 + 1))
        old, j = int(state.labels[i]), int(state.holder[p])
        if p != old and compiled.allowed[i, p] and (j < 0 or compiled.allowed[j, old]):
            exchange(i, p, state, compiled)
    fresh = keep(state.labels, compiled)
    np.testing.assert_array_equal(state.holder, fresh.holder)
    np.testing.assert_allclose(state.gains, fresh.gains, atol=1e-4)


@settings(max_examples=60, deadline=None)
@given(problems(), st.data())
def test_gains_are_values_of_the_changed_map(problem: Problem, data: st.DataObject) -> None:
    values, n2 = every_map(problem), problem.unary.shape[1]
    choice = data.draw(st.sampled_from(sorted(values)))
    state = keep(to_labels(np.array(choice, dtype=np.int64), n2), compile_problem(problem))
    for i, old in enumerate(choice):
        for p in {*range(-1, n2)} - {*choice}:
            moved = (*choice[:i], p, *choice[i + 1 :])
            if moved in values:
                gained = float(state.gains[i, p] - state.gains[i, old])
                assert gained == pytest.approx(values[moved] - values[choice], abs=1e-4)


@settings(max_examples=80, deadline=None)
@given(problems(), st.data())
def test_no_joint_move_to_free_things_helps_in_the_end(problem: Problem, data: st.DataObject) -> None:
    values, n2 = every_map(problem), problem.unary.shape[1]
    start = data.draw(st.sampled_from(sorted(values)))
    labels = to_labels(np.array(start, dtype=np.int64), n2)
    gained = move_pairs(labels, compile_problem(problem))
    reached = tuple(to_assignment(labels, n2).tolist())
    assert gained == pytest.approx(values[reached] - values[start], abs=1e-4)
    linked = {frozenset(pair) for pair in problem.ends.tolist()}
    for other, value in values.items():
        if frozenset(i for i in range(len(other)) if other[i] != reached[i]) in linked:
            assert value <= values[reached] + 1e-4


@pytest.mark.parametrize("effort", [0.02, 1.0])
@pytest.mark.parametrize("repeats", [1, 3, 9])
def test_facts_that_hold_only_after_a_joint_move(repeats: int, effort: float) -> None:
    tables = np.full((1, 4, 4), -3.0, dtype=np.float32)
    tables[0, 0, 2], tables[0, 3, 1] = 1.0, 2.0
    ends, kinds = np.tile([[0, 1]], (repeats, 1)), np.zeros(repeats, dtype=np.int64)
    found = scalable(Problem(ends, kinds, tables, np.zeros((2, 4)), np.full(2, -4.0)), effort=effort)
    assert found.assignment.tolist() == [3, 1]
