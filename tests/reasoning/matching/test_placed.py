"""A problem with places: what is absent is at one of them, and the answer tells of things alone."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.experiments.generated_tables import generate
from deixis.reasoning.evidence import no_unary_evidence
from deixis.reasoning.matching.exact import exact
from deixis.reasoning.matching.placed import AWAY, Placed, placed
from deixis.reasoning.matching.posterior import posterior
from deixis.reasoning.matching.problem import UNMATCHED


def one_fact(tables: list[list[float]], absent: float = -2.0) -> Placed:
    """Two objects, one fact; of the things in the table the first two are perceived."""
    rows = np.array([tables], dtype=np.float32)
    return placed(np.array([[0, 1]]), np.array([0]), rows, np.zeros((2, 2)), np.full(2, absent))


def test_without_a_fact_an_object_is_absent_as_probably_as_with_no_places() -> None:
    none, kinds = np.zeros((0, 2), np.int64), np.zeros(0, np.int64)
    at = [placed(none, kinds, np.zeros((0, n, n), np.float32), np.zeros((1, 2)), np.full(1, -1.0)) for n in (2, 9)]
    found = [one.folded_posterior(posterior(one.problem)).marginals for one in at]
    np.testing.assert_allclose(found[0], found[1], atol=1e-9)
    np.testing.assert_allclose(found[0][0, 2], np.exp(-1) / (2 + np.exp(-1)))


def test_a_fact_that_holds_at_a_place_speaks_for_being_absent() -> None:
    """The fact says 4 where the first object is at the place and the second is the first thing, else -4."""
    tables = np.full((3, 3), -4.0)
    np.fill_diagonal(tables, 0.0)
    tables[2, 0] = 4.0
    with_place = one_fact(tables.tolist())
    without = one_fact(tables[:2, :2].tolist())
    shares = [one.folded_posterior(posterior(one.problem)).marginals[0, -1] for one in (with_place, without)]
    assert shares[0] > 0.9 > 0.6 > shares[1]
    best = exact(with_place.problem)
    assert best.assignment.tolist() == [2, 0]
    assert with_place.folded(best.assignment).tolist() == [UNMATCHED, 0]
    assert best.value == pytest.approx(4.0 - 2.0 + np.log(1 - AWAY))


def test_the_best_value_with_some_matches_is_that_of_the_best_places_for_the_rest() -> None:
    tables = np.array([[0, -4, -4, -4], [-4, 0, -4, -4], [1, -4, 0, -4], [3, -4, -4, 0]], dtype=float)
    problem = one_fact(tables.tolist())
    each = -2.0 + np.log((1 - AWAY) / 2)
    assert problem.best_with(np.array([UNMATCHED, 0])) == pytest.approx(3.0 + each)
    assert problem.best_with(np.array([UNMATCHED, 1])) == pytest.approx(-2.0 + np.log(AWAY))
    assert problem.best_with(np.array([1, 0])) == problem.bare.value(np.array([1, 0]))


@pytest.mark.parametrize("seed", range(3))
def test_probabilities_of_things_and_of_absence_add_up_to_one(seed: int) -> None:
    table = generate(7, 1.5, missing=1, extra=1, seed=seed)
    evidence = no_unary_evidence(table.description(), table.scene())
    marginals = evidence.placed.folded_posterior(posterior(evidence.placed.problem)).marginals
    assert marginals.shape == (7, len(table.boxes) + 1)
    np.testing.assert_allclose(marginals.sum(axis=1), 1.0, atol=1e-9)


def test_without_places_there_is_one_problem() -> None:
    problem = one_fact([[0.0, 1.0], [-1.0, 0.0]])
    assert problem.problem is problem.bare
    assert problem.best_with(np.array([UNMATCHED, 0])) == -2.0


def test_dropping_a_fact_drops_it_with_and_without_places() -> None:
    table = generate(5, 2.0, seed=3)
    evidence = no_unary_evidence(table.description(), table.scene())
    rest = evidence.placed.without(2)
    assert len(rest.bare.ends) == len(rest.problem.ends) == len(evidence.problem.ends) - 1
    np.testing.assert_array_equal(rest.problem.ends, np.delete(evidence.problem.ends, 2, axis=0))
