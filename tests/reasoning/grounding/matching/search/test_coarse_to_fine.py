"""Belief propagation from coarse to fine: probabilities of allowed matches, exact where the facts form a tree."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matching_problems import problems

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import generate
from deixis.reasoning.errors import OutOfTimeError
from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence
from deixis.reasoning.grounding.matching.problem import Problem
from deixis.reasoning.grounding.matching.search import coarse_to_fine as module
from deixis.reasoning.grounding.matching.search.belief_propagation import beliefs_with_places
from deixis.reasoning.grounding.matching.search.coarse_to_fine import CoarseToFine


@settings(max_examples=60, deadline=None)
@given(problems(), st.integers(0, 9))
def test_beliefs_are_probabilities_of_allowed_matches(problem: Problem, seed: int) -> None:
    if not problem.unary.size:
        return
    found, same = CoarseToFine(problem.compiled, None).beliefs(seed=seed)
    assert found.min() >= 0.0
    np.testing.assert_allclose(found.sum(axis=1), 1.0, atol=1e-5)
    assert not found[~problem.compiled.allowed].any()
    assert same is problem.compiled


def test_beliefs_are_exact_where_facts_form_a_chain() -> None:
    problem = chain(5, 40)
    found, _ = CoarseToFine(problem.compiled, None).beliefs()
    np.testing.assert_allclose(found, of_chain(problem), atol=0.01)


@pytest.mark.parametrize("first_cells", [2, 8])
def test_pruned_levels_lead_to_the_same_likeliest_things(first_cells: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "FIRST_CELLS", first_cells)
    monkeypatch.setattr(module, "KEPT_CELLS", 10)
    problem = table(60)
    found, _ = CoarseToFine(problem.compiled, None).beliefs()
    dense, _ = beliefs_with_places(problem.compiled, None)
    is_sure = dense.max(axis=1) > 0.95
    assert is_sure.sum() > 20
    assert (found.argmax(axis=1) == dense.argmax(axis=1))[is_sure].mean() > 0.9


def test_absent_objects_get_places_and_the_others_do_not_vanish() -> None:
    problem = table(60)
    assert problem.places is not None
    found, placed = CoarseToFine(problem.compiled, problem.places()).beliefs()
    assert placed.away.shape == (len(problem.compiled.kind), 61)
    assert 0.5 < found[:, -1].sum() < 15


def test_few_facts_do_not_keep_the_first_estimate_of_absence() -> None:
    drawn = generate(60, 2.0, seed=4)
    problem = no_unary_evidence(drawn.description(), drawn.scene()).problem
    assert problem.places is not None
    found, _ = CoarseToFine(problem.compiled, problem.places()).beliefs()
    assert found.max(axis=1).mean() < 0.5
    assert found[:, -1].sum() < 0.5


def test_refining_keeps_beliefs_that_are_a_fixed_point() -> None:
    problem = chain(5, 40)
    exact = of_chain(problem)
    found, _ = CoarseToFine(problem.compiled, None).refined(exact.astype(np.float32))
    np.testing.assert_allclose(found, exact, atol=0.01)


def test_past_the_deadline_beliefs_are_those_without_facts() -> None:
    problem = chain(5, 40).compiled
    found, _ = CoarseToFine(problem, None).beliefs(Deadline.after(-1.0))
    alone = np.where(problem.allowed, np.exp(problem.unary), 0.0)
    np.testing.assert_allclose(found, alone / alone.sum(axis=1, keepdims=True), atol=1e-5)


def test_beliefs_that_are_cut_short_are_those_of_cells(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = table(100).compiled
    monkeypatch.setattr(module, "FIRST_CELLS", 4)
    levels = iter([None] * 3)  # the tables, then one level

    def require_time(deadline: Deadline) -> None:
        if next(levels, deadline) is deadline:
            raise OutOfTimeError("late")

    fine, _ = CoarseToFine(problem, None).beliefs()
    monkeypatch.setattr(module, "_require_time", require_time)
    coarse, _ = CoarseToFine(problem, None).beliefs()
    np.testing.assert_allclose(coarse.sum(axis=1), 1.0, atol=1e-5)
    assert (coarse > 0).all() and coarse.max() < fine.max()


def test_the_same_seed_gives_the_same_beliefs() -> None:
    problem = table(60).compiled
    once, again = (CoarseToFine(problem, None).beliefs(seed=4)[0] for _ in range(2))
    assert once.tolist() == again.tolist()


def table(objects: int) -> Problem:
    drawn = generate(objects, 6.0, missing=6, extra=6, seed=4)
    return no_unary_evidence(drawn.description(), drawn.scene()).problem


def chain(objects: int, things: int) -> Problem:
    """Return a chain of facts between objects whose allowed things differ, so that they are coupled by facts only."""
    rng = np.random.default_rng(8)
    ends = np.column_stack([np.arange(objects - 1), np.arange(1, objects)])
    allowed = np.arange(things)[None] % objects == np.arange(objects)[:, None]
    tables, unary = rng.normal(0, 1.5, (objects - 1, things, things)), rng.normal(0, 1, (objects, things))
    kinds = np.arange(objects - 1)
    return Problem(ends, kinds, tables.astype(np.float32), unary, np.full(objects, -1.0), allowed)


def of_chain(problem: Problem) -> np.ndarray:
    """Return the exact marginals of a chain by passing messages forwards and backwards once."""
    known, n1 = problem.compiled, len(problem.absent)
    own = np.where(known.allowed, np.exp(known.unary), 0.0)
    pairs = np.exp(known.tables[: n1 - 1].astype(np.float64))
    forwards, backwards = np.ones_like(own), np.ones_like(own)
    for i in range(1, n1):
        forwards[i] = (forwards[i - 1] * own[i - 1]) @ pairs[i - 1]
    for i in range(n1 - 2, -1, -1):
        backwards[i] = pairs[i] @ (backwards[i + 1] * own[i + 1])
    marginals = forwards * own * backwards
    return np.asarray(marginals / marginals.sum(axis=1, keepdims=True))
