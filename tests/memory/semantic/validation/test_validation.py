"""SHACL validation of every write: rejections with their reasons, and agreement of the fast checks with pyshacl."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pyoxigraph as ox
import pytest
import rdflib
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rdflib.compare import isomorphic

from deixis.errors import OntologyError
from deixis.memory.errors import RejectedWriteError
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.semantic.rdf.change import Change
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.rdf.ledger import quad_of
from deixis.memory.semantic.rdf.package import SHAPES_FILE
from deixis.memory.semantic.store import SemanticMemory
from deixis.memory.semantic.validation.compiled_shapes import compile_shapes, packaged_shapes
from deixis.memory.semantic.validation.focus_data import FocusData
from deixis.memory.semantic.validation.shacl import report_turtle, validate, violations
from deixis.memory.semantic.validation.validate import check_change, report, touched

Learn = Callable[..., None]
Read = Callable[[str], list[ox.Triple]]
MakeLesson = Callable[..., dict[GraphName, list[ox.Triple]]]

SH = "http://www.w3.org/ns/shacl#"

BROKEN = {
    "no identifier": ("<L/scene/s1/o1> dx:identifier 'o1' .", "", "say|give it the name that its scene uses"),
    "two identifiers": ("", "<L/scene/s1/o1> dx:identifier 'again' .", "one dx:identifier"),
    "in no scene": ("<L/scene/s1/o1> dx:inScene <L/scene/s1> .", "", "give dx:inScene once"),
    "in something else": (
        "<L/scene/s1/o1> dx:inScene <L/scene/s1> .", "<L/scene/s1/o1> dx:inScene <L/viewpoint/chair> .", "dx:Scene",
    ),
    "ends before it begins": (
        "<L/scene/s1/o1> dx:maxX 2.0e0 .", "<L/scene/s1/o1> dx:maxX 0.5e0 .", "at most its dx:maxX: swap the two",
    ),
    "a box of words": ("<L/scene/s1/o1> dx:maxX 2.0e0 .", "<L/scene/s1/o1> dx:maxX 'wide' .", "an xsd:double"),
    "confidence in percent": (
        "<L/scene/s1/o1> dx:confidence 0.9 .", "<L/scene/s1/o1> dx:confidence 90.0 .", "divide percentages by 100",
    ),
    "a perceived colour in words": (
        "<L/scene/s1/o1> dx:confidence 0.9 .",
        "<L/scene/s1/o1> dx:confidence 0.9 ; dx:perceivedColour 'red' .", "two hexadecimal digits each",
    ),
    "a role of two colours": (
        "<L/layout/dinner-1/role/fish_knife> rdfs:label 'fish_knife' .",
        "<L/layout/dinner-1/role/fish_knife> rdfs:label 'fish_knife' ; dx:ofColour dx:red, dx:blue .",
        "at most one dx:ofColour",
    ),
    "a scene in inches": ("<L/scene/s1> dx:unit 'm' .", "<L/scene/s1> dx:unit 'in' .", "convert the boxes to metres"),
    "a role without a name": (
        "<L/layout/dinner-1/role/fish_knife> rdfs:label 'fish_knife' .", "", "give rdfs:label once",
    ),
    "a role in no layout": (
        "<L/layout/dinner-1/role/fish_knife> dx:inLayout <L/layout/dinner-1> .", "", "give dx:inLayout once",
    ),
    "a statement about itself": (
        "<L/layout/dinner-1/fact/1> dx:object <L/layout/dinner-1/role/dinner_plate> .",
        "<L/layout/dinner-1/fact/1> dx:object <L/layout/dinner-1/role/fish_knife> .", "name two different ones",
    ),
    "a statement about nothing": (
        "<L/layout/dinner-1/fact/1> dx:object <L/layout/dinner-1/role/dinner_plate> .", "", "give it once",
    ),
    "a statement about a layout": (
        "<L/layout/dinner-1/fact/1> dx:object <L/layout/dinner-1/role/dinner_plate> .",
        "<L/layout/dinner-1/fact/1> dx:object <L/layout/dinner-1> .", "a dx:Role or a dx:PerceivedObject",
    ),
    "a statement without a relation": (
        "<L/layout/dinner-1/fact/1> dx:relation dx:right .", "", "at least one dx:relation",
    ),
    "a weight of nothing": (
        "<L/layout/dinner-1/fact/1> dx:weight 1.0 .", "<L/layout/dinner-1/fact/1> dx:weight 0.0 .", "above 0",
    ),
    "a weight above one": (
        "<L/layout/dinner-1/fact/1> dx:weight 1.0 .", "<L/layout/dinner-1/fact/1> dx:weight 1.5 .", "at most 1",
    ),
    "a match decided for nothing": (
        "<L/lesson/dinner-1/match/fish_knife> dx:perceivedAs <L/scene/s1/o2> .", "", "add dx:perceivedAs",
    ),
    "a match of nothing": (
        "<L/lesson/dinner-1/match/fish_knife> dx:ofRole <L/layout/dinner-1/role/fish_knife> .", "", "give dx:ofRole",
    ),
    "a lesson that ends before it begins": (
        "<L/lesson/dinner-1> prov:endedAtTime '2026-11-21T10:00:02.5Z'^^xsd:dateTime .",
        "<L/lesson/dinner-1> prov:endedAtTime '2026-11-21T09:00:00Z'^^xsd:dateTime .", "correct the clock",
    ),
    "a lesson without a script": ("<L/lesson/dinner-1> dx:scriptText 'layout formal_dinner' .", "", "dx:scriptText"),
    "a layout of another lesson": (
        "<L/layout/dinner-1> dx:learnedIn <L/lesson/dinner-1> .",
        "<L/layout/dinner-1> dx:learnedIn <L/viewpoint/chair> .",
        "was learned in one dx:Lesson",
    ),
    "a category with two names": ("", "<L/category/fish_knife> rdfs:label 'knife' .", "a category has one name"),
}  # fmt: skip


def _stored(triples: list[ox.Triple]) -> set[ox.Triple]:
    store = ox.Store()
    store.extend(ox.Quad(*triple) for triple in triples)
    return {quad.triple for quad in store}


@pytest.mark.parametrize("case", BROKEN)
def test_what_breaks_a_shape_is_rejected_with_how_to_mend_it(
    memory: SemanticMemory, empty_export: str, make_lesson: MakeLesson, read: Read, case: str
) -> None:
    without, instead, told = BROKEN[case]
    said = make_lesson("dinner-1")
    removed = _stored(read(without))
    for name in (GraphName.LEARNED, GraphName.ASSERTED, GraphName.EPISODES):
        said[name] = [triple for triple in _stored(said[name]) if triple not in removed]
    said[GraphName.ASSERTED] += read(instead)
    with pytest.raises(RejectedWriteError, match=told) as caught:
        memory.learn("dinner-1", {name: said[name] for name in said if name is not GraphName.INFERRED}, [])
    assert export_memory(memory) == empty_export
    results = caught.value.results
    assert results
    assert all(result.severity == "Violation" and result.focus and result.shape for result in results)
    assert len(str(caught.value).splitlines()) == 1 + len(results)


def test_a_result_carries_where_and_what(memory: SemanticMemory, read: Read) -> None:
    with pytest.raises(RejectedWriteError) as caught:
        memory.learn("one", {GraphName.ASSERTED: read("<L/viewpoint/x> a dx:Viewpoint .")}, [])
    (result,) = caught.value.results
    assert (result.focus, result.path, result.shape) == ("lx:viewpoint/x", "rdfs:label", "name of a viewpoint")


def test_values_that_cannot_be_compared_are_rejected(
    memory: SemanticMemory, make_lesson: MakeLesson, read: Read
) -> None:
    """pyshacl fails on such values and does not report them."""
    memory.learn("dinner-1", {name: said for name, said in make_lesson().items() if name is not GraphName.INFERRED}, [])
    words = read('<L/scene/s1/o1> dx:minX "wide"^^xsd:double . <L/scene/s1/o2> dx:identifier "again" .')
    with pytest.raises(RejectedWriteError, match="cannot be compared: give numbers and times") as caught:
        memory.learn("two", {GraphName.ASSERTED: words}, [])
    assert {result.focus for result in caught.value.results} == {"lx:scene/s1/o1", "lx:scene/s1/o2"}


def test_the_text_of_a_report_depends_on_its_content_only() -> None:
    lines = [
        "_:all a sh:ValidationReport ; sh:result _:first, _:second, _:third .",
        "_:second sh:focusNode <urn:b> ; sh:sourceShape _:shape ; sh:value 2 .",
        "_:first sh:focusNode <urn:a> ; sh:sourceShape _:shape ; sh:value 1 .",
        "_:third sh:focusNode <urn:a> ; sh:sourceShape _:twin .",
        "_:shape sh:path [ sh:inversePath <urn:p> ] ; sh:in ( 1 2 ) .",
        "_:twin sh:path [ sh:inversePath <urn:p> ] ; sh:not _:shape . _:shape sh:not _:twin .",  # a circle
    ]
    texts = []
    for told in (lines, lines[::-1]):
        named = "\n".join([f"@prefix sh: <{SH}> .", *told])
        texts.append(report_turtle(rdflib.Graph().parse(data=named, format="turtle")))
    assert texts[0] == texts[1]
    assert texts[0].index("urn:a") < texts[0].index("urn:b")
    assert isomorphic(*(rdflib.Graph().parse(data=text, format="turtle") for text in (texts[0], named)))


def test_warnings_do_not_reject(memory: SemanticMemory, read: Read) -> None:
    scene = "<L/scene/x> a dx:Scene ; dx:frame 'table' ; dx:unit 'm' ; dx:seenFrom <L/viewpoint/c> ."
    triples = read(scene + "<L/viewpoint/c> a dx:Viewpoint ; rdfs:label 'c' .")
    assert [result.severity for result in validate(triples)] == ["Warning"]
    memory.learn("one", {GraphName.ASSERTED: triples}, [])


def test_what_is_already_there_is_spoilt_by_a_later_lesson(taught: SemanticMemory, read: Read) -> None:
    with pytest.raises(RejectedWriteError, match="one dx:identifier"):
        taught.learn("bad", {GraphName.ASSERTED: read("<L/scene/s1/o1> dx:identifier 'x' .")}, [])
    with pytest.raises(RejectedWriteError, match="a scene"):
        taught.learn(
            "bad", {GraphName.ASSERTED: read("<urn:x> a <urn:Room> . <urn:Room> rdfs:subClassOf dx:Scene .")}, []
        )


def test_a_new_class_axiom_reaches_instances_that_are_there(memory: SemanticMemory, read: Read) -> None:
    memory.learn("one", {GraphName.ASSERTED: read("<urn:x> a <urn:Room> .")}, [])
    with pytest.raises(RejectedWriteError, match="<urn:x>"):
        memory.learn("two", {GraphName.LEARNED: read("<urn:Room> rdfs:subClassOf dx:Scene .")}, [])


def test_what_is_inferred_is_guarded_too(taught: SemanticMemory, read: Read) -> None:
    with pytest.raises(RejectedWriteError, match="one dx:identifier"):
        taught.forget("dinner-2", read("<L/scene/s1/o1> dx:identifier 'x' ."))
    assert "dinner-2" in taught.lessons()


def test_forgetting_what_something_else_rests_on_is_rejected(taught: SemanticMemory, read: Read) -> None:
    extra = read(
        "<L/lesson/x/match/y> a dx:Match ; dx:ofRole <L/layout/dinner-1/role/fish_knife> ; dx:decided false ;"
        "dx:score 0.5 ; prov:wasGeneratedBy <L/lesson/dinner-2> ."
    )
    taught.learn("comment", {GraphName.LEARNED: extra}, list(taught.triples(GraphName.INFERRED)))
    with pytest.raises(RejectedWriteError, match="describe the role too"):
        taught.forget("dinner-1", [])
    assert "dinner-1" in taught.lessons()


def test_rejected_bulk_loading_changes_nothing(taught: SemanticMemory, read: Read) -> None:
    before = export_memory(taught)
    with pytest.raises(RejectedWriteError, match="a viewpoint has one name"):
        taught.load({GraphName.ASSERTED: read("<urn:a> <urn:p> 1 . <urn:v> a dx:Viewpoint .")})
    assert export_memory(taught) == before


def test_only_what_a_change_touches_is_looked_at(taught: SemanticMemory, read: Read) -> None:
    triples = read("<L/scene/s1/o1> dx:perceivedLabel 'plate' .")
    change = Change(added={GraphName.ASSERTED: frozenset(triples)})
    nodes = touched(packaged_shapes(), FocusData(taught.store, change), change)
    assert {getattr(node, "value", "") for node in nodes} == {"https://w3id.org/deixis/learned/scene/s1/o1"}


def test_every_shape_has_severity_name_and_message() -> None:
    triples = [quad.triple for quad in ox.parse(path=SHAPES_FILE)]
    said = {(triple.subject, triple.predicate.value) for triple in triples}
    shapes = {
        triple.subject for triple in triples if str(triple.object) in (f"<{SH}NodeShape>", f"<{SH}PropertyShape>")
    }
    assert len(shapes) > 50
    for shape in shapes:
        assert (shape, SH + "severity") in said
        assert (shape, SH + "message") in said
        assert (shape, SH + "name") in said or (shape, "http://www.w3.org/2000/01/rdf-schema#label") in said
    assert "owl#Ontology" not in SHAPES_FILE.read_text(encoding="utf-8")


def test_the_shapes_are_well_formed_shacl() -> None:
    import pyshacl
    import rdflib

    shapes = rdflib.Graph().parse(SHAPES_FILE)
    assert pyshacl.validate(rdflib.Graph(), shacl_graph=shapes, meta_shacl=True)[0]


def test_a_constraint_that_is_not_known_does_not_compile(tmp_path: Path) -> None:
    file = tmp_path / "s.ttl"
    file.write_text(f"@prefix sh: <{SH}> . <urn:s> a sh:NodeShape ; sh:targetClass <urn:C> ; sh:closed true .")
    with pytest.raises(OntologyError, match="closed"):
        compile_shapes(file)


S, COUNT = "<urn:s> a sh:NodeShape", "sh:minCount 1"
UNCOMPILED = {
    "a property shape alone": f"<urn:s> a sh:PropertyShape ; sh:targetClass <urn:C> ; sh:path <urn:p> ; {COUNT} .",
    "a shape that is not said to be one": "<urn:s> sh:targetClass <urn:C> ; sh:nodeKind sh:IRI .",
    "a class as its own target": f"{S}, <http://www.w3.org/2000/01/rdf-schema#Class> ; sh:nodeKind sh:IRI .",
    "a path of two steps": f"{S} ; sh:property [ sh:path ( <urn:p> <urn:q> ) ; {COUNT} ] .",
    "a path back over a path": f"{S} ; sh:property [ sh:path [ sh:inversePath ( <urn:p> ) ] ; {COUNT} ] .",
    "a nested property shape": f"{S} ; sh:property [ sh:path <urn:p> ; sh:property [ sh:path <urn:q> ; {COUNT} ] ] .",
    "a property shape in an alternative": f"{S} ; sh:or ( [ sh:property [ sh:path <urn:q> ; {COUNT} ] ] ) .",
    "a target of a property shape": f"{S} ; sh:property [ sh:path <urn:p> ; {COUNT} ; sh:targetClass <urn:D> ] .",
    "a target by name": f"{S} ; sh:targetNode <urn:x> ; sh:nodeKind sh:Literal .",
    "a shape that is left out": f"{S} ; sh:deactivated true ; sh:nodeKind sh:Literal .",
}


@pytest.mark.parametrize("text", UNCOMPILED.values(), ids=UNCOMPILED)
def test_a_shape_that_is_not_covered_does_not_compile(text: str, tmp_path: Path) -> None:
    file = tmp_path / "s.ttl"
    file.write_text(f"@prefix sh: <{SH}> . {text}")
    with pytest.raises(OntologyError):
        compile_shapes(file)


LESSON_NODES = [
    "scene/s1", "scene/s1/o1", "scene/s1/o2", "layout/dinner-1", "layout/dinner-1/role/fish_knife",
    "layout/dinner-1/role/dinner_plate", "layout/dinner-1/fact/1", "lesson/dinner-1",
    "lesson/dinner-1/match/fish_knife", "category/fish_knife", "viewpoint/chair",
]  # fmt: skip
PREDICATES = [
    "dx:identifier", "dx:inScene", "dx:minX", "dx:maxX", "dx:confidence", "dx:perceivedLabel", "dx:unit", "dx:subject",
    "dx:object", "dx:relation", "dx:weight", "dx:line", "dx:statedAt", "dx:positive", "dx:decided", "dx:perceivedAs",
    "dx:couldBe", "dx:ofRole", "dx:category", "dx:score", "dx:learnedIn", "dx:inLayout", "rdfs:label", "rdf:type",
    "rdfs:subClassOf", "prov:startedAtTime", "prov:endedAtTime", "prov:used", "dx:provedBest", "dx:interchangeableWith",
]  # fmt: skip
VALUES = [
    '"x"', '""', '"m"', '"a:1:2"', '"x"@en', "1", "0", "-1", "0.5", "1.0", "1.5", "2.0e0", "-1.0e0", "1.0e300", "true",
    "false", '"NaN"^^xsd:double', '"INF"^^xsd:double', '"wide"^^xsd:double', '"maybe"^^xsd:boolean',
    '"2026-11-21T10:00:01Z"^^xsd:dateTime', '"2026-11-21T10:00:01"^^xsd:dateTime',
    '"2026-13-41T10:00:01Z"^^xsd:dateTime',
    '"9999999999999999999999"^^xsd:integer', '"1"^^<urn:other>', "dx:Scene", "dx:Role", "dx:Match", "dx:Layout",
    "dx:PerceivedObject", "owl:Class", *(f"<L/{node}>" for node in LESSON_NODES),
]  # fmt: skip


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    dropped=st.sets(st.integers(0, 200), max_size=3),
    said=st.lists(
        st.tuples(st.sampled_from(LESSON_NODES), st.sampled_from(PREDICATES), st.sampled_from(VALUES)), max_size=3
    ),
)
def test_the_fast_checks_and_pyshacl_agree(
    make_lesson: MakeLesson, read: Read, dropped: set[int], said: list[tuple[str, str, str]]
) -> None:
    """A write is accepted exactly if pyshacl finds no violation in the whole store."""
    graphs = make_lesson("dinner-1")
    triples = sorted(_stored([triple for name in graphs for triple in graphs[name]]), key=str)
    triples = [triple for position, triple in enumerate(triples) if position not in dropped]
    triples += [*_stored(read("".join(f"<L/{s}> {p} {o} .\n" for s, p, o in said)))]
    expected = bool(violations(triples))
    try:
        check_change(ox.Store(), Change(added={GraphName.ASSERTED: frozenset(triples)}))
    except RejectedWriteError:
        assert expected
    else:
        assert not expected


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    new=st.lists(
        st.tuples(st.sampled_from(LESSON_NODES), st.sampled_from(PREDICATES), st.sampled_from(VALUES)),
        min_size=1,
        max_size=3,
    ),
    removed=st.sets(st.integers(0, 200), max_size=2),
)
def test_checking_a_change_is_as_good_as_checking_all(
    make_lesson: MakeLesson, read: Read, new: list[tuple[str, str, str]], removed: set[int]
) -> None:
    graphs = make_lesson("dinner-1")
    there = sorted(_stored([triple for name in graphs for triple in graphs[name]]), key=str)
    store = ox.Store()
    graph = ox.NamedNode("https://w3id.org/deixis/graph/asserted")
    store.extend(quad_of(triple, graph) for triple in there)
    gone = frozenset(triple for position, triple in enumerate(there) if position in removed)
    come = frozenset(_stored(read("".join(f"<L/{s}> {p} {o} .\n" for s, p, o in new)))) - set(there)
    expected = bool(violations([*(set(there) - gone), *come]))
    try:
        check_change(store, Change({GraphName.ASSERTED: come}, {GraphName.ASSERTED: gone}))
    except RejectedWriteError:
        assert expected
    else:
        assert not expected


def test_the_hand_made_lesson_conforms(make_lesson: MakeLesson) -> None:
    assert not report([triple for triples in make_lesson().values() for triple in triples])
