"""The relation graph: facts in and out, subgraphs, views, and Definitions 1 and 2 of the paper."""

from __future__ import annotations

from typing import Any

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.errors import DeixisError, GraphError
from deixis.ontology.graph.graph import Fact, RelationGraph, Source
from deixis.ontology.tbox import default_ontology

R = default_ontology().relations
NODES = ["a", "b", "c", "d"]

sources = st.none() | st.builds(lambda line: Source("x.layout", line, 1, line, 9), st.integers(1, 99))
relation_sets = st.integers(1, 2 ** len(R) - 1).map(R.members)
facts = st.builds(
    Fact,
    st.sampled_from(NODES),
    relation_sets,
    st.sampled_from(NODES),
    st.booleans(),
    st.booleans(),
    st.floats(0.01, 1.0),
    sources,
)


def fact(relations: str, subject: str, object: str, **qualified: Any) -> Fact:
    return Fact(subject, tuple(R[name] for name in relations.split(" or ")), object, **qualified)


def graph(nodes: str, *stated: Fact) -> RelationGraph:
    return RelationGraph.from_facts(R, nodes.split(), stated)


@settings(max_examples=60, deadline=None)
@given(st.lists(facts, max_size=8))
def test_a_graph_returns_the_facts_it_was_made_from(stated: list[Fact]) -> None:
    made = RelationGraph.from_facts(R, NODES, stated)
    assert list(made.facts()) == stated
    assert len(made) == len(stated)


@settings(max_examples=40, deadline=None)
@given(st.lists(facts, max_size=8), st.permutations(NODES), st.integers(0, 4))
def test_a_subgraph_keeps_the_facts_among_its_nodes_in_order(stated: list[Fact], order: list[str], k: int) -> None:
    made = RelationGraph.from_facts(
        R, NODES, stated, kinds=["urn:k:" + n for n in NODES], boxes=np.arange(16.0).reshape(4, 2, 2)
    )
    kept = order[:k]
    part = made.subgraph(kept)
    assert part.nodes == tuple(kept)
    assert list(part.facts()) == [f for f in stated if f.subject in kept and f.object in kept]
    assert part.kinds == tuple("urn:k:" + n for n in kept)
    assert part.boxes is not None
    assert made.boxes is not None
    np.testing.assert_array_equal(part.boxes, made.boxes[[NODES.index(n) for n in kept]])


def test_a_fact_is_written_as_the_paper_writes_it() -> None:
    assert str(fact("left", "fork", "plate")) == "left(fork, plate)"
    assert str(fact("left or top_left", "fork", "plate")) == "left or top_left(fork, plate)"
    assert str(fact("on", "cup", "mat", positive=False)) == "not on(cup, mat)"


def test_only_one_affirmed_relation_is_plain() -> None:
    assert fact("left", "a", "b", optional=True, weight=0.5).plain
    assert not fact("left", "a", "b", weight=0.2).plain
    assert not fact("left", "a", "b", positive=False).plain
    assert not fact("left or right", "a", "b").plain


def test_a_relation_set_ignores_the_order_of_alternatives() -> None:
    assert fact("left or on", "a", "b").relation_set == fact("on or left", "a", "b").relation_set
    assert fact("left", "a", "b").relation_set != fact("exactly_left", "a", "b").relation_set


def test_a_repeated_node_is_an_error() -> None:
    with pytest.raises(GraphError, match="got 'a' twice") as caught:
        graph("a b a")
    assert isinstance(caught.value, DeixisError)
    assert isinstance(caught.value, ValueError)


def test_a_fact_about_an_unknown_node_is_an_error() -> None:
    with pytest.raises(GraphError, match=r"left\(a, z\) names 'z', which is not a node"):
        graph("a b", fact("left", "a", "z"))


def test_an_unknown_node_is_an_error() -> None:
    with pytest.raises(GraphError, match="no object 'z'"):
        graph("a b").index("z")
    with pytest.raises(GraphError, match="no object 'z'"):
        graph("a b").subgraph(["a", "z"])


def test_a_repeated_node_of_a_subgraph_is_an_error() -> None:
    with pytest.raises(GraphError, match="twice"):
        graph("a b").subgraph(["a", "a"])


