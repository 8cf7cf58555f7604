"""COCO and LabelMe files as scenes with y upwards, compared with results by hand."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from annotated_images import COCO, LABELME, Json, coco, shape

from deixis.ontology.tbox import default_ontology
from deixis.perception.errors import SceneError
from deixis.perception.formats.scene_json import annotation_reader, read_scene, scene_text
from deixis.perception.scene import Scene

Box = tuple[float, float, float, float]


def boxes(scene: Scene) -> dict[str, tuple[str | None, Box]]:
    """Return the label and the ranges of x and y of each object by id."""
    return {
        thing.id: (thing.label, (thing.minimum[0], thing.maximum[0], thing.minimum[1], thing.maximum[1]))
        for thing in scene.objects
    }


def test_a_coco_image_is_a_scene_with_y_upwards() -> None:
    scene = read_scene(COCO, image="breakfast.jpg")
    assert boxes(scene) == {
        "o1": ("dinner plate", (200, 440, 100, 330)),
        "o2": ("fork", (100, 130, 130, 320)),
        "o3": (None, (300, 360, 399.5, 460)),
    }
    assert (scene.unit, scene.frame, scene.viewpoint) == ("px", "image", "chair")


def test_a_labelme_file_is_a_scene_with_y_upwards() -> None:
    scene = read_scene(LABELME)
    assert boxes(scene) == {
        "o1": ("plate", (50, 110, 20, 80)),
        "o2": ("fork", (20, 30, 20, 70)),
        "o3": ("knife", (120, 130, 20, 70)),
        "o4": ("chopsticks", (5, 16, 8, 80)),
        "o5": ("cup", (150, 170, 81, 99)),
    }
    assert scene["o5"].confidence == 0.5
    assert scene["o1"].confidence == 1.0


@pytest.mark.parametrize(("wanted", "ids"), [("dinner.jpg", 1), (2, 1), ("2", 1), (1, 3), ("breakfast.jpg", 3)])
def test_an_image_is_chosen_by_its_name_or_its_id(wanted: str | int, ids: int) -> None:
    assert len(read_scene(COCO, wanted).objects) == ids


def test_the_only_image_need_not_be_chosen() -> None:
    alone = {**COCO, "images": COCO["images"][:1], "annotations": COCO["annotations"][:1]}
    assert read_scene(alone).ids == ("o1",)


@pytest.mark.parametrize("wanted", ["photos/dinner.jpg", "dinner.jpg"])
def test_the_image_of_a_labelme_file_may_be_named(wanted: str) -> None:
    assert read_scene(LABELME, wanted) == read_scene(LABELME)


def name_of(scene: Scene, one: str, other: str) -> set[str]:
    relations = default_ontology().relations
    graph = scene.graph(relations)
    return {fact.relations[0].word for fact in graph.facts() if (fact.subject, fact.object) == (one, other)}


def test_an_object_higher_in_the_image_is_at_the_top() -> None:
    scene = read_scene(COCO, 1)
    assert name_of(scene, "o3", "o1") == {"top"}
    assert name_of(scene, "o1", "o3") == {"bottom"}
    assert name_of(scene, "o2", "o1") == {"left"}


def test_parts_of_one_object_give_one_box() -> None:
    parts = [[10, 10, 20, 10, 20, 20], [40, 30, 60, 30, 60, 50, 40, 50]]
    assert boxes(read_scene(coco(segmentation=parts)))["o1"] == ("fork", (10, 60, 430, 470))


def test_shapes_that_share_group_but_no_label_are_two_objects() -> None:
    shapes = [shape(label="cup", group_id=1), shape(label="saucer", group_id=1), shape(label="cup", group_id=2)]
    assert len(read_scene({**LABELME, "shapes": shapes}).objects) == 3


def test_without_the_height_the_lowest_outline_is_the_ground() -> None:
    unknown = {key: value for key, value in LABELME.items() if key != "imageHeight"}
    turned = read_scene(unknown)
    assert turned.boxes[:, 0, 1].min() == 0
    shift = read_scene(LABELME).boxes - turned.boxes
    assert shift[..., 0].tolist() == [[0, 0]] * 5
    assert shift[..., 1].tolist() == [[8, 8]] * 5


def test_a_run_length_encoded_mask_is_skipped_if_a_box_is_given() -> None:
    encoded = {"counts": "abc", "size": [480, 640]}
    assert boxes(read_scene(coco(segmentation=encoded, bbox=[1, 2, 3, 4])))["o1"][1] == (1, 4, 474, 478)


def test_a_score_is_the_confidence_of_the_label() -> None:
    assert read_scene(coco(bbox=[1, 2, 3, 4], score=0.25))["o1"].confidence == 0.25
    assert read_scene(coco(bbox=[1, 2, 3, 4], score=0.25, category_id=None))["o1"].confidence == 1


def test_only_the_chosen_image_is_read() -> None:
    spoilt = copy.deepcopy(COCO)
    spoilt["annotations"][1]["bbox"] = "none"
    assert len(read_scene(spoilt, 1).objects) == 3
    with pytest.raises(SceneError, match=r"annotations\[1\]: 'bbox' must be 4 numbers"):
        read_scene(spoilt, 2)


def test_an_image_with_crowds_alone_is_an_empty_scene() -> None:
    assert read_scene(coco(bbox=[1, 2, 3, 4], iscrowd=1)).ids == ()
    assert read_scene({**LABELME, "shapes": []}).ids == ()


@pytest.mark.parametrize("data", [COCO, LABELME], ids=["coco", "labelme"])
def test_an_annotated_image_survives_a_scene_file(data: Json, tmp_path: Path) -> None:
    source, written = tmp_path / "annotated.json", tmp_path / "written.scene.json"
    source.write_text(json.dumps(data), encoding="utf-8")
    scene = read_scene(source, image="dinner.jpg")
    written.write_text(scene_text(scene), encoding="utf-8")
    assert read_scene(written) == scene
    assert scene.file == str(source)


def test_labels_can_be_hidden() -> None:
    assert {thing.label for thing in read_scene(LABELME).without_labels().objects} == {None}


def test_a_format_is_recognised_by_its_content() -> None:
    def reader(data: Any) -> str | None:
        found: Callable[..., Scene] | None = annotation_reader(data)
        return None if found is None else found.__name__

    assert reader(COCO) == "coco_scene"
    assert reader(LABELME) == "labelme_scene"
    assert reader({"shapes": [], "imageHeight": 3}) == "labelme_scene"
    others: list[Any] = [{"shapes": []}, {"images": []}, {"objects": [], **COCO}, [], None, 3]
    assert [reader(other) for other in others] == [None] * len(others)


def test_a_scene_is_written_as_coco_and_read_back() -> None:
    low, high = [[0.0, 0.0], [10.5, 30.0]], [[5.0, 20.0], [40.0, 60.0]]
    scene = Scene.from_boxes(low, high, labels=["cup", None], confidences=[0.75, 1.0], unit="px", frame="image")
    written = scene.to_coco(file_name="table.jpg")
    assert written["images"] == [{"id": 1, "width": 40, "height": 60, "file_name": "table.jpg"}]
    read = Scene.from_coco(json.loads(json.dumps(written)), "table.jpg")
    assert read.objects == scene.objects


def test_a_scene_in_metres_is_not_written_as_coco() -> None:
    with pytest.raises(SceneError, match="COCO boxes must be in pixels"):
        Scene.from_boxes([[0.0, 0.0]], [[1.0, 1.0]]).to_coco()
