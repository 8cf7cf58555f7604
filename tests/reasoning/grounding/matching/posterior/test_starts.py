"""Starts of chains in large scenes: several runs, their shares, and marginals that remain those of the posterior."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import problems

from deixis.deadline import CLOCK, Deadline
from deixis.experiments.generated_tables import generate
from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence
from deixis.reasoning.grounding.matching.posterior import starts
from deixis.reasoning.grounding.matching.posterior.exchangeable import exchangeable
from deixis.reasoning.grounding.matching.posterior.ladders import log_evidence, sampled_marginals
from deixis.reasoning.grounding.matching.posterior.posterior import exact_posterior
from deixis.reasoning.grounding.matching.posterior.sampling import map_value
from deixis.reasoning.grounding.matching.posterior.starts import Starts, starts_of
from deixis.reasoning.grounding.matching.problem import Problem, to_labels
from deixis.reasoning.grounding.matching.search import coarse_to_fine

NEVER = Deadline.never()


@pytest.fixture
def _all_are_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(coarse_to_fine, "MIN_COARSE_THINGS", 0)


@pytest.mark.usefixtures("_all_are_large")
def test_marginals_from_several_starts_are_the_exact_ones() -> None:
    table = generate(12, missing=1, extra=1, seed=1)
    problem = no_unary_evidence(table.description(), table.scene()).problem
    exact = exact_posterior(problem)
    assert exact is not None
    marginals, errors, _ = sampled_marginals(problem.compiled, exchangeable(problem), NEVER, 0)
    off = np.abs(marginals - exact.marginals).max(axis=1)
    assert len(starts_of(problem.compiled, None, NEVER).runs) == starts.RUNS + 1
    assert off.max() < 0.03
    assert (off <= 6 * errors + exact.error).all()


@pytest.mark.usefixtures("_all_are_large")
@settings(max_examples=8, deadline=None)
@given(problems(), st.integers(0, 9))
def test_marginals_of_small_problems_are_the_exact_ones(problem: Problem, seed: int) -> None:
    exact = exact_posterior(problem)
    if exact is None or not problem.unary.size:
        return
    found = sampled_marginals(problem.compiled, exchangeable(problem), NEVER, seed)
    assert np.abs(found.marginals - exact.marginals).max() < 0.05


def test_log_evidence_does_not_depend_on_the_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    table = generate(8, missing=1, extra=1, seed=2)
    problem = no_unary_evidence(table.description(), table.scene()).problem
    dense, first_error = log_evidence(problem)
    monkeypatch.setattr(coarse_to_fine, "MIN_COARSE_THINGS", 0)
    value, error = log_evidence(problem)
    assert value == pytest.approx(dense, abs=max(0.5, 4 * (first_error + error)))


@pytest.mark.usefixtures("_all_are_large")
def test_without_time_there_is_one_run() -> None:
    table = generate(12, seed=1)
    problem = no_unary_evidence(table.description(), table.scene()).problem
    assert len(starts_of(problem.compiled, None, Deadline.after(-1.0)).runs) == 1


@pytest.mark.usefixtures("_all_are_large")
@pytest.mark.parametrize(("seconds", "runs"), [(1.5, 1), (2.5, 2), (2.9, 3)])
def test_a_second_run_comes_before_a_refinement(monkeypatch: pytest.MonkeyPatch, seconds: float, runs: int) -> None:
    """Check runs of 1 s each, and a refinement of 0.8 s: two runs and a refinement take 2.8 s."""
    now, beliefs = [0.0], coarse_to_fine.CoarseToFine.beliefs

    def slow(self: coarse_to_fine.CoarseToFine, deadline: Deadline, *, seed: int = 0) -> object:
        now[0] += 1.0
        return beliefs(self, NEVER, seed=seed)

    table = generate(12, seed=1)
    problem = no_unary_evidence(table.description(), table.scene()).problem
    monkeypatch.setitem(vars(CLOCK), "now", lambda: now[0])
    monkeypatch.setattr(coarse_to_fine.CoarseToFine, "beliefs", slow)
    assert len(starts_of(problem.compiled, None, Deadline.after(seconds)).runs) == runs


def test_ladders_start_from_runs_in_proportion_to_shares() -> None:
    problem = Problem(
        np.zeros((0, 2), np.int64),
        np.zeros(0, np.int64),
        np.zeros((0, 1, 1), np.float32),
        np.zeros((4, 1)),
        np.zeros(4),
    )
    runs = tuple(np.full((4, 2), share, np.float32) for share in (0.1, 0.2, 0.3))
    found = Starts(problem.compiled, runs, np.array([0.0, 0.0, -1000.0]))
    np.testing.assert_allclose(found.shares, [5 / 12, 5 / 12, 1 / 6])
    assert np.bincount(found.of_ladders(12)).tolist() == [5, 5, 2]
    np.testing.assert_allclose(found.beliefs, (0.1 * 5 + 0.2 * 5 + 0.3 * 2) / 12, rtol=1e-5)


@settings(max_examples=40, deadline=None)
@given(problems(), st.integers(0, 2**20))
def test_the_value_of_a_map_is_that_of_the_problem(problem: Problem, seed: int) -> None:
    n1, n2 = problem.unary.shape
    assignment, rng = np.full(n1, -1), np.random.default_rng(seed)
    for i, p in zip(rng.permutation(n1), rng.permutation(n2), strict=False):
        if problem.allowed[i, p]:
            assignment[i] = p
    expected = problem.value(assignment)
    assert map_value(to_labels(assignment, n2), problem.compiled) == pytest.approx(expected, abs=1e-4)
