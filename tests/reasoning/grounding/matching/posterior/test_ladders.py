"""Marginals and evidence from ladders of chains: against all maps one by one, and what they say about their errors."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import generate
from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence
from deixis.reasoning.grounding.matching.posterior import ladders as module
from deixis.reasoning.grounding.matching.posterior.exchangeable import exchangeable
from deixis.reasoning.grounding.matching.posterior.ladders import log_evidence, sampled_marginals
from deixis.reasoning.grounding.matching.posterior.posterior import exact_posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem
from deixis.reasoning.grounding.options import is_decided

NEVER = Deadline.never()


@settings(max_examples=8, deadline=None)
@given(problems(), st.integers(0, 9))
def test_log_evidence_is_that_of_all_maps(problem: Problem, seed: int) -> None:
    values = every_map(problem)
    paid = [sum(problem.absent[i] for i, p in enumerate(choice) if p == UNMATCHED) for choice in values]
    expected = float(np.logaddexp.reduce(list(values.values())) - np.logaddexp.reduce(paid))
    found, error = log_evidence(problem, seed=seed)
    assert found == pytest.approx(expected, abs=max(0.3, 5 * error))


def test_marginals_of_a_larger_problem_are_the_exact_ones() -> None:
    table = generate(12, missing=1, extra=1, seed=1)
    problem = no_unary_evidence(table.description(), table.scene()).problem
    exact = exact_posterior(problem)
    assert exact is not None
    marginals, errors, *_ = sampled_marginals(problem.compiled, exchangeable(problem), NEVER, 0)
    off = np.abs(marginals - exact.marginals).max(axis=1)
    assert off.max() < 0.03
    assert (off <= 6 * errors + exact.error).all()


def test_ladders_in_threads_give_the_same_every_time() -> None:
    problem = drawn(9, 1.0)
    once, again = (sampled_marginals(problem.compiled, (), NEVER, 3) for _ in range(2))
    assert once[0].tolist() == again[0].tolist() and once[1].tolist() == again[1].tolist()


def test_ladders_that_cannot_mix_disagree_and_nothing_is_decided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PROPOSALS", 4e4)
    problem = two_orders(24, 40.0)
    marginals, errors, *_ = sampled_marginals(problem.compiled, (), NEVER, 1)
    assert errors.min() > 0.05
    assert not is_decided(marginals.max(axis=1), errors).any()


def test_past_the_deadline_errors_are_infinite() -> None:
    problem = drawn(30, 2.0)
    marginals, errors, *_ = sampled_marginals(problem.compiled, (), Deadline.after(-1.0), 0)
    assert np.isinf(errors).all()
    np.testing.assert_allclose(marginals.sum(axis=1), 1.0, atol=1e-5)
    assert log_evidence(problem, Deadline.after(-1.0))[1] == math.inf


def drawn(n: int, strength: float) -> Problem:
    rng = np.random.default_rng(n)
    ends = np.array([rng.choice(n, 2, replace=False) for _ in range(2 * n)])
    tables = rng.normal(0, strength, (3, n, n)).astype(np.float32)
    return Problem(ends, rng.integers(0, 3, 2 * n), tables, np.zeros((n, n)), np.full(n, -2.0))


def two_orders(n: int, strength: float) -> Problem:
    """Check a ring of facts with exactly two equally good maps, which share no match."""
    ends = np.stack([np.arange(n), np.roll(np.arange(n), -1)], axis=1)
    kinds, tables = np.arange(n), np.zeros((n, n, n), np.float32)
    for i, (s, o) in enumerate(ends.tolist()):
        tables[i, s, o] = strength
        tables[i, (s + n // 2) % n, (o + n // 2) % n] = strength
    return Problem(ends, kinds, tables, np.zeros((n, n)), np.full(n, -2.0))
