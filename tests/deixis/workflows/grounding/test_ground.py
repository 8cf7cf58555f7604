"""One request for Python and the command: the same options, the same answers, and everything computed once."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pytest
from commands import deixis

import deixis as package
from deixis.errors import ArgumentError
from deixis.examples_data import example
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.hypotheses.hypotheses import STATED_SIDES
from deixis.reasoning.grounding.questions.selection import Question
from deixis.reasoning.grounding.questions.situation import Situation
from deixis.report.json_answers import grounding_to_dict
from deixis.testing import assert_grounds
from deixis.workflows.grounding.dialogue import Ask, Dialogue, Oracle, OracleError
from deixis.workflows.grounding.ground import GroundingRequest, answer

SCRIPT1, FULL = example("script1.layout"), example("formal_dinner.layout")
SCENE, LABELLED = example("place_setting.scene.json"), example("place_setting.labelled.scene.json")
TRUTH = {thing.label or "": thing.id for thing in read_scene(LABELLED).objects}
PLAIN = {"time_limit": 60.0}


def written(data: dict[str, Any]) -> dict[str, Any]:
    """Convert an answer through JSON and remove its running time."""
    data = json.loads(json.dumps(data))
    assert data.pop("seconds") > 0
    return data


@pytest.fixture
def truth_file(tmp_path: Path) -> Path:
    file = tmp_path / "truth.json"
    file.write_text(json.dumps(TRUTH), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("script", "options", "arguments"),
    [
        (FULL, {}, []),
        (SCRIPT1, {"sizes": False}, ["--no-sizes"]),
        (SCRIPT1, {"literal": True}, ["--literal"]),
        (SCRIPT1, {"literal": True, "sizes": False}, ["--literal", "--no-sizes"]),
        (SCRIPT1, {"engine": "scalable"}, ["--engine", "scalable"]),
        (FULL, {"engine": "blondel", "literal": True}, ["--engine", "blondel", "--literal"]),
        (SCRIPT1, {"engine": "similarity"}, ["--engine", "similarity", "--select", "facts"]),
        (
            SCRIPT1,
            {"engine": "similarity", "select": "similarity"},
            ["--engine", "similarity", "--select", "similarity"],
        ),
        (FULL, {"viewpoint": "quarter"}, ["--viewpoint", "quarter"]),
        (
            FULL,
            {"viewpoint": "quarter", "engine": "similarity", "select": "similarity"},
            ["--viewpoint", "quarter", "--engine", "similarity", "--select", "similarity"],
        ),
        (SCRIPT1, {"ask": TRUTH, "sizes": False}, ["--oracle", "TRUTH", "--no-sizes"]),
        (
            SCRIPT1,
            {"ask": TRUTH, "sizes": False, "max_questions": 1},
            ["--oracle", "TRUTH", "--no-sizes", "--max-questions", "1"],
        ),
        (
            SCRIPT1,
            {"ask": TRUTH, "literal": True, "viewpoint": "quarter"},
            ["--oracle", "TRUTH", "--literal", "--viewpoint", "quarter"],
        ),
    ],
)
def test_python_and_the_command_give_the_same_answer(
    script: str, options: dict[str, Any], arguments: list[str], truth_file: Path
) -> None:
    given = [str(truth_file) if argument == "TRUTH" else argument for argument in arguments]
    _, out, _ = deixis("ground", script, SCENE, "--json", "--time-limit", "60", *given)
    found = package.ground(script, SCENE, **(PLAIN | options))
    assert written(json.loads(out)) == written(grounding_to_dict(found))


def test_a_session_and_the_command_give_the_same_answer(tmp_path: Path) -> None:
    with package.Session(tmp_path / "memory") as session:
        session.learn(FULL, LABELLED)
        found = session.ground(SCRIPT1, SCENE, literal=True, sizes=False, time_limit=60.0)
        asked = session.ground(SCRIPT1, SCENE, ask=TRUTH, time_limit=60.0)
    arguments = ["--json", "--time-limit", "60", "--memory", tmp_path / "memory"]
    _, out, _ = deixis("ground", SCRIPT1, SCENE, *arguments, "--literal", "--no-sizes")
    assert written(json.loads(out)) == written(grounding_to_dict(found))
    assert {name: match.perceived for name, match in asked.matches.items()} == TRUTH


def test_all_kinds_of_who_answers_give_the_same_answer() -> None:
    def told(question: Question, situation: Situation) -> str | None:
        return Oracle(TRUTH, io.StringIO()).answer(question, situation)

    out = io.StringIO()
    sources: list[Ask] = [TRUTH, told, Dialogue(lambda _: Oracle(TRUTH, out), out)]
    first, *others = (package.ground(SCRIPT1, SCENE, ask=source, sizes=False, time_limit=60.0) for source in sources)
    assert first.exchanges
    assert all(match.decided for match in first.matches.values())
    for other in others:
        assert written(grounding_to_dict(other)) == written(grounding_to_dict(first))
    assert out.getvalue().startswith("1. ")


def test_who_does_not_answer_is_asked_once() -> None:
    asked: list[str] = []

    def silent(question: Question, situation: Situation) -> None:
        asked.append(question.text)

    found = package.ground(SCRIPT1, SCENE, ask=silent, sizes=False)
    assert (len(asked), found.exchanges) == (1, ())
    assert package.ground(SCRIPT1, SCENE, sizes=False).exchanges is None


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"select": "best"}, SettingError, "`select` must be one of facts, similarity, got 'best'"),
        ({"viewpoint": "above"}, SettingError, "`viewpoint` must be one of stated, quarter, unknown, got 'above'"),
        ({"ask": {}, "engine": "scalable"}, SettingError, "only the engine 'exact' asks"),
        ({"ask": {}, "max_questions": 0}, SettingError, "`max_questions` must be at least 1, got 0"),
        ({"ask": {}, "max_questions": 1.5}, ArgumentError, "`max_questions` must be a whole number or None, got 1.5"),
        ({"max_questions": 2}, SettingError, "`max_questions` needs a source of answers"),
        ({"ask": [3]}, SettingError, "`ask` must be a mapping, a function or a Dialogue"),
        ({"ask": lambda question, situation: 3}, OracleError, "must be one of its answers, got '3'"),
        ({"meaning": None}, ArgumentError, "`meaning` must be a Meaning"),
        ({"time_limit": -1.0}, SettingError, "time_limit"),
        ({"time_limit": "soon"}, ArgumentError, "time_limit"),
        ({"time_limit": None}, ArgumentError, "time_limit"),
        ({"engine": "exakt"}, package.DeixisError, "there is no engine 'exakt'"),
        ({"ask": {"fork": "o99"}}, OracleError, "'fork' has the id 'o99', which is not in the scene"),
        ({"ask": lambda question, situation: "perhaps"}, OracleError, "must be one of its answers, got 'perhaps'"),
    ],
)
def test_bad_options_are_refused(options: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        package.ground(SCRIPT1, SCENE, **({"sizes": False} | options))


def test_the_command_refuses_questions_under_another_engine(truth_file: Path) -> None:
    code, _, err = deixis("ground", SCRIPT1, SCENE, "--oracle", truth_file, "--engine", "scalable")
    assert (code, "leave out --engine" in err) == (2, True)


def test_graph_closure_and_relations_are_computed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    import deixis.reasoning.geometry.rectangle as rectangle
    import deixis.workflows.grounding.ground as module

    closures, scenes, related = [], [], rectangle.scene_relations

    class Counted(Implications):
        def __init__(self, *arguments: Any) -> None:
            closures.append(arguments)
            super().__init__(*arguments)

    def counted(*arguments: Any, **options: Any) -> rectangle.SceneRelations:
        scenes.append(arguments)
        return related(*arguments, **options)

    package.ground(SCRIPT1, SCENE)  # whatever is compiled first
    monkeypatch.setattr(module, "Implications", Counted)
    monkeypatch.setattr("deixis.reasoning.grounding.engines.similarity.Implications", Counted)
    monkeypatch.setattr("deixis.reasoning.grounding.questions.situation.Implications", Counted)
    monkeypatch.setattr(rectangle, "scene_relations", counted)
    monkeypatch.setattr("deixis.reasoning.grounding.evidence.evidence.scene_relations", counted)
    script, scene = package.read_script(SCRIPT1), read_scene(SCENE)
    answer(GroundingRequest(script, scene, ask=TRUTH))
    of_the_whole = [arguments for arguments in closures if arguments[0].nodes == script.objects]
    assert [arguments[0] is script.graph() for arguments in of_the_whole].count(True) == 1
    assert len(scenes) == len(STATED_SIDES)  # once as seen from each side
    answer(GroundingRequest(script, Scene(scene.objects[:5])))
    assert len(scenes) == 2 * len(STATED_SIDES)


def test_a_scene_in_centimetres_without_its_unit_is_noted() -> None:
    script = package.read_script(text="plate left of cup; fork left of plate")
    boxes = {"o1": [30, 0, 57, 27], "o2": [0, 0, 3, 20], "o3": [70, 0, 80, 10]}
    objects = [{"id": name, "min": box[:2], "max": box[2:]} for name, box in boxes.items()]
    assert any('add "unit": "cm" to the scene' in note for note in package.ground(script, {"objects": objects}).notes)
    assert not any("unit" in note for note in package.ground(script, {"objects": objects, "unit": "cm"}).notes)


@pytest.mark.parametrize(("viewpoint", "cup"), [([0.6, -2], "west"), ([0.6, 2.1], "east")])
def test_left_is_as_the_placed_viewer_sees_it(viewpoint: list[float], cup: str) -> None:
    boxes = (("west", 0.0, "cup"), ("plate", 0.5, "plate"), ("east", 1.0, "cup"))
    objects = [{"id": i, "min": [x, 0, 0], "max": [x + 0.2, 0.2, 0.1], "label": label} for i, x, label in boxes]
    scene = read_scene({"viewpoint": viewpoint, "objects": objects})
    assert assert_grounds("cup left of plate", scene, {"cup": cup}).scene == scene


def test_toys_in_a_text_need_not_have_usual_sizes(tmp_path: Path) -> None:
    text = tmp_path / "shelf.txt"
    text.write_text("The toy train is left of the doll. The toy car is right of the doll. The toy boat is behind it.\n")
    boxes = {"a": (10, 10), "b": (30, 10), "c": (50, 10), "d": (30, 30)}
    things = [{"id": i, "min": [x, y, 0], "max": [x + 9, y + 5, 6]} for i, (x, y) in boxes.items()]
    scene = {"frame": "table", "viewpoint": "front", "unit": "cm", "objects": things}
    found = package.ground(text, scene).matches
    assert {name: match.perceived for name, match in found.items()} == {
        "toy_train": "a", "doll": "b", "toy_car": "c", "toy_boat": "d"
    }  # fmt: skip
