"""The Python functions of the reasoning commands: the answers of the commands, and errors."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import deixis as deixis_command

import deixis
from deixis.errors import DeixisError
from deixis.reasoning.temporal.errors import TemporalConflictError

CONFLICT = "3\n0 1 ( < )\n1 2 ( < )\n2 0 ( < )\n.\n"
ONTOLOGY = """
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix : <http://example.org/#> .
:Fork a owl:Class ; rdfs:label "fork" ; rdfs:subClassOf :Cutlery . :Cutlery a owl:Class .
:Spork a owl:Class ; rdfs:subClassOf :Fork, :Spoon . :Spoon a owl:Class ; owl:disjointWith :Fork .
:f a :Fork .
"""
SHAPES = """
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <http://example.org/#> .
:ForkShape a sh:NodeShape ; sh:targetClass :Fork ; sh:property [ sh:path :length ; sh:minCount 1 ] .
"""


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with an ontology that has an impossible class, and shapes."""
    folder = tmp_path_factory.mktemp("reasoning")
    (folder / "kinds.ttl").write_text(ONTOLOGY)
    (folder / "shapes.ttl").write_text(SHAPES)
    return folder


def _printed(*command: object) -> dict[str, object]:
    return json.loads(deixis_command(*command, "--json")[1])  # type: ignore[no-any-return]


def test_solve_answers_as_the_command() -> None:
    file = "examples/closed_but_inconsistent.csp"
    found, printed = deixis.solve(file, calculus="allen").to_dict(), _printed("solve", file, "--calculus", "allen")
    for answer in (found, printed):
        del answer["networks"][0]["seconds"]  # type: ignore[index]
    assert found == printed


def test_solve_reads_a_text_with_several_networks() -> None:
    found = deixis.solve(text=f"1\n0 1 ( < )\n.\n{CONFLICT}", calculus="point", scenario=True)
    assert [solved.verdict for solved in found.networks] == ["consistent", "inconsistent"]
    assert found.verdict == "inconsistent"
    assert len(found.networks[1].conflict) == 3
    assert found.to_text().splitlines()[0].startswith("line 1: consistent; 2 things, 1 constraint in point")


def test_solve_leaves_the_reasons_out() -> None:
    (solved,) = deixis.solve(text=CONFLICT, calculus="point", reasons=False).networks
    assert solved.verdict == "inconsistent" and not solved.conflict


def test_solve_names_line_and_column_of_a_mistake() -> None:
    with pytest.raises(DeixisError, match=r"<text>:2:7: point has no relation 'x'"):
        deixis.solve(text="1\n0 1 ( x )\n.\n", calculus="point")


def test_reason_answers_as_the_command(files: Path) -> None:
    found = deixis.reason(files / "kinds.ttl", "rl")
    assert found.to_dict() == _printed("reason", files / "kinds.ttl", "--engine", "rl")
    assert not found.possible and found.unsatisfiable == ("http://example.org/#Spork",)
    assert found.to_text().startswith("no contradiction found, but no individual can belong to Spork (rl)")
    assert "fork" in found.to_dict()["justifications"][0]["axioms"][0]["words"]


def test_reason_takes_several_files_as_one(files: Path) -> None:
    found = deixis.reason([files / "kinds.ttl", files / "shapes.ttl"], "rl", reasons=False)
    assert found.unsatisfiable == ("http://example.org/#Spork",)
    assert not found.impossible


def test_validate_answers_as_the_command(files: Path) -> None:
    data, shapes = files / "kinds.ttl", files / "shapes.ttl"
    report = deixis.validate(data, shapes)
    assert report.to_dict() == _printed("validate", data, "--shapes", shapes)
    assert (report.conforms, len(report.results)) == (False, 1)
    assert report.to_text().endswith("1 result: does not conform")


def test_reason_and_validate_take_the_memory_of_a_session(tmp_path: Path) -> None:
    with deixis.Session(memory=tmp_path / "memory") as session:
        session.learn("examples/formal_dinner.layout", "examples/place_setting.scene.json")
        assert deixis.validate(session.memory()).conforms
        assert deixis.reason(session.memory(), "rl").possible


def test_chronology_answers_as_the_command() -> None:
    file = "examples/serving.fluents.json"
    assert deixis.chronology(file).to_dict() == _printed("time", file)
    assert deixis.chronology(text=Path(file).read_text()).summary() == "5 fluents: consistent"


def test_chronology_raises_the_contradiction() -> None:
    fluents = [{"id": name, "statement": ["a", "on", "b"]} for name in ("one", "two")]
    relations = [{"a": "one", "allen": ["before"], "b": "two"}, {"a": "two", "allen": ["before"], "b": "one"}]
    with pytest.raises(TemporalConflictError):
        deixis.chronology(text=json.dumps({"origin": "noon", "fluents": fluents, "relations": relations}))


def test_relate_answers_as_the_command() -> None:
    file = "examples/place_setting.scene.json"
    assert deixis.relate(file, "ra").to_dict() == _printed("relate", file)


@pytest.mark.parametrize("function", [lambda: deixis.solve(calculus="ra"), lambda: deixis.chronology("a", text="b")])
def test_a_file_or_a_text_must_be_given(function: object) -> None:
    with pytest.raises(TypeError, match=r"must be given a path or `text`, got (both|neither)"):
        function()  # type: ignore[operator]


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda: deixis.solve("examples", calculus="ra"), "examples: this is a folder, not a network file"),
        (lambda: deixis.solve(text=CONFLICT, calculus="point", closure=True, scenario=True), "must not both be True"),
        (lambda: deixis.solve(text=CONFLICT, calculus="point", time_limit=-1), "`time_limit` must be at least 0"),
        (lambda: deixis.reason([]), "`data` must name at least one file"),
        (lambda: deixis.validate("ontology/deixis.ttl", shapes=[]), "`shapes` must name at least one file"),
    ],
)
def test_bad_arguments_are_named(function: object, message: str) -> None:
    with pytest.raises(DeixisError, match=message):
        function()  # type: ignore[operator]
