"""Axioms as complete groups of triples, and axioms in words."""

from __future__ import annotations

import pytest
from ontologies import core, ntriples, triple, triples

from deixis.reasoning.description_logic.axioms import split_axioms
from deixis.reasoning.description_logic.terms import is_blank, read_ntriples, write_ntriples
from deixis.reasoning.description_logic.verbalisation import Words, labels_of
from deixis.reasoning.errors import TriplesError

SHOWS = ":Laid a owl:Class ; rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :on ; owl:someValuesFrom :Fork ] ."


def test_a_class_expression_stays_with_its_axiom() -> None:
    (axiom,) = split_axioms(triples(SHOWS)).axioms
    assert len(axiom.triples) == 4
    assert {"<urn:t#Laid>", "<urn:t#on>", "<urn:t#Fork>"} <= axiom.signature


def test_nested_expressions_and_lists_stay_whole() -> None:
    nested = ":C owl:equivalentClass [ a owl:Class ; owl:unionOf ( :D [ a owl:Class ; owl:complementOf :E ] ) ] ."
    (axiom,) = split_axioms(triples(nested)).axioms
    assert len(axiom.triples) == 9
    chain = ":p owl:propertyChainAxiom (:q :r) ."
    (axiom,) = split_axioms(triples(chain)).axioms
    assert len(axiom.triples) == 5


@pytest.mark.parametrize(
    "text",
    [
        "[] a owl:AllDisjointClasses ; owl:members (:C :D) .",
        "[] a owl:AllDifferent ; owl:distinctMembers (:a :b) .",
        "[] a owl:NegativePropertyAssertion ; owl:sourceIndividual :a ; owl:assertionProperty :p ; "
        "owl:targetIndividual :b .",
        "[ a owl:Restriction ; owl:onProperty :p ; owl:someValuesFrom :C ] rdfs:subClassOf :D .",
    ],
)
def test_an_axiom_of_a_blank_node_is_one_group(text: str) -> None:
    (axiom,) = split_axioms(triples(text)).axioms
    assert len(axiom.triples) == len(triples(text))
    assert axiom.root.predicate.endswith("#type>")


def test_an_unnamed_individual_is_not_syntax() -> None:
    found = split_axioms(triples("_:x a :Fork ; :left _:y . :plate :right _:x ."))
    assert [len(axiom.triples) for axiom in found.axioms] == [1, 1, 1]


def test_no_triple_of_the_core_ontology_is_lost_or_in_two_parts() -> None:
    stated = read_ntriples(core())
    parts = split_axioms(stated)
    said = [t for axiom in parts.axioms for t in axiom.triples]
    assert len(said) == len(set(said))
    assert {*said, *parts.declarations, *parts.annotations} == set(stated)
    assert not set(said) & {*parts.declarations, *parts.annotations}
    for axiom in parts.axioms:
        inside = {t.subject for t in axiom.triples}
        assert {part for t in axiom.triples for part in t if is_blank(part)} <= inside


def test_undeclared_properties_are_declared_and_imports_dropped() -> None:
    text = ":o a owl:Ontology ; owl:imports <http://example.org/far> . :f :left :g ; :width 3 ."
    found = split_axioms(triples(text))
    declared = {str(t) for t in found.declarations}
    assert declared == {str(triple(f":{n} a owl:{k}Property")) for n, k in (("left", "Object"), ("width", "Datatype"))}
    assert not any("imports" in t.predicate for axiom in found.axioms for t in axiom.triples)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (":Fork rdfs:subClassOf :Cutlery", "every fork is a Cutlery"),
        (":Fork rdfs:subClassOf owl:Nothing", "nothing can be a fork"),
        (":Fork owl:disjointWith :Spoon", "fork and Spoon have nothing in common"),
        (":left a owl:TransitiveProperty", "'left' is transitive"),
        (":left owl:inverseOf :right", "'left' is the inverse of 'right'"),
        (":left rdfs:domain :Thing", "whatever is 'left' of something is a Thing"),
        (":x a :Fork", "x is a fork"),
        (":x a :Apple", "x is an Apple"),
        (":x :left :y", "left(x, y)"),
        (":x :width 3", "width(x, 3)"),
        (
            ":Laid rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :shows ; owl:someValuesFrom :Fork ]",
            "every Laid is something that is 'shows' of some fork",
        ),
        (":C owl:equivalentClass [ owl:unionOf (:Fork :Spoon) ]", "C and (fork or Spoon) are the same"),
        ("[] a owl:AllDisjointClasses ; owl:members (:Fork :Spoon)", "nothing is more than one of fork, Spoon"),
        (
            "[] a owl:NegativePropertyAssertion ; owl:sourceIndividual :a ; owl:assertionProperty :left ; "
            "owl:targetIndividual :b",
            "not left(a, b)",
        ),
    ],
)
def test_axioms_in_words(text: str, words: str) -> None:
    (axiom,) = split_axioms(triples(f"{text} .")).axioms
    labels = labels_of(triples(':Fork rdfs:label "Gabel"@de, "fork"@en .'))
    assert Words(labels).axiom(axiom) == words


def test_every_axiom_of_the_core_ontology_has_words() -> None:
    stated = read_ntriples(core())
    words = Words(labels_of(stated))
    for axiom in split_axioms(stated).axioms:
        said = words.axiom(axiom)
        assert said and "{" not in said and "_:" not in said


def test_reading_and_writing_triples_is_the_identity() -> None:
    text = ntriples(r':a :p "say \"hi\"\nto\\all"@en-GB, "1"^^xsd:integer, <urn:x%20y> . _:b :p "é" .')
    assert write_ntriples(read_ntriples(text)) == text


def test_escapes_in_an_iri_are_decoded() -> None:
    (found,) = read_ntriples(r"<urn:a> <http://www.w3.org/2002/07/owl#\u0069mports> <urn:b> .")
    assert found.predicate == "<http://www.w3.org/2002/07/owl#imports>"


@pytest.mark.parametrize("line", ["rubbish", "<a> <b>", '"x" <p> <o> .', "<a> _:p <b> .", r"<a\u003e> <p> <o> ."])
def test_text_that_is_not_a_triple_is_refused_with_its_line(line: str) -> None:
    with pytest.raises(TriplesError, match="line 2"):
        read_ntriples(f"<urn:a> <urn:b> <urn:c> .\n{line}\n")
