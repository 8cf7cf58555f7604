"""Literals as data values: equal values, ill-formed texts, datatypes, and the rules of table 8, as in HermiT."""

from __future__ import annotations

import pytest
import rdflib
from hypothesis import given
from hypothesis import strategies as st
from ontologies import ntriples, triple, triples

from deixis.reasoning.description_logic.entailment import entail
from deixis.reasoning.description_logic.owl_rl.datatypes import IllFormedError, is_in, value_of
from deixis.reasoning.description_logic.owl_rl.materialisation import Materialisation
from deixis.reasoning.description_logic.reasoners import first_inconsistent
from deixis.reasoning.description_logic.terms import term

BOUNDS = {
    "byte": (-128, 127),
    "unsignedShort": (0, 65535),
    "negativeInteger": (None, -1),
    "long": (-(2**63), 2**63 - 1),
}


def literal(text: str, datatype: str) -> str:
    return f'"{text}"^^{term(f"xsd:{datatype}")}'


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (literal("01", "int"), literal("1.0", "decimal")),
        (literal("true", "boolean"), literal("1", "boolean")),
        (literal("1e2", "double"), literal("100", "double")),
        ('"a"@en-GB', '"a"@EN-gb'),
        ('"a"', literal("a", "string")),
        (r'"\u0061"', '"a"'),
        (literal("0a", "hexBinary"), literal("0A", "hexBinary")),
        (literal("2026-03-01T01:00:00+01:00", "dateTime"), literal("2026-03-01T00:00:00Z", "dateTime")),
        (literal("2026-02-28T24:00:00", "dateTime"), literal("2026-03-01T00:00:00.0", "dateTime")),
    ],
)
def test_two_spellings_of_a_value_are_equal(one: str, other: str) -> None:
    assert value_of(one) == value_of(other) is not None


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (literal("1", "double"), literal("1", "integer")),
        (literal("1", "double"), literal("1", "float")),
        (literal("a", "anyURI"), literal("a", "string")),
        ('"a"@en', '"a"'),
        (literal("0A", "hexBinary"), literal("Cg==", "base64Binary")),
        (literal("2026-03-01T00:00:00", "dateTime"), literal("2026-03-01T00:00:00Z", "dateTime")),
    ],
)
def test_values_of_disjoint_spaces_differ(one: str, other: str) -> None:
    assert None is not value_of(one) != value_of(other) is not None


@pytest.mark.parametrize(
    "ill",
    [
        literal("heavy", "decimal"),
        literal("300", "byte"),
        literal("1.5", "integer"),
        literal("yes", "boolean"),
        literal("2026-02-30T00:00:00", "dateTime"),
        literal("2026-02-03T24:00:01", "dateTime"),
        literal("2026-02-03T00:00:00", "dateTimeStamp"),
        literal("a b", "NCName"),
        literal("0", "hexBinary"),
    ],
)
def test_an_ill_formed_text_is_refused(ill: str) -> None:
    with pytest.raises(IllFormedError):
        value_of(ill)


@given(st.integers(-(2**70), 2**70), st.sampled_from(sorted(BOUNDS)))
def test_integers_belong_to_a_datatype_within_its_bounds(number: int, datatype: str) -> None:
    low, high = BOUNDS[datatype]
    value = value_of(literal(str(number), "integer"))
    assert value is not None
    within = (low is None or number >= low) and (high is None or number <= high)
    assert is_in(value, term(f"xsd:{datatype}")) is within


@given(st.text(alphabet="0123456789+-.eEINFatruefls", max_size=8), st.sampled_from(["integer", "decimal", "boolean"]))
def test_well_formed_literals_agree_with_rdflib(text: str, datatype: str) -> None:
    theirs = rdflib.Literal(text, datatype=rdflib.XSD[datatype])
    try:
        ours = value_of(literal(text, datatype))
    except IllFormedError:
        return  # rdflib accepts more: 'Infinity', '1e5' as decimals
    assert ours is not None
    assert theirs.ill_typed is False
    assert ours.value == theirs.value


