"""Equations 5 to 9 against plain loops written from the paper, in the design's reading of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import PaperGraph, RelationGraph
from deixis.reasoning.grounding.engines import similarity
from deixis.reasoning.grounding.engines.similarity import node_similarity

MakeGraph = Callable[..., RelationGraph]
Matrix = NDArray[np.float64]
Edge = tuple[int, int, int]
"""From, to, label."""

LABELS = ("left", "right", "top", "on")


def paper_graph(n: int, edges: list[Edge]) -> PaperGraph:
    vertices = tuple(f"v{i}" for i in range(n))
    ends = np.array([edge[:2] for edge in edges], dtype=np.int32).reshape(-1, 2)
    return PaperGraph(vertices, ends, np.array([edge[2] for edge in edges], dtype=np.int8), LABELS)


@st.composite
def graphs(draw: st.DrawFn, least: int = 1, most: int = 5) -> tuple[int, list[Edge]]:
    n = draw(st.integers(least, most))
    pairs = st.tuples(st.integers(0, n - 1), st.integers(0, n - 1)).filter(lambda p: p[0] != p[1])
    chosen = draw(st.lists(pairs, max_size=10, unique=True)) if n > 1 else []
    return n, [(a, b, draw(st.integers(0, len(LABELS) - 1))) for a, b in chosen]


def reference(
    first: tuple[int, list[Edge]], second: tuple[int, list[Edge]], iterations: int, prior: Matrix | None = None
) -> Matrix:
    """Compute equations 5 to 9 with sums over pairs of edges, label by label."""
    (n1, edges1), (n2, edges2) = first, second
    shared = {label for _, _, label in edges1} & {label for _, _, label in edges2}

    def degree(edges: list[Edge], end: int, node: int, label: int) -> int:
        return sum(1 for edge in edges if edge[end] == node and edge[2] == label)

    sim = np.zeros((n1, n2))
    for a in range(n1):
        for b in range(n2):
            for label in shared:
                for end in (0, 1):
                    sim[a, b] += min(degree(edges1, end, a, label), degree(edges2, end, b, label))
    if prior is not None:
        sim = sim * prior
    s = normalised(sim)
    for _ in range(iterations):
        following = np.zeros((n1, n2))
        for a in range(n1):
            for b in range(n2):
                for label in shared:
                    for here, there in ((1, 0), (0, 1)):  # equation 6 looks at incoming edges, 7 at outgoing ones
                        d1, d2 = degree(edges1, here, a, label), degree(edges2, here, b, label)
                        if d1 and d2:
                            following[a, b] += sum(
                                s[e[there], f[there]] / (d1 * d2)
                                for e in edges1
                                for f in edges2
                                if e[here] == a and f[here] == b and e[2] == f[2] == label
                            )
                        elif not d1 and not d2:
                            following[a, b] += s.sum() / (n1 * n2)
                following[a, b] *= sim[a, b] / 2
        s = normalised(following)
    return s


def normalised(matrix: Matrix) -> Matrix:
    norm = math.sqrt(float((matrix**2).sum()))
    return matrix / norm if norm else matrix


@settings(max_examples=60, deadline=None)
@given(graphs(), graphs(), st.integers(0, 6), st.booleans(), st.integers(0, 2**16))
def test_the_arrays_agree_with_the_plain_loops(
    first: tuple[int, list[Edge]], second: tuple[int, list[Edge]], iterations: int, with_prior: bool, seed: int
) -> None:
    prior = np.random.default_rng(seed).choice([0.0, 0.5, 1.0, 2.0], (first[0], second[0])) if with_prior else None
    found = node_similarity(
        paper_graph(*first), paper_graph(*second), prior=prior, tolerance=-1.0, iterations=iterations
    )
    assert found.iterations == iterations
    np.testing.assert_allclose(found.matrices[0], reference(first, second, iterations, prior), atol=1e-10)


@settings(max_examples=50, deadline=None)
@given(graphs(least=2), graphs(), st.integers(1, 5), st.data())
def test_a_subgraph_in_a_batch_is_as_similar_as_by_itself(
    first: tuple[int, list[Edge]], second: tuple[int, list[Edge]], iterations: int, data: st.DataObject
) -> None:
    n1, edges = first
    rows = data.draw(st.lists(st.sets(st.integers(0, n1 - 1), min_size=1), min_size=1, max_size=4))
    members = np.array([[i in row for i in range(n1)] for row in rows])
    prior = np.random.default_rng(n1).choice([0.0, 1.0, 3.0], (n1, second[0]))
    found = node_similarity(paper_graph(*first), paper_graph(*second), members, prior, -1.0, iterations)
    assert found.matrices.shape == (len(rows), n1, second[0])
    for row, matrix in zip(rows, found.matrices, strict=True):
        kept = sorted(row)
        part = [(kept.index(a), kept.index(b), label) for a, b, label in edges if a in row and b in row]
        expected = np.zeros_like(matrix)
        expected[kept] = reference((len(kept), part), second, iterations, prior[kept])
        np.testing.assert_allclose(matrix, expected, atol=1e-10)


@settings(max_examples=50, deadline=None)
@given(graphs(), graphs(), st.data())
def test_renaming_the_nodes_of_either_graph_permutes_the_matrix(
    first: tuple[int, list[Edge]], second: tuple[int, list[Edge]], data: st.DataObject
) -> None:
    p, q = (data.draw(st.permutations(range(n))) for n, _ in (first, second))
    renamed1 = paper_graph(first[0], [(p[a], p[b], label) for a, b, label in first[1]])
    renamed2 = paper_graph(second[0], [(q[a], q[b], label) for a, b, label in second[1]])
    plain = node_similarity(paper_graph(*first), paper_graph(*second), tolerance=-1.0, iterations=8).matrices[0]
    renamed = node_similarity(renamed1, renamed2, tolerance=-1.0, iterations=8).matrices[0]
    np.testing.assert_allclose(renamed[np.ix_(p, q)], plain, atol=1e-10)


@settings(max_examples=50, deadline=None)
@given(graphs(), graphs())
def test_the_matrix_is_normal_or_zero_without_shared_labels(
    first: tuple[int, list[Edge]], second: tuple[int, list[Edge]]
) -> None:
    found = node_similarity(paper_graph(*first), paper_graph(*second))
    assert np.isfinite(found.matrices).all()
    assert (found.matrices >= 0).all()
    shared = {edge[2] for edge in first[1]} & {edge[2] for edge in second[1]}
    norm = float(np.sqrt((found.matrices[0] ** 2).sum()))
    assert norm == pytest.approx(1.0 if shared else 0.0)


@settings(max_examples=30, deadline=None)
@given(graphs(least=2), graphs(least=2))
def test_the_transposed_question_has_the_transposed_answer(
    first: tuple[int, list[Edge]], second: tuple[int, list[Edge]]
) -> None:
    there = node_similarity(paper_graph(*first), paper_graph(*second), tolerance=-1.0, iterations=5).matrices[0]
    back = node_similarity(paper_graph(*second), paper_graph(*first), tolerance=-1.0, iterations=5).matrices[0]
    np.testing.assert_allclose(there, back.T, atol=1e-10)


def test_one_edge_by_hand() -> None:
    """Equation 5 is the identity, and the two entries stay equal: each is 1 over the root of 2."""
    graph = paper_graph(2, [(0, 1, 0)])
    found = node_similarity(graph, graph)
    np.testing.assert_allclose(found.matrices[0], np.eye(2) / math.sqrt(2), atol=1e-12)
    assert found.converged.all()


def test_two_forks_left_of_a_plate_by_hand() -> None:
    """Solve by hand: with u for a fork and a fork, v for the plate, m = (4u + v)/9: u' = (m + v)/2 and v' = u + m.

    So r = v/u obeys 5r^2 + r - 13 = 0, and 4u^2 + v^2 = 1.
    """
    graph = paper_graph(3, [(0, 2, 0), (1, 2, 0)])
    found = node_similarity(graph, graph, tolerance=1e-14)
    r = (math.sqrt(261) - 1) / 10
    u = 1 / math.sqrt(4 + r * r)
    np.testing.assert_allclose(found.matrices[0], [[u, u, 0], [u, u, 0], [0, 0, r * u]], atol=1e-10)


def test_one_iteration_by_hand() -> None:
    """left(a, b), on(b, c) against left(x, y): equation 5 has 1 for (a, x) and (b, y), and on is not shared.

    After the first step m = 2/6 of an entry s, and both entries are (m + s)/2: equal again.
    """
    found = node_similarity(paper_graph(3, [(0, 1, 0), (1, 2, 3)]), paper_graph(2, [(0, 1, 0)]), iterations=1)
    expected = np.array([[1, 0], [0, 1], [0, 0]]) / math.sqrt(2)
    np.testing.assert_allclose(found.matrices[0], expected, atol=1e-12)


def test_graphs_without_a_shared_label_are_not_alike() -> None:
    found = node_similarity(paper_graph(2, [(0, 1, 0)]), paper_graph(3, [(0, 1, 1), (1, 2, 2)]))
    assert not found.matrices.any()
    assert found.converged.all()


@pytest.mark.parametrize(("n1", "n2"), [(0, 0), (0, 2), (2, 0), (2, 2)])
def test_graphs_without_edges_or_nodes_are_not_alike(n1: int, n2: int) -> None:
    found = node_similarity(paper_graph(n1, []), paper_graph(n2, []))
    assert found.matrices.shape == (1, n1, n2)
    assert not found.matrices.any()


def test_not_converging_is_reported(graph_of: MakeGraph, figure_7: list[str]) -> None:
    graph = graph_of(*figure_7).paper_view()
    short = node_similarity(graph, graph, iterations=1)
    assert (short.converged.tolist(), short.iterations) == ([False], 1)
    long = node_similarity(graph, graph)
    assert long.converged.tolist() == [True]
    assert 1 < long.iterations < 500


def test_a_prior_of_zero_forbids_a_pair(graph_of: MakeGraph, figure_7: list[str]) -> None:
    graph = graph_of(*figure_7).paper_view()
    prior = np.ones((12, 12))
    prior[1, 1] = 0
    assert node_similarity(graph, graph).matrices[0, 1, 1] > 0
    assert node_similarity(graph, graph, prior=prior).matrices[0, 1, 1] == 0


def test_deadline_stops_without_convergence() -> None:
    graph = paper_graph(3, [(0, 1, 0), (1, 2, 1), (2, 0, 0)])
    found = node_similarity(graph, graph, deadline=Deadline.after(0.0))
    assert found.iterations == 0
    assert not found.converged.any()
    assert found.matrices.any()


def test_many_edges_cost_no_more_than_a_matrix_for_each_label() -> None:
    rng = np.random.default_rng(1)
    n, count = 400, 12_000
    ends = rng.integers(n, size=(count, 2)).tolist()
    graph = paper_graph(n, [(a, b, (a + b) % 2) for a, b in ends])
    with processor_time_below(2.0):
        node_similarity(graph, graph, iterations=2)


@pytest.mark.parametrize(("dense", "looped"), [(0, 10_000), (0, 0)])
def test_large_sets_of_edges_carry_what_small_ones_do(monkeypatch: pytest.MonkeyPatch, dense: int, looped: int) -> None:
    rng, pairs = np.random.default_rng(3), list(itertools.permutations(range(9), 2))
    edges = [(*pairs[i], int(rng.integers(4))) for i in rng.permutation(len(pairs)).tolist()]
    first, second = paper_graph(9, edges[:40]), paper_graph(9, edges[30:])
    expected = node_similarity(first, second, iterations=20).matrices
    monkeypatch.setattr(similarity, "MAX_DENSE", dense)
    monkeypatch.setattr(similarity, "MAX_LOOPED", looped)
    monkeypatch.setattr(similarity, "CARRIED_CELLS", 3 * 81)  # three of the eight labels and directions at once
    found = node_similarity(first, second, iterations=20).matrices
    assert found == pytest.approx(expected, abs=1e-12) and expected.any()
