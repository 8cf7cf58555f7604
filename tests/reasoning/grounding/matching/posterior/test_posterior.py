"""The posterior against all maps weighed one by one, added up or sampled; what it says about its own error."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.posterior import ladders
from deixis.reasoning.grounding.matching.posterior import posterior as module
from deixis.reasoning.grounding.matching.posterior.exchangeable import exchangeable
from deixis.reasoning.grounding.matching.posterior.posterior import log_sum_bound, posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED, MatchingError, Problem
from deixis.reasoning.grounding.matching.search import coarse_to_fine
from deixis.reasoning.grounding.options import is_decided

NONE = np.zeros((0, 2), np.int64)


def brute(problem: Problem) -> np.ndarray:
    n1, n2 = problem.unary.shape
    values = every_map(problem)
    marginals = np.zeros((n1, n2 + 1))
    for choice, value in values.items():
        for i, p in enumerate(choice):
            marginals[i, p] += math.exp(value)  # -1, left out, is the last column
    return marginals / max(sum(math.exp(value) for value in values.values()), 1e-300)


@settings(max_examples=80, deadline=None)
@given(problems())
def test_added_up_marginals_are_those_of_all_maps(problem: Problem) -> None:
    found = posterior(problem, mass=1e-7)
    assert found.exact
    np.testing.assert_allclose(found.marginals, brute(problem), atol=1e-5)


@settings(max_examples=60, deadline=None)
@given(problems(), st.sampled_from([0.5, 0.2, 0.05]))
def test_what_is_missing_is_no_more_than_is_said(problem: Problem, mass: float) -> None:
    found = posterior(problem, mass=mass)
    assert found.exact
    assert found.error <= mass
    assert np.abs(found.marginals - brute(problem)).max(initial=0.0) <= found.error + 1e-5


@settings(max_examples=80, deadline=None)
@given(problems(), st.floats(-30.0, 10.0))
def test_no_sum_over_all_maps_is_above_its_bound(problem: Problem, enough: float) -> None:
    total = float(np.logaddexp.reduce(list(every_map(problem).values())))
    bound = log_sum_bound(problem, total + enough)
    assert bound >= total - 1e-4
    if enough >= 2.0:
        assert bound <= total + enough


@settings(max_examples=10, deadline=None)
@given(problems(), st.integers(0, 9))
def test_sampled_marginals_come_near_those_of_all_maps(problem: Problem, seed: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "FACTOR_CELLS", -1)
        patch.setattr(ladders, "PROPOSALS", 1e5)
        found = posterior(problem, seed=seed)
    assert found.exact == (0 in problem.unary.shape)
    np.testing.assert_allclose(found.marginals, brute(problem), atol=max(0.02, 6 * found.error))


def test_chains_cross_valleys_and_average_groups() -> None:
    n = 9
    unary = np.where(np.eye(n, dtype=bool) | np.eye(n, k=1, dtype=bool), 6.0, 0.0)
    unary[1] = unary[0]
    problem = Problem(NONE, NONE[:, 0], np.zeros((0, n, n), np.float32), unary, np.full(n, -4.0))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "FACTOR_CELLS", -1)
        sampled = posterior(problem)
    assert exchangeable(problem) == ((0, 1),)
    assert sampled.marginals[0].tolist() == sampled.marginals[1].tolist()
    np.testing.assert_allclose(sampled.marginals, permanents(unary, -4.0), atol=0.03)


def permanents(unary: np.ndarray, absent: float) -> np.ndarray:
    """Return the marginals without facts, by recursion over the sets of things that are taken."""
    n1, n2 = unary.shape
    weight = np.concatenate([np.exp(unary), np.full((n1, 1), math.exp(absent))], axis=1)
    marginals = np.zeros((n1, n2 + 1))
    ahead = [{0: 1.0}]
    for i in range(n1):
        ahead.append({})
        for taken, total in ahead[i].items():
            for p in range(n2 + 1):
                if p == n2 or not taken >> p & 1:
                    after = taken | (1 << p if p < n2 else 0)
                    ahead[i + 1][after] = ahead[i + 1].get(after, 0.0) + total * weight[i, p]
    behind = dict.fromkeys(ahead[n1], 1.0)
    for i in reversed(range(n1)):
        before: dict[int, float] = {}
        for taken, total in ahead[i].items():
            for p in range(n2 + 1):
                if p == n2 or not taken >> p & 1:
                    rest = weight[i, p] * behind[taken | (1 << p if p < n2 else 0)]
                    before[taken] = before.get(taken, 0.0) + rest
                    marginals[i, p] += total * rest
        behind = before
    marginals /= marginals.sum(axis=1, keepdims=True)
    return marginals


@settings(max_examples=30, deadline=None)
@given(problems())
def test_marginals_sum_to_one_and_entropy_is_bounded(problem: Problem) -> None:
    found = posterior(problem)
    np.testing.assert_allclose(found.marginals.sum(axis=1), 1.0)
    assert (found.entropy >= 0).all()
    assert (found.entropy <= math.log(problem.unary.shape[1] + 1) + 1e-9).all()


def test_the_same_seed_gives_the_same_marginals() -> None:
    problem = large(20)
    one, two = posterior(problem, seed=4), posterior(problem, seed=4)
    assert not one.exact
    assert one.marginals.tolist() == two.marginals.tolist()


def test_only_large_scenes_have_a_likeliest_map(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, start = large(20), np.full(20, UNMATCHED)
    assert posterior(problem, Deadline.after(0.2), start=start).likeliest is None
    monkeypatch.setattr(coarse_to_fine, "MIN_COARSE_THINGS", 0)
    found = posterior(problem, Deadline.after(0.2), start=start).likeliest
    assert found is not None
    assert problem.value(found) > problem.value(start)
    again = posterior(problem, Deadline.after(0.2), start=found).likeliest
    assert again is not None
    assert problem.value(again) >= problem.value(found) - 1e-3


@pytest.mark.parametrize("seconds", [0.0, 0.3])
def test_the_deadline_is_kept_and_nothing_is_claimed(seconds: float) -> None:
    problem = large(300)
    posterior(large(4))  # compiled or loaded
    with processor_time_below(seconds + 2.0):
        found = posterior(problem, Deadline.after(seconds))
    assert not found.exact
    assert found.error > 0.05
    assert not is_decided(found.marginals.max(axis=1), found.errors).any()
    np.testing.assert_allclose(found.marginals.sum(axis=1), 1.0, atol=1e-5)


def test_past_the_deadline_the_start_is_all_that_is_said() -> None:
    problem, start = large(40), np.arange(40)[::-1].copy()
    start[3] = UNMATCHED
    found = posterior(problem, Deadline.after(-1.0), start=start)
    assert (found.exact, found.error) == (False, math.inf)
    assert found.marginals.argmax(axis=1).tolist() == np.where(start == UNMATCHED, 40, start).tolist()
    assert set(np.unique(found.marginals)) == {0.0, 1.0}


@pytest.mark.parametrize("mass", [0.0, 1.0, -1.0])
def test_a_mass_outside_its_range_is_refused(mass: float) -> None:
    with pytest.raises(MatchingError, match="mass"):
        posterior(large(2), mass=mass)


def test_a_start_that_is_not_a_map_is_refused() -> None:
    with pytest.raises(MatchingError):
        posterior(large(2), start=np.array([1, 1]))


def large(n: int) -> Problem:
    rng = np.random.default_rng(3)
    ends = np.array([rng.choice(n, 2, replace=False) for _ in range(n)])
    tables = rng.normal(0, 1, (3, n, n)).astype(np.float32)
    return Problem(ends, rng.integers(0, 3, n), tables, np.zeros((n, n)), np.full(n, -1.0))
