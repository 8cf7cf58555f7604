"""Validate answers against the published JSON Schemas."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import deixis as deixis_command
from documentation.command_reference import commands, options
from schemas import SCHEMAS, contents, errors_in
from source_tree import ROOT

import deixis
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.ontology.models.sizes import SizeModel
from deixis.ontology.rdf.vocabulary import BASE
from deixis.reasoning.temporal.bounds import Bounds

jsonschema = pytest.importorskip("jsonschema")

EXAMPLES = ROOT / "examples"
PAGE = ROOT / "docs" / "reference" / "json.md"
RUN_ELSEWHERE = {"experiment figure6", "experiment scoreboard", "experiment open-ended", "experiment apprentice"}
"""Commands whose answers the tests of the experiments validate, since running them takes long."""

LINES = {"reference_line", "situation"}
"""Schemas of the lines of commands that print several answers."""

CASES = [
    ("categories", "category list"),
    ("check", "check {e}/formal_dinner.layout {e}/second_table.scene.json"),
    ("check", "check formal_dinner {t}/table.scene.json"),
    ("formatted", "fmt {e}/script1.layout"),
    ("grounding", "ground {e}/script1.layout {e}/place_setting.scene.json --no-sizes"),
    ("habits", "habits {t}/room.habits sandals 'wooden block'"),
    ("imagination", "imagine {e}/script2.layout"),
    ("inference", "infer {e}/script1.layout"),
    ("inference", "infer {e}/contradiction.layout"),
    ("inference", "infer {e}/script1.layout --verdict"),
    ("explanation", "infer {t}/tea.layout --explain 'left(fork, knife)'"),
    ("explanation", "infer {t}/tea.layout --explain 'above(fork, knife)'"),
    ("why_not", "infer {t}/tea.layout --why-not 'left(fork, knife)'"),
    ("why_not", "infer {t}/tea.layout --why-not 'right(fork, knife)'"),
    ("why_not", "infer {t}/tea.layout --why-not 'above(fork, knife)'"),
    ("learned", "learn {e}/formal_dinner.layout {e}/place_setting.scene.json --memory {t}/new"),
    (
        "learned",
        "learn {e}/script1.layout {t}/table.scene.json {e}/script2.layout {t}/table.scene.json --memory {t}/new",
    ),
    ("learned_relations", "learn-relation -o {t}/models.ttl"),
    ("learned_relations", "learn-relation --reset --memory {t}/other"),
    ("learned_relations", "learn-relation --descriptions {t}/said.jsonl -o {t}/weights.json"),
    ("lint", "lint {e}/contradiction.layout"),
    ("category_changed", "category rename dinner_plate charger --memory {t}/changed"),
    ("category_changed", "category merge salad_fork dinner_fork --memory {t}/changed"),
    ("category_changed", "category forget dinner_fork --memory {t}/changed"),
    ("memory_imported", "memory import {t}/changed.trig --memory {t}/imported"),
    ("memory_imported", "memory import {t}/changed.zip --memory {t}/imported"),
    ("memory_imported", "memory import {t}/watched.episodes.json --memory {t}/imported"),
    ("memory_forgotten", "memory forget formal_dinner-1 --memory {t}/changed"),
    ("learned_activity", "activity learn again {t}/all.fluents.json --known {t}/again.json"),
    ("memory_stats", "memory stats"),
    ("memory_stats", "memory stats --memory {t}/other"),
    ("memory_verified", "memory verify"),
    ("shown", "point {e}/showing.skeleton.jsonl {e}/showing.scene.json --said {e}/showing.said.jsonl"),
    ("query", "query 'SELECT ?s ?o WHERE {{ ?s a ?o }} LIMIT 5'"),
    ("query", "query 'ASK {{ ?s ?p 1 }}'"),
    ("query", "query 'DESCRIBE dx:left'"),
    ("reading", "read {t}/desk.txt"),
    ("reason", "reason {t}/kinds.ttl --engine rl"),
    ("reason", "reason {t}/kinds.ttl --engine rl --explain ':f a :C'"),
    ("reason", "reason {t}/kinds.ttl --engine rl --explain ':f a :C' --all"),
    ("recognised", "recognise {t}/table.scene.json"),
    ("reference", "refer 'the chair' {e}/study.scene.json"),
    ("reference", "refer 'the bin' {e}/study.scene.json --oracle o14"),
    ("telling", "tell {e}/formal_dinner.layout"),
    ("telling", "tell {e}/second_table.scene.json"),
    ("relate", "relate {e}/place_setting.scene.json --calculus ra"),
    ("relate", "relate {e}/place_setting.scene.json --of o1 --of o2"),
    ("relation", "relation left"),
    ("relation", "relation near"),
    ("retrieval", "retrieve {e}/place_setting.scene.json"),
    ("scene", "perceive {t}/table.pcd"),
    ("script", "parse {e}/formal_dinner.layout"),
    ("layout", "show formal_dinner"),
    ("simulation", "simulate {e}/script1.layout --seed 7"),
    ("solve", "solve {e}/place_setting.csp --calculus ra --scenario"),
    ("solve", "solve {e}/place_setting.csp --calculus ra --explain 2 4"),
    ("solve", "solve {e}/closed_but_inconsistent.csp --calculus allen"),
    ("taught", "teach {t}/table.scene.json o1 napkin"),
    ("activity_grounding", "activity ground 'first the cup, then the plate' --memory {t}/watched"),
    ("predicted_activity", "activity predict --told 'first the plate, then the cup' --memory {t}/watched"),
    ("predicted_activity", "activity predict {t}/laid.fluents.json --known {t}/laid.json"),
    ("recognised_activity", "activity recognise --known {t}/known.json --memory {t}/watched"),
    ("recall", "recall 'what is on the table?' --memory {t}/watched"),
    ("recall", "recall 'where was the spoon before?' --memory {t}/watched"),
    ("asked", "ask napkin {t}/table.scene.json"),
    ("asked", "ask coaster {t}/table.scene.json --points-at o1 --memory {t}/asked"),
    ("fluent", "episodes add t2 left t1 --start 1 --memory {t}/told"),
    ("episodes_changed", "episodes import {t}/laid.fluents.json --memory {t}/told"),
    ("episodes_changed", "episodes update f1 --certainty 0.9 --memory {t}/told"),
    ("episodes_changed", "episodes finish f2 --at 3 --memory {t}/told"),
    ("episodes_changed", "episodes delete f3 --memory {t}/told"),
    ("episodes_log", "episodes changes --memory {t}/watched"),
    ("experience", "episodes record 'first table' --at 0 --memory {t}/told"),
    ("experience", "episodes record 'second table' --stop --at 9 --memory {t}/told"),
    ("episodes_classes", "episodes classes --used --memory {t}/watched"),
    ("memory_content", "episodes memory working --memory {t}/watched"),
    ("memory_content", "episodes memory episodic --memory {t}/told"),
    ("memory_content", "episodes memory semantic --memory {t}/watched"),
    ("memory_content", "episodes memory perceptual --memory {t}/watched"),
    ("memory_content", "episodes memory procedural --memory {t}/watched"),
    ("consolidated", "episodes consolidate --memory {t}/told"),
    ("episodes", "episodes list --memory {t}/watched"),
    ("episodes_checked", "episodes check --no-ontology --memory {t}/watched"),
    ("unlearned", "unlearn --table {t}/table.scene.json --dry-run"),
    ("time", "time {e}/serving.fluents.json"),
    ("time", "time {e}/serving.fluents.json --at 25"),
    ("time", "time {e}/serving.fluents.json --relate fetch served"),
    ("time", "time {e}/serving.fluents.json --explain fetch.start served.start"),
    ("time", "time {t}/wrong.fluents.json"),
    ("robot", "robot run --layout {t}/pair.layout --seed 2 --rate 0.5 --memory {t}/robot"),
    ("tracking", "track simulator --things 1 --actions 0"),
    ("validation", "validate"),
    ("validation", "validate {t}/wrong.ttl"),
]
"""Schema and command line of each validated answer; ``{e}`` is the folder of examples, ``{t}`` that of `home`."""


OF_INPUT = {"skeleton", "utterance"}
"""Schemas of lines of files that Deixis reads."""

OF_PYTHON = {"look", "meaning", "told"}
"""Schemas of answers that no command prints."""


def errors(name: str, answer: Any) -> list[str]:
    return errors_in(name, json.loads(answer.to_json()))


@pytest.fixture(scope="module")
def scene() -> deixis.Scene:
    return deixis.read_scene(EXAMPLES / "place_setting.scene.json")


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a cloud, the scene perceived in it, a memory that learned from it, and small files."""
    pytest.importorskip("open3d")
    folder = tmp_path_factory.mktemp("home")
    script = EXAMPLES / "formal_dinner.layout"
    deixis_command("simulate", script, "--seed", 7, "-o", folder / "table.pcd")
    deixis_command("perceive", folder / "table.pcd", "-o", folder / "table.scene.json")
    deixis_command("learn", script, folder / "table.scene.json", "--memory", folder / "memory")
    deixis_command("learn", script, EXAMPLES / "place_setting.scene.json", "--memory", folder / "other")
    changed = ("--memory", shutil.copytree(folder / "memory", folder / "changed"))
    deixis_command("memory", "export", "-o", folder / "changed.trig", *changed)
    deixis_command("memory", "export", "--format", "views", "-o", folder / "changed.zip", *changed)
    served = EXAMPLES / "serving.fluents.json"
    deixis_command("activity", "learn", "serving", served, "--known", folder / "known.json")
    place = {"id": "a", "statement": ["cup", "at", "[0, 0, 0.1, 0.1]"], "start": [0, 1]}
    later = {"id": "b", "statement": ["plate", "at", "[0.2, 0, 0.4, 0.2]"], "start": [2, 3]}
    for name, fluents in (("laid", [place]), ("all", [place, later])):
        text = json.dumps({"origin": "noon", "fluents": fluents})
        (folder / f"{name}.fluents.json").write_text(text, encoding="utf-8")
    deixis_command("activity", "learn", "laid", folder / "all.fluents.json", "--known", folder / "laid.json")
    with Blackboard.open(folder / "watched", create=True) as board:
        seen = Source(Origin.SEEN, "tracker")
        board.add(episodic("f1", ("t1", "isA", "cup"), start=0.0, source=seen), by="tracker")
        board.add(episodic("f2", ("t1", "on", "table"), start=Bounds(-1.0, 0.0), source=seen), by="tracker")
    deixis_command(
        "memory",
        "export",
        "--format",
        "episodes",
        "-o",
        folder / "watched.episodes.json",
        "--memory",
        folder / "watched",
    )
    for thing in ("t1", "t2", "t3"):
        deixis_command("episodes", "add", thing, "on", "table", "--start", 1, "--memory", folder / "told")
    deixis_command("episodes", "record", "second table", "--at", 0, "--memory", folder / "told")
    prefixes = "@prefix : <http://e/> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> ."
    fluent = {"id": "a", "statement": ["cup", "full"], "start": [0, 1], "finish": [5, 6]}
    too_short = {"from": "a.start", "to": "a.finish", "bounds": [1, 2]}
    files = {
        "said.jsonl": json.dumps({"text": "the bin", "scene": str(EXAMPLES / "study.scene.json"), "target": "o14"}),
        "tea.layout": "layout tea\nfork left of plate\nplate left of knife\n",
        "pair.layout": "layout pair\nfork left of plate\n",
        "desk.txt": "On the desk are two cups, each on its saucer. The red pen was on the pad. A lamp is in a corner.",
        "room.habits": "sneakers: rack\nboots: rack\nsweater: chair\nshorts: chair\n",
        "wrong.fluents.json": json.dumps({"origin": "noon", "fluents": [fluent], "relations": [too_short]}),
        "kinds.ttl": f"{prefixes} :F rdfs:subClassOf :C . :f a :F .",
        "wrong.ttl": f"{prefixes} @prefix dx: <https://w3id.org/deixis#> . :x a dx:Role .",
    }
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


