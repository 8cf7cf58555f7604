"""Matches that are coincidences: an absent object, and another thing that satisfies its facts."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from matching_problems import problems

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.posterior.coincidences import (
    CERTAINLY_PRESENT,
    PRIOR_ABSENT,
    SHIPPED_WEIGHTS,
    coincidences,
    discounted,
)
from deixis.reasoning.grounding.matching.posterior.posterior import Posterior, posterior
from deixis.reasoning.grounding.matching.problem import Problem


def row(misfit: float = 0.0, n: int = 6, u: float = 0.0) -> tuple[Problem, Posterior]:
    """Return a chain of objects, each beside the next; the last fact of the first object fails by ``misfit``."""
    table = np.full((1, n, n), -3.0, np.float32)
    table[0, np.arange(n - 1), np.arange(1, n)] = 3.0
    ends = np.array([(i, i + 1) for i in range(n - 1)])
    off = table.copy()
    off[0, 0, 1] -= misfit
    problem = Problem(
        ends,
        np.array([1] + [0] * (n - 2)),
        np.concatenate([table, off]),
        np.where(np.eye(n), u, 0.0),
        np.full(n, -5.0),
    )
    return problem, Posterior(np.hstack([np.eye(n) * 0.999, np.full((n, 1), 0.001)]), True, 0.0)


@settings(max_examples=40, deadline=None)
@given(problems())
def test_numbers_are_those_of_loops_over_facts(problem: Problem) -> None:
    marginals = posterior(problem).marginals
    n1, n2 = problem.unary.shape
    if not n2:
        return
    found = coincidences(problem, marginals)
    for i in range(n1):
        values, largest = np.zeros(n2), 0.0
        for (a, b), kind in zip(problem.ends.tolist(), problem.kinds.tolist(), strict=True):
            if i in (a, b):
                likelihood = np.exp(problem.tables[kind] if i == a else problem.tables[kind].T)
                other = marginals[b if i == a else a]
                values += np.log(likelihood @ other[:n2] + other[n2])
                largest += math.log(likelihood.max(axis=0) @ other[:n2] + other[n2])
        p = int(marginals[i, :n2].round(6).argmax())
        assert found.misfit[i] == pytest.approx(max(0.0, largest - values[p]), abs=1e-4)
        others = problem.allowed[i] & (np.arange(n2) != p)
        assert found.alternatives[i] == pytest.approx(np.exp(values[others] - values[p]).sum(), rel=1e-3)


@settings(max_examples=40, deadline=None)
@given(problems())
def test_discounted_rows_are_distributions_with_more_absence(problem: Problem) -> None:
    before = posterior(problem)
    after = discounted(problem, before).marginals
    np.testing.assert_allclose(after.sum(axis=1), 1.0, atol=1e-6)
    assert (after[:, :-1] <= before.marginals[:, :-1] + 1e-12).all()


def test_past_the_deadline_the_probabilities_are_unknown() -> None:
    problem, found = row(4.0)
    assert not found.is_unknown
    assert discounted(problem, found, Deadline.after(0.0)).is_unknown


def test_a_match_that_misses_facts_is_less_probable() -> None:
    chances = [discounted(*row(misfit)).marginals[0, 0] for misfit in (0.0, 4.0, 8.0, 16.0)]
    assert chances == sorted(chances, reverse=True)
    assert chances[0] > 0.99 > chances[-1]


def test_a_label_or_a_kind_speaks_against_a_coincidence() -> None:
    assert discounted(*row(12.0, u=4.0)).marginals[0, 0] > discounted(*row(12.0)).marginals[0, 0]


def test_objects_that_were_pointed_out_keep_their_things() -> None:
    problem, found = row(16.0)
    known = discounted(replace(problem, absent=np.full(6, CERTAINLY_PRESENT - 1)), found)
    assert (known.marginals == found.marginals).all()


def test_objects_without_facts_keep_their_things() -> None:
    problem, found = row(16.0)
    alone = replace(problem, ends=problem.ends[:0], kinds=problem.kinds[:0])
    assert (discounted(alone, found).marginals == found.marginals).all()


def test_absent_neighbours_make_coincidences_more_probable() -> None:
    problem, found = row(8.0, n=30)
    marginals = found.marginals.copy()
    marginals[10:] = np.eye(31)[30]  # two thirds of the objects are absent
    there = discounted(problem, found).marginals[0, 0]
    assert discounted(problem, replace(found, marginals=marginals)).marginals[0, 0] < there
    assert coincidences(problem, marginals).remaining(SHIPPED_WEIGHTS)[0] < 1.0 - PRIOR_ABSENT / 10


def test_a_counted_number_of_absent_objects_stays() -> None:
    problem, found = row(misfit=3.0, n=40)
    flat = replace(found, marginals=np.hstack([np.full((40, 40), 0.999 / 40), np.full((40, 1), 0.001)]))
    again = discounted(problem, flat).marginals[:, -1].mean()
    once = discounted(problem, replace(flat, absent_counted=True)).marginals[:, -1].mean()
    assert 0.001 < once < again
