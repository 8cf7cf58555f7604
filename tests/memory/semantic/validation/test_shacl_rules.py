"""SHACL rules: each feature by hand, everything against pyshacl, and triple by triple."""

from __future__ import annotations

from random import Random

import pyoxigraph as ox
import pyshacl
import pytest
import rdflib
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.errors import OntologyError
from deixis.memory.errors import QueryError
from deixis.memory.semantic.validation import shacl_rules
from deixis.memory.semantic.validation.shacl_rules import RuleInference
from deixis.reasoning.errors import LimitError

PREFIXES = """
@prefix : <urn:t#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
:prefixes sh:declare [ sh:prefix "" ; sh:namespace "urn:t#"^^xsd:anyURI ] .
"""

UNDER = """
:OnShape a sh:NodeShape ; sh:targetSubjectsOf :on ; sh:rule [ a sh:TripleRule ;
    sh:subject [ sh:path :on ] ; sh:predicate :under ; sh:object sh:this ] .
"""
SETTING = """
:Plate a rdfs:Class, sh:NodeShape ;
    sh:rule [ a sh:TripleRule ; sh:order 2 ; sh:condition :Flanked ; sh:condition [ sh:property [ sh:path :left ;
        sh:hasValue :knife ] ] ; sh:subject sh:this ; sh:predicate rdf:type ; sh:object :Setting ] ;
    sh:rule [ a sh:TripleRule ; sh:deactivated true ;
        sh:subject sh:this ; sh:predicate rdf:type ; sh:object :Never ] .
:Flanked a sh:NodeShape ; sh:property [ sh:path [ sh:inversePath :left ] ; sh:minCount 1 ] .
:DinnerPlate rdfs:subClassOf :Plate .
"""
CHAIN = """
:ChainShape a sh:NodeShape ; sh:targetObjectsOf :left ; sh:rule [ a sh:SPARQLRule ; sh:order 1 ;
    sh:prefixes :prefixes ; sh:construct "CONSTRUCT { ?x :left ?y } WHERE { ?x :left $this . $this :left ?y }" ] .
"""
NEIGHBOUR = """
:Both a sh:NodeShape ; sh:targetClass :Setting ; sh:rule [ a sh:TripleRule ; sh:subject :table ; sh:predicate :bears ;
    sh:object [ sh:path ( :left [ sh:inversePath :on ] ) ] ] .
"""
ALL = UNDER + SETTING + CHAIN + NEIGHBOUR


def triples(turtle: str) -> list[ox.Triple]:
    return [quad.triple for quad in ox.parse((PREFIXES + turtle).encode(), format=ox.RdfFormat.TURTLE)]


def data(turtle: str) -> list[ox.Triple]:
    """Facts, without what the prefixes say of themselves."""
    found = triples(turtle)
    return [t for t in found if not isinstance(t.subject, ox.BlankNode) and "prefixes" not in str(t.subject)]


def inferred(rules: str, facts: str) -> set[str]:
    return {str(triple) for triple in RuleInference(triples(rules), data(facts)).inferred}


def said(turtle: str) -> set[str]:
    return {str(triple) for triple in data(turtle)}


def test_a_triple_rule_follows_its_paths() -> None:
    assert inferred(UNDER, ":napkin :on :plate, :table .") == said(":plate :under :napkin . :table :under :napkin .")


def test_conditions_classes_and_switches_are_kept_to() -> None:
    table = ":p a :DinnerPlate ; :left :knife . :f a :Fork ; :left :p . :q a :DinnerPlate ; :left :knife . "
    table += ":DinnerPlate rdfs:subClassOf :Plate ."
    assert inferred(SETTING, table) == said(":p a :Setting .")


def test_a_construct_rule_runs_to_the_fixpoint() -> None:
    chain = " ".join(f":x{i} :left :x{i + 1} ." for i in range(6))
    wanted = " ".join(f":x{i} :left :x{j} ." for i in range(6) for j in range(i + 2, 7))
    assert inferred(CHAIN, chain) == said(wanted)


def test_a_rule_feeds_a_rule_of_lower_order() -> None:
    table = ":p a :Plate ; :left :knife . :f a :Fork ; :left :p . :n :on :knife ."
    assert inferred(ALL, table) >= said(":p a :Setting . :table :bears :n . :f :left :knife .")


def test_what_is_stated_later_is_no_longer_inferred() -> None:
    known = RuleInference(triples(UNDER), data(":napkin :on :plate ."))
    assert known.add(data(":plate :under :napkin .")) == ()
    assert known.inferred == ()