@pytest.mark.parametrize("name", SCHEMAS)
def test_a_schema_is_valid_and_named_by_its_file(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(contents(name))
    assert contents(name)["$id"] == f"https://w3id.org/deixis/schema/{name}.schema.json"
    assert contents(name)["title"]


@pytest.mark.parametrize(("name", "command"), CASES, ids=[f"{name}{at}" for at, (name, _) in enumerate(CASES)])
def test_commands_print_answers_of_their_schema(
    name: str, command: str, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(home / "memory"))
    code, out, err = deixis_command(*shlex.split(command.format(e=EXAMPLES, t=home)), "--json")
    assert out and code != 2, err
    assert errors_in(name, json.loads(out)) == []


def _listed() -> dict[str, set[str]]:
    """Return the schemas of each command, as the table on the page of JSON answers has them."""
    section = PAGE.read_text(encoding="utf-8").partition("## Schemas\n")[2].partition("\n## ")[0]
    rows = re.findall(r"^\| `([a-z0-9 -]+)` +\| (.*?) +\|$", section, flags=re.MULTILINE)
    return {command: set(re.findall(r"`(\w+)`", schemas)) - LINES for command, schemas in rows}


def test_every_command_with_json_has_a_schema_on_the_page() -> None:
    known = {
        context.command_path.removeprefix("deixis ")
        for command, context in commands()
        if "--json" in options(command, context)
    }
    assert known and _listed().keys() == known
    assert (
        set().union(*_listed().values()) | {"fact", "claim", "claim_outcome", *LINES, *OF_INPUT, *OF_PYTHON}
        == SCHEMAS.keys()
    )


def test_answers_of_every_command_are_validated() -> None:
    ran = {
        command: {name for name, line in CASES if line == command or line.startswith(f"{command} ")}
        for command in _listed()
    }
    expected = {command: set() if command in RUN_ELSEWHERE else schemas for command, schemas in _listed().items()}
    assert ran == expected


def test_lines_of_a_batch_have_their_schema(tmp_path: Path) -> None:
    study = str(EXAMPLES / "study.scene.json")
    lines = [{"text": "the bin", "scene": study}, {"text": "the bin", "scene": "none"}, {}]
    file = tmp_path / "texts.jsonl"
    file.write_text("\n".join(map(json.dumps, lines)), encoding="utf-8")
    code, out, _ = deixis_command("refer", "--batch", file)
    answers = [json.loads(line) for line in out.splitlines()]
    assert (code, ["error" in answer for answer in answers]) == (0, [False, True, True])
    assert [errors_in("reference_line", answer) for answer in answers] == [[], [], []]


@pytest.mark.parametrize("script", ["formal_dinner", "script1", "script2", "contradiction"])
def test_scripts_and_what_follows_have_their_schema(script: str) -> None:
    read = deixis.read_script(EXAMPLES / f"{script}.layout")
    assert errors("script", read) == []
    assert errors("inference", deixis.infer(read)) == []
    assert errors("imagination", deixis.imagine(read)) == []


@pytest.mark.parametrize(
    "options",
    [{}, {"engine": "similarity"}, {"viewpoint": "quarter"}, {"ask": {"napkin": "o2"}}],
    ids=["default", "similarity", "viewpoint", "questions"],
)
def test_groundings_have_their_schema(scene: deixis.Scene, options: dict[str, Any]) -> None:
    assert errors("grounding", deixis.ground(EXAMPLES / "script1.layout", scene, **options)) == []


@pytest.mark.parametrize(("text", "oracle"), [("the lamp on the desk", None), ("the chair", None), ("the bin", "o14")])
def test_references_have_their_schema(text: str, oracle: str | None) -> None:
    assert errors("reference", deixis.refer(text, EXAMPLES / "study.scene.json", oracle=oracle)) == []


def test_answers_of_a_robot_have_their_schema(tmp_path: Path) -> None:
    low = np.array([[0, 0, 0], [0.1, 0, 0], [0.5, 0, 0]])
    table = deixis.Scene.from_boxes(low, low + np.array([[0.03, 0.2, 0.01], [0.03, 0.2, 0.01], [0.25, 0.25, 0.02]]))
    with deixis.Robot(tmp_path / "memory") as robot:
        robot.sees(table, at=0.0)
        known = robot.told(deixis.read_script(text="layout row; fork left of knife; knife left of plate"), at=1.0)
        waiting = robot.told(deixis.read_script(text="layout pair; fork left of plate; knife left of plate"), at=1.0)
        assert known.taught and waiting.waiting
        assert errors("told", known) == errors("told", waiting) == []
        assert errors("look", robot.look()) == []
        robot.sees(replace(table, objects=table.objects[1:]), at=2.0)
        assert robot.look().faults()
        assert errors("look", robot.look()) == []


def test_learned_words_and_sizes_have_their_schema(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        session.learn(EXAMPLES / "formal_dinner.layout", EXAMPLES / "place_setting.labelled.scene.json")
        session.learn_relations()
        sizes = {f"{BASE}Fork": SizeModel((-1.7, 0.1), (-2.0, 0.2), views=3.0)}
        meaning = replace(session.meaning(), sizes=sizes)
    assert repr(meaning) == "<Meaning graded words with 5 learned models, learned sizes of 1 kind>"
    assert meaning.to_text().splitlines()[-1] == "dx:Fork          length 0.183 m, aspect 0.14"
    assert errors("meaning", meaning) == []
    assert len(meaning.to_text().splitlines()) == 1 + len(meaning.models_in_force.models) + len(meaning.sizes)


def test_facts_of_graded_words_have_their_schema() -> None:
    assert errors("script", deixis.read_script(text="cup near plate")) == []


def test_checks_and_retrievals_have_their_schema(scene: deixis.Scene) -> None:
    for table in ("second_table", "place_setting"):
        assert errors("check", deixis.check(EXAMPLES / "formal_dinner.layout", EXAMPLES / f"{table}.scene.json")) == []
    assert errors("retrieval", deixis.retrieve(scene, EXAMPLES)) == []


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.scene.json")), ids=lambda path: path.name)
def test_scenes_have_their_schema(file: Path) -> None:
    assert errors("scene", deixis.read_scene(file)) == []
    assert errors_in("scene", json.loads(file.read_text(encoding="utf-8"))) == []


def test_an_answer_with_another_key_is_refused() -> None:
    data = deixis.read_script(text="fork left of plate").to_dict() | {"colour": "red"}
    assert errors_in("script", data)