@pytest.mark.parametrize("short", ["subjects", "objects", "relation_sets", "positive", "optional", "weights"])
def test_edge_arrays_of_different_lengths_are_an_error(short: str) -> None:
    arrays: dict[str, Any] = {
        "subjects": np.zeros(2, np.int32),
        "objects": np.ones(2, np.int32),
        "relation_sets": np.ones(2, np.int64),
        "positive": np.ones(2, bool),
        "optional": np.zeros(2, bool),
        "weights": np.ones(2),
    }
    arrays[short] = arrays[short][:1]
    with pytest.raises(GraphError, match="must have one length, got"):
        RelationGraph(vocabulary=R, nodes=("a", "b"), **arrays)


def test_too_few_sources_kinds_or_boxes_are_errors() -> None:
    whole = graph("a b", fact("left", "a", "b"), fact("left", "b", "a"))
    fields = ("subjects", "objects", "relation_sets", "positive", "optional", "weights")
    arrays = {name: getattr(whole, name) for name in fields}
    with pytest.raises(GraphError, match="must have one length, got"):
        RelationGraph(R, ("a", "b"), **arrays, sources=(None,))
    with pytest.raises(GraphError, match="one per node, or none"):
        RelationGraph(R, ("a", "b"), **arrays, kinds=("urn:k",))
    with pytest.raises(GraphError, match="one per node, got"):
        RelationGraph(R, ("a", "b"), **arrays, boxes=np.zeros((1, 2, 2)))


def test_networkx_has_nodes_and_parallel_edges_with_attributes() -> None:
    stated = [
        fact("left or right", "a", "b", weight=0.8, source=Source("x.layout", 3, 1, 3, 9)),
        fact("on", "a", "b", positive=False, optional=True),
    ]
    made = RelationGraph.from_facts(R, ["a", "b", "c"], stated, kinds=["urn:k", None, None])
    view = made.to_networkx()
    assert isinstance(view, nx.MultiDiGraph)
    assert list(view.nodes) == ["a", "b", "c"]
    assert view.nodes["a"] == {"kind": "urn:k", "colour": None, "box": None}
    first, second = (data for _, _, data in view.edges(data=True))
    assert first == {
        "relations": ("left", "right"),
        "positive": True,
        "optional": False,
        "weight": 0.8,
        "source": "x.layout:3:1",
    }
    assert (second["relations"], second["positive"], second["optional"]) == (("on",), False, True)
    assert second["source"] is None


def test_networkx_nodes_have_boxes() -> None:
    made = RelationGraph.from_facts(R, ["a"], [], boxes=np.array([[[0.0, 1.0], [2.0, 3.0]]]))
    assert made.to_networkx().nodes["a"]["box"] == [[0.0, 1.0], [2.0, 3.0]]


def labelled(made: RelationGraph) -> dict[tuple[str, str], str]:
    """Return the edge labels of Definition 1 (alpha), by pair of vertices."""
    view = made.paper_view()
    return {
        (view.vertices[s], view.vertices[o]): view.labels[label]
        for (s, o), label in zip(view.edges.tolist(), view.edge_labels.tolist(), strict=True)
    }


def test_definition_1_labels_edges_by_word_and_vertices_by_name() -> None:
    view = graph("a b").paper_view()
    assert len(view.labels) == len(set(view.labels)) == 10
    assert {"left", "bottom_right", "on"} <= set(view.labels)
    assert view.vertices == ("a", "b")
    assert view.edges.shape == (0, 2)
    assert view.adjacency().shape == (10, 2, 2)


def test_both_readings_of_a_word_are_one_label() -> None:
    made = graph("a b c", fact("left", "a", "b"), fact("exactly_left", "b", "c"))
    assert labelled(made) == {("a", "b"): "left", ("b", "c"): "left"}


def test_definition_1_leaves_out_denials_and_disjunctions() -> None:
    made = graph(
        "a b c d",
        fact("left", "a", "b", positive=False),
        fact("left or right", "b", "c"),
        fact("on", "c", "d", optional=True),
        fact("top", "d", "a", weight=0.7),
        fact("top", "b", "d", weight=0.2),
    )
    assert labelled(made) == {("c", "d"): "on", ("d", "a"): "top"}


