"""OWL 2 RL: each rule by hand, comparison with owlrl and HermiT, and adding triples step by step."""

from __future__ import annotations

import re
from collections.abc import Iterable
from random import Random

import owlrl  # type: ignore[import-untyped]
import pytest
import rdflib
from hypothesis import given, settings
from hypothesis import strategies as st
from ontologies import PREFIXES, core, ntriples, triple, triples

from deixis.deadline import Deadline
from deixis.reasoning.description_logic.owl_rl.materialisation import Materialisation
from deixis.reasoning.description_logic.owl_rl.rules import rules
from deixis.reasoning.description_logic.reasoners import classify
from deixis.reasoning.description_logic.terms import (
    EQUIVALENT_CLASS,
    EQUIVALENT_PROPERTY,
    NOTHING,
    SAME_AS,
    SUB_CLASS_OF,
    SUB_PROPERTY_OF,
    THING,
    TYPE,
    Triple,
    is_blank,
    is_literal,
    read_ntriples,
    write_ntriples,
)
from deixis.reasoning.errors import LimitError, NotEntailedError

FOLLOWS = [  # rule, premises, conclusion
    ("eq-sym", ":a owl:sameAs :b", ":b owl:sameAs :a"),
    ("eq-trans", ":a owl:sameAs :b . :b owl:sameAs :c", ":a owl:sameAs :c"),
    ("eq-rep-s", ":a owl:sameAs :b . :a :p :c", ":b :p :c"),
    ("eq-rep-p", ":p owl:sameAs :q . :a :p :c", ":a :q :c"),
    ("eq-rep-o", ":b owl:sameAs :c . :a :p :b", ":a :p :c"),
    ("prp-dom", ":p rdfs:domain :C . :a :p :b", ":a a :C"),
    ("prp-rng", ":p rdfs:range :C . :a :p :b", ":b a :C"),
    ("prp-fp", ":p a owl:FunctionalProperty . :a :p :b, :c", ":b owl:sameAs :c"),
    ("prp-ifp", ":p a owl:InverseFunctionalProperty . :a :p :c . :b :p :c", ":a owl:sameAs :b"),
    ("prp-symp", ":p a owl:SymmetricProperty . :a :p :b", ":b :p :a"),
    ("prp-trp", ":p a owl:TransitiveProperty . :a :p :b . :b :p :c", ":a :p :c"),
    ("prp-spo1", ":p rdfs:subPropertyOf :q . :a :p :b", ":a :q :b"),
    ("prp-spo2", ":q owl:propertyChainAxiom (:p :r :p) . :a :p :b . :b :r :c . :c :p :d", ":a :q :d"),
    ("prp-eqp1", ":p owl:equivalentProperty :q . :a :p :b", ":a :q :b"),
    ("prp-eqp2", ":p owl:equivalentProperty :q . :a :q :b", ":a :p :b"),
    ("prp-inv1", ":p owl:inverseOf :q . :a :p :b", ":b :q :a"),
    ("prp-inv2", ":p owl:inverseOf :q . :a :q :b", ":b :p :a"),
    ("prp-key", ":C owl:hasKey (:p :q) . :a a :C ; :p :x ; :q :y . :b a :C ; :p :x ; :q :y", ":a owl:sameAs :b"),
    ("cls-int1", ":C owl:intersectionOf (:D :E) . :a a :D, :E", ":a a :C"),
    ("cls-int2", ":C owl:intersectionOf (:D :E) . :a a :C", ":a a :E"),
    ("cls-uni", ":C owl:unionOf (:D :E) . :a a :E", ":a a :C"),
    ("cls-svf1", ":C owl:onProperty :p ; owl:someValuesFrom :D . :a :p :b . :b a :D", ":a a :C"),
    ("cls-svf2", ":C owl:onProperty :p ; owl:someValuesFrom owl:Thing . :a :p :b", ":a a :C"),
    ("cls-avf", ":C owl:onProperty :p ; owl:allValuesFrom :D . :a a :C ; :p :b", ":b a :D"),
    ("cls-hv1", ":C owl:onProperty :p ; owl:hasValue :b . :a a :C", ":a :p :b"),
    ("cls-hv2", ":C owl:onProperty :p ; owl:hasValue :b . :a :p :b", ":a a :C"),
    (
        "cls-maxc2",
        ":C owl:onProperty :p ; owl:maxCardinality '1'^^xsd:nonNegativeInteger . :a a :C ; :p :b, :c",
        ":b owl:sameAs :c",
    ),
    (
        "cls-maxqc3",
        ":C owl:onProperty :p ; owl:onClass :D ; owl:maxQualifiedCardinality '1'^^xsd:nonNegativeInteger . "
        ":a a :C ; :p :b, :c . :b a :D . :c a :D",
        ":b owl:sameAs :c",
    ),
    (
        "cls-maxqc4",
        ":C owl:onProperty :p ; owl:onClass owl:Thing ; owl:maxQualifiedCardinality '1'^^xsd:nonNegativeInteger . "
        ":a a :C ; :p :b, :c",
        ":b owl:sameAs :c",
    ),
    ("cls-oo", ":C owl:oneOf (:a :b)", ":b a :C"),
    ("cax-sco", ":C rdfs:subClassOf :D . :a a :C", ":a a :D"),
    ("cax-eqc1", ":C owl:equivalentClass :D . :a a :C", ":a a :D"),
    ("cax-eqc2", ":C owl:equivalentClass :D . :a a :D", ":a a :C"),
    ("scm-sco", ":C rdfs:subClassOf :D . :D rdfs:subClassOf :E", ":C rdfs:subClassOf :E"),
    ("scm-eqc1", ":C owl:equivalentClass :D", ":D rdfs:subClassOf :C"),
    ("scm-eqc1", ":C owl:equivalentClass :D", ":C rdfs:subClassOf :D"),
    ("scm-eqc2", ":C rdfs:subClassOf :D . :D rdfs:subClassOf :C", ":C owl:equivalentClass :D"),
    ("scm-spo", ":p rdfs:subPropertyOf :q . :q rdfs:subPropertyOf :r", ":p rdfs:subPropertyOf :r"),
    ("scm-eqp1", ":p owl:equivalentProperty :q", ":q rdfs:subPropertyOf :p"),
    ("scm-eqp1", ":p owl:equivalentProperty :q", ":p rdfs:subPropertyOf :q"),
    ("scm-eqp2", ":p rdfs:subPropertyOf :q . :q rdfs:subPropertyOf :p", ":p owl:equivalentProperty :q"),
    ("scm-dom1", ":p rdfs:domain :C . :C rdfs:subClassOf :D", ":p rdfs:domain :D"),
    ("scm-dom2", ":q rdfs:domain :C . :p rdfs:subPropertyOf :q", ":p rdfs:domain :C"),
    ("scm-rng1", ":p rdfs:range :C . :C rdfs:subClassOf :D", ":p rdfs:range :D"),
    ("scm-rng2", ":q rdfs:range :C . :p rdfs:subPropertyOf :q", ":p rdfs:range :C"),
    (
        "scm-hv",
        ":C owl:hasValue :a ; owl:onProperty :p . :D owl:hasValue :a ; owl:onProperty :q . :p rdfs:subPropertyOf :q",
        ":C rdfs:subClassOf :D",
    ),
    (
        "scm-svf1",
        ":C owl:someValuesFrom :E ; owl:onProperty :p . :D owl:someValuesFrom :F ; owl:onProperty :p . "
        ":E rdfs:subClassOf :F",
        ":C rdfs:subClassOf :D",
    ),
    (
        "scm-svf2",
        ":C owl:someValuesFrom :E ; owl:onProperty :p . :D owl:someValuesFrom :E ; owl:onProperty :q . "
        ":p rdfs:subPropertyOf :q",
        ":C rdfs:subClassOf :D",
    ),
    (
        "scm-avf1",
        ":C owl:allValuesFrom :E ; owl:onProperty :p . :D owl:allValuesFrom :F ; owl:onProperty :p . "
        ":E rdfs:subClassOf :F",
        ":C rdfs:subClassOf :D",
    ),
    (
        "scm-avf2",
        ":C owl:allValuesFrom :E ; owl:onProperty :p . :D owl:allValuesFrom :E ; owl:onProperty :q . "
        ":p rdfs:subPropertyOf :q",
        ":D rdfs:subClassOf :C",
    ),
    *(
        (rule, f":C {word} :E ; owl:onProperty :p . :D {word} :E ; owl:onProperty :p", ":C rdfs:subClassOf :D")
        for rule, word in (
            ("scm-hv", "owl:hasValue"),
            ("scm-svf1", "owl:someValuesFrom"),
            ("scm-avf1", "owl:allValuesFrom"),
        )
    ),
    ("scm-int", ":C owl:intersectionOf (:D :E)", ":C rdfs:subClassOf :E"),
    ("scm-uni", ":C owl:unionOf (:D :E)", ":D rdfs:subClassOf :C"),
]

