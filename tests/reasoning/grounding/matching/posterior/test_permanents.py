"""Sums over all maps without facts."""

from __future__ import annotations

from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import maps

from deixis.reasoning.grounding.matching.posterior import permanents
from deixis.reasoning.grounding.matching.posterior.permanents import (
    log_prior,
    log_sum_without_facts,
    mean_without_facts,
)
from deixis.reasoning.grounding.matching.problem import Problem


@st.composite
def problems(draw: st.DrawFn, largest: int = 4) -> Problem:
    n1, n2 = draw(st.integers(1, largest)), draw(st.integers(1, largest))
    rng = np.random.default_rng(draw(st.integers(0, 10_000)))
    ends = np.zeros((0, 2), np.int64)
    unary, absent = rng.normal(0, 2, (n1, n2)), rng.normal(-3, 1, n1)
    return Problem(ends, ends[:, 0], np.zeros((0, n2, n2), np.float32), unary, absent, rng.random((n1, n2)) < 0.8)


def enumerated(problem: Problem, unary: bool) -> float:
    n1, n2 = problem.unary.shape
    total = 0.0
    for count in range(min(n1, n2) + 1):
        for rows in combinations(range(n1), count):
            for columns in permutations(range(n2), count):
                left = np.delete(problem.absent, list(rows)).sum()
                if not unary:
                    total += np.exp(left)
                elif problem.allowed[list(rows), list(columns)].all():
                    total += np.exp(left + problem.unary[list(rows), list(columns)].sum())
    return float(np.log(total))


@settings(max_examples=60, deadline=None)
@given(problems())
def test_sums_are_those_of_all_maps(problem: Problem) -> None:
    assert log_sum_without_facts(problem) == pytest.approx(enumerated(problem, True), abs=1e-9)
    assert log_prior(problem) == pytest.approx(enumerated(problem, False), abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(problems())
def test_means_are_those_over_all_maps(problem: Problem) -> None:
    part = np.random.default_rng(0).normal(0, 1, problem.unary.shape)
    found = [(problem.value(option), option) for option in maps(problem.allowed)]
    weights = np.exp([value for value, _ in found])
    values = [
        sum(problem.absent[i] if p < 0 else part[i, p] for i, p in enumerate(option.tolist())) for _, option in found
    ]
    mean = float(weights @ values / weights.sum())
    assert mean_without_facts(problem, part) == pytest.approx(mean, abs=1e-4)


@pytest.mark.parametrize("spread", [0.0, 1.0, 3.0])
def test_the_sum_of_many_is_near_the_exact_one(spread: float, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(1)
    ends = np.zeros((0, 2), np.int64)
    unary = rng.normal(0, spread, (12, 12)) + 0.001
    problem = Problem(ends, ends[:, 0], np.zeros((0, 12, 12), np.float32), unary, np.full(12, -4.0))
    exact = log_sum_without_facts(problem)
    monkeypatch.setattr(permanents, "MAX_EXACT", 0)
    assert log_sum_without_facts(problem) == pytest.approx(exact, abs=0.5)
