"""Validate answers against the published JSON Schemas."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from typing import Any

import pytest
from commands import deixis as deixis_command
from source_tree import ROOT

import deixis

jsonschema = pytest.importorskip("jsonschema")
referencing = pytest.importorskip("referencing")

SCHEMAS = {path.name.removesuffix(".schema.json"): path for path in sorted((ROOT / "docs" / "schema").glob("*.json"))}
EXAMPLES = ROOT / "examples"


def contents(name: str) -> dict[str, Any]:
    loaded: dict[str, Any] = json.loads(SCHEMAS[name].read_text(encoding="utf-8"))
    return loaded


def validator(name: str) -> Any:
    registry = referencing.Registry().with_resources(
        (contents(other)["$id"], referencing.Resource.from_contents(contents(other))) for other in SCHEMAS
    )
    return jsonschema.Draft202012Validator(contents(name), registry=registry)


def errors(name: str, answer: deixis.Scene | Any) -> list[str]:
    data = json.loads(answer.to_json())
    return [f"{error.json_path}: {error.message}" for error in validator(name).iter_errors(data)]


@pytest.fixture(scope="module")
def scene() -> deixis.Scene:
    return deixis.read_scene(EXAMPLES / "place_setting.scene.json")


@pytest.mark.parametrize("name", SCHEMAS)
def test_a_schema_is_valid_and_named_by_its_file(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(contents(name))
    assert contents(name)["$id"] == f"https://w3id.org/deixis/schema/{name}.schema.json"
    assert contents(name)["title"]


@pytest.mark.parametrize("script", ["formal_dinner", "script1", "script2", "contradiction"])
def test_scripts_and_what_follows_have_their_schema(script: str) -> None:
    read = deixis.read_script(EXAMPLES / f"{script}.layout")
    assert errors("script", read) == []
    assert errors("inference", deixis.infer(read)) == []
    assert errors("imagination", deixis.imagine(read)) == []


@pytest.mark.parametrize(
    "options",
    [{}, {"sizes": False}, {"engine": "similarity"}, {"viewpoint": "quarter"}, {"ask": {"napkin": "o2"}}],
    ids=["default", "words", "similarity", "viewpoint", "questions"],
)
def test_groundings_have_their_schema(scene: deixis.Scene, options: dict[str, Any]) -> None:
    assert errors("grounding", deixis.ground(EXAMPLES / "script1.layout", scene, **options)) == []


@pytest.mark.parametrize(("text", "oracle"), [("the lamp on the desk", None), ("the chair", None), ("the bin", "o14")])
def test_references_have_their_schema(text: str, oracle: str | None) -> None:
    assert errors("reference", deixis.refer(text, EXAMPLES / "study.scene.json", oracle=oracle)) == []


def test_facts_of_graded_words_have_their_schema() -> None:
    assert errors("script", deixis.read_script(text="cup near plate")) == []


def test_checks_and_retrievals_have_their_schema(scene: deixis.Scene) -> None:
    for table in ("second_table", "place_setting"):
        assert errors("check", deixis.check(EXAMPLES / "formal_dinner.layout", EXAMPLES / f"{table}.scene.json")) == []
    assert errors("retrieval", deixis.retrieve(scene, EXAMPLES)) == []


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.scene.json")), ids=lambda path: path.name)
def test_scenes_have_their_schema(file: Path) -> None:
    assert errors("scene", deixis.read_scene(file)) == []
    assert list(validator("scene").iter_errors(json.loads(file.read_text(encoding="utf-8")))) == []


def test_what_is_seen_and_learned_has_its_schema(tmp_path: Path) -> None:
    pytest.importorskip("open3d")
    from deixis.report.json_answers import learned_to_dict

    script = deixis.read_script(EXAMPLES / "formal_dinner.layout")
    seen = deixis.perceive(deixis.simulate(script, seed=7).cloud)
    assert errors("scene", seen) == []
    with deixis.Session(tmp_path / "memory") as session:
        learned = json.loads(json.dumps(learned_to_dict(session.learn(script, seen))))
        assert list(validator("learned").iter_errors(learned)) == []
        assert errors("recognised", session.recognise(seen)) == []
        for sparql in ("SELECT ?s ?o WHERE { ?s a ?o } LIMIT 5", "ASK { ?s ?p 1 }"):
            assert errors("query", session.query(sparql)) == []


def test_a_text_in_english_has_its_schema() -> None:
    from deixis.report.read import reading_to_dict

    text = "On the desk there are two cups, each on its saucer. The red pen was on the pad. A lamp is in a corner."
    read = reading_to_dict(deixis.read_script(text=text, english=True))
    assert list(validator("reading").iter_errors(json.loads(json.dumps(read)))) == []


@pytest.mark.parametrize("told", ["formal_dinner.layout", "second_table.scene.json"])
def test_what_is_told_has_its_schema(told: str) -> None:
    assert errors("telling", deixis.tell(EXAMPLES / told)) == []


@pytest.mark.parametrize(
    ("name", "command"),
    [
        ("formatted", "fmt {e}/script1.layout"),
        ("relate", "relate {e}/place_setting.scene.json --calculus ra"),
        ("relate", "relate {e}/place_setting.scene.json --of o1 --of o2"),
        ("relation", "relation left"),
        ("relation", "relation near"),
        ("simulation", "simulate {e}/script1.layout --seed 7"),
        ("solve", "solve {e}/place_setting.csp --calculus ra --scenario"),
        ("solve", "solve {e}/place_setting.csp --calculus ra --explain 2 4"),
        ("solve", "solve {e}/closed_but_inconsistent.csp --calculus allen"),
        ("time", "time {e}/serving.fluents.json"),
        ("time", "time {e}/serving.fluents.json --at 25"),
        ("time", "time {e}/serving.fluents.json --relate fetch served"),
        ("time", "time {e}/serving.fluents.json --explain fetch.start served.start"),
    ],
)
def test_commands_print_answers_of_their_schema(name: str, command: str) -> None:
    _, out, err = deixis_command(*shlex.split(command.format(e=EXAMPLES)), "--json")
    assert out, err
    assert [error.message for error in validator(name).iter_errors(json.loads(out))] == []


def test_conflicts_in_time_have_their_schema(tmp_path: Path) -> None:
    fluent = {"id": "a", "statement": ["cup", "full"], "start": [0, 1], "finish": [5, 6]}
    file = tmp_path / "wrong.fluents.json"
    too_short = {"from": "a.start", "to": "a.finish", "bounds": [1, 2]}
    content = {"origin": "noon", "fluents": [fluent], "relations": [too_short]}
    file.write_text(json.dumps(content), encoding="utf-8")
    code, out, _ = deixis_command("time", file, "--json")
    assert code == 1
    assert [error.message for error in validator("time").iter_errors(json.loads(out))] == []


def test_what_an_ontology_entails_has_its_schema(tmp_path: Path) -> None:
    prefixes = "@prefix : <http://e/> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> ."
    file = tmp_path / "kinds.ttl"
    file.write_text(f"{prefixes} :F rdfs:subClassOf :C . :f a :F .", encoding="utf-8")
    for options in ([], ["--explain", ":f a :C"], ["--explain", ":f a :C", "--all"]):
        _, out, err = deixis_command("reason", file, "--engine", "rl", *options, "--json")
        assert out, err
        assert [error.message for error in validator("reason").iter_errors(json.loads(out))] == []


def test_an_answer_with_another_key_is_refused() -> None:
    data = deixis.read_script(text="fork left of plate").to_dict() | {"colour": "red"}
    assert list(validator("script").iter_errors(data))
