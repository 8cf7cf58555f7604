"""Candidate groundings: probabilities, groups that stand for all orders, and where they come from."""

from __future__ import annotations

import math
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from matching_problems import problems, reordered

from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.matching.posterior.exchangeable import exchangeable
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem
from deixis.reasoning.grounding.matching.search.exact import maps_within
from deixis.reasoning.grounding.questions.candidates import Candidates, candidates_of


def alike(n: int) -> Problem:
    none = np.zeros((0, 2), np.int64)
    return Problem(none, none[:, 0], np.zeros((0, n, n), np.float32), np.ones((n, n)), np.zeros(n))


def test_equal_maps_are_one_candidate_with_the_weight_of_both() -> None:
    found = Candidates(np.array([[0, 1], [1, 0], [0, 1]]), np.array([1.0, 2.0, 1.0]))
    assert found.assignments.tolist() == [[0, 1], [1, 0]]
    assert found.weights.tolist() == [0.5, 0.5]


def test_a_group_of_k_stands_for_all_orders() -> None:
    group = Candidates(np.array([[2, 0, 1, 3]]), np.ones(1), groups=((0, 1, 2),))
    assert group.count == 6
    assert group.bits == pytest.approx(math.log2(6))
    listed = group.pinned((0, 1, 2))
    assert {tuple(row) for row in listed.assignments.tolist()} == {(*order, 3) for order in permutations(range(3))}
    assert listed.weights == pytest.approx(np.full(6, 1 / 6))


def test_members_that_are_left_out_make_no_new_orders() -> None:
    group = Candidates(np.array([[UNMATCHED, 0, UNMATCHED]]), np.ones(1), groups=((0, 1, 2),))
    assert group.count == 3
    assert len(group.pinned((0, 1, 2))) == 3


def test_pinning_one_of_twenty_multiplies_by_twenty_alone() -> None:
    group = Candidates(np.arange(20)[None], np.ones(1), groups=(tuple(range(20)),))
    assert group.count == math.factorial(20)
    assert len(group.pinned((4,))) == 20
    assert group.pinned((4,)).bits == pytest.approx(group.bits)


def test_rows_that_stand_for_the_same_maps_are_one() -> None:
    assert len(Candidates(np.array([[0, 1], [1, 0]]), np.ones(2), groups=((0, 1),))) == 1


@settings(max_examples=40, deadline=None)
@given(problems(most=3))
def test_weights_are_those_of_the_posterior(problem: Problem) -> None:
    found, maps = candidates_of(problem, margin=3.0), maps_within(problem, 3.0)
    odds = dict(zip(map(tuple, maps.assignments.tolist()), np.exp(maps.values - maps.values[0]), strict=True))
    total = sum(odds.values())
    assert len(found) == len(odds)
    for row, weight in zip(found.assignments.tolist(), found.weights, strict=True):
        assert weight == pytest.approx(odds[tuple(row)] / total)


@settings(max_examples=60, deadline=None)
@given(problems())
def test_permuting_a_group_changes_no_value(problem: Problem) -> None:
    for group in exchangeable(problem):
        order = np.arange(len(problem.absent))
        order[[group[0], group[1]]] = order[[group[1], group[0]]]
        swapped = reordered(problem, order, np.arange(problem.unary.shape[1]))
        for maps in maps_within(problem, 5.0).assignments[:20]:
            assert swapped.value(maps) == pytest.approx(problem.value(maps), abs=1e-5)


def test_too_many_maps_become_groups_and_incomplete() -> None:
    found = candidates_of(alike(10), limit=50)
    assert (len(found), found.groups, found.complete) == (1, (tuple(range(10)),), False)
    assert found.count == math.factorial(10)


def test_few_maps_are_listed_whole() -> None:
    found = candidates_of(alike(4))
    assert (len(found), found.groups, found.complete) == (24, (), True)


@pytest.mark.parametrize(
    ("weights", "groups"),
    [([], ()), ([0.0, 0.0], ()), ([1.0, -1.0], ()), ([1.0, np.nan], ()), ([1.0, 1.0], ((0, 0),)), ([1, 1], ((0, 5),))],
)
def test_weights_and_groups_that_cannot_be_are_refused(
    weights: list[float], groups: tuple[tuple[int, ...], ...]
) -> None:
    with pytest.raises(SettingError):
        Candidates(np.arange(2 * len(weights)).reshape(-1, 2), np.array(weights), groups)


def test_no_object_at_all_is_one_candidate() -> None:
    empty = Candidates(np.zeros((1, 0), np.int64), np.ones(1))
    assert (len(empty), empty.count, empty.bits, empty.undecided) == (1, 1, 0.0, ())
