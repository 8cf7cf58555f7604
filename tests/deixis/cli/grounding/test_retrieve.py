"""``deixis retrieve``: the layouts that a scene is like, and the scenes that a script is like."""

from __future__ import annotations

import json
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

import pytest
import typer

import deixis as package
from deixis.cli.grounding.retrieve import retrieve
from deixis.errors import DeixisError
from deixis.perception.formats.scene_json import read_scene
from deixis.session import Session
from deixis.workflows.scenes.perceive import write_scene

EXAMPLES = Path(__file__).parents[4] / "examples"
SETTING = EXAMPLES / "place_setting.scene.json"


@pytest.fixture(autouse=True)
def _nothing_remembered(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path / "none"))


def run(*args: object) -> tuple[int, str]:
    """Runs the command by itself: exit code and what it printed."""
    app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)
    app.command()(retrieve)
    out = StringIO()
    with redirect_stdout(out), redirect_stderr(out):
        try:
            app([str(arg) for arg in args])
        except SystemExit as end:
            return int(end.code or 0), out.getvalue()
    raise AssertionError("a command ends with an exit code")


def names(printed: str) -> list[str]:
    return [entry["name"] for entry in json.loads(printed)["results"]]


def test_a_scene_ranks_the_scripts_of_a_folder() -> None:
    code, out = run(SETTING, "--among", EXAMPLES, "--json")
    assert code == 0
    found = json.loads(out)["results"]
    assert names(out)[:3] == ["formal_dinner.layout", "script1.layout", "script2.layout"]
    assert found[0]["similarity"] == 1.0
    assert found[0]["matches"]["dinner_plate"] == "o8"
    assert found[2]["similarity"] < 1


def test_words_that_the_ontology_does_not_know_are_told_apart(tmp_path: Path) -> None:
    scripts = {"dinner": "fork left of red_plate", "pump": "gasket_1 left of flange", "nonsense": "glimp left of florb"}
    for name, text in scripts.items():
        (tmp_path / f"{name}.layout").write_text(text, encoding="utf-8")
    for labels, first in ((("fork", "red plate"), "dinner.layout"), (("gasket", "flange"), "pump.layout")):
        objects = [
            {"id": f"o{i}", "min": [i, 0], "max": [i + 0.2, 0.2], "label": word} for i, word in enumerate(labels)
        ]
        (tmp_path / "one.scene.json").write_text(json.dumps({"unit": "m", "objects": objects}), encoding="utf-8")
        _, out = run(tmp_path / "one.scene.json", "--among", tmp_path, "--json", "--least", 0)
        found = json.loads(out)["results"]
        assert names(out)[0] == first
        assert [entry["objects"] for entry in found] == [1.0, 0.0, 0.0]


def test_a_script_ranks_the_scenes_of_a_folder(tmp_path: Path) -> None:
    setting = read_scene(SETTING)
    write_scene(setting, tmp_path / "whole.scene.json")
    write_scene(setting.reordered(range(5)), tmp_path / "part.scene.json")
    code, out = run(EXAMPLES / "formal_dinner.layout", "--among", tmp_path, "--json", "--least", 0)
    assert code == 0
    assert names(out) == ["whole.scene.json", "part.scene.json"]


def test_a_scene_ranks_what_is_remembered(tmp_path: Path) -> None:
    with Session(memory=tmp_path / "memory") as session:
        session.learn(EXAMPLES / "formal_dinner.layout", SETTING)
        session.learn(EXAMPLES / "script2.layout", SETTING)
    code, out = run(SETTING, "--memory", tmp_path / "memory")
    assert code == 0
    lines = out.splitlines()
    assert lines[1].split()[:2] == ["formal_dinner", "1.000"]
    assert lines[2].startswith("script2 ")


def test_results_of_folder_and_memory_are_ranked_together(tmp_path: Path) -> None:
    memory, folder = tmp_path / "memory", tmp_path / "scenes"
    folder.mkdir()
    setting = read_scene(SETTING)
    write_scene(setting.reordered(range(5)), folder / "part.scene.json")
    with Session(memory=memory) as session:
        session.learn(EXAMPLES / "formal_dinner.layout", SETTING)
    script = EXAMPLES / "formal_dinner.layout"
    assert names(run(script, "--memory", memory, "--json")[1]) == ["formal_dinner-1"]
    both = run(script, "--memory", memory, "--among", folder, "--json", "--least", 0)[1]
    assert names(both) == ["formal_dinner-1", "part.scene.json"]
    both = run(SETTING, "--memory", memory, "--among", EXAMPLES, "--json")[1]
    assert names(both)[:2] == ["formal_dinner", "formal_dinner.layout"]
    alone = run(SETTING, "--memory", memory, "--no-memory", "--among", EXAMPLES, "--json")[1]
    assert "formal_dinner" not in names(alone)


def test_a_memory_that_is_named_must_be_there(tmp_path: Path) -> None:
    with pytest.raises(DeixisError, match="there is no memory at"):
        run(SETTING, "--memory", tmp_path / "gone", "--among", EXAMPLES)


def test_no_more_are_printed_than_were_asked_for() -> None:
    _, out = run(SETTING, "--among", EXAMPLES, "--json", "--top", 1)
    assert len(names(out)) == 1


def test_where_nothing_is_similar_the_exit_code_is_1(tmp_path: Path) -> None:
    (tmp_path / "two.layout").write_text("fork left of plate\n", encoding="utf-8")
    code, out = run(SETTING, "--among", tmp_path, "--least", 0.9)
    assert code == 1
    assert out.startswith("None of the 1 candidates has a similarity of at least 0.9 to ")


@pytest.mark.parametrize(
    ("args", "message"),
    [
        ((SETTING, "--among", "nowhere"), "name a folder of layout scripts"),
        ((SETTING, "--among", "EMPTY"), "no layout scripts in it"),
        ((EXAMPLES / "script1.layout", "--among", "EMPTY"), "no scenes in it"),
        ((EXAMPLES / "script1.layout",), "--among DIR"),
        (("nothing.scene.json", "--among", EXAMPLES), "nothing.scene.json"),
    ],
)
def test_bad_input_is_an_error_that_names_it(args: tuple[object, ...], message: str, tmp_path: Path) -> None:
    with pytest.raises(DeixisError, match=r"\S") as error:
        run(*(tmp_path if arg == "EMPTY" else arg for arg in args))
    assert message in str(error.value)


def test_python_retrieves_as_the_command_does(tmp_path: Path) -> None:
    by_scene = package.retrieve(SETTING, among=EXAMPLES)
    assert [one.name for one in by_scene.found] == names(run(SETTING, "--among", EXAMPLES, "--json")[1])
    with Session(memory=tmp_path / "memory") as session:
        session.learn(EXAMPLES / "formal_dinner.layout", SETTING)
        by_script = package.retrieve(EXAMPLES / "formal_dinner.layout", memory=session)
    assert [(one.name, one.similarity) for one in by_script.found] == [("formal_dinner-1", 1.0)]
    assert by_script.found[0].matches["dinner_plate"] == "o8"


def test_the_results_are_drawn_as_bars(tmp_path: Path) -> None:
    code, out = run(SETTING, "--among", EXAMPLES, "--plot", tmp_path / "similar.svg")
    assert (code, out.splitlines()[-1]) == (0, f"Written: {tmp_path / 'similar.svg'}")
    assert "informal.layout" in (tmp_path / "similar.svg").read_text(encoding="utf-8")
