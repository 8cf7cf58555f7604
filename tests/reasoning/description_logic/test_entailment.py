"""The engines of description logic behind one call: what each decides, and what it reports as undecided."""

from __future__ import annotations

import pytest
from ontologies import CUTLERY, ntriples, triple, triples

from deixis.deadline import Deadline
from deixis.reasoning.description_logic.entailment import (
    Entailment,
    LogicEngine,
    entail,
    explained,
    unsatisfiable_by_rules,
)
from deixis.reasoning.description_logic.reasoners import first_inconsistent
from deixis.reasoning.errors import LimitError, SettingError

pytestmark = pytest.mark.slow

SPORK = ":Spork a owl:Class ; rdfs:subClassOf :Fork, :Spoon . "
TRAY = (
    ":has a owl:ObjectProperty . :Tray a owl:Class ; "
    "rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :has ; owl:someValuesFrom :Spork ] . "
)


@pytest.mark.parametrize("engine", list(LogicEngine))
def test_every_engine_finds_the_consequences_of_the_rules(engine: LogicEngine) -> None:
    found = entail(ntriples(CUTLERY + ":f a :DessertFork ."), engine)
    assert found.consistent and found.unsatisfiable == ()
    assert set(found.inferred) == {triple(":DessertFork rdfs:subClassOf :Cutlery"), *triples(":f a :Fork, :Cutlery .")}
    assert found.complete == (engine in ("hermit", "pellet"))


@pytest.mark.parametrize(
    ("engine", "impossible"),
    [("rl", ("Spork",)), ("auto", ("Spork", "Tray"))],
)
def test_only_the_rules_miss_unnamed_individuals(engine: str, impossible: tuple[str, ...]) -> None:
    text = ntriples(CUTLERY + SPORK + TRAY)
    found = explained(text, entail(text, engine), Deadline.never())
    assert found.unsatisfiable == tuple(f"urn:t#{name}" for name in impossible)
    assert len(found.impossible) == len(impossible)
    assert found.consistent


def test_the_rules_leave_tableau_contradictions_undecided() -> None:
    turtle = CUTLERY + SPORK + TRAY + ":t a :Tray ."
    assert first_inconsistent([triples(turtle)]) == 0
    by_rules = entail(ntriples(turtle), "rl")
    assert by_rules.consistent and not by_rules.complete


@pytest.mark.parametrize("engine", ["auto", "pellet"])
def test_an_inconsistency_is_found_and_justified(engine: str) -> None:
    text = ntriples(CUTLERY + ":x a :Fork, :Spoon .")
    found = explained(text, entail(text, engine), Deadline.never())
    assert not found.consistent and [len(why.axioms) for why in found.inconsistency] == [3]
    assert found.inferred == ()


def test_the_verdict_stays_if_the_explanation_runs_out_of_time() -> None:
    text = ntriples(CUTLERY + ":x a :Fork, :Spoon .")
    found = explained(text, entail(text, "hermit"), Deadline.after(0))
    assert not found.consistent and found.inconsistency == ()
    assert found.unexplained is not None and "time limit reached" in found.unexplained


@pytest.mark.parametrize("more", ["", ":x a :Fork, :Spoon ."])
def test_a_malformed_literal_that_hermit_refuses_is_justified(more: str) -> None:
    text = ntriples(CUTLERY + ':weight a owl:DatatypeProperty . :y :weight "heavy"^^xsd:decimal . ' + more)
    found = explained(text, entail(text), Deadline.never(), every=True)
    assert not found.consistent and found.unexplained is None
    assert sorted(len(why.axioms) for why in found.inconsistency) == ([1, 3] if more else [1])


def test_the_verdict_stays_if_hermit_refuses_the_ontology() -> None:
    date = ':made a owl:DatatypeProperty . :z :made "2026-01-01"^^xsd:date . '
    text = ntriples(CUTLERY + date + TRAY + SPORK + ":t a :Tray .")
    inconsistent = Entailment(LogicEngine.AUTO, complete=False, consistent=False)
    found = explained(text, inconsistent, Deadline.never())
    assert not found.consistent and found.inconsistency == ()
    assert found.unexplained is not None and "hermit refused the ontology" in found.unexplained


def test_the_rules_name_every_unsatisfiable_class() -> None:
    many = "".join(f":S{i} a owl:Class ; rdfs:subClassOf :Fork, :Spoon . " for i in range(8))
    assert unsatisfiable_by_rules(triples(CUTLERY + many)) == tuple(f"urn:t#S{i}" for i in range(8))


@pytest.mark.parametrize("engine", list(LogicEngine))
def test_every_engine_keeps_its_time_limit(engine: LogicEngine) -> None:
    with pytest.raises(LimitError, match="undecided"):
        entail(ntriples(CUTLERY), engine, time_limit=0.0)


def test_an_unknown_engine_is_refused() -> None:
    with pytest.raises(SettingError, match="one of auto, rl, hermit, pellet"):
        entail("", "racer")
