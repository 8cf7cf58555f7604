"""Test that queries see the ontology, and that a term which is not in the vocabulary is an error."""

from __future__ import annotations

from collections.abc import Iterator

import pyoxigraph as ox
import pytest

import deixis
from deixis.examples_data import example
from deixis.memory.errors import QueryError
from deixis.memory.semantic.queries.results import EMPTY_ANSWER
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory


@pytest.fixture(scope="module")
def taught(tmp_path_factory: pytest.TempPathFactory) -> Iterator[deixis.Session]:
    """A session that learned one layout."""
    script = deixis.read_script(example("formal_dinner.layout"))
    with deixis.Session(tmp_path_factory.mktemp("terms") / "memory") as session:
        session.learn(script, deixis.read_scene(example("place_setting.scene.json")), time_limit=60.0)
        yield session


def test_subclasses_are_found_across_ontology_and_lessons(taught: deixis.Session) -> None:
    rows = taught.query("SELECT ?x { ?x rdfs:subClassOf* dx:Fork }").rows
    names = {row["x"].value.rpartition("/")[2].rpartition("#")[2] for row in rows}
    assert {"Fork", "DinnerFork", "SaladFork", "dinner_fork", "salad_fork"} <= names


def test_the_ontology_gives_labels_without_naming_its_graph(taught: deixis.Session) -> None:
    assert taught.query("ASK { dx:left rdfs:label ?label ; owl:inverseOf dx:right }").boolean


@pytest.mark.parametrize(
    ("query", "message"),
    [
        (
            "SELECT ?x { ?x a owl:class }",
            "query:1:18: the vocabulary has no term 'owl:class'; did you mean 'owl:Class'?",
        ),
        ("SELECT ?x { ?x a dx:fork }", "query:1:18: the vocabulary has no term 'dx:fork'; did you mean 'dx:Fork'?"),
        ("SELECT ?x { ?x a dx:ruler }", "did you mean 'dx:Ruler'?"),
        ("SELECT ?x { ?x dx:inLayuot ?y }", "did you mean 'dx:inLayout'?"),
        ("ASK { ?x a <https://w3id.org/deixis/onto#Layuot> }", "did you mean 'dx:Layout'?"),
        ("PREFIX o: <https://w3id.org/deixis/onto#> ASK { ?x a o:Xyzzy }", "no term 'dx:Xyzzy'; docs/"),
    ],
)
def test_an_unknown_term_is_an_error_with_the_nearest(taught: deixis.Session, query: str, message: str) -> None:
    with pytest.raises(QueryError) as raised:
        taught.query(query)
    assert message in str(raised.value)


def test_a_noun_that_no_lesson_uses_is_a_known_term(taught: deixis.Session) -> None:
    assert taught.query("SELECT ?x { ?x a dx:BarMat }").remarks() == (EMPTY_ANSWER,)


def test_a_term_that_the_memory_uses_is_accepted(memory: SemanticMemory) -> None:
    own = ox.NamedNode("https://w3id.org/deixis/onto#ownTerm")
    memory.load({GraphName.ASSERTED: [ox.Triple(ox.NamedNode("urn:a"), own, ox.Literal("b"))]})
    assert memory.query(f"ASK {{ ?x {own} ?y }}").boolean


def test_an_empty_answer_says_so(taught: deixis.Session) -> None:
    for query in ("SELECT *", "CONSTRUCT { ?x a dx:Fork }"):
        answer = taught.query(f"{query} {{ ?x a dx:Layout . FILTER(?x = lx:nothing) }}")
        assert answer.empty and EMPTY_ANSWER in answer.to_text()
        assert EMPTY_ANSWER in answer._repr_html_()
    assert not taught.query("ASK { ?x a dx:Layout . FILTER(?x = lx:nothing) }").empty


def test_an_empty_answer_names_classes_with_subclasses_only(taught: deixis.Session) -> None:
    for written in ("a dx:Layout", "rdf:type <https://w3id.org/deixis/onto#Layout>"):
        (_, note) = taught.query(f"SELECT ?x {{ ?x {written} }}").remarks()
        assert note.endswith("ask for '?x rdfs:subClassOf dx:Layout'")
    assert taught.query("SELECT ?x { ?x rdfs:subClassOf dx:Layout }").remarks() == ()
    assert taught.query("SELECT ?x { ?x a dx:Horse }").remarks() == (EMPTY_ANSWER,)
