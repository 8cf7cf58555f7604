"""The commands ``deixis episodes …``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from commands import deixis


@pytest.fixture
def memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of a memory with two statements on its blackboard."""
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path / "m"))
    assert deixis("episodes", "add", "t1", "on", "table", "--start", "1")[0] == 0
    assert deixis("episodes", "add", "t1", "isA", "fork", "--start", "2", "--by", "anna", "--origin", "shown")[0] == 0
    return tmp_path


def test_statements_are_finished_updated_and_deleted(memory: Path) -> None:
    assert deixis("episodes", "finish", "f1", "--at", "5")[1] == "Finished 1 fluent.\n"
    updated = deixis("episodes", "update", "--pattern", "*", "isA", "*", "--certainty", "0.5")
    assert updated[1] == "Updated 1 fluent.\n"
    assert deixis("episodes", "list", "--window", "3", "4")[1].splitlines() == [
        "f1: on(t1, table) from [1, 1] to [5, 5], certainty 1, said by user",
        "f2: isA(t1, fork) from [2, 2] to (-∞, ∞), certainty 0.5, shown by anna",
    ]
    assert len(deixis("episodes", "list", "--now")[1].splitlines()) == 1
    assert deixis("episodes", "delete", "--window", "0", "9")[1] == "Deleted 2 fluents.\n"
    assert deixis("episodes", "list")[1] == "Nothing is known to hold.\n"
    assert len(deixis("episodes", "changes", "--since", "2")[1].splitlines()) == 4
    assert len(deixis("episodes", "changes", "--since", "-5")[1].splitlines()) == 6
    assert deixis("memory", "verify")[1].splitlines()[0] == "All episodes are undamaged."


def test_exported_file_is_read_by_time_and_imported_again(memory: Path) -> None:
    file = memory / "x.fluents.json"
    assert deixis("episodes", "export", "-o", str(file))[0] == 0
    assert "on(t1, table)" in deixis("time", str(file))[1]
    other = str(memory / "other")
    code, out, _ = deixis("episodes", "import", str(file), "--name", "lunch", "--memory", other)
    assert (code, out) == (0, "Added 2 fluents.\n")
    assert len(deixis("episodes", "list", "--experience", "lunch", "--memory", other)[1].splitlines()) == 2


def test_contradiction_in_space_is_the_answer_no(memory: Path) -> None:
    assert deixis("episodes", "check", "--no-ontology")[0] == 0
    for pair in (("t1", "left", "t2"), ("t2", "left", "t1")):
        deixis("episodes", "add", *pair, "--start", "3")
    code, out, _ = deixis("episodes", "check", "--no-ontology")
    assert code == 1
    assert "cannot be both left of and right of" in out


def test_experience_is_recorded_and_shown_by_its_memory(memory: Path) -> None:
    deixis("episodes", "record", "lunch", "--at", "0")
    deixis("episodes", "record", "lunch", "--stop", "--at", "9")
    assert deixis("episodes", "memory", "episodic")[1] == "lunch: from 0 to 9 s\n"
    assert deixis("episodes", "memory", "procedural")[1] == "The procedural memory is empty.\n"
    assert deixis("episodes", "classes", "--used")[1] == "Fork < Cutlery, Tableware, Thing: t1\n"


def test_answers_are_printed_as_json(memory: Path) -> None:
    def answer(*words: str) -> Any:
        return json.loads(deixis("episodes", *words, "--json")[1])

    assert answer("add", "t2", "left", "t1", "--start", "3")["statement"] == ["t2", "left", "t1"]
    assert answer("update", "f1", "--certainty", "0.5") == {"fluents": 1, "sequence": 4}
    log = answer("changes", "--since", "3")["changes"]
    assert [(change["kind"], change["before"]["certainty"], change["after"]["certainty"]) for change in log] == [
        ("update", 1.0, 0.5)
    ]
    assert answer("record", "lunch", "--at", "0")["finish"] is None
    assert answer("record", "lunch", "--stop", "--at", "9")["finish"] == 9.0
    assert [each["name"] for each in answer("memory", "episodic")["experiences"]] == ["lunch"]
    assert answer("classes", "--used")["classes"][0]["individuals"] == ["t1"]
    assert answer("consolidate")["lessons"] == {}


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (("classes", "Frok"), "there is no class 'Frok'; did you mean 'Fork'?"),
        (("add", "t1"), "at most one object, got 1 word"),
        (("add", "t1", "at", "--start", "1"), "box of a thing"),
        (("add", "t1", "on", "t2", "--start", "5", "--finish", "4"), "must start before it finishes"),
        (("finish",), "by their ids, or else by --pattern"),
        (("delete", "f9"), "no fluent 'f9'"),
        (("record", "lunch", "--stop"), "no experience 'lunch'"),
        (("record", " "), "the name of an experience must be printable text that is not blank"),
        (("update", "f1"), "there is no new value; give --certainty, --start or --finish"),
        (("add", "t1", "on", "t2", "--start", "1e300"), "a time of 1e+300 s from the origin is beyond 4e+09 s"),
        (("add", "t1", "on", "t2", "--start", "inf"), "a finite number of seconds, got infinity"),
    ],
)
def test_bad_input_is_explained(memory: Path, command: tuple[str, ...], message: str) -> None:
    code, _, error = deixis("episodes", *command)
    assert code == 2
    assert message in error


def test_memories_without_episodes_are_asked_by_name(tmp_path: Path) -> None:
    layout, scene = "examples/formal_dinner.layout", "examples/place_setting.scene.json"
    assert deixis("learn", layout, scene, "--memory", tmp_path)[0] == 0
    assert deixis("episodes", "memory", "semantic", "--memory", tmp_path)[1] == "layout formal_dinner\n"
    assert deixis("episodes", "memory", "working", "--memory", tmp_path)[1] == "The working memory is empty.\n"
