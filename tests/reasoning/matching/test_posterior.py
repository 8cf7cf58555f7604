"""The posterior against all maps weighed one by one, and the sampled one against the exact one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import every_map, problems

from deixis.reasoning.matching.posterior import posterior
from deixis.reasoning.matching.problem import MatchingError, Problem


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
def test_listed_marginals_are_those_of_all_maps(problem: Problem) -> None:
    found = posterior(problem)
    assert found.exact
    np.testing.assert_allclose(found.marginals, brute(problem), atol=1e-5)


@settings(max_examples=6, deadline=None)
@given(problems(), st.integers(0, 9))
def test_sampled_marginals_come_near_those_of_all_maps(problem: Problem, seed: int) -> None:
    found = posterior(problem, limit=1, seed=seed)
    assert found.exact == (len(every_map(problem)) == 1)
    np.testing.assert_allclose(found.marginals, brute(problem), atol=0.05)


@settings(max_examples=30, deadline=None)
@given(problems())
def test_every_object_is_something_or_left_out_and_entropy_is_bounded(problem: Problem) -> None:
    found = posterior(problem)
    np.testing.assert_allclose(found.marginals.sum(axis=1), 1.0)
    assert (found.entropy >= 0).all()
    assert (found.entropy <= math.log(problem.unary.shape[1] + 1) + 1e-9).all()


@pytest.mark.parametrize("mass", [0.0, 1.0, -1.0])
def test_a_mass_outside_its_range_is_refused(mass: float) -> None:
    none = np.zeros((0, 2), np.int64)
    with pytest.raises(MatchingError, match="mass"):
        posterior(Problem(none, none[:, 0], np.zeros((0, 1, 1), np.float32), np.zeros((1, 1)), np.zeros(1)), mass=mass)