CONTRADICTS = [
    ("eq-diff1", ":a owl:sameAs :b . :a owl:differentFrom :b"),
    ("eq-diff1", ":a owl:differentFrom :a"),
    ("eq-diff2", "[] a owl:AllDifferent ; owl:members (:a :b :c) . :a owl:sameAs :c"),
    ("eq-diff3", "[] a owl:AllDifferent ; owl:distinctMembers (:a :b :a)"),
    ("prp-irp", ":p a owl:IrreflexiveProperty . :a :p :a"),
    ("prp-asyp", ":p a owl:AsymmetricProperty . :a :p :b . :b :p :a"),
    ("prp-pdw", ":p owl:propertyDisjointWith :q . :a :p :b ; :q :b"),
    ("prp-adp", "[] a owl:AllDisjointProperties ; owl:members (:p :q :r) . :a :p :b ; :r :b"),
    ("prp-npa1", "[] owl:sourceIndividual :a ; owl:assertionProperty :p ; owl:targetIndividual :b . :a :p :b"),
    ("prp-npa2", "[] owl:sourceIndividual :a ; owl:assertionProperty :p ; owl:targetValue 'x' . :a :p 'x'"),
    ("cls-nothing2", ":a a owl:Nothing"),
    ("cls-com", ":C owl:complementOf :D . :a a :C, :D"),
    ("cls-maxc1", ":C owl:onProperty :p ; owl:maxCardinality '0'^^xsd:nonNegativeInteger . :a a :C ; :p :b"),
    (
        "cls-maxqc1",
        ":C owl:onProperty :p ; owl:onClass :D ; owl:maxQualifiedCardinality '0'^^xsd:nonNegativeInteger . "
        ":a a :C ; :p :b . :b a :D",
    ),
    (
        "cls-maxqc2",
        ":C owl:onProperty :p ; owl:onClass owl:Thing ; owl:maxQualifiedCardinality '0'^^xsd:nonNegativeInteger . "
        ":a a :C ; :p :b",
    ),
    ("cax-dw", ":C owl:disjointWith :D . :a a :C, :D"),
    ("cax-adc", "[] a owl:AllDisjointClasses ; owl:members (:C :D :E) . :a a :C, :E"),
]


