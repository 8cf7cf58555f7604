"""HermiT through its adapter: what follows, what is impossible, what cannot be."""

from __future__ import annotations

import pytest

from deixis.reasoning.description_logic import classify
from deixis.reasoning.errors import InconsistencyError

RDF, RDFS, OWL = (
    "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "http://www.w3.org/2000/01/rdf-schema#",
    "http://www.w3.org/2002/07/owl#",
)


def line(subject: str, predicate: str, object: str) -> str:
    return f"<{subject}> <{predicate}> <{object}> .\n"


def declared(*classes: str) -> str:
    return "".join(line(c, RDF + "type", OWL + "Class") for c in classes)


CUTLERY = (
    declared("urn:Cutlery", "urn:Fork", "urn:Spoon", "urn:DessertFork")
    + line("urn:Fork", RDFS + "subClassOf", "urn:Cutlery")
    + line("urn:Spoon", RDFS + "subClassOf", "urn:Cutlery")
    + line("urn:DessertFork", RDFS + "subClassOf", "urn:Fork")
    + line("urn:Fork", OWL + "disjointWith", "urn:Spoon")
)


@pytest.mark.slow
def test_broader_classes_of_classes_and_individuals_follow() -> None:
    individual = line("urn:f", RDF + "type", "urn:DessertFork") + line("urn:f", RDF + "type", OWL + "NamedIndividual")
    inferred = classify(CUTLERY + individual).inferred
    assert line("urn:DessertFork", RDFS + "subClassOf", "urn:Cutlery") in inferred
    assert line("urn:f", RDF + "type", "urn:Cutlery") in inferred
    assert line("urn:f", RDF + "type", "urn:DessertFork") not in inferred  # was stated
    assert line("urn:Fork", RDFS + "subClassOf", "urn:Cutlery") not in inferred


@pytest.mark.slow
def test_a_class_that_nothing_can_belong_to_is_named() -> None:
    spork = declared("urn:Spork") + "".join(
        line("urn:Spork", RDFS + "subClassOf", of) for of in ("urn:Fork", "urn:Spoon")
    )
    assert classify(CUTLERY + spork).unsatisfiable == ("urn:Spork",)
    with pytest.raises(InconsistencyError, match="nothing can satisfy it"):
        classify(CUTLERY + spork + line("urn:x", RDF + "type", "urn:Spork"))


@pytest.mark.slow
def test_two_runs_know_nothing_of_each_other() -> None:
    classify(CUTLERY)
    assert "Cutlery" not in classify(declared("urn:Other")).inferred
