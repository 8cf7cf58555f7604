"""``deixis relation`` and ``deixis learn-relation``: text, JSON, pictures, files, and what they refuse."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner, Result

from deixis.cli.descriptions.learn_relation import learn_relation
from deixis.cli.descriptions.relation import read_models, relation
from deixis.errors import DeixisError
from deixis.ontology.models.relation_triples import models_to_turtle
from deixis.ontology.tbox import default_ontology
from deixis.plots.relation import field
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models

APP = typer.Typer(pretty_exceptions_enable=False)
APP.command()(relation)
APP.command("learn-relation")(learn_relation)


@pytest.fixture(autouse=True)
def memory(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """The default memory: a folder that is not there yet."""
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path / "memory"))
    return tmp_path / "memory"


def run(*args: object) -> Result:
    return CliRunner().invoke(APP, [*map(str, args)])


def refused(*args: object) -> str:
    """Run a command that must raise a DeixisError and return its message."""
    error = run(*args).exception
    assert isinstance(error, DeixisError), error
    return str(error)


@pytest.fixture
def lesson(tmp_path: Path) -> list[str]:
    """A script of three things, and a scene that labels them."""
    script, scene = tmp_path / "t.layout", tmp_path / "t.scene.json"
    script.write_text("fork left of plate\nknife right of plate\n", encoding="utf-8")
    places = {"fork": (0, 2), "plate": (5, 32), "knife": (35, 37)}
    objects = [{"id": n, "min": [a, 0], "max": [b, 20], "label": n} for n, (a, b) in places.items()]
    scene.write_text(json.dumps({"unit": "cm", "objects": objects}), encoding="utf-8")
    return [str(script), str(scene)]


def test_a_word_is_shown_with_readings_inverse_and_graded_model() -> None:
    found = run("relation", "to the left of")
    assert found.exit_code == 0
    lines = found.stdout.splitlines()
    assert lines[0] == "left: left of"
    assert "inverse     right" in lines
    assert "wide        x < m; y any" in lines
    assert any(line.startswith("exact       x < m; y o fi di s = si d f oi") for line in lines)
    assert any("model 'horizontal', shipped, from prototypes" in line for line in lines)
    assert any(line.strip().startswith("deviation") and "0.785398: 0.7" in line for line in lines)


def test_json_has_the_parameters() -> None:
    found = json.loads(run("relation", "on", "--json").stdout)
    assert found["word"] == "on" and found["inverse"] == "under" and "on top of" in found["synonyms"]
    assert set(found["readings"]) == {"wide", "exact"} and found["readings"]["wide"]["z"]
    assert [term["feature"] for term in found["graded"]["terms"]] == ["across", "foot", "gap", "rise"]


@pytest.mark.parametrize("ending", ["png", "svg"])
def test_the_field_is_drawn(tmp_path: Path, ending: str) -> None:
    target = tmp_path / "new" / f"left.{ending}"
    found = run("relation", "left", "--plot", target)
    assert found.exit_code == 0 and f"Written: {target}" in found.stdout
    assert target.stat().st_size > 5000


def test_the_field_of_left_is_highest_just_to_the_left() -> None:
    places, degrees = field(default_ontology().relations["left"], shipped_models(), 13)
    row, column = divmod(int(degrees.argmax()), 13)
    assert places[row] == 0
    assert -1.1 < places[column] <= -0.5


def test_learned_models_are_written_read_and_shown(lesson: list[str], tmp_path: Path, memory: Path) -> None:
    out = tmp_path / "models.ttl"
    found = run("learn-relation", *lesson, "-o", out)
    assert found.exit_code == 0
    assert found.stdout.splitlines() == [
        "horizontal  learned from 2 facts",
        "saying      learned from 2 facts",
        f"Written: {out}",
    ]
    assert not memory.exists()
    models = read_models(out)
    assert models["horizontal"].provenance.examples == 2
    assert models["horizontal"].provenance.sources == (f"{lesson[0]} {lesson[1]}",)
    assert models["vertical"].provenance.examples == 0
    assert "learned from 2 facts of one scene" in run("relation", "left", "--models", out).stdout


def test_learning_says_as_json_what_it_learned(lesson: list[str], tmp_path: Path) -> None:
    found = json.loads(run("learn-relation", *lesson, "-o", tmp_path / "m.ttl", "--json").stdout)
    assert [model["model"] for model in found["learned"]] == ["horizontal", "saying"]


def test_what_relation_refuses(tmp_path: Path) -> None:
    assert "did you mean 'left'" in refused("relation", "lefft")
    assert "no relation word 'nosuch'; use one of bottom, bottom_left," in refused("relation", "nosuch")
    assert "must end in .png" in refused("relation", "left", "--plot", tmp_path / "a.txt")
    assert "there is no such file" in refused("relation", "left", "--models", tmp_path / "none.ttl")
    empty = tmp_path / "empty.ttl"
    empty.write_text("", encoding="utf-8")
    assert "no relation model in this file" in refused("relation", "left", "--models", empty)
    empty.write_text(models_to_turtle(shipped_models().models.values()).replace('"0.01"', '"x"'), encoding="utf-8")
    assert "must be numbers" in refused("relation", "left", "--models", empty)


def test_the_memory_keeps_learned_models_and_shows_those_in_use(lesson: list[str], memory: Path) -> None:
    found = run("learn-relation", *lesson)
    assert found.exit_code == 0, found.exception
    assert found.stdout.splitlines()[2:] == [
        "lessons     words_t-1",
        "kept as     words_t-1",
        f"{memory} now uses these models.",
    ]
    assert "learned from 2 facts of one scene" in run("relation", "left").stdout
    assert "shipped, from prototypes" in run("relation", "left", "--no-memory").stdout
    assert "shipped, from prototypes" in run("relation", "on").stdout
    again = json.loads(run("learn-relation", *lesson, "--json").stdout)
    assert again["left_out"] == [f"{lesson[0]} {lesson[1]}: remembered already, as words_t-1"]
    assert again["learned"][0]["examples"] == 2 and again["learned"][0]["learned_from"] == ["words_t-1"]
    assert "uses the shipped models again" in run("learn-relation", "--reset").stdout
    assert "shipped, from prototypes" in run("relation", "left").stdout
    assert "learned from 2 facts" in run("learn-relation").stdout


def test_models_in_a_file_use_the_memory_unless_it_is_excluded(lesson: list[str], tmp_path: Path) -> None:
    run("learn-relation", *lesson)
    other, out = tmp_path / "other.layout", tmp_path / "m.ttl"
    other.write_text("knife right of fork\n", encoding="utf-8")
    assert run("learn-relation", other, lesson[1], "-o", out).exit_code == 0
    where = read_models(out)["horizontal"].provenance
    assert (where.examples, where.sources, where.lessons) == (3, (f"{other} {lesson[1]}",), ("words_t-1",))
    assert run("learn-relation", other, lesson[1], "-o", out, "--no-memory").exit_code == 0
    assert read_models(out)["horizontal"].provenance.examples == 1


def test_what_learning_refuses(lesson: list[str], tmp_path: Path, memory: Path) -> None:
    out = tmp_path / "m.ttl"
    assert "come in pairs" in refused("learn-relation", lesson[0], "-o", out)
    assert "strength" in refused("learn-relation", *lesson, "-o", out, "--strength", "0")
    folder = tmp_path / "folder.ttl"
    folder.mkdir()
    assert "a folder" in refused("learn-relation", *lesson, "-o", folder)
    assert "must end in .ttl" in refused("learn-relation", *lesson, "-o", lesson[0])
    bare = tmp_path / "bare.scene.json"
    bare.write_text('{"objects": [{"id": "a", "min": [0, 0], "max": [1, 1]}]}', encoding="utf-8")
    assert "nothing to learn" in refused("learn-relation", lesson[0], bare, "-o", out)
    assert not out.exists()
    assert "nothing to learn" in refused("learn-relation", lesson[0], bare)
    assert "there are no lessons at" in refused("learn-relation")
    assert "--no-memory leaves no place" in refused("learn-relation", *lesson, "--no-memory")
    assert "--models needs -o" in refused("learn-relation", *lesson, "--models", out)
    assert "name scripts and labelled scenes" in refused("learn-relation", "--no-memory", "-o", out)
    assert "learn in a second command" in refused("learn-relation", *lesson, "--reset")
    assert "there is no memory at" in refused("learn-relation", "--reset")
    assert "there is no memory at" in refused("relation", "left", "--memory", tmp_path / "gone")
    assert not memory.exists()
