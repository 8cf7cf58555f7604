"""Blondel's and Heymans and Singh's similarities: by another way, by hand, and that maps are maps."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from matching_problems import problems
from numpy.typing import NDArray

from deixis.reasoning.grounding.engines.baselines import blondel_similarity, heymans_singh_similarity
from deixis.reasoning.grounding.engines.similarity import assign
from deixis.reasoning.grounding.matching.problem import Problem


def blondel(problem: Problem) -> NDArray[np.int64]:
    return assign(blondel_similarity(problem).matrix, problem.allowed)


def heymans_singh(problem: Problem) -> NDArray[np.int64]:
    return assign(heymans_singh_similarity(problem).matrix, problem.allowed)


def path(n1: int, n2: int) -> Problem:
    """Build a chain of facts 0 -> 1 -> 2 …, and things in a chain."""
    ends = np.stack([np.arange(n1 - 1), np.arange(1, n1)], axis=1)
    return Problem(
        ends, np.zeros(n1 - 1, np.int64), np.eye(n2, k=1, dtype=np.float32)[None], np.zeros((n1, n2)), np.zeros(n1)
    )


@pytest.mark.parametrize(("n1", "n2"), [(3, 3), (3, 5), (4, 4)])
def test_blondel_limit_is_the_leading_eigenprojection(n1: int, n2: int) -> None:
    a, b = np.eye(n1, k=1), np.eye(n2, k=1)
    matrix = np.kron(a, b) + np.kron(a.T, b.T)
    squares, vectors = np.linalg.eigh(matrix @ matrix)
    leading = vectors[:, squares > squares.max() - 1e-9]
    limit = (leading @ (leading.T @ np.ones(n1 * n2))).reshape(n1, n2)
    np.testing.assert_allclose(blondel_similarity(path(n1, n2)).matrix, limit / np.linalg.norm(limit), atol=1e-6)


def test_the_ends_of_an_arrow_are_told_apart_by_what_they_lack() -> None:
    """By hand: with a where the ends agree and x where not, a <- (3a + x) / 4 and x <- -x / 2, so that x vanishes."""
    half = np.sqrt(0.5)
    np.testing.assert_allclose(heymans_singh_similarity(path(2, 2)).matrix, [[half, 0.0], [0.0, half]], atol=1e-6)


def test_an_arrow_is_matched_to_an_arrow() -> None:
    assert blondel(path(3, 3)).tolist() == [0, 1, 2]
    assert heymans_singh(path(3, 3)).tolist() == [0, 1, 2]


@settings(max_examples=40, deadline=None)
@given(problems())
def test_what_comes_out_is_a_map_and_the_similarity_is_finite(problem: Problem) -> None:
    for engine in (blondel, heymans_singh):
        problem.require_map(engine(problem))
    for similarity in (blondel_similarity, heymans_singh_similarity):
        assert np.isfinite(similarity(problem).matrix).all()
