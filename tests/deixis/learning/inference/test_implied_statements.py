"""Implications of layouts are stored with their reasons, and removed with their lesson."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pyoxigraph as ox
import pytest

from deixis.examples_data import example
from deixis.learning.inference import implied_statements
from deixis.learning.inference.implied_statements import implied_triples
from deixis.learning.lessons.lesson import layout_concept
from deixis.learning.update import stale
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.semantic.rdf.change import concluding
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.entailment.implications import Implications
from deixis.session import Session
from deixis.workflows.layouts.read import read_script

ROW = "layout row; fork left of plate; plate left of knife; napkin on plate; spoon probably right of knife"
FORKS = """SELECT ?fork ?plate {
    ?a dx:left ?b ; rdfs:label ?fork ; dx:ofKind/rdfs:subClassOf* dx:Fork .
    ?b rdfs:label ?plate ; dx:ofKind/rdfs:subClassOf* dx:Plate
}"""


def triples(text: str) -> set[ox.Triple]:
    return set(implied_triples(layout_concept(read_script(text=text), "row-1"), default_ontology().relations))


def names(triple: ox.Triple) -> tuple[str, ...]:
    return tuple(str(getattr(term, "value", "")).rsplit("/", 1)[-1].rsplit("#", 1)[-1] for term in triple)


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Session]:
    with Session(tmp_path_factory.mktemp("implied") / "memory") as session:
        for script in ("formal_dinner.layout", "script1.layout"):
            session.learn(example(script), example("place_setting.scene.json"))
        yield session


def test_roles_have_what_is_stated_and_what_follows() -> None:
    found = {names(triple) for triple in triples(ROW)}
    assert {("fork", "left", "plate"), ("fork", "left", "knife"), ("knife", "right", "fork")} <= found
    assert not any({"spoon", "left"} <= set(triple) or {"spoon", "right"} <= set(triple) for triple in found)


def test_an_implied_statement_has_its_rule_and_premises() -> None:
    found = triples(ROW)
    (statement,) = (
        {t.subject for t in found if names(t)[1:] == ("subject", "fork")}
        & {t.subject for t in found if names(t)[1:] == ("relation", "left")}
        & {t.subject for t in found if names(t)[1:] == ("object", "knife")}
    )
    about = {names(t)[1:] for t in found if t.subject == statement}
    assert {("rule", "transitivity"), ("wasDerivedFrom", "1"), ("wasDerivedFrom", "2")} <= about


def test_they_are_what_infer_finds() -> None:
    script = read_script(example("formal_dinner.layout"))
    found = set(implied_triples(layout_concept(script, "x-1"), script.ontology.relations))
    infer = Implications(script.graph())
    assert sum(names(t)[1:] == ("type", "ImpliedStatement") for t in found) == infer.unstated()
    assert {("implicationsStored", "true")} == {names(t)[1:] for t in found if names(t)[1] == "implicationsStored"}


def test_a_large_closure_is_not_stored(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(implied_statements, "MAX_IMPLIED", 3)
    assert {names(triple) for triple in triples(ROW)} == {("row-1", "implicationsStored", "false")}


def test_a_layout_with_alternatives_says_that_more_may_follow() -> None:
    found = {names(triple) for triple in triples("layout row; a left or top_left of b; b left of c")}
    assert ("row-1", "implicationsStored", "false") in found
    assert ("a", "left", "c") in found  # both alternatives are to the left


def test_queries_find_what_follows_and_why(session: Session) -> None:
    names = {(row["fork"].value, row["plate"].value) for row in session.query(FORKS).rows}
    assert names >= {("salad_fork", "dinner_plate"), ("dinner_fork", "dinner_plate")}
    rules = session.query("SELECT DISTINCT ?r { ?s a dx:ImpliedStatement ; dx:rule/a dx:InferenceRule ; dx:rule ?r }")
    assert len(rules.rows) >= 4


def test_answers_note_layouts_whose_implications_are_not_stored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(implied_statements, "MAX_IMPLIED", 3)
    monkeypatch.setattr(implied_statements, "MAX_ON_DEMAND", 10)
    with Session(tmp_path / "memory") as session:
        session.learn(example("formal_dinner.layout"), example("place_setting.scene.json"))
        found = session.query(FORKS)
        (note,) = found.notes
        assert "may be incomplete: formal_dinner-1" in note
        assert json.loads(found.to_json())["notes"] == [note]
        assert json.loads(session.query("ASK { ?s a dx:ImpliedStatement }").to_json())["notes"] == [note]
        assert session.query("SELECT ?l { ?l rdfs:subClassOf dx:Layout }").notes == ()


def test_a_query_completes_a_layout_that_implies_much(session: Session, tmp_path: Path) -> None:
    with pytest.MonkeyPatch.context() as patch, Session(tmp_path / "memory") as late:
        patch.setattr(implied_statements, "MAX_IMPLIED", 3)
        for script in ("formal_dinner.layout", "script1.layout"):
            late.learn(example(script), example("place_setting.scene.json"))
        found = late.query(FORKS)
        assert not found.notes
        assert sorted(map(str, found.rows)) == sorted(map(str, session.query(FORKS).rows))
        assert not list(stale(late.memory().store, default_ontology()))
        late.forget("formal_dinner-1")
        assert not list(stale(late.memory().store, default_ontology()))
        assert late.query("SELECT ?s { ?s a dx:ImpliedStatement }").rows


def test_complete_answers_have_no_notes(session: Session) -> None:
    assert session.query(FORKS).notes == ()


def test_verify_finds_a_missing_implication(session: Session, tmp_path: Path) -> None:
    memory, ontology = session.memory(), default_ontology()
    assert list(stale(memory.store, ontology)) == []
    kept, rules = list(memory.triples(GraphName.INFERRED)), memory.kept_up()
    gone = next(triple for triple in kept if names(triple)[1] == "left" and "/role/" in str(triple.subject))
    memory.commit(concluding(memory.store, [triple for triple in kept if triple != gone]), rules)
    try:
        assert "1 missing" in "".join(stale(memory.store, ontology))
    finally:
        memory.commit(concluding(memory.store, kept), rules)


def test_export_and_import_keep_the_implications(session: Session, tmp_path: Path) -> None:
    (tmp_path / "all.trig").write_text(export_memory(session.memory()), encoding="utf-8")
    with Session(tmp_path / "memory") as other:
        other.import_(tmp_path / "all.trig")
        assert set(other.memory().triples(GraphName.INFERRED)) == set(session.memory().triples(GraphName.INFERRED))


def test_forgetting_a_lesson_removes_what_it_implied(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        learned = session.learn(example("script1.layout"), example("place_setting.scene.json"))
        assert session.query("ASK { ?s a dx:ImpliedStatement }").boolean
        session.forget(learned.lesson.id)
        left = [t for t in session.memory().triples(GraphName.INFERRED) if "script1-1" in str(t)]
        assert left == []


def test_the_next_lesson_completes_an_older_memory(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        session.learn(example("script1.layout"), example("place_setting.scene.json"))
        memory = session.memory()
        old = [t for t in memory.triples(GraphName.INFERRED) if "/layout/" not in str(t.subject)]
        memory.commit(concluding(memory.store, old), "1 before")
        assert not session.query("ASK { ?s a dx:ImpliedStatement }").boolean
        session.learn(example("script2.layout"), example("place_setting.scene.json"))
        asked = "SELECT DISTINCT ?l { ?s a dx:ImpliedStatement ; dx:inLayout ?l }"
        assert len(session.query(asked).rows) == 2
