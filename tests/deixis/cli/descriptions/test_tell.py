"""The command ``deixis tell``: layouts and scenes in English."""

from __future__ import annotations

import json
from pathlib import Path

from commands import deixis

EXAMPLES = Path(__file__).parents[4] / "examples"


def test_a_layout_is_described_without_what_follows(tmp_path: Path) -> None:
    layout = tmp_path / "row.layout"
    layout.write_text("left to right: fork, plate, knife\nfork left of knife\n", encoding="utf-8")
    assert deixis("tell", layout)[:2] == (0, "The fork is left of the plate. The plate is left of the knife.\n")
    code, out, _ = deixis("tell", layout, "--all")
    assert (code, out) == (0, "The fork is left of the plate. The fork and the plate are left of the knife.\n")


def test_json_has_the_facts_of_each_sentence(tmp_path: Path) -> None:
    layout = tmp_path / "row.layout"
    layout.write_text("left to right: fork, plate, knife\nfork left of knife\n", encoding="utf-8")
    code, out, _ = deixis("tell", layout, "--json")
    told = json.loads(out)
    assert code == 0
    assert [len(sentence["facts"]) for sentence in told["sentences"]] == [1, 1]
    assert [(f["relation"], f["subject"], f["object"]) for f in told["left_out"]] == [("left", "fork", "knife")]


def test_a_scene_is_described_from_its_landmark_on() -> None:
    code, out, _ = deixis("tell", EXAMPLES / "second_table.scene.json")
    assert code == 0
    assert out.startswith("There are two napkins. The first napkin is on the dinner plate.")


def test_what_is_not_a_layout_or_a_scene_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "x.scene.json"
    file.write_text("{", encoding="utf-8")
    code, _, error = deixis("tell", file)
    assert code == 2
    assert "x.scene.json" in error


def test_the_ids_of_numbered_things_are_printed() -> None:
    lines = deixis("tell", EXAMPLES / "second_table.scene.json", "--time-limit", 120)[1].splitlines()
    assert lines[-1] == "In the scene, napkin 1 is p6, napkin 2 is p1."