@pytest.mark.parametrize(("rule", "premises", "conclusion"), FOLLOWS, ids=[case[0] for case in FOLLOWS])
def test_each_rule_gives_its_conclusion_with_a_derivation(rule: str, premises: str, conclusion: str) -> None:
    stated, wanted = triples(f"{premises} ."), triple(conclusion)
    known = Materialisation(stated)
    assert wanted in known and wanted in known.inferred
    steps = known.derivation([wanted])
    assert steps[-1].triple == wanted
    assert rule in {step.rule for step in steps}
    for position, step in enumerate(steps):
        assert (step.rule is None) == (step.triple in stated)
        assert set(step.premises) <= {other.triple for other in steps[:position]}


@pytest.mark.parametrize(("rule", "premises", "conclusion"), FOLLOWS, ids=[case[0] for case in FOLLOWS])
def test_no_rule_fires_without_one_of_its_premises(rule: str, premises: str, conclusion: str) -> None:
    stated, wanted = triples(f"{premises} ."), triple(conclusion)
    needed = [step.triple for step in Materialisation(stated).derivation([wanted]) if step.rule is None]
    for left_out in needed:
        assert wanted not in Materialisation([t for t in needed if t != left_out])


@pytest.mark.parametrize(("rule", "premises"), CONTRADICTS, ids=[case[0] for case in CONTRADICTS])
def test_each_contradiction_is_found_with_its_derivation(rule: str, premises: str) -> None:
    stated = triples(f"{premises} .")
    known = Materialisation(stated)
    found = next(c for c in known.contradictions if c.rule == rule)
    assert {step.triple for step in known.derivation(found.premises) if step.rule is None} <= set(stated)


