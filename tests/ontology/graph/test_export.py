"""Export as JSON, Turtle and DOT: the output has exactly the facts of the graph, whatever the names are."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from itertools import pairwise

import numpy as np
import pyoxigraph
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from rdflib import RDF, RDFS, Graph, Literal, URIRef

from deixis.errors import GraphError
from deixis.ontology.graph.export import fact_to_dict, graph_to_dict, graph_to_dot, graph_to_turtle
from deixis.ontology.graph.graph import Fact, RelationGraph, Source
from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.tbox import default_ontology

R = default_ontology().relations
STATEMENT = URIRef(DX.RELATION_STATEMENT)

ODD = [
    'say "cheese"',
    "line\nbreak",
    "> . <urn:x> a <https://w3id.org/deixis/onto#RelationStatement> .",
    '" . <urn:x> a <https://w3id.org/deixis/onto#RelationStatement> . "',
    "🍴",
    "back\\slash\\",
    "%20",
    "a b",
    "a/../b",
    "fact 1",
    "fact%201",
    "]; evil -> node; [",
    "tab\tand\rreturn",
    "bell\x07",
    "nul\x00",
    "\u2028\ufeff",
    "",
    ".",
    "été",
]

names = st.text(max_size=12) | st.sampled_from(ODD)


@st.composite
def graphs(draw: st.DrawFn) -> RelationGraph:
    nodes = draw(st.lists(names, min_size=2, max_size=5, unique=True))
    file = draw(names)
    facts = []
    for number in range(draw(st.integers(0, 4))):
        mask = draw(st.integers(1, 2 ** len(R) - 1))
        source = Source(file, number + 1, 2, number + 1, 7) if draw(st.booleans()) else None
        facts.append(
            Fact(
                draw(st.sampled_from(nodes)),
                R.members(mask),
                draw(st.sampled_from(nodes)),
                draw(st.booleans()),
                draw(st.booleans()),
                draw(st.sampled_from([1.0, 0.8, 0.2])),
                source,
            )
        )
    boxes = np.arange(len(nodes) * 4.0).reshape(-1, 2, 2) if draw(st.booleans()) else None
    kinds = [draw(st.sampled_from([None, "urn:k:Plate"])) for _ in nodes] if draw(st.booleans()) else []
    colours = [draw(st.sampled_from([None, "urn:c:red"])) for _ in nodes] if draw(st.booleans()) else []
    return RelationGraph.from_facts(R, nodes, facts, kinds=kinds, boxes=boxes, colours=colours)


def odd_graph() -> RelationGraph:
    facts = [Fact(a, (R["left"],), b) for a, b in pairwise(ODD)]
    return RelationGraph.from_facts(R, ODD, facts)


def test_turtle_and_networkx_contain_the_colours() -> None:
    graph = RelationGraph.from_facts(R, ["a", "b"], [], colours=["urn:c:red", None])
    told = Graph().parse(data=graph_to_turtle(graph), format="turtle")
    said = list(told.subject_objects(URIRef(DX.OF_COLOUR)))
    assert said == [(URIRef("urn:deixis:graph:a"), URIRef("urn:c:red"))]
    assert dict(graph.to_networkx().nodes(data="colour")) == {"a": "urn:c:red", "b": None}
    assert graph.subgraph(["b", "a"]).colours == (None, "urn:c:red")


def test_there_must_be_one_colour_per_node() -> None:
    with pytest.raises(GraphError, match="`kinds` and `colours` must have"):
        RelationGraph.from_facts(R, ["a", "b"], [], colours=["urn:c:red"])


@settings(max_examples=60, deadline=None)
@given(graphs())
def test_json_has_all_facts_of_the_graph(graph: RelationGraph) -> None:
    data = json.loads(json.dumps(graph_to_dict(graph)))
    nodes = data["nodes"]
    assert [node["id"] for node in nodes] == list(graph.nodes)
    assert [node["kind"] for node in nodes if "kind" in node] == [kind for kind in graph.kinds if kind]
    assert [node["colour"] for node in nodes if "colour" in node] == [colour for colour in graph.colours if colour]
    if graph.boxes is None:
        assert not any("min" in node or "max" in node for node in nodes)
    else:
        np.testing.assert_array_equal([[node["min"], node["max"]] for node in nodes], graph.boxes)
    spans = [{"end_line": fact.source.end_line, "end_column": 7} if fact.source else {} for fact in graph.facts()]
    assert data["facts"] == [fact_to_dict(fact) | span for fact, span in zip(graph.facts(), spans, strict=True)]


def test_json_has_the_qualifiers_of_a_fact() -> None:
    fact = Fact("a", (R["exactly_left"],), "b", True, True, 0.8, Source("x.layout", 3, 1, 3, 9))
    assert fact_to_dict(fact) == {
        "relation": "left",
        "subject": "a",
        "object": "b",
        "reading": "exact",
        "relations": ["exactly_left"],
        "positive": True,
        "optional": True,
        "weight": 0.8,
        "file": "x.layout",
        "line": 3,
        "column": 1,
    }


def test_a_disjunction_is_one_string_in_json() -> None:
    entry = fact_to_dict(Fact("a", (R["left"], R["top_left"]), "b"))
    assert (entry["relation"], entry["relations"]) == ("left or top_left", ["left", "top_left"])
    assert "line" not in entry


@settings(max_examples=60, deadline=None)
@given(graphs())
@example(odd_graph())
def test_turtle_has_exactly_the_facts_of_the_graph(graph: RelationGraph) -> None:
    text = graph_to_turtle(graph)
    read = Graph().parse(data=text, format="turtle")
    statements = set(read.subjects(RDF.type, STATEMENT))
    assert len(statements) == len(graph)
    things = set(read.subjects(RDF.type)) - statements
    assert len(things) == len(graph.nodes)
    assert {str(o) for o in read.objects(None, RDFS.label)} == set(graph.nodes)
    assert sorted(str(o) for s in statements for o in read.objects(s, URIRef(DX.RELATION))) == sorted(
        relation.iri for fact in graph.facts() for relation in fact.relations
    )
    quads = list(pyoxigraph.parse(text, format=pyoxigraph.RdfFormat.TURTLE))
    assert len({str(quad.triple) for quad in quads}) == len(read)
    labels = [q.object.value for q in quads if q.predicate.value == str(RDFS.label) and hasattr(q.object, "value")]
    assert sorted(labels) == sorted(graph.nodes)


def test_turtle_has_the_qualifiers_of_a_fact() -> None:
    fact = Fact("a", (R["left"],), "b", False, True, 0.8, Source('odd".layout', 3, 1, 3, 9))
    read = Graph().parse(data=graph_to_turtle(RelationGraph.from_facts(R, ["a", "b"], [fact])), format="turtle")
    (statement,) = read.subjects(RDF.type, STATEMENT)
    said = {str(p): o for p, o in read.predicate_objects(statement)}
    assert said[DX.RELATION] == URIRef(R["left"].iri)
    assert said[DX.POSITIVE] == Literal(False)
    assert said[DX.OPTIONAL] == Literal(True)
    assert str(said[DX.STATED_AT]) == 'odd".layout:3:1'
    assert float(str(said[DX.WEIGHT])) == 0.8
    assert read.value(said[DX.SUBJECT], RDFS.label) == Literal("a")
    assert read.value(said[DX.OBJECT], RDFS.label) == Literal("b")


def test_turtle_types_an_object_by_its_kind_or_as_a_thing() -> None:
    graph = RelationGraph.from_facts(R, ["a", "b"], [], kinds=["urn:k:Plate", None])
    read = Graph().parse(data=graph_to_turtle(graph), format="turtle")
    assert {str(o) for o in read.objects(None, RDF.type)} == {"urn:k:Plate", DX.THING.value}


def test_no_kind_can_inject_a_statement() -> None:
    kind = f"urn:k> . <urn:x> a <{DX.RELATION_STATEMENT}> . <urn:y> a <urn:z"
    read = Graph().parse(data=graph_to_turtle(RelationGraph.from_facts(R, ["a"], [], kinds=[kind])), format="turtle")
    assert len(read) == 2


def test_an_empty_graph_is_turtle_without_triples() -> None:
    assert len(Graph().parse(data=graph_to_turtle(RelationGraph.from_facts(R, [], [])), format="turtle")) == 0


STRING = re.compile(r'"(?:[^"\\]|\\.)*"', re.DOTALL)


@settings(max_examples=60, deadline=None)
@given(graphs())
@example(odd_graph())
def test_dot_has_one_line_per_node_and_per_edge(graph: RelationGraph) -> None:
    bare = STRING.sub("S", graph_to_dot(graph))
    assert '"' not in bare
    lines = bare.splitlines()
    assert (lines[0], lines[-1]) == ("digraph layout {", "}")
    assert lines.count("    S;") == len(graph.nodes)
    edge = re.compile(r"    S -> S \[label=S, style=(solid|dashed|dotted), penwidth=\d\.\d\d\];")
    assert sum(bool(edge.fullmatch(line)) for line in lines) == len(graph)
    assert len(lines) == 3 + len(graph.nodes) + len(graph)


def test_dot_styles_denied_optional_and_hedged_facts() -> None:
    facts = [
        Fact("a", (R["left"], R["top"]), "b"),
        Fact("a", (R["on"],), "b", positive=False),
        Fact("a", (R["on"],), "b", optional=True, weight=0.2),
    ]
    lines = graph_to_dot(RelationGraph.from_facts(R, ["a", "b"], facts)).splitlines()[-4:-1]
    assert lines == [
        '    "a" -> "b" [label="left of or above", style=solid, penwidth=1.00];',
        '    "a" -> "b" [label="not on", style=dashed, penwidth=1.00];',
        '    "a" -> "b" [label="on", style=dotted, penwidth=0.30];',
    ]


@pytest.mark.skipif(shutil.which("dot") is None, reason="Graphviz is not installed")
def test_graphviz_reads_the_dot_of_odd_names() -> None:
    names = [name for name in ODD if "\x00" not in name]
    graph = RelationGraph.from_facts(R, names, [Fact(names[0], (R["left"],), names[1])])
    done = subprocess.run(["dot", "-Tplain"], input=graph_to_dot(graph), capture_output=True, text=True, check=True)
    assert sum(line.startswith("node ") for line in done.stdout.splitlines()) == len(names)
