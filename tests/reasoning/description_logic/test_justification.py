"""Justifications: minimal sets of complete axioms, for entailments found by rules or only by a tableau."""

from __future__ import annotations

from itertools import combinations

import pytest
import rdflib
from ontologies import CUTLERY, core, ntriples, triple, triples

from deixis.deadline import Deadline
from deixis.reasoning.description_logic.axioms import Axiom, split_axioms
from deixis.reasoning.description_logic.justification import Justification, denial, justify, justify_all
from deixis.reasoning.description_logic.owl_rl.materialisation import Materialisation
from deixis.reasoning.description_logic.reasoners import first_inconsistent
from deixis.reasoning.description_logic.terms import Triple, read_ntriples
from deixis.reasoning.errors import LimitError, NotEntailedError, SettingError

pytestmark = pytest.mark.slow

TABLE = """
:Spork a owl:Class ; rdfs:subClassOf dx:Fork, dx:Spoon .
:Tray a owl:Class ; rdfs:subClassOf [ a owl:Restriction ; owl:onProperty dx:left ; owl:someValuesFrom :Spork ] .
:f a dx:Fork ; dx:exactlyLeft :p . :p dx:left :k .
"""


def assert_minimal(found: Justification, text: str) -> None:
    """Assert that the axioms entail the statement, and that leaving out any one of them does not."""
    parts = split_axioms(read_ntriples(text))
    background = [*parts.declarations, *(denial(found.entailed) if found.entailed else ())]
    assert set(found.axioms) <= set(parts.axioms)
    chosen = [*([a for a in found.axioms if a != left_out] for left_out in found.axioms), list(found.axioms)]
    ontologies = [[*background, *(t for axiom in axioms for t in axiom.triples)] for axioms in chosen]
    assert first_inconsistent(ontologies) == len(found.axioms)


CASES = [
    (":Spork rdfs:subClassOf owl:Nothing", 3),
    (":Tray rdfs:subClassOf owl:Nothing", 4),  # through someValuesFrom, which no rule of OWL 2 RL finds
    (":f a dx:Tableware", 3),
    (":f dx:left :k", 4),
    ("dx:left rdfs:domain dx:SpatialEntity", 3),
]


@pytest.mark.parametrize(("statement", "axioms"), CASES, ids=[case[0] for case in CASES])
def test_entailments_of_the_core_have_minimal_justifications(statement: str, axioms: int) -> None:
    text = core() + ntriples(TABLE)
    found = justify(text, triple(statement))
    assert len(found.axioms) == axioms
    assert_minimal(found, text)


def test_an_inconsistency_has_a_minimal_justification() -> None:
    text = core() + ntriples(TABLE + ":x a :Spork .")
    found = justify(text)
    assert found.entailed is None
    assert len(found.axioms) == 4
    assert_minimal(found, text)


def test_an_inconsistency_beyond_the_rules_is_justified() -> None:
    others = "".join(f":C{i} a owl:Class ; rdfs:subClassOf :C{i + 1} . :i{i} a :C{i} ." for i in range(12))
    table = TABLE.replace("dx:Fork", ":Fork").replace("dx:Spoon", ":Spoon")
    text = ntriples(CUTLERY + others + table + ":x a :Tray .")
    found = justify(text)
    assert len(found.axioms) == 5
    assert_minimal(found, text)


def test_all_minimal_contradictory_subsets_are_justifications() -> None:
    said = ":Spork rdfs:subClassOf :Fork, :Spoon . :x a :Spork, :Fork . :y a :Fork, :Spoon ."
    text = ntriples(CUTLERY + said)
    parts = split_axioms(read_ntriples(text))

    def contradictory(axioms: tuple[Axiom, ...]) -> bool:
        stated = [*parts.declarations, *(t for axiom in axioms for t in axiom.triples)]
        return bool(Materialisation(stated).contradictions)

    subsets = (set(some) for size in range(6) for some in combinations(parts.axioms, size) if contradictory(some))
    minimal: list[set[Axiom]] = []
    for some in subsets:  # the smaller ones first
        if not any(known <= some for known in minimal):
            minimal.append(some)
    found = list(justify_all(text))
    assert {frozenset(one.axioms) for one in found} == {frozenset(some) for some in minimal}
    assert len(found) == len(minimal) == 3


def test_a_justification_is_turtle_with_its_blank_nodes_whole() -> None:
    text = core() + ntriples(TABLE)
    found = justify(text, triple(":Spork rdfs:subClassOf owl:Nothing"))
    graph = rdflib.Graph().parse(data=found.ntriples, format="turtle")
    assert len(graph) == len(found.ntriples.splitlines())
    (members,) = graph.objects(predicate=rdflib.OWL.members)
    assert rdflib.URIRef("https://w3id.org/deixis/onto#Spoon") in rdflib.collection.Collection(graph, members)


def test_not_entailed_differs_from_not_known_in_time() -> None:
    text = ntriples(CUTLERY)
    with pytest.raises(NotEntailedError, match="does not follow"):
        justify(text, triple(":Cutlery rdfs:subClassOf :Fork"))
    with pytest.raises(NotEntailedError, match="consistent"):
        justify(text)
    with pytest.raises(LimitError, match="undecided"):
        justify(text, triple(":DessertFork rdfs:subClassOf :Cutlery"), deadline=Deadline.after(0.01))


@pytest.mark.parametrize("statement", [":Fork a owl:Class", ":p owl:inverseOf :q", ":a :p []"])
def test_a_statement_that_cannot_be_denied_is_refused(statement: str) -> None:
    asked: Triple = triples(f"{statement} .")[0]
    with pytest.raises(SettingError, match=r"cannot be explained|named resources"):
        justify(ntriples(CUTLERY), asked)
