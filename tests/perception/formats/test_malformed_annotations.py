"""Malformed COCO and LabelMe files: a catalogue, and anything anywhere in a file."""

from __future__ import annotations

import copy
import json
import time
from pathlib import Path
from typing import Any

import pytest
from annotated_images import COCO, LABELME, Json, coco, shape
from commands import deixis
from damaged_files import damaged
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.perception.errors import SceneError
from deixis.perception.formats.scene_json import read_scene


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


@settings(max_examples=200, deadline=None)
@given(data=st.data(), original=st.sampled_from([COCO, LABELME]))
def test_a_damaged_file_gives_a_scene_or_a_scene_error(
    data: st.DataObject, original: Json, tmp_path_factory: pytest.TempPathFactory
) -> None:
    file = tmp_path_factory.getbasetemp() / "damaged.json"
    file.write_bytes(damaged(json.dumps(original).encode(), data))
    message = str(file)
    try:
        read_scene(file, 1 if original is COCO else None)
    except SceneError as error:
        message = str(error)
    assert message.startswith(str(file)) and "\n" not in message and len(message) < 1000


HOSTILE = {
    "deep": "[" * 1_000_000,
    "deep object": '{"shapes":' * 100_000,
    "deep shape": '{"version": "5", "shapes": ' + "[" * 5_000 + "]" * 5_000 + "}",
    "repeated keys": '{"version": "5", "shapes": [], ' + ", ".join(f'"k{k}": 1' for k in (*range(50_000), 7)) + "}",
    "digits": '{"images": [{"id": ' + "9" * 500_000 + '}], "annotations": [], "categories": []}',
    "no number": '{"version": "5", "imageHeight": NaN, "shapes": []}',
    "zeros": "\0" * 1_000_000,
    "cut off": json.dumps(COCO)[:-20],
    "nothing": "",
    "escapes": '{"version": "5", "shapes": [{"label": "\\u001b[31m", "points": [[0, 0], [1, 1], [0, 2]]}]}',
}


@pytest.mark.parametrize("name", HOSTILE)
def test_the_command_says_in_one_line_what_is_wrong_with_a_scene(name: str, tmp_path: Path) -> None:
    file = tmp_path / "hostile.json"
    file.write_text(HOSTILE[name], encoding="utf-8")
    started = time.process_time()
    code, out, err = deixis("relate", file, "--calculus", "ra")
    assert (code, out) == (2, "") and err.startswith(f"deixis: {file}") and err.count("\n") == 1
    assert len(err) < len(str(file)) + 500 and time.process_time() - started < 10
