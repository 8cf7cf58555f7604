"""COCO and LabelMe files as scenes: golden cases by hand, y turned upwards, and a catalogue of malformed files."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.ontology.tbox import default_ontology
from deixis.perception.annotations import annotation_reader
from deixis.perception.errors import SceneError
from deixis.perception.scene import Scene
from deixis.perception.scene_file import read_scene, write_scene

Json = dict[str, Any]

COCO: Json = {
    "info": {"description": "two laid tables"},
    "images": [
        {"id": 1, "file_name": "breakfast.jpg", "width": 640, "height": 480},
        {"id": 2, "file_name": "dinner.jpg", "width": 800, "height": 600},
    ],
    "categories": [{"id": 10, "name": "fork", "supercategory": "cutlery"}, {"id": 20, "name": "dinner plate"}],
    "annotations": [
        {"id": 501, "image_id": 1, "category_id": 20, "bbox": [200, 150, 240, 230], "iscrowd": 0},
        {"id": 502, "image_id": 2, "category_id": 10, "bbox": [5, 5, 10, 10]},
        {"id": 503, "image_id": 1, "category_id": 10, "segmentation": [[100, 160, 130, 160, 120, 350, 110, 350]]},
        {"id": 504, "image_id": 1, "category_id": 10, "bbox": [0, 0, 640, 90], "iscrowd": 1},
        {"id": 505, "image_id": 1, "category_id": None, "bbox": [300, 20, 60, 60.5]},
    ],
}
"""Of the breakfast: a plate, a fork to its left, a crowd of forks, and something unnamed beyond the plate."""

LABELME: Json = {
    "version": "5.4.1",
    "flags": {},
    "imagePath": "photos/dinner.jpg",
    "imageData": None,
    "imageHeight": 100,
    "imageWidth": 200,
    "shapes": [
        {"label": "plate", "points": [[80, 50], [80, 80]], "shape_type": "circle", "group_id": None, "flags": {}},
        {"label": "fork", "points": [[20, 30], [25, 80], [30, 30]], "shape_type": "polygon"},
        {"label": "knife", "points": [[130, 80], [120, 30]], "shape_type": "rectangle"},
        {"label": "chopsticks", "points": [[5, 90], [10, 20]], "shape_type": "line", "group_id": 3},
        {"label": "chopsticks", "points": [[12, 92], [16, 21]], "shape_type": "line", "group_id": 3},
        {"label": "cup", "points": [[150, 1], [170, 19]], "group_id": 3, "shape_type": "mask", "score": 0.5},
    ],
}

Box = tuple[float, float, float, float]


def boxes(scene: Scene) -> dict[str, tuple[str | None, Box]]:
    """Of each object its label, and x from and to, y from and to."""
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


def test_what_is_higher_in_the_image_is_at_the_top() -> None:
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


def test_a_mask_that_is_run_length_encoded_is_passed_over_where_a_box_is_given() -> None:
    encoded = {"counts": "abc", "size": [480, 640]}
    assert boxes(read_scene(coco(segmentation=encoded, bbox=[1, 2, 3, 4])))["o1"][1] == (1, 4, 474, 478)


def test_a_score_is_the_confidence_of_the_label() -> None:
    assert read_scene(coco(bbox=[1, 2, 3, 4], score=0.25))["o1"].confidence == 0.25
    assert read_scene(coco(bbox=[1, 2, 3, 4], score=0.25, category_id=None))["o1"].confidence == 1


def test_only_the_chosen_image_is_looked_at() -> None:
    spoilt = copy.deepcopy(COCO)
    spoilt["annotations"][1]["bbox"] = "none"
    assert len(read_scene(spoilt, 1).objects) == 3
    with pytest.raises(SceneError, match=r"annotations\[1\]: 'bbox' must have 4 numbers"):
        read_scene(spoilt, 2)


def test_an_image_with_crowds_alone_is_an_empty_scene() -> None:
    assert read_scene(coco(bbox=[1, 2, 3, 4], iscrowd=1)).ids == ()
    assert read_scene({**LABELME, "shapes": []}).ids == ()


@pytest.mark.parametrize("data", [COCO, LABELME], ids=["coco", "labelme"])
def test_an_annotated_image_comes_back_from_a_scene_file(data: Json, tmp_path: Path) -> None:
    source, written = tmp_path / "annotated.json", tmp_path / "written.scene.json"
    source.write_text(json.dumps(data), encoding="utf-8")
    scene = read_scene(source, image="dinner.jpg")
    write_scene(scene, written)
    assert read_scene(written) == scene
    assert scene.file == str(source)


def test_labels_can_be_hidden() -> None:
    assert {thing.label for thing in read_scene(LABELME).without_labels().objects} == {None}


def test_a_format_is_told_by_its_content() -> None:
    def reader(data: Any) -> str | None:
        found: Callable[..., Scene] | None = annotation_reader(data)
        return None if found is None else found.__name__

    assert reader(COCO) == "coco_scene"
    assert reader(LABELME) == "labelme_scene"
    assert reader({"shapes": [], "imageHeight": 3}) == "labelme_scene"
    others: list[Any] = [{"shapes": []}, {"images": []}, {"objects": [], **COCO}, [], None, 3]
    assert [reader(other) for other in others] == [None] * len(others)


def coco(**annotation: Any) -> Json:
    """A file with one image 480 px high and one annotation of it, a fork's."""
    entry = {"image_id": 1, "category_id": 10, **annotation}
    return {"images": COCO["images"][:1], "categories": COCO["categories"], "annotations": [entry]}


