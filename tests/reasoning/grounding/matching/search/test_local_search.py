"""Incremental gains of local search equal recomputed ones."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems

from deixis.reasoning.grounding.matching.problem import Problem, compile_problem, to_labels
from deixis.reasoning.grounding.matching.search.local_search import exchange, keep


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
