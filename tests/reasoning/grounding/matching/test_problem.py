"""The matching problem: its value, and arrays that state none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from matching_problems import every_map, problems

from deixis.reasoning.grounding.matching.problem import MatchingError, Problem


@settings(max_examples=60, deadline=None)
@given(problems())
def test_the_value_of_a_map_is_the_sum_of_what_speaks_for_it(problem: Problem) -> None:
    for choice, value in list(every_map(problem).items())[:50]:
        assert problem.value(np.array(choice, dtype=np.int64)) == pytest.approx(value, abs=1e-5)


def test_a_problem_is_laid_out_for_compiled_loops_once() -> None:
    problem = Problem(**GOOD)
    assert problem.compiled is problem.compiled


GOOD: dict[str, Any] = {
    "ends": np.array([[0, 1]]),
    "kinds": np.array([0]),
    "tables": np.zeros((1, 3, 3), np.float32),
    "unary": np.zeros((2, 3)),
    "absent": np.zeros(2),
}


@pytest.mark.parametrize(
    ("name", "wrong", "message"),
    [
        ("ends", np.array([[0, 2]]), "two different objects"),
        ("ends", np.array([[1, 1]]), "two different objects"),
        ("ends", np.array([0, 1]), "`ends` must have shape"),
        ("kinds", np.array([1]), "must be tables from"),
        ("kinds", np.array([0, 0]), "`kinds` must have shape"),
        ("tables", np.full((1, 3, 3), np.nan, np.float32), "finite"),
        ("tables", np.zeros((1, 2, 3), np.float32), "`tables` must have shape"),
        ("unary", np.full((2, 3), np.nan), "rule matches out with `allowed`"),
        ("unary", np.full((2, 3), np.inf), "rule matches out with `allowed`"),
        ("unary", np.full((2, 3), -np.inf), "rule matches out with `allowed`"),
        ("allowed", np.ones((3, 2), bool), "`allowed` must have shape"),
        ("unary", np.zeros(2), "must have shape"),
        ("absent", np.array([0.0, -np.inf]), "`absent` must be finite"),
    ],
)
def test_arrays_that_state_no_problem_are_refused(name: str, wrong: Any, message: str) -> None:
    Problem(**GOOD)
    with pytest.raises(MatchingError, match=message):
        Problem(**(GOOD | {name: wrong}))