def shape(**changes: Any) -> Json:
    return {"label": "fork", "points": [[1, 2], [3, 4], [1, 4]], "shape_type": "polygon", **changes}


def labelme(**changes: Any) -> Json:
    return {**LABELME, "shapes": [LABELME["shapes"][0], {k: v for k, v in shape(**changes).items() if v != "drop"}]}


def without(data: Json, *path: Any) -> Json:
    """The file without what lies at a path."""
    changed = copy.deepcopy(data)
    inner: Any = changed
    for step in path[:-1]:
        inner = inner[step]
    del inner[path[-1]]
    return changed


def changed(data: Json, value: Any, *path: Any) -> Json:
    """The file with something else at a path."""
    result = copy.deepcopy(data)
    inner: Any = result
    for step in path[:-1]:
        inner = inner[step]
    inner[path[-1]] = value
    return result


FORK = coco(bbox=[1, 2, 3, 4])
WHICH = "'breakfast.jpg' (id 1), 'dinner.jpg' (id 2)"
MANY = changed(COCO, [{"id": i, "file_name": f"{i}.jpg"} for i in range(1, 9)], "images")

CATALOGUE: list[tuple[Json, str]] = [
    (COCO, f"the file has 2 images; choose one by file name or id: {WHICH}"),
    (
        MANY,
        "the file has 8 images; choose one by file name or id: "
        + ", ".join(f"'{i}.jpg' (id {i})" for i in range(1, 6))
        + ", …",
    ),
    (changed(FORK, [], "images"), "'images' is empty, so there is no scene in this file"),
    (changed(FORK, {}, "images"), "'images' must be a list, not an object"),
    (changed(FORK, [3], "images"), "images[0]: an object {…} is expected here, not a number"),
    (without(FORK, "images", 0, "id"), "images[0]: 'id' is missing"),
    (changed(FORK, 1.5, "images", 0, "id"), "images[0]: 'id': an id is a whole number or a text, not a number"),
    (changed(FORK, [1], "images", 0, "id"), "images[0]: 'id': an id is a whole number or a text, not a list"),
    (changed(FORK, 10**20, "images", 0, "id"), "images[0]: 'id': the number is too large"),
    (changed(FORK, COCO["images"][:1] * 2, "images"), "images[1]: the id 1 is used twice"),
    (changed(FORK, 7, "images", 0, "file_name"), "images[0]: 'file_name': a text is expected, not a number"),
    (changed(FORK, "tall", "images", 0, "height"), "images[0]: 'height': a number is expected, not a text"),
    (changed(FORK, -480, "images", 0, "height"), "images[0]: 'height': an image measures some pixels, not -480"),
    (without(FORK, "categories"), "'categories' is missing"),
    (changed(FORK, None, "categories"), "'categories' must be a list, not null"),
    (changed(FORK, [None], "categories"), "categories[0]: an object {…} is expected here, not null"),
    (without(FORK, "categories", 1, "name"), "categories[1]: 'name' is missing"),
    (changed(FORK, " ", "categories", 1, "name"), "categories[1]: 'name': a text is expected, and this one is blank"),
    (changed(FORK, 10, "categories", 1, "id"), "categories[1]: the id 10 is used twice"),
    (changed(FORK, "none", "annotations"), "'annotations' must be a list, not a text"),
    (changed(FORK, [[]], "annotations"), "annotations[0]: an object {…} is expected here, not a list"),
    (without(FORK, "annotations", 0, "image_id"), "annotations[0]: 'image_id' is missing"),
    (coco(image_id=9), "annotations[0]: 'image_id' 9 is the id of no image in this file"),
    (coco(image_id="x" * 900), f"annotations[0]: 'image_id' {'x' * 59}… is the id of no image in this file"),
    (without(FORK, "annotations", 0, "category_id"), "annotations[0]: 'category_id' is missing"),
    (coco(category_id=11), "annotations[0]: 'category_id' 11 is the id of no category in this file"),
    (coco(category_id=True), "annotations[0]: 'category_id': an id is a whole number or a text, not true"),
    (coco(), "annotations[0]: 'bbox' is missing, and so is 'segmentation'; an object needs one of them"),
    (coco(bbox=[1, 2, 3]), "annotations[0]: 'bbox' must have 4 numbers: x, y, width and height"),
    (coco(bbox={"x": 1}), "annotations[0]: 'bbox' must have 4 numbers: x, y, width and height"),
    (coco(bbox=[1, 2, "3", 4]), "annotations[0]: 'bbox': a number is expected, not a text"),
    (coco(bbox=[1, 2, 3, -4]), "annotations[0]: 'bbox': a width or height below 0"),
    (coco(bbox=[1, 2, 0, 4]), "annotations[0]: 'bbox': the outline has no width; an object's box needs both"),
    (coco(bbox=[1, 2, 3, 0]), "annotations[0]: 'bbox': the outline has no height; an object's box needs both"),
    (coco(bbox=[1, 10**400, 3, 4]), "annotations[0]: 'bbox': the number is too large"),
    (coco(bbox=[1.7e308, 2, 1.7e308, 4]), "annotations[0]: 'bbox': a coordinate is not finite"),
    (
        coco(segmentation={"counts": [1, 2], "size": [3, 4]}),
        "annotations[0]: 'segmentation' is run-length encoded, which is not read; give a 'bbox' beside it",
    ),
    (coco(segmentation=[]), "annotations[0]: 'segmentation' must be a list of polygons, with one at least"),
    (
        coco(segmentation=[[1, 2, 3, 4, 5, 7], [1, 2, 3, 4, 5]]),
        "annotations[0]: 'segmentation'[1] must be a list x1, y1, x2, y2, … of 3 corners or more",
    ),
    (
        coco(segmentation=[[1, 2, 3, 4]]),
        "annotations[0]: 'segmentation'[0] must be a list x1, y1, x2, y2, … of 3 corners or more",
    ),
    (coco(segmentation=[[1, 2, 3, 4, 5, None]]), "annotations[0]: 'segmentation'[0]: a number is expected, not null"),
    (
        coco(segmentation=[[1, 2, 1, 4, 1, 5]]),
        "annotations[0]: 'segmentation': the outline has no width; an object's box needs both",
    ),
    (coco(bbox=[1, 2, 3, 4], iscrowd=2), "annotations[0]: 'iscrowd' must be 0 or 1"),
    (
        coco(bbox=[1, 2, 3, 4], score=1.5),
        "annotations[0]: 'score' is a confidence and lies between 0 and 1, not at 1.5",
    ),
    (changed(LABELME, {}, "shapes"), "'shapes' must be a list, not an object"),
    (changed(LABELME, ["fork"], "shapes"), "shapes[0]: an object {…} is expected here, not a text"),
    (changed(LABELME, "100", "imageHeight"), "'imageHeight': a number is expected, not a text"),
    (changed(LABELME, 0, "imageHeight"), "'imageHeight': an image measures some pixels, not 0"),
    (labelme(label="drop"), "shapes[1]: 'label' is missing"),
    (labelme(points="drop"), "shapes[1]: 'points' is missing"),
    (labelme(label=3), "shapes[1]: 'label': a text is expected, not a number"),
    (labelme(label=""), "shapes[1]: 'label': a text is expected, and this one is blank"),
    (labelme(points=None), "shapes[1]: 'points' must be a list of points [x, y], not null"),
    (labelme(points=[]), "shapes[1]: 'points': a polygon has 3 or more points, not 0"),
    (labelme(points=[[1, 2], [3, 4]]), "shapes[1]: 'points': a polygon has 3 or more points, not 2"),
    (labelme(shape_type="circle"), "shapes[1]: 'points': a circle has 2 points, not 3"),
    (
        labelme(points=[[1, 2]], shape_type="rectangle"),
        "shapes[1]: 'points': a rectangle has 2 to 4 points, not 1",
    ),
    (labelme(points=[[1, 2], [3], [4, 5]]), "shapes[1]: 'points'[1] must have 2 numbers: x and y"),
    (labelme(points=[[1, 2], [3, 4], [5, "6"]]), "shapes[1]: 'points'[2]: a number is expected, not a text"),
    (
        labelme(points=[[1, 2], [1, 2]], shape_type="circle"),
        "shapes[1]: 'points': the outline has no width; an object's box needs both",
    ),
    (
        labelme(points=[[1, 2], [9, 2]], shape_type="line"),
        "shapes[1]: 'points': the outline has no height; an object's box needs both",
    ),
    (
        labelme(points=[[1, 2]], shape_type="point"),
        "shapes[1]: a point has no extent, and an object needs a box; outline it, or leave it out",
    ),
    (
        labelme(shape_type="blob"),
        "shapes[1]: the shape_type 'blob' is not known; use one of polygon, rectangle, circle, line, linestrip, "
        "points, mask, oriented_rectangle",
    ),
    (labelme(shape_type=7), "shapes[1]: 'shape_type': a text is expected, not a number"),
    (labelme(group_id=[1]), "shapes[1]: 'group_id' is a whole number, a text or null, not a list"),
    (labelme(score="sure"), "shapes[1]: 'score': a number is expected, not a text"),
]


