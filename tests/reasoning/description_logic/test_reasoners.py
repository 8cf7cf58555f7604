"""HermiT and Pellet through their adapter: entailments, unsatisfiable classes, inconsistency and errors."""

from __future__ import annotations

import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from ontologies import CUTLERY, ntriples, triple, triples

from deixis.reasoning.description_logic import reasoners as description_logic
from deixis.reasoning.description_logic.reasoners import Reasoner, classify, first_inconsistent
from deixis.reasoning.description_logic.terms import read_ntriples
from deixis.reasoning.errors import InconsistencyError, LimitError, ReasonerError, SettingError, TriplesError

pytestmark = pytest.mark.slow

BOTH = pytest.mark.parametrize("reasoner", list(Reasoner))
SPORK = ":Spork a owl:Class ; rdfs:subClassOf :Fork, :Spoon ."


@BOTH
def test_broader_classes_of_classes_and_individuals_follow(reasoner: Reasoner) -> None:
    found = classify(ntriples(CUTLERY + ":f a :DessertFork, owl:NamedIndividual ."), reasoner)
    inferred = set(read_ntriples(found.inferred))
    assert inferred == {triple(":DessertFork rdfs:subClassOf :Cutlery"), *triples(":f a :Fork, :Cutlery .")}
    assert found.unsatisfiable == ()


@BOTH
def test_unsatisfiable_classes_are_named(reasoner: Reasoner) -> None:
    assert classify(ntriples(CUTLERY + SPORK), reasoner).unsatisfiable == ("urn:t#Spork",)
    with pytest.raises(InconsistencyError, match="no model satisfies it"):
        classify(ntriples(CUTLERY + SPORK + ":x a :Spork ."), reasoner)


@BOTH
def test_relations_between_individuals_are_returned_on_request(reasoner: Reasoner) -> None:
    text = ntriples(
        ":left a owl:ObjectProperty, owl:TransitiveProperty ; owl:inverseOf :right ; rdfs:subPropertyOf :beside . "
        ":right a owl:ObjectProperty . :beside a owl:ObjectProperty . :a :left :b . :b :left :c ."
    )
    wanted = {
        triple(":a :left :c"), triple(":a :beside :b"), triple(":b :beside :c"), triple(":a :beside :c"),
        triple(":b :right :a"), triple(":c :right :b"), triple(":c :right :a"),
    }  # fmt: skip
    found = set(read_ntriples(classify(text, reasoner, properties=True).inferred))
    assert {t for t in found if t.subject in ("<urn:t#a>", "<urn:t#b>", "<urn:t#c>")} == wanted
    assert not wanted & set(read_ntriples(classify(text, reasoner).inferred))


@BOTH
def test_consistency_is_decided_beyond_the_rules(reasoner: Reasoner) -> None:
    # every A has a fork that is a spoon, or is a B, but nothing is a B; no rule of OWL 2 RL finds this
    text = CUTLERY + (
        ":has a owl:ObjectProperty . :A a owl:Class ; rdfs:subClassOf [ a owl:Class ; owl:unionOf ( :B "
        "[ a owl:Restriction ; owl:onProperty :has ; owl:someValuesFrom "
        "[ a owl:Class ; owl:intersectionOf ( :Fork :Spoon ) ] ] ) ] . :B a owl:Class ; rdfs:subClassOf owl:Nothing ."
    )
    assert "urn:t#A" in classify(ntriples(text), reasoner).unsatisfiable
    with pytest.raises(InconsistencyError):
        classify(ntriples(text + ":a a :A ."), reasoner)


def test_one_run_finds_the_first_inconsistent_ontology() -> None:
    good, bad = triples(CUTLERY), triples(CUTLERY + SPORK + ":x a :Spork .")
    assert first_inconsistent([good, good, bad, good]) == 2
    assert first_inconsistent([good, good]) is None
    assert first_inconsistent([]) is None


@BOTH
def test_runs_in_threads_are_independent_and_leave_no_files(
    reasoner: Reasoner, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    texts = [ntriples(CUTLERY), ntriples(":A a owl:Class . :B a owl:Class . :A rdfs:subClassOf :B . :a a :A .")]
    with ThreadPoolExecutor(2) as pool:
        first, second = pool.map(lambda text: classify(text, reasoner).inferred, texts)
    assert "Cutlery" in first and "Cutlery" not in second
    assert set(read_ntriples(second)) == {triple(":a a :B")}
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr() == ("", "")


@BOTH
def test_a_run_and_its_process_end_at_the_time_limit(
    reasoner: Reasoner, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with pytest.raises(LimitError, match=r"undecided: .* did not answer within 0\.05 s"):
        classify(ntriples(CUTLERY), reasoner, time_limit=0.05)
    assert list(tmp_path.iterdir()) == []
    running = subprocess.run(["ps", "-eo", "args"], capture_output=True, text=True, check=False).stdout
    assert str(tmp_path) not in running


@BOTH
def test_imports_are_not_followed(reasoner: Reasoner) -> None:
    text = ":o a owl:Ontology ; owl:imports <http://127.0.0.1:9/nothing-is-here> ." + CUTLERY
    assert classify(ntriples(text), reasoner).unsatisfiable == ()


def test_a_refused_ontology_is_reported_with_the_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    text = ':day a owl:DatatypeProperty . :f :day "2026-01-01"^^xsd:date .'
    with pytest.raises(ReasonerError, match=r"hermit refused the ontology: .*datatype"):
        classify(ntriples(text))
    assert list(tmp_path.iterdir()) == []


def test_annotations_do_not_reach_a_reasoner() -> None:
    text = CUTLERY + r':Fork rdfs:comment "a\n\"b\\\u0000c"@en ; rdfs:seeAlso "2026-01-01"^^xsd:date .'
    assert classify(ntriples(text)).unsatisfiable == ()


def test_invalid_settings_and_texts_are_refused() -> None:
    with pytest.raises(SettingError, match="one of hermit, pellet, got 'racer'"):
        classify("", "racer")
    with pytest.raises(SettingError, match="at least 0 seconds"):
        classify("", time_limit=-1)
    with pytest.raises(TriplesError, match="line 1"):
        classify("rubbish")


def test_missing_java_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(description_logic, "_java", lambda arguments: ["/nowhere/java"])
    with pytest.raises(ReasonerError, match="hermit cannot be run"):
        classify(ntriples(CUTLERY))
