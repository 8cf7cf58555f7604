"""Descriptions of objects in a study, and bad input."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from source_tree import ROOT

import deixis
from deixis.perception.errors import SceneError
from deixis.perception.formats.scene_json import scene_to_dict
from deixis.reasoning.errors import DescriptionError
from deixis.reasoning.grounding.reference.answer import Question
from deixis.workflows.descriptions.refer import refer_batch

STUDY = ROOT / "examples" / "study.scene.json"


@pytest.fixture(scope="module")
def study() -> deixis.Scene:
    return deixis.read_scene(STUDY)


@pytest.mark.parametrize(
    ("text", "target"),
    [
        ("the chair to the left of the desk with the monitor", "o7"),
        ("the lamp on the desk", "o12"),
        ("the tall lamp", "o13"),
        ("the red chair", "o10"),
        ("the bin closest to the door", "o15"),
        ("the bin farthest from the door", "o14"),
        ("the chair in front of the desk with the lamp", "o9"),
        ("facing the window, the desk on the right", "o5"),
        ("facing the window, the desk on the left", "o4"),
        ("the chair between the two desks", "o8"),
        ("the couch", "o11"),
        ("the trash can near the couch", "o15"),
        ("The lamp is next to the sofa. It is not on a desk.", "o13"),
        ("There is a desk with a lamp. It is the chair in front of it.", "o9"),
        ("Of the two bins, the one closest to the door.", "o15"),
        ("There is no monitor on this desk.", "o5"),
        ("the desk without a monitor", "o5"),
        ("the bin farthest from the door, not the one near the door", "o14"),
        ("the bin that is not the one closest to the door", "o14"),
    ],
)
def test_people_mean_the_object_that_fits_best(study: deixis.Scene, text: str, target: str) -> None:
    assert deixis.refer(text, study).target == target


def test_probabilities_are_a_distribution(study: deixis.Scene) -> None:
    found = deixis.refer("the chair by the window", study)
    shares = [found.probability, *(share for _, share in found.alternatives)]
    assert sum(shares) == pytest.approx(1.0, abs=0.02)
    assert shares == sorted(shares, reverse=True)


@pytest.mark.parametrize("turn", [((0, 1), (-1, 0)), ((-1, 0), (0, -1))], ids=["quarter", "half"])
def test_a_turned_room_with_unknown_viewer_means_the_same(
    study: deixis.Scene, turn: tuple[tuple[int, int], ...]
) -> None:
    things = []
    for thing in study.objects:
        corners = np.array([thing.minimum[:2], thing.maximum[:2]]) @ turn
        low, high = (*corners.min(axis=0), thing.minimum[2]), (*corners.max(axis=0), thing.maximum[2])
        x, y = np.array(thing.front or (0.0, 0.0)) @ turn
        front = None if thing.front is None else (float(x), float(y))
        things.append(deixis.PerceivedObject(thing.id, low, high, thing.label, colour=thing.colour, front=front))
    turned = deixis.Scene(tuple(things), viewpoint="unknown")
    text = "the chair to the left of the desk with the monitor"
    assert deixis.refer(text, turned).probability == pytest.approx(deixis.refer(text, study).probability, abs=1e-3)


def test_left_is_that_of_a_known_viewer() -> None:
    seen = deixis.Scene.from_boxes(
        centre=np.array([[0, 0, 0], [1, 0, 0]]), size=[[0.1, 0.1, 0.1]] * 2, labels=["cup", "cup"]
    )
    found = deixis.refer("the cup on the left", seen)
    assert (found.target, found.frame) == ("o1", "viewer")
    unknown = deixis.refer("the cup on the left", replace(seen, viewpoint="unknown"))
    assert unknown.probability < found.probability


@pytest.mark.parametrize("oracle", ["o7", "o8", "o9", "o10"])
def test_an_oracle_leads_to_any_object(study: deixis.Scene, oracle: str) -> None:
    found = deixis.refer("the chair", study, oracle=oracle)
    assert found.target == oracle and found.decided
    assert 1 <= len(found.turns) <= 4


def test_a_dialogue_ends_without_an_answer(study: deixis.Scene) -> None:
    asked: list[Question] = []

    def answer(question: Question) -> None:
        asked.append(question)

    found = deixis.refer("the chair", study, ask=answer)
    assert len(asked) == 1 and found.turns == () and not found.decided
    assert found.question == asked[0]


def test_hidden_labels_leave_sizes(study: deixis.Scene) -> None:
    bare = study.without_labels()
    found = deixis.refer("the tall lamp", bare)
    assert found.probability < 0.95
    assert deixis.refer("the sofa", bare).probability > 1 / len(bare.objects)


def test_an_empty_scene_has_no_target() -> None:
    found = deixis.refer("the chair", deixis.Scene(()))
    assert (found.target, found.probability, found.decided) == (None, 0.0, False)


@pytest.mark.parametrize("text", ["", "  \n", "?!", "x" * 6000], ids=["empty", "blank", "signs", "long"])
def test_texts_that_describe_nothing_are_refused(study: deixis.Scene, text: str) -> None:
    with pytest.raises(DescriptionError):
        deixis.refer(text, study)


@pytest.mark.parametrize(
    "text", ["der rote Stuhl neben dem Tisch", "la silla roja", "the grommit near the frobble", "椅子"]
)
def test_texts_without_a_known_noun_are_refused(study: deixis.Scene, text: str) -> None:
    with pytest.raises(DescriptionError):
        deixis.refer(text, study)


def test_a_label_of_the_scene_is_a_known_noun(study: deixis.Scene) -> None:
    labelled = replace(study, objects=(replace(study.objects[0], label="grommit"), *study.objects[1:]))
    assert deixis.refer("the grommit", labelled).target == study.objects[0].id


def test_an_unknown_oracle_is_refused(study: deixis.Scene) -> None:
    with pytest.raises(DescriptionError, match="`oracle` must be an object of the scene, got 'o99'; there are: o1, o2"):
        deixis.refer("the chair", study, oracle="o99")


def test_a_missing_scene_is_an_error() -> None:
    with pytest.raises(SceneError, match="no such file"):
        deixis.refer("the chair", "missing.scene.json")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("nonsense", "line 1: not JSON"),
        ("[]", "line 1: a line must be an object with the texts 'text' and 'scene'"),
        ('{"text": "the bin"}', "a line must be an object with the texts 'text' and 'scene'"),
        ('{"text": "the bin", "scene": "none.json"}', "none.json: there is no such file"),
        ('{"text": " ", "scene": "study.scene.json"}', "got a blank text"),
        ('{"text": "the bin", "scene": "study.scene.json", "image": 1}', "'image' is not a key of a line"),
    ],
)
def test_a_bad_line_of_a_batch_is_an_error_answer(line: str, said: str) -> None:
    good = json.dumps({"text": "the sofa", "scene": "study.scene.json"})
    first, second = refer_batch([line, good], STUDY.parent)
    assert said in first["error"]
    assert second["target"] == "o11"


def test_a_batch_may_answer_its_questions(tmp_path: Path) -> None:
    line = json.dumps({"text": "the bin", "scene": str(STUDY), "oracle": "o14"})
    (found,) = refer_batch([line, "\n"], tmp_path)
    assert found["target"] == "o14" and found["questions"]


@pytest.fixture(scope="module")
def across() -> deixis.Scene:
    """Return six blocks between the speaker, at the near side, and the addressee, at the far side."""
    low = np.array([(x, y) for y in (0.0, 0.2) for x in (0.0, 0.3, 0.6)])
    scene = deixis.Scene.from_boxes(low, low + 0.05, labels=["block"] * 6, viewpoint="unknown")
    colours = [(220, 30, 30), (30, 60, 210), (220, 30, 30)] * 2
    objects = tuple(replace(one, colour=colour) for one, colour in zip(scene.objects, colours, strict=True))
    return replace(scene, objects=objects, speaker=(0.3, -1.0), addressee=(0.3, 1.2))


@pytest.mark.parametrize(
    ("text", "target"),
    [
        ("Pick up the blue block closest to me.", "o2"),
        ("Pick up the blue block closest to you.", "o5"),
        ("the blue block farthest from you", "o2"),
        ("the red block closest to you on your left", "o6"),
        ("the red block closest to you on my left", "o4"),
        ("the red block closest to me on the left side of the table, from your point of view", "o3"),
        ("the second closest blue block to me", "o5"),
    ],
)
def test_people_across_a_table_see_it_from_two_sides(across: deixis.Scene, text: str, target: str) -> None:
    assert deixis.refer(text, across).target == target


def test_a_scene_keeps_the_places_of_people(across: deixis.Scene) -> None:
    again = deixis.read_scene(scene_to_dict(across))
    assert (again.speaker, again.addressee) == ((0.3, -1.0), (0.3, 1.2))


def test_without_known_people_both_are_the_viewer(across: deixis.Scene) -> None:
    alone = replace(across, viewpoint="chair", speaker=None, addressee=None)
    assert deixis.refer("the blue block closest to you", alone).target == "o2"
    assert deixis.refer("the blue block closest to me", alone).target == "o2"


def test_on_a_flat_scene_the_top_is_the_far_side(across: deixis.Scene) -> None:
    alone = replace(across, viewpoint="chair", speaker=None, addressee=None)
    assert deixis.refer("the blue block at the top", alone).target == "o5"
    assert deixis.refer("the lowest blue block", alone).target == "o2"


@pytest.fixture(scope="module")
def table() -> deixis.Scene:
    return deixis.read_scene(ROOT / "examples" / "place_setting.scene.json")


def labelled(scene: deixis.Scene, labels: Mapping[str, str]) -> deixis.Scene:
    """Return a scene with labels for some of its objects."""
    things = tuple(replace(one, label=labels.get(one.id)) for one in scene.objects)
    return replace(scene, objects=things)


@pytest.fixture(scope="module")
def partly(table: deixis.Scene) -> deixis.Scene:
    return labelled(table, {"o2": "bowl", "o8": "plate"})


@pytest.mark.parametrize("text", ["the teacup", "the cup", "the saucer", "the mug on the tray"])
def test_objects_without_labels_may_be_what_a_noun_names(partly: deixis.Scene, text: str) -> None:
    found = deixis.refer(text, partly)
    shares = dict([(found.target or "", found.probability), *found.alternatives])
    assert not found.decided and len(found.alternatives) > 5
    assert shares.get("o2", 0.0) + shares.get("o8", 0.0) < 0.25


@pytest.mark.parametrize(("text", "target"), [("the bowl", "o2"), ("the plate", "o8"), ("the dish", "o8")])
def test_a_fitting_label_outweighs_missing_ones(partly: deixis.Scene, text: str, target: str) -> None:
    found = deixis.refer(text, partly)
    assert found.target == target and 0.5 < found.probability < 0.95


def test_a_synonym_counts_as_much_as_the_label_itself(table: deixis.Scene) -> None:
    scene = labelled(table, {"o8": "sofa"})
    assert deixis.refer("the couch", scene).target == "o8"
    assert deixis.refer("the couch", scene).probability == pytest.approx(
        deixis.refer("the sofa", scene).probability, abs=0.15
    )


@pytest.mark.parametrize("labels", [{}, {"o2": "bowl", "o8": "plate"}, {f"o{place}": "" for place in range(1, 13)}])
@pytest.mark.parametrize(
    ("text", "targets"),
    [
        ("the leftmost object", {"o3", "o4"}),
        ("the smallest thing", {"o3"}),
        ("the largest object", {"o8"}),
        ("the object on the far left", {"o3", "o4"}),
        ("the rightmost item", {"o5"}),
    ],
)
def test_any_object_is_compared_with_all_objects(
    table: deixis.Scene, labels: dict[str, str], text: str, targets: set[str]
) -> None:
    scene = labelled(table, {name: label or f"kind{name}" for name, label in labels.items()})
    found = deixis.refer(text, scene)
    assert found.target in targets and found.probability > 2 / len(scene.objects)


def test_a_landmark_may_be_the_largest_object(table: deixis.Scene) -> None:
    scene = labelled(table, {one.id: "cup" if one.id in {"o11", "o4"} else one.id for one in table.objects})
    assert deixis.refer("the cup next to the largest object", scene).target == "o11"


def test_candidates_are_evidence_of_the_class(partly: deixis.Scene) -> None:
    things = (
        replace(one, candidates=(("mug", 0.7), ("glass", 0.2))) if one.id == "o12" else one for one in partly.objects
    )
    scene = replace(partly, objects=tuple(things))
    mug, glass, fork = (deixis.refer(f"the {noun}", scene) for noun in ("mug", "glass", "fork"))
    assert (mug.target, glass.target) == ("o12", "o12")
    assert mug.probability > glass.probability > deixis.refer("the glass", partly).probability
    assert fork.target != "o12"


def test_an_unlabelled_thing_of_their_size_competes_with_cups() -> None:
    places, sides = np.arange(7) * 0.5, [0.1, 0.1, 0.1, 0.1, 0.4, 0.4, 0.4]
    labels = [None, "cup", "cup", "cup", "bin", "bin", None]
    scene = deixis.Scene.from_boxes(
        centre=np.column_stack([places, 0 * places, 0 * places]), size=np.repeat(sides, 3).reshape(-1, 3), labels=labels
    )
    leftmost, rightmost = (deixis.refer(f"the {side} cup", scene) for side in ("leftmost", "rightmost"))
    assert (leftmost.target, rightmost.target) == ("o1", "o4")
    assert not leftmost.decided and leftmost.probability > 0.4
    assert rightmost.probability > 0.8


def cups(**settings: object) -> deixis.Scene:
    boxes = {"west": (0.0, "cup"), "plate": (0.5, "plate"), "east": (1.0, "cup")}
    objects = [
        {"id": name, "min": [x, 0, 0], "max": [x + 0.2, 0.2, 0.1], "label": label} for name, (x, label) in boxes.items()
    ]
    return deixis.read_scene({"objects": objects, **settings})


@pytest.mark.parametrize(("viewpoint", "left"), [("chair", "west"), ([0.6, -2], "west"), ([0.6, 2.1], "east")])
def test_left_is_as_the_placed_viewer_sees_it(viewpoint: object, left: str) -> None:
    scene = cups(viewpoint=viewpoint)
    assert deixis.refer("the cup to the left of the plate", scene).target == left
    assert scene_to_dict(scene)["viewpoint"] == viewpoint
    assert deixis.read_scene(scene_to_dict(scene)) == scene


def test_a_doubtful_label_counts_less_than_a_certain_one() -> None:
    scene = cups()
    doubtful = replace(scene, objects=(replace(scene["west"], confidence=0.3), *scene.objects[1:]))
    assert deixis.refer("the cup", scene).probability == pytest.approx(0.5, abs=0.03)
    found = deixis.refer("the cup", doubtful)
    assert found.target == "east" and found.probability > 0.6
