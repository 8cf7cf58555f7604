"""deixis reason: files and memories, engines, justifications, explanations, and what goes wrong."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import rdflib
from commands import deixis
from ontologies import CORE, PREFIXES

from deixis.examples_data import example
from deixis.session import Session

pytestmark = pytest.mark.slow

TABLE = ':Spork a owl:Class ; rdfs:label "spork"@en . :f a dx:Fork ; dx:left :p . :p dx:left :k .'
IMPOSSIBLE = ":Spork rdfs:subClassOf dx:Fork, dx:Spoon ."
ENGINES = pytest.mark.parametrize("engine", ["auto", "rl", "hermit", "pellet"])


@pytest.fixture
def table(tmp_path: Path) -> Path:
    file = tmp_path / "table.ttl"
    file.write_text(PREFIXES + TABLE, encoding="utf-8")
    return file


@pytest.fixture
def spork(tmp_path: Path) -> Path:
    file = tmp_path / "spork.ttl"
    file.write_text(PREFIXES + IMPOSSIBLE, encoding="utf-8")
    return file


@ENGINES
def test_what_follows_is_printed_by_every_engine(table: Path, engine: str) -> None:
    code, out, err = deixis("reason", table, CORE, "--engine", engine, "--triples")
    assert (code, err) == (0, "")
    assert ("consistent" if engine in ("hermit", "pellet") else "no contradiction found") in out.splitlines()[0]
    assert "<urn:t#f> dx:left <urn:t#k>" in out.splitlines()
    assert "<urn:t#f> rdf:type dx:Tableware" in out.splitlines()
    assert "_:" not in out


@pytest.mark.parametrize("engine", ["auto", "rl"])
def test_an_impossible_class_is_named_with_its_reasons(table: Path, spork: Path, engine: str) -> None:
    code, out, _ = deixis("reason", table, spork, CORE, "--engine", engine)
    assert code == 1
    assert "no individual can belong to spork" in out.splitlines()[0]
    assert out.splitlines()[1:4] == [
        "nothing can be a spork, because",
        "  every spork is a fork",
        "  every spork is a spoon",
    ]
    assert "nothing is more than one of fork" in out.splitlines()[4]


def test_an_inconsistency_is_justified_in_text_turtle_and_json(table: Path, spork: Path) -> None:
    spork.write_text(PREFIXES + IMPOSSIBLE + ":x a :Spork .", encoding="utf-8")
    code, out, _ = deixis("reason", table, spork, CORE)
    assert code == 1
    assert out.startswith("inconsistent (auto)") and "  x is a spork" in out.splitlines()
    code, out, _ = deixis("reason", table, spork, CORE, "--turtle")
    assert code == 1
    graph = rdflib.Graph().parse(data=out, format="turtle")
    assert (None, rdflib.OWL.members, None) in graph
    assert (rdflib.URIRef("urn:t#x"), rdflib.RDF.type, rdflib.URIRef("urn:t#Spork")) in graph
    code, out, _ = deixis("reason", table, spork, CORE, "--json")
    found = json.loads(out)
    assert code == 1 and found["consistent"] is False and len(found["justifications"][0]["axioms"]) == 4


def test_the_verdict_alone_is_printed_on_request(table: Path, spork: Path) -> None:
    assert deixis("reason", table, CORE, "--verdict")[0] == 0
    code, out, _ = deixis("reason", table, spork, CORE, "--verdict")
    assert code == 1 and len(out.splitlines()) == 1
    code, _, err = deixis("reason", table, "--verdict", "--all")
    assert code == 2 and "--verdict excludes" in err


def test_all_justifications_of_a_statement_are_printed(tmp_path: Path) -> None:
    chains = tmp_path / "chains.ttl"
    said = ":r a owl:ObjectProperty, owl:TransitiveProperty . :f :r :p, :m . :p :r :k . :m :r :k ."
    chains.write_text(PREFIXES + said, encoding="utf-8")
    code, out, _ = deixis("reason", chains, "--explain", ":f :r :k", "--all", "--time-limit", "120")
    assert code == 0
    assert out.count("r(f, k), because") == 2
    assert "  r(f, p)" in out.splitlines() and "  r(f, m)" in out.splitlines()
    code, out, _ = deixis("reason", chains, "--explain", ":f :r :k", "--all", "--json", "--time-limit", "120")
    found = json.loads(out)
    assert code == 0 and found["complete"]
    assert [len(one["axioms"]) for one in found["justifications"]] == [3, 3]


def test_a_statement_is_explained_by_axioms_and_steps(table: Path) -> None:
    code, out, _ = deixis("reason", table, CORE, "--explain", ":f dx:left :k")
    assert code == 0
    assert out.splitlines() == [
        "left(f, k), because", "  left(f, p)", "  left(p, k)", "  'left' is transitive",
        "by these steps:", "  left(f, k)  [prp-trp]",
    ]  # fmt: skip
    code, out, _ = deixis("reason", table, CORE, "--explain", ":f a dx:Tableware", "--json")
    found = json.loads(out)
    assert code == 0 and len(found["axioms"]) == 3 and found["steps"][-1]["rule"] == "cax-sco"


def test_a_statement_that_does_not_follow_exits_with_1(table: Path) -> None:
    code, out, err = deixis("reason", table, CORE, "--explain", ":k dx:left :f")
    assert (code, out) == (1, "") and "does not follow" in err


def test_everything_remembered_is_reasoned_over(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        session.learn(example("formal_dinner.layout"), example("place_setting.scene.json"))
    code, out, err = deixis("reason", "--memory", tmp_path / "memory")
    assert (code, err) == (0, "")
    assert out.startswith("no contradiction found") and "dx:left" in out


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["missing.ttl"], "no such file"),
        (["TABLE", "--explain", "nonsense"], "is not one statement"),
        (["TABLE", "--explain", "xx:a rdf:type xx:b"], "the prefix xx: is not declared"),
        (["TABLE", "--explain", ":a a :B ; a :C"], "is not one statement"),
        (["TABLE", "--explain", ":a owl:inverseOf :b"], "cannot be explained"),
        (["--memory", "nowhere"], "memory"),
    ],
)
def test_bad_input_is_reported_and_exits_2(arguments: list[str], told: str, table: Path, tmp_path: Path) -> None:
    given = [str(table) if a == "TABLE" else str(tmp_path / a) if a == "nowhere" else a for a in arguments]
    code, out, err = deixis("reason", *given)
    assert (code, out) == (2, "")
    assert told in err and "Traceback" not in err


def test_a_dtd_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "bomb.owl"
    file.write_text('<!DOCTYPE r [<!ENTITY a "b">]><rdf:RDF/>', encoding="utf-8")
    code, _, err = deixis("reason", file)
    assert code == 2 and "DTD" in err


def test_a_time_limit_that_strikes_is_undecided(table: Path) -> None:
    code, out, err = deixis("reason", table, CORE, "--engine", "hermit", "--time-limit", "0.05")
    assert (code, out) == (3, "")
    assert "undecided" in err
