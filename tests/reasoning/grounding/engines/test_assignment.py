"""The Hungarian step against all assignments, and the graph similarity by hand."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.reasoning.grounding.engines.similarity import assign, graph_similarity
from deixis.reasoning.grounding.matching.problem import UNMATCHED

Matrix = NDArray[np.float64]


def all_assignments(allowed: NDArray[np.bool_]) -> Iterator[list[int]]:
    """Yield every partial one-to-one map of rows to allowed columns."""
    n1, n2 = allowed.shape
    for count in range(min(n1, n2) + 1):
        for rows in combinations(range(n1), count):
            for columns in permutations(range(n2), count):
                if all(allowed[row, column] for row, column in zip(rows, columns, strict=True)):
                    assignment = [UNMATCHED] * n1
                    for row, column in zip(rows, columns, strict=True):
                        assignment[row] = column
                    yield assignment


@st.composite
def problems(draw: st.DrawFn) -> tuple[Matrix, NDArray[np.bool_]]:
    shape = draw(st.integers(1, 4)), draw(st.integers(1, 4))
    values = st.lists(st.integers(-3, 9), min_size=shape[0] * shape[1], max_size=shape[0] * shape[1])
    flags = st.lists(st.booleans(), min_size=shape[0] * shape[1], max_size=shape[0] * shape[1])
    return np.array(draw(values), dtype=float).reshape(shape), np.array(draw(flags)).reshape(shape)


@settings(max_examples=100, deadline=None)
@given(problems())
def test_most_matches_come_first_then_the_largest_sum(
    problem: tuple[Matrix, NDArray[np.bool_]],
) -> None:
    matrix, allowed = problem

    def key(assignment: list[int]) -> tuple[int, float]:
        pairs = [(row, column) for row, column in enumerate(assignment) if column != UNMATCHED]
        return len(pairs), sum(float(matrix[pair]) for pair in pairs)

    found = assign(matrix, allowed).tolist()
    options = list(all_assignments(allowed))
    assert found in options
    assert key(found) == max(map(key, options))


@pytest.mark.parametrize("shape", [(0, 0), (0, 3), (3, 0)])
def test_nothing_is_assigned_to_nothing(shape: tuple[int, int]) -> None:
    assert assign(np.zeros(shape), np.ones(shape, dtype=bool)).tolist() == [UNMATCHED] * shape[0]


def test_where_nothing_is_allowed_nothing_is_assigned() -> None:
    assert assign(np.ones((2, 2)), np.zeros((2, 2), dtype=bool)).tolist() == [UNMATCHED, UNMATCHED]


@pytest.mark.parametrize("n", [1, 2, 5])
def test_a_perfect_one_to_one_matrix_has_similarity_1(n: int) -> None:
    order = np.random.default_rng(n).permutation(n)
    matrix = np.eye(n)[order] / np.sqrt(n)
    assignment = assign(matrix, np.ones((n, n), dtype=bool))
    np.testing.assert_array_equal(assignment, order)
    assert graph_similarity(matrix, assignment) == pytest.approx(1.0)


def test_the_similarity_of_a_matrix_without_preference_by_hand() -> None:
    """Check 1 over the root of 2: each of four entries is 1/2, and two are matched."""
    matrix = np.full((2, 2), 0.5)
    assert graph_similarity(matrix, np.array([0, 1])) == pytest.approx(1 / np.sqrt(2))
    assert graph_similarity(matrix, np.array([0, UNMATCHED])) == pytest.approx(0.5)


def test_nothing_matched_has_similarity_0() -> None:
    assert graph_similarity(np.ones((2, 2)), np.array([UNMATCHED, UNMATCHED])) == 0.0
    assert graph_similarity(np.zeros((0, 0)), np.zeros(0, dtype=np.int64)) == 0.0


@settings(max_examples=50, deadline=None)
@given(problems())
def test_the_similarity_of_a_normalised_matrix_is_at_most_1(problem: tuple[Matrix, NDArray[np.bool_]]) -> None:
    matrix, allowed = np.abs(problem[0]), problem[1]
    norm = np.sqrt((matrix**2).sum())
    matrix = matrix / norm if norm else matrix
    assert -1e-12 <= graph_similarity(matrix, assign(matrix, allowed)) <= 1 + 1e-12