def test_adding_a_fact_looks_only_at_the_nodes_that_it_reaches() -> None:
    many = " ".join(f":n{i} :on :p{i} ." for i in range(500))
    known = RuleInference(triples(UNDER), data(many))
    looked_at = known.focus_nodes_looked_at
    assert {str(t) for t in known.add(data(":new :on :p1 ."))} == said(":p1 :under :new .")
    assert known.focus_nodes_looked_at - looked_at <= 3


# ---- against pyshacl


def _fact() -> st.SearchStrategy[str]:
    things = [f":{name}" for name in ("a", "b", "c", "d", "knife")]
    related = st.tuples(st.sampled_from(things), st.sampled_from([":left", ":on"]), st.sampled_from(things))
    typed = st.tuples(st.sampled_from(things), st.just("a"), st.sampled_from([":Plate", ":DinnerPlate", ":Fork"]))
    return st.one_of(related, typed).map(lambda words: f"{' '.join(words)} .")


HIERARCHY = ":DinnerPlate rdfs:subClassOf :Plate . :b a :DinnerPlate ; :left :knife . "


def by_pyshacl(facts: str) -> set[str]:
    """pyshacl iterates each shape's rules by themselves: it is run again until nothing comes any more."""
    graph = rdflib.Graph().parse(data=PREFIXES + facts, format="turtle")
    before = set(rdflib.Graph().parse(data=PREFIXES + facts, format="turtle"))
    shapes = rdflib.Graph().parse(data=PREFIXES + ALL, format="turtle")
    known = -1
    while known != len(graph):
        known = len(graph)
        pyshacl.shacl_rules(graph, shacl_graph=shapes, advanced=True, iterate_rules=True, inplace=True)
    new = [t for t in graph if t not in before and not any(isinstance(part, rdflib.BNode) for part in t)]
    return {" ".join(part.n3() for part in t) for t in new if "prefixes" not in str(t[0])}


@settings(max_examples=40, deadline=None)
@given(st.lists(_fact(), min_size=2, max_size=9))
def test_random_facts_come_to_what_pyshacl_makes_of_them(facts: list[str]) -> None:
    turtle = HIERARCHY + " ".join(facts)
    assert inferred(ALL, turtle) == by_pyshacl(turtle)


@settings(max_examples=30, deadline=None)
@given(st.lists(_fact(), min_size=2, max_size=9), st.randoms(use_true_random=False))
def test_added_one_by_one_in_any_order_facts_come_to_the_same(facts: list[str], random: Random) -> None:
    turtle = HIERARCHY + " ".join(facts)
    one_by_one = data(turtle)
    random.shuffle(one_by_one)
    known = RuleInference(triples(ALL))
    for triple in one_by_one:
        known.add([triple])
    assert {str(triple) for triple in known.inferred} == inferred(ALL, turtle)


# ---- bad input

SPARQL = ':S a sh:NodeShape ; sh:targetNode :a ; sh:rule [ a sh:SPARQLRule ; sh:construct "{}" ] .'


@pytest.mark.parametrize(
    ("rules", "error", "told"),
    [
        (":S sh:targetNode :a ; sh:rule [ sh:subject :a ] .", OntologyError, "say which by rdf:type"),
        (":S sh:targetNode :a ; sh:rule [ a sh:TripleRule ; sh:subject :a ] .", OntologyError, "sh:predicate must be"),
        (SPARQL.replace("{}", "SELECT * { ?s ?p ?o }"), OntologyError, "must be a CONSTRUCT"),
        (SPARQL.replace("{}", "CONSTRUCT { ?s ?p ?o } { SERVICE <http://x> { ?s ?p ?o } }"), QueryError, "SERVICE"),
        (
            ":S sh:targetNode :a ; sh:rule [ a sh:TripleRule ; sh:condition [ sh:sparql [] ] ; sh:subject sh:this ; "
            "sh:predicate :p ; sh:object :b ] .",
            OntologyError,
            "not known",
        ),
    ],
)
def test_a_rule_that_cannot_be_run_is_refused(rules: str, error: type[Exception], told: str) -> None:
    with pytest.raises(error, match=told):
        RuleInference(triples(rules), data(":a :p :b ."))


def test_rules_without_end_are_stopped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shacl_rules, "MAX_ROUNDS", 100)  # every round makes one more than before
    counting = SPARQL.replace("{}", "CONSTRUCT { $this <urn:n> ?m } { $this <urn:n> ?n BIND(?n + 1 AS ?m) }")
    start = [ox.Triple(ox.NamedNode("urn:t#a"), ox.NamedNode("urn:n"), ox.Literal(1))]
    with pytest.raises(LimitError, match="ever new triples"):
        RuleInference(triples(counting), start)
    with pytest.raises(OntologyError, match="blank node"):
        RuleInference(triples(SPARQL.replace("{}", "CONSTRUCT { $this <urn:n> [] } { }")), data(":a :p :b ."))
