"""Scenes: refused values, boxes and relation graphs."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deixis.errors import DeixisError
from deixis.ontology.tbox import default_ontology
from deixis.perception.errors import SceneError
from deixis.perception.formats.scene_json import read_scene, scene_text
from deixis.perception.scene import Heading, PerceivedObject, Scene

R = default_ontology().relations

FORK = PerceivedObject("fork", (0.0, 0.0), (0.02, 0.2), label="fork", confidence=0.8)
PLATE = PerceivedObject("plate", (0.05, -0.02), (0.32, 0.25), label="plate")


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("id", 3),
        ("minimum", 0.0),
        ("maximum", None),
        ("label", 3),
        ("confidence", "high"),
        ("oriented", (0, 0, 0)),
        ("candidates", ["cup"]),
        ("front", 1.0),
        ("heading", "left"),
    ],
)
def test_a_field_of_an_object_with_a_wrong_type_is_named(name: str, value: object) -> None:
    fields: dict[str, Any] = {"id": "o1", "minimum": (0.0, 0.0), "maximum": (2.0, 1.0), name: value}
    with pytest.raises(DeixisError, match=f"`{name}` must be"):
        Scene((PerceivedObject(**fields),))


@pytest.mark.parametrize("objects", [None, iter(()), "o1", [3], {"o1": 1}])
def test_objects_of_a_scene_are_a_tuple_of_objects(objects: Any) -> None:
    with pytest.raises(DeixisError, match="`objects` must be a list of PerceivedObjects"):
        Scene(objects)


def test_bad_orders_angles_and_numbers_are_refused() -> None:
    scene = Scene((PerceivedObject("o1", (0.0, 0.0), (2.0, 1.0)),))
    with pytest.raises(SceneError, match="`order` must have positions of the 1 objects"):
        scene.reordered([1])
    with pytest.raises(SceneError, match="`angle` must be a finite number"):
        scene.turned(math.inf)
    with pytest.raises(SceneError, match="`min` must be an array of numbers"):
        Scene.from_boxes([[10**400, 0]], [[1, 1]])


def test_an_unknown_id_is_reported_with_the_known_ones() -> None:
    scene = Scene((PerceivedObject("o1", (0.0, 0.0), (2.0, 1.0)),))
    for lookup in (scene.__getitem__, scene.cloud_of):
        with pytest.raises(SceneError, match="there is no object 'o9'; there are: o1"):
            lookup("o9")


def test_the_boxes_are_one_array() -> None:
    boxes = Scene((FORK, PLATE)).boxes
    assert boxes.shape == (2, 2, 2)
    np.testing.assert_array_equal(boxes[0], [[0, 0], [0.02, 0.2]])


def test_an_empty_scene_has_no_boxes_and_no_relations() -> None:
    assert Scene(()).boxes.shape == (0, 2, 2)
    assert len(Scene(()).graph(R)) == 0


def test_objects_are_found_by_id() -> None:
    scene = Scene((FORK, PLATE))
    assert scene.ids == ("fork", "plate")
    assert scene["plate"] is PLATE


def test_the_graph_names_every_ordered_pair() -> None:
    graph = Scene((FORK, PLATE)).graph(R)
    assert [str(fact) for fact in graph.facts()] == ["exactly_left(fork, plate)", "exactly_right(plate, fork)"]


def test_the_tolerance_reaches_the_graph() -> None:
    """Check that a fork that overlaps the plate by a millimetre is top left of it at a tolerance of a centimetre."""
    scene = Scene((PerceivedObject("fork", (0.0, 0.249), (0.051, 0.5)), PLATE))
    names = [str(next(scene.graph(R, tolerance).facts())) for tolerance in (0.0, 0.01)]
    assert names == ["exactly_top(fork, plate)", "exactly_top_left(fork, plate)"]


def test_without_labels_only_the_names_are_gone() -> None:
    plain = Scene((FORK, PLATE), frame="tray").without_labels()
    assert [(thing.label, thing.confidence) for thing in plain.objects] == [(None, 1.0)] * 2
    assert plain.frame == "tray"
    np.testing.assert_array_equal(plain.boxes, Scene((FORK, PLATE)).boxes)


def test_a_reordered_scene_lists_its_objects_in_that_order() -> None:
    assert Scene((FORK, PLATE)).reordered([1, 0]).objects == (PLATE, FORK)


def test_scenes_from_different_files_may_be_equal() -> None:
    assert Scene((FORK,), file="a") == Scene((FORK,), file="b")
    assert Scene((FORK,), viewpoint="door") != Scene((FORK,))


@pytest.mark.parametrize(
    ("minimum", "maximum", "message"),
    [
        ((0.0, math.nan), (1.0, 1.0), "must be finite"),
        ((0.0, 0.0), (math.inf, 1.0), "must be finite"),
        ((0.0,), (1.0,), "2 coordinates, or both 3"),
        ((0.0, 0.0), (1.0, 1.0, 1.0), "2 coordinates, or both 3"),
        ((0.0, 2.0), (1.0, 1.0), "on y its min 2 is above its max 1"),
    ],
)
def test_an_invalid_box_is_refused(minimum: tuple[float, ...], maximum: tuple[float, ...], message: str) -> None:
    with pytest.raises(SceneError, match=message):
        Scene((PerceivedObject("o", minimum, maximum),))


@pytest.mark.parametrize("confidence", [-0.5, 1.01, math.nan])
def test_a_confidence_must_be_a_probability(confidence: float) -> None:
    with pytest.raises(SceneError, match="must be from 0 to 1"):
        Scene((PerceivedObject("o", (0.0, 0.0), (1.0, 1.0), label="x", confidence=confidence),))


def test_a_point_is_a_box() -> None:
    assert Scene((PerceivedObject("o", (1.0, 1.0), (1.0, 1.0)),)).ids == ("o",)


def test_two_objects_of_one_id_are_refused() -> None:
    with pytest.raises(SceneError, match="the id 'fork' is used twice"):
        Scene((FORK, FORK))


@pytest.mark.parametrize(
    ("id", "corner", "message"),
    [("a\n\x1b[31mred", 1.0, "control character"), ("a", 1e12, "beyond 1e\\+09; check the unit")],
)
def test_control_characters_and_huge_coordinates_are_refused(id: str, corner: float, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        Scene((PerceivedObject(id, (0.0, 0.0), (corner, 1.0)),))


def test_relations_of_equal_boxes_do_not_depend_on_their_order() -> None:
    relations = default_ontology().relations
    things = [PerceivedObject(id, (0.0, 0.0), (1.0, 1.0)) for id in ("b", "a")]
    facts = [{str(fact) for fact in Scene(tuple(order)).graph(relations).facts()} for order in (things, things[::-1])]
    assert facts[0] == facts[1] == {"exactly_on(b, a)", "exactly_under(a, b)"}


def test_fronts_are_unit_vectors_and_nan_where_unknown() -> None:
    chair = PerceivedObject("chair", (0.0, 0.0), (0.5, 0.5), front=(0.0, -2.0))
    np.testing.assert_array_equal(Scene((chair, PLATE)).fronts, [[0, -1], [np.nan, np.nan]])


@pytest.mark.parametrize("front", [(0.0, 0.0), (math.inf, 1.0), (1.0,)])
def test_a_front_without_a_direction_is_refused(front: tuple[float, ...]) -> None:
    chair = PerceivedObject("chair", (0.0, 0.0), (0.5, 0.5), front=front)  # type: ignore[arg-type]
    with pytest.raises(SceneError, match="object 'chair': 'front' must be a direction of 2 finite numbers"):
        Scene((chair,))


def test_the_summary_says_that_the_side_is_unknown() -> None:
    assert Scene((FORK,), viewpoint="unknown").summary().endswith("seen from an unknown side")


def test_a_placed_viewer_turns_boxes_fronts_and_people() -> None:
    cup = PerceivedObject("cup", (0.0, 0.0), (1.0, 1.0), front=(1.0, 0.0))
    scene = Scene((cup, PerceivedObject("jug", (4.0, 0.0), (5.0, 1.0))), viewer=(9.0, 0.5), speaker=(9.0, 0.5))
    seen = scene.from_viewer()
    assert seen["cup"].minimum[1] > seen["jug"].minimum[1]  # the jug is nearer
    np.testing.assert_allclose(seen.fronts[0], (0.0, -1.0), atol=1e-12)
    assert seen.speaker == pytest.approx((0.5, -9.0), abs=1e-12)
    assert seen.viewer is None and scene["cup"] == cup


def test_a_viewer_in_the_middle_of_the_scene_is_refused() -> None:
    with pytest.raises(SceneError, match="beside the middle"):
        Scene((PerceivedObject("cup", (0.0, 0.0), (1.0, 1.0)),), viewer=(0.5, 0.5))


def heading(part: str, probability: float = 0.97) -> Scene:
    known = Heading(part, (0.0, 2.0), probability)
    return Scene((PerceivedObject("cup", (0.0, 0.0), (0.1, 0.1), heading=known),))


def test_measured_handle_is_the_front_of_a_thing_without_one() -> None:
    assert heading("handle").fronts.tolist() == [[0.0, 1.0]]
    assert np.isnan(heading("handle", 0.6).fronts).all()
    assert np.isnan(heading("head").fronts).all()
    assert heading("head").heads.tolist() == [[0.0, 1.0]]


def test_headings_turn_with_the_scene_and_are_written(tmp_path: Path) -> None:
    turned = heading("head").turned(np.pi / 2).objects[0].heading
    assert turned is not None and turned.direction == pytest.approx((-2.0, 0.0), abs=1e-9)
    file = tmp_path / "cup.scene.json"
    file.write_text(scene_text(heading("head")), encoding="utf-8")
    assert read_scene(file).objects == heading("head").objects


@pytest.mark.parametrize(
    "known", [Heading("foot", (1.0, 0.0)), Heading("head", (0.0, 0.0)), Heading("head", (1.0, 0.0), 2.0)]
)
def test_wrong_heading_is_refused(known: Heading) -> None:
    with pytest.raises(SceneError, match="heading"):
        Scene((PerceivedObject("cup", (0.0, 0.0), (0.1, 0.1), heading=known),))


@pytest.mark.parametrize(("unit", "scale"), [("m", 1.0), ("cm", 0.01), ("mm", 0.001), ("px", 1.0)])
def test_lengths_of_boxes_are_converted_to_metres(unit: str, scale: float) -> None:
    corners = Scene.from_boxes(min=[[10, 20]], max=[[30, 60]], unit=unit)
    centres = Scene.from_boxes(centre=[[20, 40]], size=[[20, 40]], yaw=0.0, unit=unit)
    for scene in (corners, centres):
        np.testing.assert_allclose(scene.boxes, scale * np.array([[[10, 20], [30, 60]]]))
        assert scene.unit == ("px" if unit == "px" else "m")


def test_an_unknown_unit_of_boxes_is_refused() -> None:
    with pytest.raises(SceneError, match=r"^`unit` must be one of m, cm, mm, px, got 'inch'$"):
        Scene.from_boxes(min=[[0, 0]], max=[[1, 1]], unit="inch")
    with pytest.raises(SceneError, match=r"`unit` of a Scene must be 'm' or 'px', got 'cm'; convert the boxes"):
        Scene((), unit="cm")