def test_the_values_of_unknown_datatypes_are_unknown() -> None:
    assert value_of('"x"^^<urn:mine>') is None
    value = value_of(literal("1", "integer"))
    assert value is not None and is_in(value, "<urn:mine>") is None


FUNCTIONAL = ":weight a owl:DatatypeProperty, owl:FunctionalProperty . "
RANGED = ":weight a owl:DatatypeProperty ; rdfs:range xsd:decimal . "
CASES = [  # contradictory or not, the rule, and the ontology
    (True, "dt-diff", FUNCTIONAL + ":a :weight 1, 2 ."),
    (False, "", FUNCTIONAL + ':a :weight 1, "01"^^xsd:int, 1.0 .'),
    (True, "dt-diff", FUNCTIONAL + ':a :weight "1", 1 .'),
    (True, "dt-not-type", RANGED + ':a :weight "heavy" .'),
    (False, "", RANGED + ":a :weight 5 ."),
    (True, "dt-not-type", RANGED + ":a :weight 5e0 ."),
    (True, "dt-not-type", ":weight a owl:DatatypeProperty ; rdfs:range xsd:byte . :a :weight 300 ."),
    (
        True,
        "dt-not-type",
        ":weight a owl:DatatypeProperty . :a a [ a owl:Restriction ; owl:onProperty :weight ; "
        "owl:allValuesFrom xsd:string ] ; :weight 1 .",
    ),
    (
        True,
        "dt-diff",
        ":weight a owl:DatatypeProperty . :b owl:sameAs :a . :a :weight 1 . :b :weight 2 . :a a [ a owl:Restriction ; "
        "owl:onProperty :weight ; owl:maxCardinality 1 ] .".replace(
            "owl:maxCardinality 1", 'owl:maxCardinality "1"^^xsd:nonNegativeInteger'
        ),
    ),
]


@pytest.mark.parametrize(("contradictory", "rule", "turtle"), CASES)
def test_the_rules_compare_the_values_of_literals(contradictory: bool, rule: str, turtle: str) -> None:
    known = Materialisation(triples(turtle))
    assert {found.rule for found in known.contradictions} == ({rule} if contradictory else set())
    for found in known.contradictions:
        assert any(":weight" in str(premise) or "weight>" in str(premise) for premise in found.premises)


@pytest.mark.slow
@pytest.mark.parametrize(("contradictory", "rule", "turtle"), CASES)
def test_hermit_agrees_about_literals(contradictory: bool, rule: str, turtle: str) -> None:
    assert (first_inconsistent([triples(turtle)]) == 0) is contradictory
    assert entail(ntriples(turtle), "auto").consistent is not contradictory


def test_an_ill_formed_literal_is_a_contradiction() -> None:
    known = Materialisation(triples(':weight a owl:DatatypeProperty . :a :weight "heavy"^^xsd:decimal .'))
    assert [found.rule for found in known.contradictions] == ["dt-not-type"]


def test_equal_values_join_and_keep_their_spellings() -> None:
    known = Materialisation(triples(':Heavy owl:onProperty :weight ; owl:hasValue 10 . :a :weight "010"^^xsd:int .'))
    assert triple(":a a :Heavy") in known
    steps = known.derivation([triple(":a a :Heavy")])
    assert triple(':a :weight "010"^^xsd:int') in [step.triple for step in steps]


def test_a_value_of_a_datatype_satisfies_a_restriction() -> None:
    said = ":Weighed owl:onProperty :weight ; owl:someValuesFrom xsd:integer . :a :weight 5.0 . :b :weight 5.5 ."
    known = Materialisation(triples(said))
    assert triple(":a a :Weighed") in known
    assert triple(":b a :Weighed") not in known
    assert not any(found.subject.startswith('"') for found in known.inferred)
