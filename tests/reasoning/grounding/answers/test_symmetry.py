"""Interchangeable objects, against all renamings of small graphs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from timing import processor_time_below

from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.grounding.answers.symmetry import (
    _Automorphisms,
    _facts,
    _neighbours,
    _stable,
    interchangeable,
)

MakeGraph = Callable[..., RelationGraph]
R = default_ontology().relations


@st.composite
def graphs(draw: st.DrawFn) -> tuple[RelationGraph, list[int]]:
    nodes = list("abcdef")[: draw(st.integers(1, 6))]
    node = st.sampled_from(nodes)
    fact = st.builds(
        Fact,
        node,
        st.sampled_from([(R["left"],), (R["top"],), (R["left"], R["on"])]),
        node,
        st.sampled_from([True, True, True, False]),
        st.sampled_from([False, False, True]),
        st.sampled_from([1.0, 1.0, 0.8]),
    )
    simple = st.builds(lambda s, o: Fact(s, (R["left"],), o), node, node)
    facts = draw(st.lists(simple | simple | fact, max_size=7))
    colours = draw(st.lists(st.sampled_from([0, 0, 0, 1]), min_size=len(nodes), max_size=len(nodes)))
    return RelationGraph.from_facts(R, nodes, facts), colours


@st.composite
def claims(draw: st.DrawFn, nodes: Sequence[str]) -> Claim:
    relation = draw(st.sampled_from(["row", "row in order", "between", "closer", "tallest"]))
    some = tuple(draw(st.permutations(nodes))[:3])
    if relation == "tallest":
        return Claim("tallest", some[:1])
    if relation.startswith("row"):
        return Claim("row", some, value="left to right" if "order" in relation else None)
    return Claim(relation, some[:1], some[1:])


def meaning(claim: Claim, image: Mapping[str, str]) -> tuple[object, ...]:
    """Return what a claim states about renamed objects."""
    subjects, arguments = ([image[name] for name in names] for names in (claim.subjects, claim.arguments))
    if claim.relation == "row" and claim.value is None:
        subjects.sort()
    if claim.relation == "between":
        arguments.sort()
    return (claim.relation, claim.value, *subjects, None, *arguments)


def orbits(graph: RelationGraph, colours: list[int], said: Sequence[Claim] = ()) -> list[tuple[str, ...]]:
    """Find the groups from all renamings that preserve every fact, claim and colour."""
    n = len(graph.nodes)
    edges = [
        (int(s), int(o), int(r), bool(p), bool(q), float(w))
        for s, o, r, p, q, w in zip(
            graph.subjects,
            graph.objects,
            graph.relation_sets,
            graph.positive,
            graph.optional,
            graph.weights,
            strict=True,
        )
    ]
    images: list[set[int]] = [{i} for i in range(n)]
    for image in permutations(range(n)):
        if any(colours[i] != colours[image[i]] for i in range(n)):
            continue
        renamed = {graph.nodes[i]: graph.nodes[image[i]] for i in range(n)}
        if Counter(meaning(one, renamed) for one in said) != Counter(
            meaning(one, {name: name for name in renamed}) for one in said
        ):
            continue
        if Counter((image[s], image[o], *rest) for s, o, *rest in edges) == Counter(
            (s, o, *rest) for s, o, *rest in edges
        ):
            for i in range(n):
                images[i].add(image[i])
    groups = {tuple(sorted(group)) for group in images if len(group) > 1}
    return [tuple(graph.nodes[i] for i in group) for group in sorted(groups)]


@settings(max_examples=80, deadline=None)
@given(graphs())
def test_the_groups_are_the_orbits_of_all_renamings(problem: tuple[RelationGraph, list[int]]) -> None:
    assert interchangeable(*problem) == orbits(*problem)


@settings(max_examples=120, deadline=None)
@given(st.data())
def test_the_groups_are_the_orbits_with_claims(data: st.DataObject) -> None:
    graph, colours = data.draw(graphs())
    said = data.draw(st.lists(claims(graph.nodes), max_size=4))
    assert interchangeable(graph, colours, said) == orbits(graph, colours, said)


def test_a_row_in_order_separates_its_members(graph_of: MakeGraph) -> None:
    frames = graph_of("left(tool, a)", "left(tool, b)", "left(tool, c)")
    row = Claim("row", ("a", "b", "c"))
    assert interchangeable(frames, [0] * 4, [row]) == [("a", "b", "c")]
    assert interchangeable(frames, [0] * 4, [replace(row, value="left to right")]) == []


def test_a_ring_is_one_group_though_no_swap_of_two_proves_it(graph_of: MakeGraph) -> None:
    ring = graph_of("left(a, b)", "left(b, c)", "left(c, d)", "left(d, a)")
    assert interchangeable(ring, [0] * 4) == [("a", "b", "c", "d")]
    assert interchangeable(ring, [0, 1, 0, 1]) == [("a", "c"), ("b", "d")]
    assert interchangeable(ring, [1, 0, 0, 0]) == []


def test_triangles_and_hexagon_fool_only_colour_refinement(graph_of: MakeGraph) -> None:
    """Check twelve nodes of one colour: no triangle node can be exchanged with a hexagon node."""
    rings = ["left(a, b)", "left(b, c)", "left(c, a)", "left(d, e)", "left(e, f)", "left(f, d)"]
    rings += [f"left(h{i}, h{(i + 1) % 6})" for i in range(6)]
    graph = graph_of(*rings)
    assert interchangeable(graph, [0] * 12) == [tuple("abcdef"), tuple(f"h{i}" for i in range(6))]


def test_figure_7_has_three_groups(graph_of: MakeGraph, figure_7: list[str]) -> None:
    groups = interchangeable(graph_of(*figure_7), [0] * 12)
    assert {frozenset(group) for group in groups} == {
        frozenset({"salad_fork", "dinner_fork"}),
        frozenset({"dessert_fork", "dessert_spoon"}),
        frozenset({"dinner_knife", "water_glass"}),
    }


def test_the_fuller_script_has_no_group(graph_of: MakeGraph, full_script: list[str]) -> None:
    assert interchangeable(graph_of(*full_script), [0] * 12) == []


def test_colours_separate(graph_of: MakeGraph) -> None:
    forks = graph_of("left(fork_1, plate)", "left(fork_2, plate)")
    assert interchangeable(forks, [0, 0, 0]) == [("fork_1", "fork_2")]
    assert interchangeable(forks, ["x", 0, "y"]) == []


@pytest.mark.parametrize("other", ["0.8 left(b, p)", "optional left(b, p)", "not left(b, p)", "top(b, p)"])
def test_whatever_qualifies_a_fact_separates(other: str, graph_of: MakeGraph) -> None:
    assert interchangeable(graph_of("left(a, p)", other), [0, 0, 0]) == []


def test_a_thousand_like_objects_are_one_group_soon() -> None:
    nodes = [f"n{i}" for i in range(1000)]
    with processor_time_below(10):
        assert interchangeable(RelationGraph.from_facts(R, nodes, []), [0] * 1000) == [tuple(nodes)]
        forks = [Fact(name, (R["left"],), "n0") for name in nodes[1:]]
        assert interchangeable(RelationGraph.from_facts(R, nodes, forks), [0] * 1000) == [tuple(nodes[1:])]


def test_no_objects_have_no_groups() -> None:
    assert interchangeable(RelationGraph.from_facts(R, [], []), []) == []


def test_many_parts_that_are_alike_are_described_quickly() -> None:
    left = (R["left"],)
    facts = [Fact(f"fork{i}", left, f"plate{i}") for i in range(300)]
    names = [name for fact in facts for name in (fact.subject, fact.object)]
    graph = RelationGraph.from_facts(R, names, facts)
    assert sorted(map(len, interchangeable(graph, [0] * len(names)))) == [300, 300]


@settings(max_examples=80, deadline=None)
@given(graphs())
def test_the_first_colouring_is_that_of_plain_colour_refinement(case: tuple[RelationGraph, list[int]]) -> None:
    graph, colours = case
    edges = list(_facts(graph))
    plain = _Automorphisms(_neighbours(edges, len(graph.nodes))).refine(dict(enumerate(colours)))
    hashed = _stable(edges, colours).tolist()
    n = range(len(graph.nodes))
    assert [[plain[i] == plain[j] for j in n] for i in n] == [[hashed[i] == hashed[j] for j in n] for i in n]