@pytest.mark.parametrize(("data", "message"), CATALOGUE, ids=range(len(CATALOGUE)))
def test_a_malformed_file_is_refused_with_the_place_and_the_reason(data: Json, message: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    assert str(caught.value) == f"{path}: {message}"


@pytest.mark.parametrize(
    ("data", "wanted", "message"),
    [
        (COCO, "tea.jpg", f"there is no image 'tea.jpg' in this file; it has {WHICH}"),
        (COCO, 3, f"there is no image '3' in this file; it has {WHICH}"),
        (COCO, "x" * 900, f"there is no image '{'x' * 59}…' in this file; it has {WHICH}"),
        (
            changed(COCO, "dinner.jpg", "images", 0, "file_name"),
            "dinner.jpg",
            "2 images are called 'dinner.jpg'; choose one by its id: 'dinner.jpg' (id 1), 'dinner.jpg' (id 2)",
        ),
        (
            without(COCO, "images", 1, "file_name"),
            "dinner.jpg",
            "there is no image 'dinner.jpg' in this file; it has 'breakfast.jpg' (id 1), 2",
        ),
        (LABELME, "tea.jpg", "this file is about the image 'photos/dinner.jpg' alone, not 'tea.jpg'"),
        (without(LABELME, "imagePath"), "tea.jpg", "this file is about the image '' alone, not 'tea.jpg'"),
        ({"objects": []}, "tea.jpg", "an image ('tea.jpg') is chosen in annotation files, and this is a scene"),
    ],
)
def test_an_image_that_a_file_has_not_is_refused(data: Json, wanted: str | int, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(data, wanted)
    assert str(caught.value) == f"<scene>: {message}"


scalars = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5)
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=4),
    max_leaves=8,
)


