"""The shipped examples: every script and scene reads, and formatting a script keeps its facts."""

from __future__ import annotations

from pathlib import Path

import pytest

import deixis
from deixis.examples_data import EXAMPLES
from deixis.grammar.script import Script

LAYOUTS = sorted(EXAMPLES.glob("*.layout"))
SCENES = sorted(EXAMPLES.glob("*.scene.json"))


def facts(script: Script) -> list[str]:
    return [str(fact) for fact in script.facts]


def test_there_are_some() -> None:
    assert len(LAYOUTS) >= 4
    assert len(SCENES) >= 2


@pytest.mark.parametrize("path", LAYOUTS, ids=lambda path: path.name)
def test_a_script_keeps_its_facts_when_formatted(path: Path) -> None:
    script = deixis.read_script(path)
    assert script.facts
    assert script.viewpoint == "chair"
    text = deixis.format_script(script)
    again = deixis.read_script(text=text)
    assert facts(again) == facts(script)
    assert again.objects == script.objects
    assert (again.name, again.title) == (script.name, script.title)
    assert deixis.format_script(again) == text


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.name)
def test_a_scene_reads_and_writes(path: Path, tmp_path: Path) -> None:
    scene = deixis.read_scene(path)
    assert scene.objects
    deixis.write_scene(scene, tmp_path / "copy.scene.json")
    assert deixis.read_scene(tmp_path / "copy.scene.json") == scene


def test_the_labelled_scene_is_the_plain_one_with_labels() -> None:
    plain, labelled = (deixis.read_scene(EXAMPLES / f"place_setting{kind}.scene.json") for kind in ("", ".labelled"))
    assert labelled.without_labels() == plain
    assert len({thing.label for thing in labelled.objects}) == 12
