"""Belief propagation: always a map, the best one where messages are exact, and none where time is too short."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from matching_problems import problems

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import generate
from deixis.reasoning.grounding.matching.problem import Problem, to_assignment
from deixis.reasoning.grounding.matching.search import scalable as module
from deixis.reasoning.grounding.matching.search.belief_propagation import LEVELS, MIN_LEVELS, propagate
from deixis.reasoning.grounding.matching.search.scalable import mean_range, scalable


@settings(max_examples=60, deadline=None)
@given(problems())
def test_it_is_a_map_that_nothing_rules_out(problem: Problem) -> None:
    problem.require_map(propagated(problem))


def test_a_chain_of_facts_leads_to_its_one_best_map() -> None:
    # each fact holds of one pair only, so that the chain can lie in one place only
    n = 12
    places = np.random.default_rng(5).permutation(n)
    ends = np.column_stack([np.arange(n - 1), np.arange(1, n)])
    tables = np.zeros((n - 1, n, n), np.float32)
    tables[np.arange(n - 1), places[:-1], places[1:]] = 1.0
    problem = Problem(ends, np.arange(n - 1), tables, np.zeros((n, n)), np.full(n, -1.0))
    assert propagated(problem).tolist() == places.tolist()


def test_without_facts_it_is_the_best_assignment() -> None:
    gain = np.array([[3.0, 2.9, 0.0], [3.0, 0.5, 0.0], [0.2, 0.1, 9.9]])
    allowed = gain < 9
    none = np.zeros((0, 2), np.int64)
    problem = Problem(none, none[:, 0], np.zeros((0, 3, 3), np.float32), gain, np.full(3, -1.0), allowed)
    assert propagated(problem).tolist() == [1, 0, -1]


def test_an_object_that_nothing_suits_is_left_out() -> None:
    tables = np.full((1, 2, 2), -5.0, np.float32)
    tables[0, 0, 0] = tables[0, 1, 1] = 0.0
    gain = np.array([[1.0, 1.0], [0.0, 0.5]])
    problem = Problem(np.array([[0, 1]]), np.array([0]), tables, gain, np.full(2, -1.0))
    assert (propagated(problem) >= 0).sum() == 1


def test_large_table_is_near_the_best_of_annealing(monkeypatch: pytest.MonkeyPatch) -> None:
    table = generate(100, 2.5, 0.1, missing=10, extra=10, seed=4)
    problem = table.crisp(centred=True)
    monkeypatch.setattr(module, "MIN_PROPAGATED_OBJECTS", 101)
    annealed = scalable(problem).value
    assert problem.value(propagated(problem)) > 0.9 * annealed
    monkeypatch.undo()
    assert scalable(problem).value > 0.99 * annealed


def test_the_same_seed_gives_the_same_map() -> None:
    problem = generate(60, seed=1).crisp()
    assert propagated(problem).tolist() == propagated(problem).tolist()


@pytest.mark.parametrize(("seconds", "effort"), [(-1.0, 1.0), (1e-7, 1.0), (np.inf, (MIN_LEVELS - 1) / LEVELS)])
def test_with_too_few_steps_there_is_no_map(seconds: float, effort: float) -> None:
    problem = generate(60, seed=1).crisp()
    deadline = Deadline.after(seconds)
    assert propagate(problem.compiled, mean_range(problem.compiled), deadline, effort=effort) is None


def propagated(problem: Problem) -> np.ndarray:
    labels = propagate(problem.compiled, mean_range(problem.compiled))
    assert labels is not None
    return to_assignment(labels, problem.unary.shape[1])
