"""The exact engine against all maps one by one: the optimum, its proof, all optima, the margin, the clock."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems, reordered
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.problem import UNMATCHED, MatchingError, Problem
from deixis.reasoning.grounding.matching.search.exact import exact, loose_bound, maps_within, warm


def blank(n1: int, n2: int, absent: float = -1.0) -> Problem:
    none = np.zeros((0, 2), np.int64)
    return Problem(none, none[:, 0], np.zeros((0, n2, n2), np.float32), np.zeros((n1, n2)), np.full(n1, absent))


def knotty(n: int, facts: int) -> Problem:
    """Draw random tables that nothing satisfies together: no bound is near."""
    rng = np.random.default_rng(5)
    ends = np.array([rng.choice(n, 2, replace=False) for _ in range(facts)])
    tables = rng.normal(0, 1, (facts, n, n)).astype(np.float32)
    return Problem(ends, np.arange(facts), tables, np.zeros((n, n)), np.zeros(n))


@settings(max_examples=80, deadline=None)
@given(problems())
def test_the_optimum_is_the_best_of_all_maps_and_proved(problem: Problem) -> None:
    found = exact(problem)
    values = every_map(problem)
    assert found.proved
    assert values[tuple(found.assignment.tolist())] == pytest.approx(max(values.values()), abs=1e-6)
    assert found.bound >= max(values.values()) - 1e-6
    assert found.value == problem.value(found.assignment)


@settings(max_examples=80, deadline=None)
@given(problems(), st.sampled_from([0.0, 0.5, 1.7, 50.0]))
def test_all_maps_within_the_margin_are_listed_once_best_first(problem: Problem, margin: float) -> None:
    found = maps_within(problem, margin)
    values = every_map(problem)
    best = max(values.values())
    listed = [tuple(row) for row in found.assignments.tolist()]
    assert found.complete and not found.limited
    assert len(set(listed)) == len(listed)
    assert set(listed) >= {choice for choice, value in values.items() if value > best - margin + 1e-5}
    assert set(listed) <= {choice for choice, value in values.items() if value > best - margin - 1e-5}
    assert (np.diff(found.values) <= 1e-6).all()
    np.testing.assert_allclose(found.values, [values[choice] for choice in listed], atol=1e-6)


@settings(max_examples=60, deadline=None)
@given(problems(), st.randoms())
def test_order_changes_neither_values_nor_optima(problem: Problem, random: object) -> None:
    rng = np.random.default_rng(len(problem.ends))
    n1, n2 = problem.unary.shape
    rows, columns = rng.permutation(n1), rng.permutation(n2)
    other = maps_within(reordered(problem, rows, columns))
    back = np.full((len(other.assignments), n1), UNMATCHED)
    matched = other.assignments != UNMATCHED
    back[:, rows] = np.where(matched, columns[np.where(matched, other.assignments, 0)] if n2 else UNMATCHED, UNMATCHED)
    assert {tuple(row) for row in back.tolist()} == {tuple(row) for row in maps_within(problem).assignments.tolist()}


@settings(max_examples=60, deadline=None)
@given(problems())
def test_the_loose_bound_is_never_below_the_best(problem: Problem) -> None:
    assert loose_bound(problem) >= max(every_map(problem).values()) - 1e-6


def test_three_chairs_in_a_row_are_told_apart_by_two_facts() -> None:
    left = np.triu(np.ones((3, 3), np.float32), 1)[None]
    problem = Problem(np.array([[2, 0], [0, 1]]), np.zeros(2, np.int64), left, np.zeros((3, 3)), np.full(3, -1.0))
    found = maps_within(problem)
    assert found.assignments.tolist() == [[1, 2, 0]]
    assert found.values.tolist() == [2.0]


def test_object_is_left_out_where_absence_is_better() -> None:
    says = np.full((1, 2, 2), -3.0, np.float32)
    problem = Problem(np.array([[0, 1]]), np.zeros(1, np.int64), says, np.array([[1.0, 1.0], [0.5, 0.5]]), np.zeros(2))
    assert exact(problem).assignment[1] == UNMATCHED
    assert exact(problem).value == 1.0


@pytest.mark.parametrize(("n1", "n2"), [(0, 0), (0, 3), (3, 0), (5, 2), (2, 5)])
def test_few_or_no_objects_on_either_side(n1: int, n2: int) -> None:
    found = exact(blank(n1, n2))
    assert found.proved
    assert int((found.assignment != UNMATCHED).sum()) == min(n1, n2)
    assert found.value == -(n1 - min(n1, n2))


def test_where_everything_is_ruled_out_everything_is_left_out() -> None:
    problem = Problem(np.zeros((0, 2), np.int64), np.zeros(0, np.int64), np.zeros((0, 3, 3), np.float32),
                      np.zeros((2, 3)), np.full(2, -4.0), np.zeros((2, 3), bool))  # fmt: skip
    assert exact(problem).assignment.tolist() == [UNMATCHED, UNMATCHED]
    assert exact(problem).proved


def test_a_list_that_is_cut_off_says_so() -> None:
    found = maps_within(blank(5, 5), limit=7)
    assert len(found.values) == 7
    assert found.limited and not found.complete


def test_thousand_identical_objects_keep_the_time_limit() -> None:
    warm()
    with processor_time_below(10.0):
        found = exact(blank(1000, 1000), Deadline.after(5.0))
    assert found.value == 0.0
    assert found.proved


@pytest.mark.parametrize("seconds", [-1.0, 0.2])
def test_past_the_deadline_the_map_has_a_valid_bound(seconds: float) -> None:
    warm()
    problem = knotty(25, 150)
    with processor_time_below(seconds + 3.0):
        found = exact(problem, Deadline.after(seconds))
    problem.require_map(found.assignment)
    assert not found.proved
    assert found.gap > 0
    assert found.bound == found.value + found.gap
    maps = maps_within(problem, 0.0, Deadline.after(seconds))
    assert not maps.complete and not maps.limited


@pytest.mark.parametrize("margin", [-1.0, float("nan")])
def test_a_margin_below_zero_is_refused(margin: float) -> None:
    with pytest.raises(MatchingError, match="margin"):
        maps_within(blank(1, 1), margin)
