"""ground --ask and --viewpoint: what is asked resolves the answer, and a turned table is grounded as if it were not."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import deixis

import deixis as deixis_package
from deixis.deadline import Deadline
from deixis.examples_data import example
from deixis.experiments.generated_tables import generate
from deixis.learning.lessons.scene_evidence import evidence_of
from deixis.perception.formats.scene_json import read_scene
from deixis.reasoning.geometry.turning import turned
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.engines.map_engines import ExactEngine
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.grounding.hypotheses.viewpoint import Viewpoint, Viewpoints
from deixis.reasoning.grounding.questions.candidates import Candidates
from deixis.reasoning.grounding.questions.inquiry import begin
from deixis.reasoning.grounding.questions.refinement import narrowed
from deixis.reasoning.grounding.questions.selection import questions
from deixis.reasoning.grounding.questions.situation import situation_of
from deixis.workflows.grounding.dialogue import Oracle
from deixis.workflows.grounding.viewpoint import ViewpointScene
from deixis.workflows.layouts.read import read_script

SCENE = example("place_setting.scene.json")
PATIENT = ("--time-limit", "60")
"""Options for answers that a busy machine must not leave undecided."""
TRUTH = {thing.label: thing.id for thing in read_scene(example("place_setting.labelled.scene.json")).objects}


def matches(out: str) -> dict[str, str]:
    return {match["object"]: match["perceived"] for match in json.loads(out)["matches"]}


@pytest.mark.parametrize("script", ["script1.layout", "formal_dinner.layout"])
def test_an_oracle_settles_the_matches_in_few_questions(script: str, tmp_path: Path) -> None:
    oracle = tmp_path / "truth.json"
    oracle.write_text(json.dumps(TRUTH), encoding="utf-8")
    code, out, err = deixis("ground", example(script), SCENE, "--oracle", oracle, "--json", "--no-sizes")
    assert code == 0
    assert matches(out) == TRUTH
    assert all(match["decided"] for match in json.loads(out)["matches"])
    asked = [line for line in err.splitlines() if line[:1].isdigit()]
    assert len(asked) <= 7
    questions = json.loads(out)["questions"]
    assert [f"{n}. {one['text']}" for n, one in enumerate(questions, 1)] == [line.split("   ")[0] for line in asked]
    assert all(one["outcome"] == "resolved" and one["answer"] and one["bits"] > 0 for one in questions)


def test_a_dialogue_without_answers_leaves_the_grounding_as_is(monkeypatch: pytest.MonkeyPatch) -> None:
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


def test_a_malformed_truth_file_is_bad_input(tmp_path: Path) -> None:
    oracle = tmp_path / "truth.json"
    oracle.write_text('["o1"]', encoding="utf-8")
    code, out, err = deixis("ground", example("script1.layout"), SCENE, "--oracle", oracle)
    assert (code, out) == (2, "")
    assert str(oracle) in err


def turned_scene(quarters: int) -> dict[str, Any]:
    """Turn the shipped setting, without labels, by quarters of a circle."""
    scene = read_scene(SCENE)
    return scene_of(scene.ids, turned(scene.boxes, quarters * math.pi / 2))


def scene_of(ids: Sequence[str], boxes: np.ndarray) -> dict[str, Any]:
    objects = [
        {"id": id, "min": low.tolist(), "max": high.tolist()} for id, (low, high) in zip(ids, boxes, strict=True)
    ]
    return {"frame": "table", "viewpoint": "chair", "unit": "m", "objects": objects}


@pytest.mark.parametrize(("quarters", "option"), [(1, "quarter"), (2, "quarter"), (3, "unknown")])
def test_a_turned_table_is_grounded_as_if_it_were_not(quarters: int, option: str, tmp_path: Path) -> None:
    file = tmp_path / "turned.scene.json"
    file.write_text(json.dumps(turned_scene(quarters)), encoding="utf-8")
    straight = deixis("ground", example("formal_dinner.layout"), SCENE, "--json", *PATIENT)[1]
    code, out, _ = deixis("ground", example("formal_dinner.layout"), file, "--viewpoint", option, "--json", *PATIENT)
    assert code == 0
    assert matches(out) == matches(straight) == TRUTH
    said = json.loads(out)
    assert any(note.startswith("the scene was taken turned by ") for note in said["notes"])
    best, *_ = said["viewpoints"]
    back = (best["turned"] + 90 * quarters) % 360
    assert min(back, 360 - back) < 15 and not best["mirrored"]
    assert best["probability"] == max(side["probability"] for side in said["viewpoints"])
    assert sum(side["probability"] for side in said["viewpoints"]) == pytest.approx(1.0, abs=0.01)
    assert "viewpoints" not in json.loads(straight)


@pytest.mark.parametrize("viewpoint", ["quarter", "unknown"])
def test_no_side_is_recovered_where_nothing_tells_one(viewpoint: str, tmp_path: Path) -> None:
    script = tmp_path / "alone.layout"
    script.write_text("layout alone seen from chair\nplate is a Plate\nfork is a Fork\n", encoding="utf-8")
    code, out, _ = deixis("ground", script, SCENE, "--viewpoint", viewpoint, "--json")
    _, stated, _ = deixis("ground", script, SCENE, "--json")
    assert code == 0
    assert matches(out) == matches(stated)
    assert any("nothing indicates from which side" in note for note in json.loads(out)["notes"])
    assert json.loads(out)["viewpoints"] == []


def boxes_file(tmp_path: Path, lows: list[list[float]], side: float = 0.1) -> Path:
    """Write a scene of equal things, o1, o2, …, with the given lower corners."""
    boxes = np.array([[low, [x + side for x in low]] for low in lows])
    file = tmp_path / "boxes.scene.json"
    file.write_text(json.dumps(scene_of([f"o{k + 1}" for k in range(len(lows))], boxes)), encoding="utf-8")
    return file


def layout_file(tmp_path: Path, *lines: str) -> Path:
    file = tmp_path / "words.layout"
    file.write_text("\n".join(("layout words seen from chair", *lines)) + "\n", encoding="utf-8")
    return file


def probabilities(out: str) -> list[float | None]:
    return [match["probability"] for match in json.loads(out)["matches"]]


def test_incomplete_groundings_without_answers_stay_uncertain(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = layout_file(tmp_path, *(f"a{k} left of a{k + 1}" for k in range(29)))
    scene = boxes_file(tmp_path, [[0.0, 0.0]] * 30)
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    code, out, err = deixis("ground", script, scene, "--ask", "--time-limit", 1, "--json")
    assert code in (0, 1, 3)  # 1: thirty things at one place are another scene than thirty in a row
    assert "Not all groundings could be considered" in err
    assert len(matches(out)) == (0 if code == 1 else 30)
    assert all(chance is None or chance < 0.2 for chance in probabilities(out))


def test_both_searches_share_the_time_limit_without_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    script = layout_file(tmp_path, *(f"a{k} left of a{k + 1}" for k in range(29)))
    scene = boxes_file(tmp_path, [[0.0, 0.0]] * 30)
    limits: list[float] = []

    def recorded(evidence: Evidence, engine: ExactEngine, deadline: Deadline, notes: tuple[str, ...]) -> Grounding:
        limits.append(deadline.left)
        return ground(evidence, engine, deadline, notes)

    monkeypatch.setattr("deixis.workflows.grounding.ground.ground_evidence", recorded)
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    deixis("ground", script, scene, "--ask", "--time-limit", 0.4, "--json")
    assert limits[0] < 0.3  # what to ask took half of it
    deixis("ground", script, scene, "--ask", "--time-limit", 0.4, "--viewpoint", "quarter", "--json")
    assert limits[1] < 0.15  # and the side half before that
    limits.clear()
    monkeypatch.setattr("sys.stdin", io.StringIO("?\n"))
    deixis("ground", example("script1.layout"), SCENE, "--ask", "--no-sizes", "--time-limit", 20)
    assert 15 < limits[0] <= 20  # counted from the answer on


def test_who_does_not_know_leaves_every_probability_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    arguments = ("ground", example("script2.layout"), SCENE, "--json", *PATIENT)
    monkeypatch.setattr("sys.stdin", io.StringIO("?\n" * 50))
    _, asked, err = deixis(*arguments, "--ask")
    assert err.startswith("1. ")
    assert json.loads(asked)["matches"] == json.loads(deixis(*arguments)[1])["matches"]


def test_what_is_pointed_out_is_certain_and_no_other_object(tmp_path: Path) -> None:
    script = layout_file(tmp_path, "cup left of mug", "cup left of jug")
    scene = boxes_file(tmp_path, [[0.0, 0.0], [0.3, 0.1], [0.3, -0.1], [0.6, 0.0]])
    oracle = tmp_path / "truth.json"
    oracle.write_text('{"cup": "o1", "mug": "o4", "jug": "o2"}', encoding="utf-8")
    _, out, err = deixis("ground", script, scene, "--oracle", oracle, "--json")
    assert "Which one is" in err
    assert matches(out) == {"cup": "o1", "mug": "o4", "jug": "o2"}
    assert all(chance is not None and chance > 0.975 for chance in probabilities(out))


def test_it_is_asked_about_what_would_otherwise_not_be_decided(monkeypatch: pytest.MonkeyPatch) -> None:
    arguments = ("ground", example("script2.layout"), SCENE, "--json")
    undecided = [match for match in json.loads(deixis(*arguments)[1])["matches"] if not match["decided"]]
    monkeypatch.setattr("sys.stdin", io.StringIO(""))
    assert bool(undecided) == deixis(*arguments, "--ask")[2].startswith("1. ")
    assert undecided


@pytest.mark.parametrize("viewpoint", ["quarter", "unknown"])
def test_no_side_is_inferred_when_no_compared_pair_was_found(viewpoint: str, tmp_path: Path) -> None:
    script = layout_file(tmp_path, "cup is a Cup", "mug is a Mug", "cup left of mug")
    scene = boxes_file(tmp_path, [[0.0, 0.0], [0.4, 0.1]])
    things = json.loads(scene.read_text(encoding="utf-8"))
    for thing in things["objects"]:
        thing["label"] = "fish_knife"
    scene.write_text(json.dumps(things), encoding="utf-8")
    _, out, err = deixis("ground", script, scene, "--viewpoint", viewpoint, "--json")
    assert matches(out) == {}, err
    (note,) = [note for note in json.loads(out)["notes"] if note.startswith("the scene was taken")]
    assert "nothing indicates from which side" in note


def test_a_match_is_at_most_as_probable_as_its_viewpoints(tmp_path: Path) -> None:
    """Two equal things fit from two opposite sides, so that both matches stay uncertain."""
    script, scene = layout_file(tmp_path, "cup left of mug"), boxes_file(tmp_path, [[0.0, 0.0], [0.4, 0.0]])
    _, out, err = deixis("ground", script, scene, "--viewpoint", "quarter", "--json")
    for match in json.loads(out)["matches"]:
        assert match["probability"] < 0.55 and not match["decided"], err


def test_an_uncertain_viewpoint_limits_probabilities_to_one_side(tmp_path: Path) -> None:
    def doubt(probability: float) -> str:
        sides = [Viewpoint(0.0, False, probability, 0.0, np.zeros(1, np.int64))]
        sides += [Viewpoint(math.pi, False, 1 - probability, -1.0, np.zeros(1, np.int64))]
        return "; ".join(
            ViewpointScene(read_scene(SCENE), Viewpoints(tuple(sides), exact=True), share=probability).viewpoint_notes
        )

    assert "hold as seen from this side" in doubt(0.6)
    assert not doubt(0.99)


def test_no_side_is_reported_where_every_angle_fits_alike(tmp_path: Path) -> None:
    script = layout_file(tmp_path, "cup inside box")
    scene = boxes_file(tmp_path, [[0.0, 0.0]], side=0.6)
    things = json.loads(scene.read_text(encoding="utf-8"))
    things["objects"].append({"id": "small", "min": [0.25, 0.25], "max": [0.35, 0.35]})
    scene.write_text(json.dumps(things), encoding="utf-8")
    _, out, err = deixis("ground", script, scene, "--viewpoint", "unknown", "--json")
    assert matches(out) == {"cup": "small", "box": "o1"}, err
    assert any("nothing indicates from which side" in note for note in json.loads(out)["notes"])


def test_a_ruled_out_match_leaves_an_uncertain_label_uncertain(tmp_path: Path) -> None:
    script = read_script(layout_file(tmp_path, "cup is a Cup", "mug is a Mug"))
    scene = read_scene(boxes_file(tmp_path, [[0.0, 0.0], [0.4, 0.0], [0.8, 0.0]]))
    evidence = evidence_of(script, scene)
    labels = evidence.labels.copy()
    labels[0, 0] = 0.3  # perhaps the cup
    evidence = replace(evidence, labels=labels)
    maps = np.array([[0, 1], [1, 0], [2, 1], [1, 2]])
    start = begin(situation_of(evidence.description, evidence.scene), Candidates(maps, np.ones(4)))
    is_it = next(
        q for q in questions(start.situation, start.start) if (q.kind, q.subject, q.thing) == ("identity", 1, 0)
    )
    told = narrowed(evidence, start.answered(is_it, "no"))
    assert np.argwhere(~told.allowed).tolist() == [[1, 0]]
    assert told.problem.absent.tolist() == evidence.problem.absent.tolist()


def test_an_answer_about_forks_leaves_the_knives_open(monkeypatch: pytest.MonkeyPatch) -> None:
    script, scene = example("script1.layout"), example("place_setting.scene.json")
    before = json.loads(deixis("ground", script, scene, "--json")[1])
    monkeypatch.setattr("sys.stdin", io.StringIO("yes\n"))
    code, out, err = deixis("ground", script, scene, "--ask", "--json")
    assert code == 0 and "Is the dinner fork left of the salad fork?" in err
    was, now = ({match["object"]: match for match in found["matches"]} for found in (before, json.loads(out)))
    assert now["dinner_fork"]["decided"] and not was["dinner_fork"]["decided"]
    for knife in ("dinner_knife", "fish_knife"):
        assert now[knife]["decided"] == was[knife]["decided"]
        assert now[knife]["probability"] == pytest.approx(was[knife]["probability"], abs=0.01)


@pytest.mark.parametrize("truth", ["o3", None])
def test_of_a_single_object_the_answer_is_believed(truth: str | None, tmp_path: Path) -> None:
    script = layout_file(tmp_path, "cup is a Cup")
    scene = boxes_file(tmp_path, [[0.3 * k, 0.0] for k in range(3)])
    oracle = tmp_path / "truth.json"
    oracle.write_text(json.dumps({"cup": truth}), encoding="utf-8")
    _, out, err = deixis("ground", script, scene, "--oracle", oracle, "--json")
    assert err.startswith("1. Which one is the cup?")
    assert matches(out) == ({"cup": "o3"} if truth else {})
    assert all(chance is not None and chance > 0.975 for chance in probabilities(out))
    assert "labels of the scene" not in out


@pytest.mark.parametrize("seed", [14, 17])
def test_what_the_answers_make_likely_is_asked_about_in_turn(seed: int, tmp_path: Path) -> None:
    table = generate(6, 1.5, 0.2, seed=seed)
    description, things = table.description(), [f"o{k + 1}" for k in range(len(table.boxes))]
    script = layout_file(tmp_path, *(str(fact) for fact in description.facts()))
    scene, oracle = tmp_path / "table.scene.json", tmp_path / "truth.json"
    scene.write_text(json.dumps(scene_of(things, table.boxes)), encoding="utf-8")
    truth = {name: things[p] for name, p in zip(description.nodes, table.truth.tolist(), strict=True)}
    oracle.write_text(json.dumps(truth), encoding="utf-8")
    code, out, err = deixis("ground", script, scene, "--oracle", oracle, "--json")
    assert code == 0
    assert matches(out) == truth
    assert all(match["decided"] for match in json.loads(out)["matches"])
    assert "groundings is left after" in err


@pytest.mark.parametrize("absent", ["dinner_knife", "water_glass"])
def test_who_says_that_an_object_is_not_there_is_believed(absent: str, tmp_path: Path) -> None:
    oracle = tmp_path / "truth.json"
    oracle.write_text(json.dumps(TRUTH | {absent: None}), encoding="utf-8")
    _, out, _ = deixis("ground", example("script1.layout"), SCENE, "--no-sizes", "--oracle", oracle, "--json")
    asked = [one for one in json.loads(out)["questions"] if one["answer"] == "absent"]
    if asked:
        assert absent not in matches(out)
    assert len(json.loads(out)["questions"]) <= 12


def test_a_dialogue_ends_when_the_oracle_finds_no_object(tmp_path: Path) -> None:
    oracle = tmp_path / "truth.json"
    oracle.write_text(json.dumps(dict.fromkeys(TRUTH)), encoding="utf-8")
    _, out, _ = deixis("ground", example("script1.layout"), SCENE, "--no-sizes", "--oracle", oracle, "--json")
    assert len(json.loads(out)["questions"]) <= 2 * len(TRUTH)
    assert len(matches(out)) <= 2


def test_python_recovers_the_viewpoint_as_the_command_does() -> None:
    found = deixis_package.ground(example("formal_dinner.layout"), turned_scene(1), viewpoint="quarter")
    assert {name: match.perceived for name, match in found.matches.items()} == TRUTH
    with pytest.raises(deixis_package.DeixisError, match="`viewpoint` must be one of stated, quarter, unknown"):
        deixis_package.ground(example("formal_dinner.layout"), SCENE, viewpoint="above")


def test_python_holds_a_dialogue_as_the_command_does() -> None:
    out = io.StringIO()
    asked = deixis_package.ask(
        example("script1.layout"), SCENE, lambda _: Oracle({name or "": id for name, id in TRUTH.items()}, out), out
    )
    assert all(match.decided for match in asked.matches.values())


@pytest.mark.parametrize("viewpoint", ["quarter", "unknown"])
def test_viewpoints_are_as_probable_as_the_sides_of_matches(viewpoint: str) -> None:
    found = deixis_package.ground(
        example("formal_dinner.layout"), turned_scene(1), viewpoint=viewpoint, time_limit=60.0
    )
    assert found.viewpoints and found.fits is not None
    sides = {(side.angle, side.mirrored): probability / found.fits for side, probability in found.sides}
    assert sum(view.probability for view in found.viewpoints) == pytest.approx(1.0)
    rest = 1 - sum(view.probability for view in found.viewpoints if (view.angle, view.mirrored) in sides)
    for view in found.viewpoints:
        if (view.angle, view.mirrored) in sides:
            assert view.probability == pytest.approx((1 - rest) * sides[view.angle, view.mirrored])
    shown = f"with probability {found.viewpoints[0].probability:.2f}"
    assert any(note.startswith("the scene was taken turned") and note.endswith(shown) for note in found.notes)
