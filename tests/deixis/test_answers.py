"""Renderings of answers: short texts, plain data, tables, notebooks and pictures."""

from __future__ import annotations

import copy
import inspect
import json
import pickle
from dataclasses import replace
from typing import get_type_hints

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.patches import Rectangle

import deixis
from deixis.answers import Answer, share
from deixis.errors import DeixisError
from deixis.extras import MissingExtraError
from deixis.perception.simulator.laying import truth_scene
from deixis.perception.tracking.situation import TrackedThing
from deixis.plots.figure import BELONGS
from deixis.report.renderers import RENDERERS, to_rows
from deixis.workflows.layouts.lay_table import lay_script

SCRIPT = deixis.read_script("examples/formal_dinner.layout")
SCENE = deixis.read_scene("examples/place_setting.scene.json")
DESCRIPTION = json.dumps({"text": "the bin near the door", "scene": "examples/study.scene.json", "target": "o14"})
PNG = b"\x89PNG"


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Answer]:
    """One answer of each type that needs no views."""
    found = deixis.ground(SCRIPT, SCENE)
    with deixis.Session(memory=tmp_path_factory.mktemp("answers") / "memory") as session:
        learned = session.learn(SCRIPT, SCENE)
        words, meaning = session.learn_relations(), session.meaning()
        concept, layout = session.concept("formal_dinner"), session.layouts()[0]
    with deixis.Robot(tmp_path_factory.mktemp("robot") / "memory") as robot:
        robot.sees(truth_scene(lay_script(SCRIPT, seed=7).table), at=0.0)
        told, look = robot.told(SCRIPT, at=1.0), robot.look()
        assert repr(robot) == "<Robot: 12 things in view, 1 layout known>"
        assert repr(robot.layouts["formal_dinner"]) == "<LearnedLayout 'formal_dinner': 12 roles, 1 table>"
    box, cloud = np.array([[0.0, 0.0, 0.0], [0.1, 0.1, 0.1]]), deixis.PointCloud(np.zeros((1, 3), np.float32))
    oriented = deixis.OrientedBox((0.05, 0.05, 0.05), 0.0, (0.1, 0.1, 0.1))
    thing = TrackedThing("t1", box, oriented, cloud, np.eye(4), 1.0, 0.0, 0.0, 0.1, "seen", moving=False)
    return {
        "Meaning": meaning,
        "Told": told,
        "Look": look,
        "Learned": learned,
        "LearnedWords": words,
        "CountedConcept": concept,
        "LayoutConcept": layout,
        "Reference": deixis.refer("the bin near the door", "examples/study.scene.json"),
        "Script": SCRIPT,
        "Scene": SCENE,
        "Grounding": found,
        "Match": found.matches["napkin"],
        "Check": deixis.check(SCRIPT, "examples/second_table.scene.json"),
        "Inference": deixis.infer(SCRIPT),
        "Imagination": deixis.imagine(SCRIPT),
        "Retrieval": deixis.retrieve(SCENE, "examples"),
        "Lint": deixis.lint("examples/contradiction.layout"),
        "Telling": deixis.tell(SCRIPT),
        "Simulation": deixis.simulate(SCRIPT, seed=7),
        "ReadText": deixis.read(text="The fork is left of the plate. If there is soup, the spoon is on the plate."),
        "Solved": deixis.solve("examples/closed_but_inconsistent.csp", calculus="allen"),
        "SolvedNetwork": deixis.solve("examples/place_setting.csp", calculus="ra", closure=True).networks[0],
        "Entailment": deixis.reason("ontology/deixis.ttl", "rl"),
        "ShapesReport": deixis.validate("ontology/deixis.ttl"),
        "Chronology": deixis.chronology("examples/serving.fluents.json"),
        "Related": deixis.relate(SCENE, "cd"),
        "Consolidation": deixis.Consolidation({"dinner": "dinner-1"}, {"walk": "nothing was said in it"}),
        "LearnedReference": deixis.learn_reference([DESCRIPTION], strength=0.3),
        "Tracking": deixis.Tracking((thing,), (thing,), frames=2, seconds=0.1),
    }


OF_EXPERIMENTS = {"Apprentice", "Figure6", "OpenEnded", "Scoreboard"}
"""Answers of the functions ``deixis.experiments.*.run``, which the package does not export."""


