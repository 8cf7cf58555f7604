"""The exact engine against all partial one-to-one maps: the best total, its proof, the margins, the clock."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.branch_and_bound import Search
from deixis.reasoning.engines import Alignment
from deixis.reasoning.evidence import UNMATCHED, Evidence, no_unary_evidence
from deixis.reasoning.exact import ExactEngine
from deixis.reasoning.rectangle import perceived_graph

MakeGraph = Callable[..., RelationGraph]
MakeBoxes = Callable[..., NDArray[np.float64]]
R = default_ontology().relations


def scene(boxes: NDArray[np.float64]) -> RelationGraph:
    return perceived_graph([f"o{i}" for i in range(len(boxes))], boxes, R)


@st.composite
def descriptions(draw: st.DrawFn, most: int = 5) -> RelationGraph:
    nodes = list("abcde")[: draw(st.integers(0, most))]
    if len(nodes) < 2:
        return RelationGraph.from_facts(R, nodes, [])
    node = st.sampled_from(nodes)
    relations = st.sets(st.sampled_from(list(R.values())), min_size=1, max_size=2)
    fact = st.builds(
        Fact,
        node,
        relations.map(lambda s: tuple(sorted(s, key=lambda r: r.index))),
        node,
        st.sampled_from([True, True, False]),
        st.booleans(),
        st.sampled_from([1.0, 1.0, 0.8, 0.5, 0.2]),
    )
    return RelationGraph.from_facts(R, nodes, draw(st.lists(fact, max_size=7)))


@st.composite
def evidences(draw: st.DrawFn, boxes: NDArray[np.float64] | None = None) -> Evidence:
    description = draw(descriptions())
    n1 = len(description.nodes)
    n2 = draw(st.integers(0, 5 if n1 < 5 else 4))
    extent = st.tuples(st.integers(0, 6), st.integers(1, 4)).map(lambda e: (e[0], e[0] + e[1]))
    drawn = draw(st.lists(st.tuples(extent, extent), min_size=n2, max_size=n2))
    shape = n1, n2
    cells = st.lists(st.sampled_from([True, True, True, False]), min_size=n1 * n2, max_size=n1 * n2)
    amounts = st.lists(st.sampled_from([0.0, 0.0, 0.0, 0.7, 1.6]), min_size=n1 * n2, max_size=n1 * n2)
    corners = np.array(drawn, dtype=np.float64).reshape(-1, 2, 2).transpose(0, 2, 1)
    return Evidence(
        description,
        scene(corners),
        np.array(draw(cells), dtype=bool).reshape(shape),
        np.array(draw(amounts), dtype=np.float64).reshape(shape),
    )


def maps(allowed: NDArray[np.bool_]) -> Iterator[tuple[int, ...]]:
    n1, n2 = allowed.shape
    for count in range(min(n1, n2) + 1):
        for rows in combinations(range(n1), count):
            for columns in permutations(range(n2), count):
                pairs = dict(zip(rows, columns, strict=True))
                if all(allowed[pair] for pair in pairs.items()):
                    yield tuple(pairs.get(i, UNMATCHED) for i in range(n1))


def total(evidence: Evidence, assignment: tuple[int, ...]) -> float:
    """From the sentences of the design: degree times weight, fact by fact, and what labels say."""
    vocabulary, names = evidence.description.vocabulary, exact_names(evidence.scene)
    value = sum(evidence.bonus[i, p] for i, p in enumerate(assignment) if p != UNMATCHED)
    nodes = evidence.description.nodes
    for fact in evidence.description.facts():
        p, q = (assignment[nodes.index(name)] for name in (fact.subject, fact.object))
        if fact.subject == fact.object or UNMATCHED in (p, q):
            continue
        seen = vocabulary[names[p, q]]
        degree = 0.0
        for stated in fact.relations:
            if stated == seen or (stated.name in seen.broader and stated.word == seen.word):
                degree = max(degree, 1.0)
            elif stated.name in seen.broader:
                degree = max(degree, 0.5)
        if not fact.positive:
            degree = 0.0 if degree else 1.0
        value += degree * fact.weight
    return float(value)


def exact_names(graph: RelationGraph) -> dict[tuple[int, int], str]:
    return {(graph.index(fact.subject), graph.index(fact.object)): fact.relations[0].name for fact in graph.facts()}


def align(evidence: Evidence, seconds: float = 10.0) -> Alignment:
    return ExactEngine().align(evidence, time.perf_counter() + seconds)


@settings(max_examples=60, deadline=None)
@given(evidences())
def test_the_total_is_the_best_of_all_maps_and_proved(evidence: Evidence) -> None:
    found = align(evidence)
    chosen = tuple(found.assignment.tolist())
    options = {option: total(evidence, option) for option in maps(evidence.allowed)}
    assert found.proved_best
    assert chosen in options
    assert options[chosen] == pytest.approx(max(options.values()), abs=1e-9)
    assert evidence.total(found.assignment) == pytest.approx(options[chosen], abs=1e-9)


@settings(max_examples=40, deadline=None)
@given(evidences())
def test_of_the_best_maps_one_with_most_matches_is_taken(evidence: Evidence) -> None:
    found = align(evidence)
    options = {option: total(evidence, option) for option in maps(evidence.allowed)}
    best = max(options.values())
    most = max(sum(p != UNMATCHED for p in o) for o, value in options.items() if value > best - 1e-9)
    assert int((found.assignment != UNMATCHED).sum()) == most


@settings(max_examples=40, deadline=None)
@given(evidences())
def test_a_margin_is_what_the_best_map_without_the_match_loses(evidence: Evidence) -> None:
    found = align(evidence)
    assert found.margins is not None
    assert found.runners_up is not None
    options = {option: total(evidence, option) for option in maps(evidence.allowed)}
    for i, p in enumerate(found.assignment.tolist()):
        if p == UNMATCHED:
            assert math.isnan(found.margins[i])
            continue
        without = max(value for option, value in options.items() if option[i] != p)
        assert found.margins[i] == pytest.approx(max(options.values()) - without, abs=1e-9)
        assert found.runners_up[i] != p


@settings(max_examples=40, deadline=None)
@given(evidences(), st.data())
def test_improving_never_worsens_and_keeps_to_what_is_allowed(evidence: Evidence, data: st.DataObject) -> None:
    search = Search(evidence, np.ones(evidence.allowed.shape))
    options = list(maps(evidence.allowed))
    start = np.array(data.draw(st.sampled_from(options)), dtype=np.int64)
    before = start.copy()
    better = search.improve(start)
    np.testing.assert_array_equal(start, before)
    assert search.value(better) >= search.value(start) - 1e-9
    assert tuple(better.tolist()) in set(options)


def test_the_preference_decides_between_equal_totals(boxes_of: MakeBoxes, graph_of: MakeGraph) -> None:
    boxes = boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)])
    evidence = no_unary_evidence(graph_of(nodes="a b"), scene(boxes))
    for best in ([0, 1], [1, 0]):
        preference = np.zeros((2, 2))
        preference[[0, 1], best] = 1e-3
        search = Search(evidence, preference)
        found = search.solve(np.full(2, UNMATCHED), time.perf_counter() + 5)
        assert found.assignment.tolist() == best
        assert found.proved


def test_nothing_at_most_the_floor_is_looked_for(boxes_of: MakeBoxes, graph_of: MakeGraph) -> None:
    evidence = no_unary_evidence(graph_of("left(a, b)"), scene(boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)])))
    search = Search(evidence, np.ones((2, 2)))
    start = np.full(2, UNMATCHED)
    assert search.solve(start, math.inf, floor=0.9).assignment.tolist() == [0, 1]
    assert search.solve(start, math.inf, floor=1.1).assignment.tolist() == [UNMATCHED, UNMATCHED]


def test_a_forbidden_pair_is_not_in_the_answer(boxes_of: MakeBoxes, graph_of: MakeGraph) -> None:
    evidence = no_unary_evidence(graph_of("left(a, b)"), scene(boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)])))
    search = Search(evidence, np.ones((2, 2)))
    found = search.solve(np.full(2, UNMATCHED), math.inf, forbidden=(0, 0))
    assert found.assignment[0] != 0
    assert found.proved


def knotty(n: int) -> Evidence:
    """Random facts that a random scene cannot satisfy together: no bound is near."""
    rng = np.random.default_rng(3)
    low = rng.uniform(0, 10, (n, 2))
    names = [f"n{i:02}" for i in range(n)]
    words = ["left", "right", "top", "bottom", "top_left", "bottom_right"]
    facts = []
    for _ in range(5 * n):
        s, o = rng.choice(n, 2, replace=False)
        facts.append(Fact(names[s], (R[str(rng.choice(words))],), names[o]))
    return no_unary_evidence(
        RelationGraph.from_facts(R, names, facts), scene(np.stack([low, low + rng.uniform(0.1, 2, (n, 2))], axis=1))
    )


@pytest.mark.parametrize("seconds", [-1.0, 0.0, 0.2])
def test_past_the_deadline_there_is_an_answer_that_is_not_called_proved(seconds: float) -> None:
    evidence = knotty(18)
    started = time.perf_counter()
    found = align(evidence, seconds)
    assert time.perf_counter() - started < seconds + 8
    assert not found.proved_best
    assert sorted(found.assignment.tolist()) == list(range(18))
    assert found.margins is not None
    assert np.isnan(found.margins).all()
    assert any("time limit" in note for note in found.notes)


@pytest.mark.parametrize(("n1", "n2"), [(0, 0), (0, 3), (3, 0), (1, 1), (1, 3)])
def test_few_or_no_objects_on_either_side(n1: int, n2: int, graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    description = RelationGraph.from_facts(R, list("abc")[:n1], [])
    boxes = boxes_of(*[[(2 * i, 2 * i + 1), (0, 1)] for i in range(n2)]) if n2 else np.zeros((0, 2, 2))
    found = align(no_unary_evidence(description, scene(boxes)))
    assert found.proved_best
    assert found.matrix.shape == (n1, n2)
    assert int((found.assignment != UNMATCHED).sum()) == min(n1, n2)


def test_graphs_with_nothing_in_common_are_matched_all_the_same_and_none_is_better(
    graph_of: MakeGraph, boxes_of: MakeBoxes
) -> None:
    evidence = no_unary_evidence(graph_of("on(a, b)"), scene(boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)])))
    found = align(evidence)
    assert found.graph_similarity == 0.0
    assert sorted(found.assignment.tolist()) == [0, 1]
    assert found.margins is not None
    assert found.margins.tolist() == [0.0, 0.0]
