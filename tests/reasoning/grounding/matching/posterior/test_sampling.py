"""Chains of random maps: their maps are maps, and their values those of the maps; proposals are drawn as stated."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import problems

from deixis.reasoning.grounding.matching.posterior.sampling import begin, cool, guide_by, new_chains, sample
from deixis.reasoning.grounding.matching.problem import Problem, to_assignment


def beliefs(problem: Problem, seed: int) -> np.ndarray:
    drawn = np.random.default_rng(seed).random((len(problem.absent), problem.unary.shape[1] + 1))
    shares: np.ndarray = drawn / drawn.sum(axis=1, keepdims=True)
    return shares


@settings(max_examples=60, deadline=None)
@given(problems(), st.integers(0, 2**20))
def test_chains_hold_allowed_maps_and_their_values(problem: Problem, seed: int) -> None:
    n1, n2 = problem.unary.shape
    if not n1 or not n2:
        return
    guide = guide_by(beliefs(problem, seed), problem.compiled.allowed)
    chains = new_chains(problem.compiled, np.array([1.0, 0.5, 0.0]))
    begin(chains, problem.compiled, guide, seed)
    cool(chains, problem.compiled, guide, np.array([0.7, 0.4, 0.1]), 2, seed)
    counts, sums = np.zeros((n1, n2 + 1), np.float32), np.zeros(3)
    sample(chains, counts, sums, problem.compiled, guide, 7, seed)
    assert counts.sum(axis=1).tolist() == [7.0] * n1
    assert not counts[~problem.compiled.allowed].any()
    for labels, holder, value in zip(chains.labels, chains.holder, chains.values, strict=True):
        assignment = to_assignment(labels, n2)
        problem.require_map(assignment)
        paid = problem.absent[labels == n2].sum()
        assert value == pytest.approx(problem.value(assignment) - paid, abs=1e-3)
        assert {p: i for p, i in enumerate(holder.tolist()) if i >= 0} == {
            p: i for i, p in enumerate(labels.tolist()) if p < n2
        }


@settings(max_examples=30, deadline=None)
@given(problems(), st.integers(0, 2**20))
def test_the_alias_tables_give_back_the_probabilities(problem: Problem, seed: int) -> None:
    n1, n2 = problem.unary.shape
    if not n1:
        return
    guide = guide_by(beliefs(problem, seed), problem.compiled.allowed)
    drawn = np.zeros((n1, n2 + 1))
    for i in range(n1):
        for p in range(n2 + 1):
            drawn[i, p] += guide.keep[i, p]
            drawn[i, guide.alias[i, p]] += 1.0 - guide.keep[i, p]
    expected = guide.weight / guide.weight.sum(axis=1, keepdims=True)
    np.testing.assert_allclose(drawn / (n2 + 1), expected, atol=1e-5)
    assert not expected[~problem.compiled.allowed].any()
    assert guide.weight.sum() == pytest.approx(1.0, abs=1e-4)


@settings(max_examples=40, deadline=None)
@given(problems(), st.integers(0, 2**20))
def test_facts_about_absent_objects_are_in_the_values(problem: Problem, seed: int) -> None:
    n1, n2 = problem.unary.shape
    if not n1 or not n2:
        return
    known, rng = problem.compiled, np.random.default_rng(seed)
    away = rng.normal(0.0, 2.0, (len(known.kind), n2 + 1)).astype(np.float32)
    away[:, -1] = 0.0
    known = known._replace(away=away)
    guide = guide_by(beliefs(problem, seed), known.allowed)
    chains = new_chains(known, np.array([1.0, 0.3]))
    begin(chains, known, guide, seed)
    sample(chains, np.zeros((n1, n2 + 1), np.float32), np.zeros(2), known, guide, 9, seed)
    owner = np.repeat(np.arange(n1), np.diff(known.first))
    for labels, value in zip(chains.labels, chains.values, strict=True):
        mine, theirs = labels[owner], labels[known.other]
        about = away[mine == n2, theirs[mine == n2]].sum()
        paid = problem.absent[labels == n2].sum()
        assert value == pytest.approx(problem.value(to_assignment(labels, n2)) - paid + about, abs=1e-3)
