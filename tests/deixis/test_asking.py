"""ground --ask and --viewpoint: what is asked resolves the answer, and a turned table is grounded as if it were not."""

from __future__ import annotations

import io
import json
import math
from pathlib import Path

import pytest
from commands import deixis

from deixis.examples_data import example
from deixis.perception.scene_file import read_scene
from deixis.reasoning.viewpoints import turned

SCENE = example("place_setting.scene.json")
TRUTH = {thing.label: thing.id for thing in read_scene(example("place_setting.labelled.scene.json")).objects}


def matches(out: str) -> dict[str, str]:
    return {match["object"]: match["perceived"] for match in json.loads(out)["matches"]}


@pytest.mark.parametrize("script", ["script1.layout", "formal_dinner.layout"])
def test_an_oracle_settles_who_is_who_in_few_questions(script: str, tmp_path: Path) -> None:
    oracle = tmp_path / "truth.json"
    oracle.write_text(json.dumps(TRUTH), encoding="utf-8")
    code, out, err = deixis("ground", example(script), SCENE, "--oracle", oracle, "--json", "--no-sizes")
    assert code == 0
    assert matches(out) == TRUTH
    assert all(match["decided"] for match in json.loads(out)["matches"])
    asked = [line for line in err.splitlines() if line[:1].isdigit()]
    assert len(asked) <= 6


def test_without_answers_the_dialogue_ends_and_the_answer_is_as_without_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    code, out, _ = deixis("ground", example("script1.layout"), SCENE, "--ask", "--no-sizes")
    assert code == 0
    assert "No further answers." in out
    (fish_knife,) = [line for line in out.splitlines() if line.startswith("fish_knife ")]
    assert " or " in fish_knife


def test_only_the_exact_engine_asks() -> None:
    code, _, err = deixis("ground", example("script1.layout"), SCENE, "--ask", "--engine", "similarity")
    assert code == 2
    assert "leave out --engine" in err


def test_a_truth_file_that_is_none_is_bad_input(tmp_path: Path) -> None:
    oracle = tmp_path / "truth.json"
    oracle.write_text('["o1"]', encoding="utf-8")
    code, out, err = deixis("ground", example("script1.layout"), SCENE, "--oracle", oracle)
    assert (code, out) == (2, "")
    assert str(oracle) in err


@pytest.mark.parametrize(("quarters", "option"), [(1, "quarter"), (2, "quarter"), (3, "unknown")])
def test_a_turned_table_is_grounded_as_if_it_were_not(quarters: int, option: str, tmp_path: Path) -> None:
    scene = read_scene(SCENE)
    boxes = turned(scene.boxes, quarters * math.pi / 2)
    objects = [
        {"id": thing.id, "min": box[0].tolist(), "max": box[1].tolist()}
        for thing, box in zip(scene.objects, boxes, strict=True)
    ]
    file = tmp_path / "turned.scene.json"
    file.write_text(
        json.dumps({"frame": "table", "viewpoint": "chair", "unit": "m", "objects": objects}), encoding="utf-8"
    )
    straight = deixis("ground", example("formal_dinner.layout"), SCENE, "--json")[1]
    code, out, _ = deixis("ground", example("formal_dinner.layout"), file, "--viewpoint", option, "--json")
    assert code == 0
    assert matches(out) == matches(straight) == TRUTH
    notes = json.loads(out)["notes"]
    assert any(note.startswith("the scene was taken turned by ") for note in notes)


@pytest.mark.parametrize("viewpoint", ["quarter", "unknown"])
def test_no_side_is_recovered_where_nothing_tells_one(viewpoint: str, tmp_path: Path) -> None:
    script = tmp_path / "alone.layout"
    script.write_text("layout alone seen from chair\nplate is a Plate\nfork is a Fork\n", encoding="utf-8")
    code, out, _ = deixis("ground", script, SCENE, "--viewpoint", viewpoint, "--json")
    _, stated, _ = deixis("ground", script, SCENE, "--json")
    assert code == 0
    assert matches(out) == matches(stated)
    assert any("nothing tells from which side" in note for note in json.loads(out)["notes"])