def test_public_types_are_importable_and_have_renderers() -> None:
    for name in RENDERERS.keys() - OF_EXPERIMENTS:
        assert issubclass(getattr(deixis, name), Answer)
    assert get_type_hints(Answer.to_text) == {"return": str}


def test_repr_and_str_are_one_short_line(answers: dict[str, Answer]) -> None:
    for name, answer in answers.items():
        assert len(repr(answer)) < 160
        assert repr(answer).startswith(f"<{name} ")
        assert str(answer).startswith(f"{name} ")
        assert "\n" not in repr(answer)


def test_answers_can_be_copied_and_pickled(answers: dict[str, Answer]) -> None:
    for name, answer in answers.items():
        for copied in (copy.copy(answer), copy.deepcopy(answer), pickle.loads(pickle.dumps(answer))):
            assert (repr(copied), copied.to_dict()) == (repr(answer), answer.to_dict()), name


def test_answers_are_compared_without_an_error(answers: dict[str, Answer]) -> None:
    for answer in answers.values():
        assert answer == answer
        assert isinstance(copy.deepcopy(answer) == answer, bool)


def test_a_copied_grounding_cannot_be_changed(answers: dict[str, Answer]) -> None:
    copied = copy.deepcopy(answers["Grounding"])
    with pytest.raises(TypeError):
        copied.matches["napkin"] = None  # type: ignore[attr-defined]


def test_the_repr_of_an_answer_about_two_lines_is_one() -> None:
    scene = deixis.Scene.from_boxes([[0, 0]], [[1, 1]], labels=["cup"])
    assert "\n" not in repr(deixis.refer("the\ncup", scene)) + str(deixis.refer("the\ncup", scene))


def test_plain_data_is_json(answers: dict[str, Answer]) -> None:
    for answer in answers.values():
        assert json.loads(answer.to_json()) == json.loads(json.dumps(answer.to_dict()))
        assert "\n" not in answer.to_json(indent=None)


def test_text_is_what_the_command_prints(answers: dict[str, Answer]) -> None:
    assert answers["Grounding"].to_text().splitlines()[0].split()[:2] == ["napkin", "o2"]
    assert answers["Look"].to_text().startswith("This table is laid as 'formal_dinner' says, probability 1.00.")
    assert answers["Check"].to_text().startswith("This table is not laid as 'formal_dinner' says.")


def test_tables_have_a_row_for_each_thing(answers: dict[str, Answer]) -> None:
    rows = {name: to_rows(answer) for name, answer in answers.items() if name != "Match"}
    assert [row["perceived"] for row in rows["Grounding"]] == [
        match.perceived for match in deixis.ground(SCRIPT, SCENE).matches.values()
    ]
    assert len(rows["Script"]) == len(SCRIPT.facts)
    assert len(rows["Scene"]) == len(rows["Imagination"]) == len(rows["Learned"]) == 12
    assert len(rows["Look"]) == len(rows["Told"]) == len(rows["Simulation"]) == 12
    assert [row["state"] for row in rows["Tracking"]] == ["seen", "gone"]
    assert len(rows["LayoutConcept"]) == len(rows["CountedConcept"]) == len(SCRIPT.facts)
    assert {row["verdict"] for row in rows["Check"]} == {"correct", "missing", "misplaced", "extra"}
    assert [row["condition"] for row in rows["ReadText"]] == [None, "if there is soup"]
    assert [row["verdict"] for row in rows["Solved"]] == ["inconsistent"]
    assert {row["calculus"] for row in rows["SolvedNetwork"]} == {"ra"}
    assert len(rows["Related"]) == 12 * 11
    assert [row["start_to"] for row in rows["Chronology"]][:2] == [5.0, 30.0]
    assert len(rows["Entailment"]) == len(answers["Entailment"].to_dict()["inferred"])
    assert rows.pop("ShapesReport") == []
    assert all(len(set(map(tuple, table))) >= 1 for table in rows.values())


def test_data_frames_have_the_same_rows(answers: dict[str, Answer]) -> None:
    pandas = pytest.importorskip("pandas")
    frame = answers["Grounding"].to_dataframe()
    assert isinstance(frame, pandas.DataFrame)
    assert list(frame["object"]) == [row["object"] for row in to_rows(answers["Grounding"])]