OVER_LISTS = (
    "cax-adc", "cls-int1", "cls-int2", "cls-oo", "cls-uni", "eq-diff2", "eq-diff3", "prp-adp", "prp-key", "prp-spo2",
    "scm-int", "scm-uni",
)  # fmt: skip
"""Rules whose premises are lists, which are expanded for each list and are in no table."""


def test_every_rule_of_the_table_has_a_case() -> None:
    tried = {case[0] for case in FOLLOWS} | {case[0] for case in CONTRADICTS}
    assert tried == {rule.name for rule in rules()} | set(OVER_LISTS)


def test_a_triple_that_does_not_follow_has_no_derivation() -> None:
    with pytest.raises(NotEntailedError, match="does not follow"):
        Materialisation(triples(":a :p :b .")).derivation([triple(":b :p :a")])


def test_a_cyclic_list_is_not_a_list() -> None:
    ring = ":C owl:intersectionOf _:l . _:l rdf:first :D ; rdf:rest _:l . :a a :D ."
    assert triple(":a a :C") not in Materialisation(triples(ring))


def test_the_time_limit_raises_an_error() -> None:
    links = "".join(f":x{i} :p :x{i + 1} ." for i in range(300))
    with pytest.raises(LimitError, match="undecided: time limit reached"):
        Materialisation(triples(":p a owl:TransitiveProperty . " + links), deadline=Deadline.after(0.0))


# ---- compared with owlrl

CLASSES, PROPERTIES, THINGS = "CDEF", "pqr", "abcd"


def _statement() -> st.SearchStrategy[str]:
    kind, relation, thing = (st.sampled_from([f":{n}" for n in names]) for names in (CLASSES, PROPERTIES, THINGS))
    characteristic = st.sampled_from([f"owl:{n}Property" for n in ("Transitive", "Symmetric", "Functional")])
    schema = st.sampled_from(["rdfs:subClassOf", "owl:equivalentClass"])
    roles = st.sampled_from(["rdfs:subPropertyOf", "owl:inverseOf", "owl:equivalentProperty"])
    ends = st.sampled_from(["rdfs:domain", "rdfs:range"])
    quantified = st.sampled_from(["owl:someValuesFrom", "owl:allValuesFrom"])
    return st.one_of(
        st.tuples(kind, schema, kind).map(" ".join),
        st.tuples(relation, roles, relation).map(" ".join),
        st.tuples(relation, ends, kind).map(" ".join),
        st.tuples(relation, st.just("a"), characteristic).map(" ".join),
        st.tuples(thing, st.just("a"), kind).map(" ".join),
        st.tuples(thing, relation, thing).map(" ".join),
        st.tuples(kind, relation, quantified, kind).map(lambda w: f"{w[0]} owl:onProperty {w[1]} ; {w[2]} {w[3]}"),
        st.tuples(kind, kind, kind).map(lambda w: f"{w[0]} owl:intersectionOf ({w[1]} {w[2]})"),
        st.tuples(kind, kind, kind).map(lambda w: f"{w[0]} owl:unionOf ({w[1]} {w[2]})"),
        st.tuples(relation, relation, relation).map(lambda w: f"{w[0]} owl:propertyChainAxiom ({w[1]} {w[2]})"),
        st.tuples(thing, thing).map(lambda w: f"{w[0]} owl:sameAs {w[1]}"),
    )


DECLARED = "".join(f":{n} a owl:Class . " for n in CLASSES) + "".join(
    f":{n} a owl:ObjectProperty . " for n in PROPERTIES
)


@settings(max_examples=30, deadline=None)
@given(st.lists(_statement(), min_size=4, max_size=14))
def test_random_ontologies_give_the_same_triples_as_owlrl(statements: list[str]) -> None:
    turtle = DECLARED + " ".join(f"{statement} ." for statement in statements)
    ours = Materialisation(triples(turtle))
    assert telling(triples_of(ours)) == telling(owlrl_closure(turtle))


def test_the_core_with_a_table_gives_the_same_triples_as_owlrl() -> None:
    assert telling(triples_of(Materialisation(read_ntriples(core() + ntriples(TABLE))))) == telling(
        owlrl_closure(core() + write_ntriples(triples(TABLE)))
    )