def paths(data: Any, *above: Any) -> list[tuple[Any, ...]]:
    """The paths to everything in a file."""
    children = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    return [path for key, value in children for path in ((*above, key), *paths(value, *above, key))]


@settings(max_examples=200, deadline=None)
@given(data=st.data(), original=st.sampled_from([COCO, LABELME]), value=values, image=st.none() | st.just(1))
def test_a_file_with_anything_anywhere_gives_a_scene_or_a_scene_error(
    data: st.DataObject, original: Json, value: Any, image: int | None
) -> None:
    spoilt = changed(original, value, *data.draw(st.sampled_from(paths(original))))
    refused_or_read(spoilt, image)


@settings(max_examples=100, deadline=None)
@given(st.dictionaries(st.sampled_from(["images", "annotations", "categories", "shapes", "version"]), values))
def test_a_file_of_anything_gives_a_scene_or_a_scene_error(data: Json) -> None:
    refused_or_read(data, None)


def refused_or_read(data: Json, image: int | None) -> None:
    scene, message = None, "<scene>: "
    try:
        scene = read_scene(data, image)
    except SceneError as error:
        message = str(error)
    assert message.startswith("<scene>: ")
    assert len(message.encode("utf-8")) < 1000
    if scene is not None:
        assert scene.unit == "px"
        assert scene.ids == tuple(f"o{i + 1}" for i in range(len(scene.objects)))
        assert (scene.boxes[:, 0] <= scene.boxes[:, 1]).all()