@pytest.mark.parametrize(
    ("stated", "label"),
    [
        (["left", "top_left"], "top_left"),
        (["top_left", "left"], "top_left"),
        (["left", "top"], "left"),
        (["top", "left"], "top"),
        (["top_left", "exactly_left"], "top_left"),
        (["left", "exactly_left"], "left"),
        (["left", "exactly_top_left", "bottom_left"], "top_left"),
    ],
)
def test_the_most_specific_label_of_a_pair_is_kept(stated: list[str], label: str) -> None:
    assert labelled(graph("a b", *(fact(name, "a", "b") for name in stated))) == {("a", "b"): label}


def test_a_pair_has_one_label_in_each_direction() -> None:
    made = graph("a b", fact("left", "a", "b"), fact("right", "b", "a"))
    assert labelled(made) == {("a", "b"): "left", ("b", "a"): "right"}


def test_the_adjacency_has_one_matrix_per_label() -> None:
    view = graph("a b c", fact("left", "a", "b"), fact("on", "c", "b")).paper_view()
    expected = np.zeros((10, 3, 3))
    expected[view.labels.index("left"), 0, 1] = 1
    expected[view.labels.index("on"), 2, 1] = 1
    np.testing.assert_array_equal(view.adjacency(), expected)


def test_definition_2_of_the_plate_in_figure_7_is_as_counted() -> None:
    """Count the edges into the plate: 3 right (glass, two knives), 1 on, 1 top left, 2 left, 2 top; 0 outgoing."""
    stated = [
        fact("right", "water_glass", "dinner_plate"),
        fact("on", "napkin", "dinner_plate"),
        fact("top_left", "bread_plate", "dinner_plate"),
        fact("on", "butter_knife", "bread_plate"),
        fact("left", "salad_fork", "dinner_plate"),
        fact("left", "dinner_fork", "dinner_plate"),
        fact("top", "dessert_fork", "dinner_plate"),
        fact("top", "dessert_spoon", "dinner_plate"),
        fact("right", "dinner_knife", "dinner_plate"),
        fact("right", "fish_knife", "dinner_plate"),
        fact("right", "soup_spoon", "fish_knife"),
    ]
    names = list(dict.fromkeys(n for f in stated for n in (f.subject, f.object)))
    view = RelationGraph.from_facts(R, names, stated).paper_view()
    counts = view.histograms()
    assert counts.shape == (12, 2, 10)

    def buckets(name: str, direction: int) -> dict[str, int]:
        row = counts[names.index(name), direction]
        return {view.labels[i]: int(row[i]) for i in np.flatnonzero(row)}

    assert buckets("dinner_plate", 0) == {"right": 3, "on": 1, "top_left": 1, "left": 2, "top": 2}
    assert buckets("dinner_plate", 1) == {}
    assert buckets("bread_plate", 0) == {"on": 1}
    assert buckets("bread_plate", 1) == {"top_left": 1}
    assert buckets("fish_knife", 0) == {"right": 1}
    assert buckets("fish_knife", 1) == {"right": 1}
    assert counts.sum() == 22


@settings(max_examples=40, deadline=None)
@given(st.lists(facts, max_size=10))
def test_the_histograms_are_the_degrees_of_the_adjacency(stated: list[Fact]) -> None:
    view = RelationGraph.from_facts(R, NODES, stated).paper_view()
    matrices, counts = view.adjacency(), view.histograms()
    np.testing.assert_array_equal(counts[:, 0], matrices.sum(axis=1).T)
    np.testing.assert_array_equal(counts[:, 1], matrices.sum(axis=2).T)


def test_a_rare_fact_becomes_a_denial_of_the_other_weight() -> None:
    rarely, usually = fact("left", "a", "b", weight=0.2), fact("on", "a", "b", weight=0.8)
    words = RelationGraph.from_facts(R, ["a", "b"], [rarely, usually]).affirming()
    assert [(one.positive, one.weight) for one in words.facts()] == [(False, 0.8), (True, 0.8)]
    assert str(rarely) == "rarely left(a, b)"