TABLE = """
:f a dx:Fork, owl:NamedIndividual ; dx:left :p . :p a dx:DinnerPlate, owl:NamedIndividual ; dx:left :k .
:k a dx:Knife, owl:NamedIndividual . :n a dx:Napkin, owl:NamedIndividual ; dx:exactlyOn :p .
"""


def triples_of(known: Materialisation) -> set[Triple]:
    return set(known.inferred)


def owlrl_closure(turtle: str) -> set[Triple]:
    graph = rdflib.Graph().parse(data=PREFIXES + turtle, format="turtle")
    stated = set(graph)
    owlrl.DeductiveClosure(owlrl.OWLRL_Semantics, axiomatic_triples=False, datatype_axioms=False).expand(graph)
    return set(read_ntriples(_nt(set(graph) - stated)))


def _nt(found: Iterable[tuple[rdflib.term.Node, rdflib.term.Node, rdflib.term.Node]]) -> str:
    """Return the valid RDF triples as N-Triples: owlrl also makes triples whose subject is a literal."""
    plain = (t for t in found if not isinstance(t[0], rdflib.Literal) and isinstance(t[1], rdflib.URIRef))
    return "".join(f"{' '.join(part.n3() for part in t)} .\n" for t in plain)


def telling(found: set[Triple]) -> set[Triple]:
    """Return the triples of named resources, without tautologies and known differences from owlrl."""
    reflexive = (SAME_AS, SUB_CLASS_OF, SUB_PROPERTY_OF, EQUIVALENT_CLASS, EQUIVALENT_PROPERTY)
    return {
        t
        for t in found
        if not any(is_blank(part) or is_literal(part) for part in t)
        and not (t.subject == t.object and t.predicate in reflexive)
        and THING not in t
        and NOTHING not in t
        and t.subject.startswith(("<urn:", "<https://w3id.org/"))
        and not (t.predicate == TYPE and re.search(r"(owl|rdf-schema|rdf-syntax-ns)#", t.object))
    }


# ---- step by step


@settings(max_examples=40, deadline=None)
@given(st.lists(_statement(), min_size=3, max_size=14), st.randoms(use_true_random=False))
def test_adding_facts_in_any_order_gives_the_same_triples(statements: list[str], random: Random) -> None:
    stated = triples(DECLARED + " ".join(f"{statement} ." for statement in statements))
    at_once = Materialisation(stated)
    shuffled = list(stated)
    random.shuffle(shuffled)
    step_by_step = Materialisation()
    given_back: set[Triple] = set()
    for one in shuffled:
        given_back.update(step_by_step.add([one]))
    assert set(step_by_step.inferred) == set(at_once.inferred)
    assert given_back - set(stated) == set(at_once.inferred)
    assert {frozenset(c.premises) for c in step_by_step.contradictions} == {
        frozenset(c.premises) for c in at_once.contradictions
    }
    for one in step_by_step.inferred:
        assert {s.triple for s in step_by_step.derivation([one]) if s.rule is None} <= set(stated)


def test_adding_a_fact_returns_only_its_consequences() -> None:
    known = Materialisation(read_ntriples(core()))
    new = known.add(triples(":f a dx:Fork ."))
    assert {t.subject for t in new} == {"<urn:t#f>"}
    assert triple(":f a dx:Tableware") in new
    assert known.add(triples(":f a dx:Cutlery .")) == ()


# ---- compared with HermiT


@pytest.mark.slow
def test_the_core_with_a_table_agrees_with_hermit() -> None:
    stated = core() + ntriples(TABLE)
    known = set(Materialisation(read_ntriples(stated)).inferred)
    hermit = set(read_ntriples(classify(stated, properties=True).inferred))
    compared = (TYPE, SUB_CLASS_OF, SUB_PROPERTY_OF)
    for predicate in compared:
        ours = {t for t in telling(known) if t.predicate == predicate}
        theirs = {t for t in hermit if t.predicate == predicate}
        assert ours == theirs, predicate
        assert ours or predicate != TYPE
    relations = {t for t in telling(known) if t.predicate not in compared and t.subject.startswith("<urn:t#")}
    assert relations == {t for t in hermit if t.predicate not in compared}
    assert triple(":f dx:left :k") in relations and triple(":p dx:under :n") in relations
