"""The best of two maps part by part: never worse than either, made of both, and the best choice of parts."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems

from deixis.reasoning.grounding.matching.problem import Problem, compile_problem, to_assignment, to_labels
from deixis.reasoning.grounding.matching.search.local_search import combine


@settings(max_examples=100, deadline=None)
@given(problems(), st.data())
def test_it_is_a_map_of_both_and_no_worse_than_either(problem: Problem, data: st.DataObject) -> None:
    values, n2 = every_map(problem), problem.unary.shape[1]
    one, two = data.draw(st.sampled_from(sorted(values))), data.draw(st.sampled_from(sorted(values)))
    labels = to_labels(np.array(one, dtype=np.int64), n2)
    gained = combine(labels, to_labels(np.array(two, dtype=np.int64), n2), compile_problem(problem))
    child = tuple(to_assignment(labels, n2).tolist())
    assert all(mine in pair for mine, *pair in zip(child, one, two, strict=True))
    assert values[child] - values[one] == pytest.approx(gained, abs=1e-5)
    assert values[child] >= max(values[one], values[two]) - 1e-5


def test_independent_parts_are_combined_separately() -> None:
    ends, kinds = np.array([[0, 1], [2, 3]]), np.array([0, 1])
    tables = np.zeros((2, 4, 4), np.float32)
    tables[0, 0, 1], tables[1, 3, 2] = 1.0, 1.0  # the first fact holds in the first map, the second in the second
    problem = Problem(ends, kinds, tables, np.zeros((4, 4)), np.zeros(4))
    labels = np.array([0, 1, 2, 3])
    assert combine(labels, np.array([1, 0, 3, 2]), compile_problem(problem)) == 1.0
    assert labels.tolist() == [0, 1, 3, 2]
