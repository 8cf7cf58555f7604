"""The command deixis habits and its answer."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import deixis as run

import deixis

ROOT = Path(__file__).parents[4]
FILE = "sneakers: rack\nrain boots: rack\nwool sweater: chair\ngym shorts: chair\nevery book: desk\n"


def test_the_command_prints_rules_and_places(tmp_path: Path) -> None:
    file = tmp_path / "room.habits"
    file.write_text(FILE, encoding="utf-8")
    code, out, err = run("habits", file, "loafers", "novel", "qwrtz")
    assert (code, err) == (0, "")
    assert "shoes:" in out and "loafers: rack, prob" in out and "novel: desk, prob" in out
    assert "the lexicon does not know it" in out


def test_the_json_satisfies_its_schema(tmp_path: Path) -> None:
    jsonschema = pytest.importorskip("jsonschema")
    file = tmp_path / "room.habits"
    file.write_text(FILE, encoding="utf-8")
    code, out, _ = run("habits", file, "loafers", "--json")
    schema = json.loads((ROOT / "docs" / "schema" / "habits.schema.json").read_text(encoding="utf-8"))
    jsonschema.validate(json.loads(out), schema)
    assert code == 0 and json.loads(out)["things"][0]["place"] == "rack"


def test_a_wrong_file_is_refused_with_its_place(tmp_path: Path) -> None:
    file = tmp_path / "room.habits"
    file.write_text("sneakers\n", encoding="utf-8")
    code, _, err = run("habits", file)
    assert code == 2 and f"{file}:1:1: expected" in err
    assert run("habits", tmp_path / "none.habits")[0] == 2


def test_the_answer_is_text_data_and_rows() -> None:
    found = deixis.habits({"sneakers": "rack", "shorts": "chair"}, ["boots"], rules={"books": "desk"})
    assert "books: " in found.to_text() and found.to_dict()["rules"][0]["concept"]
    assert "rule" in str(found)
