"""The marginal likelihood against all maps weighed one by one: never below it, and near it where there are few."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from matching_problems import every_map, problems

from deixis.reasoning.grounding.matching import posterior as module
from deixis.reasoning.grounding.matching.posterior import log_marginal_likelihood
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem


def brute(problem: Problem) -> float:
    """The mean weight of all maps, by what leaving out costs alone."""
    weight = prior = 0.0
    unruled = Problem(problem.ends, problem.kinds, problem.tables, np.zeros_like(problem.unary), problem.absent)
    for choice in every_map(unruled):
        prior += math.exp(sum(problem.absent[i] for i, p in enumerate(choice) if p == UNMATCHED))
    for value in every_map(problem).values():
        weight += math.exp(value)
    return math.log(weight / prior)


@settings(max_examples=80, deadline=None)
@given(problems())
def test_it_is_never_below_that_of_all_maps_and_little_above(problem: Problem) -> None:
    found = log_marginal_likelihood(problem)
    if 0 in problem.unary.shape:
        assert found == math.inf
        return
    assert -1e-6 <= found - brute(problem) <= 0.05


def test_without_evidence_it_is_that_of_chance() -> None:
    none = np.zeros((0, 2), np.int64)
    problem = Problem(none, none[:, 0], np.zeros((0, 7, 7), np.float32), np.zeros((6, 7)), np.full(6, -3.0))
    assert abs(log_marginal_likelihood(problem)) < 0.05


def test_what_is_too_large_to_add_up_is_not_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = np.array([[0, 1]])
    problem = Problem(ends, np.array([0]), np.zeros((1, 2, 2), np.float32), np.zeros((2, 2)), np.full(2, -1.0))
    monkeypatch.setattr(module, "FACTOR_CELLS", 1)
    assert log_marginal_likelihood(problem) == math.inf