def test_pandas_is_named_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(MissingExtraError, match="pip install pandas"):
        SCENE.to_dataframe()


def test_a_probability_below_1_is_not_shown_as_1(answers: dict[str, Answer]) -> None:
    grounding = answers["Grounding"]
    assert isinstance(grounding, deixis.Grounding)
    match = grounding.matches["napkin"]
    assert match.probability is not None and 0.9995 < match.probability < 1
    assert str(match) == "Match napkin is o2, probability 0.999"
    assert "<td style='text-align:left'>0.999</td>" in (grounding._repr_html_() or "")


def test_notebooks_show_tables_and_escape_names() -> None:
    script = deixis.read_script(text='"<b>" left of plate')
    shown = script._repr_html_()
    assert "<table>" in shown
    assert "<b>Script</b>" in shown
    assert "<td style='text-align:left'><b>" not in shown


def test_pictures_go_into_given_axes(answers: dict[str, Answer]) -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure

    figure = Figure()
    left, right = figure.subplots(1, 2)
    assert answers["Grounding"].plot(left) is figure
    assert answers["Check"].plot(right) is figure
    assert left.collections and right.collections
    assert not answers["Scene"].plot().axes[0].get_title()


def test_pictures_are_png_in_notebooks(answers: dict[str, Answer]) -> None:
    pytest.importorskip("matplotlib")
    for name, renderer in RENDERERS.items():
        if renderer.figure is None or name not in answers:
            continue
        shown = answers[name]._repr_png_()
        assert shown is not None
        assert shown.startswith(PNG)
    assert answers["Script"]._repr_png_() is None


def test_a_decided_object_is_coloured_in_its_scene(answers: dict[str, Answer]) -> None:
    axes = answers["Reference"].plot().axes[0]
    assert axes.get_title(loc="left") == "“the bin near the door”"
    assert "bin (o15) 0.98" in [text.get_text() for text in axes.texts]
    assert list(to_rgb(BELONGS)) in np.asarray(axes.collections[0].get_facecolor())[:, :3].tolist()


def test_times_without_an_end_reach_the_edge_of_the_chart(answers: dict[str, Answer]) -> None:
    axes = answers["Chronology"].plot().axes[0]
    ends = [bar.get_x() + bar.get_width() for bar in axes.patches if isinstance(bar, Rectangle)]
    assert max(ends) == pytest.approx(axes.get_xlim()[1])
    assert axes.get_yticklabels()[0].get_text() == "fetch: fetches(robot, cup)"


def test_answers_with_nothing_to_draw_say_so() -> None:
    nothing = deixis.refer("the bin", deixis.read_scene({"objects": []}))
    none = deixis.retrieve(SCENE, "examples", least=1.0)
    for answer in (nothing, deixis.Tracking(), replace(none, found=())):
        with pytest.raises(DeixisError, match="to draw; to_text"):
            answer.plot()
        assert answer._repr_png_() is None


def test_an_answer_without_a_picture_says_so() -> None:
    with pytest.raises(DeixisError, match="a Script has no picture"):
        SCRIPT.plot()


def test_a_script_given_as_a_file_name_is_explained() -> None:
    with pytest.raises(DeixisError, match="if 'fork left of plate' is the script itself, pass it as text="):
        deixis.read_script("fork left of plate")


@pytest.mark.parametrize(
    ("part", "total", "words"),
    [
        (1, 1, "the only name"),
        (2, 2, "both names"),
        (7, 7, "all 7 names"),
        (0, 2, "neither name"),
        (0, 7, "none of 7 names"),
    ],
)
def test_shares_are_said_in_words(part: int, total: int, words: str) -> None:
    assert share(part, total, "name") == words


def test_exported_functions_return_exported_answers() -> None:
    functions = [member for name in deixis.__all__ if inspect.isfunction(member := getattr(deixis, name))]
    returned = {inspect.signature(function).return_annotation for function in functions}
    assert all(issubclass(getattr(deixis, name), Answer) for name in returned - {"str"})


def test_one_of_a_kind_is_said_in_the_singular(answers: dict[str, Answer]) -> None:
    concept = answers["CountedConcept"]
    assert isinstance(concept, deixis.CountedConcept)
    assert next(concept.lines()) == "1 table: formal_dinner-1"
    assert deixis.Tracking(frames=1).to_text().endswith("1 frame used, 0.00 s.")
