"""Malformed COCO and LabelMe files: a catalogue, and arbitrary values at any place of a file."""

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
    """Return the file without the value at a path."""
    changed = copy.deepcopy(data)
    inner: Any = changed
    for step in path[:-1]:
        inner = inner[step]
    del inner[path[-1]]
    return changed


def changed(data: Json, value: Any, *path: Any) -> Json:
    """Return the file with another value at a path."""
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
    (changed(FORK, [], "images"), "'images' must have at least one image, got none"),
    (changed(FORK, {}, "images"), "'images' must be a list, got an object"),
    (changed(FORK, [3], "images"), "images[0] must be an object {…}, got a number"),
    (without(FORK, "images", 0, "id"), "images[0]: 'id' is missing"),
    (changed(FORK, 1.5, "images", 0, "id"), "images[0]: 'id' must be a whole number or a string, got a number"),
    (changed(FORK, [1], "images", 0, "id"), "images[0]: 'id' must be a whole number or a string, got a list"),
    (changed(FORK, 10**20, "images", 0, "id"), "images[0]: 'id': the number is too large"),
    (changed(FORK, COCO["images"][:1] * 2, "images"), "images[1]: the id 1 is used twice"),
    (changed(FORK, 7, "images", 0, "file_name"), "images[0]: 'file_name' must be a string, got a number"),
    (changed(FORK, "tall", "images", 0, "height"), "images[0]: 'height' must be a number, got a string"),
    (changed(FORK, -480, "images", 0, "height"), "images[0]: 'height' must be a number of pixels above 0, got -480"),
    (without(FORK, "categories"), "'categories' is missing"),
    (changed(FORK, None, "categories"), "'categories' must be a list, got null"),
    (changed(FORK, [None], "categories"), "categories[0] must be an object {…}, got null"),
    (without(FORK, "categories", 1, "name"), "categories[1]: 'name' is missing"),
    (
        changed(FORK, " ", "categories", 1, "name"),
        "categories[1]: 'name' must be a string that is not blank, got \" \"",
    ),
    (changed(FORK, 10, "categories", 1, "id"), "categories[1]: the id 10 is used twice"),
    (changed(FORK, "none", "annotations"), "'annotations' must be a list, got a string"),
    (changed(FORK, [[]], "annotations"), "annotations[0] must be an object {…}, got a list"),
    (without(FORK, "annotations", 0, "image_id"), "annotations[0]: 'image_id' is missing"),
    (coco(image_id=9), "annotations[0]: 'image_id' 9 is not the id of an image in this file"),
    (coco(image_id="x" * 900), f"annotations[0]: 'image_id' {'x' * 59}… is not the id of an image in this file"),
    (without(FORK, "annotations", 0, "category_id"), "annotations[0]: 'category_id' is missing"),
    (coco(category_id=11), "annotations[0]: 'category_id' 11 is not the id of a category in this file"),
    (coco(category_id=True), "annotations[0]: 'category_id' must be a whole number or a string, got true"),
    (coco(), "annotations[0]: 'bbox' and 'segmentation' are both missing; give one of them"),
    (coco(bbox=[1, 2, 3]), "annotations[0]: 'bbox' must be 4 numbers, x, y, width and height, got [1, 2, 3]"),
    (coco(bbox={"x": 1}), "annotations[0]: 'bbox' must be 4 numbers, x, y, width and height, got {'x': 1}"),
    (coco(bbox=[1, 2, "3", 4]), "annotations[0]: 'bbox' must be a number, got a string"),
    (coco(bbox=[1, 2, 3, -4]), "annotations[0]: 'bbox': width and height must be at least 0, got 3 and -4"),
    (coco(bbox=[1, 2, 0, 4]), "annotations[0]: 'bbox': the width of the outline must be above 0, got 0"),
    (coco(bbox=[1, 2, 3, 0]), "annotations[0]: 'bbox': the height of the outline must be above 0, got 0"),
    (coco(bbox=[1.7e308, 2, 1.7e308, 4]), "annotations[0]: 'bbox': a coordinate is not finite"),
    (
        coco(segmentation={"counts": [1, 2], "size": [3, 4]}),
        "annotations[0]: run-length encoded 'segmentation' cannot be read; add a 'bbox'",
    ),
    (coco(segmentation=[]), "annotations[0]: 'segmentation' must be a list of at least one polygon, got []"),
    (
        coco(segmentation=[[1, 2, 3, 4, 5, 7], [1, 2, 3, 4, 5]]),
        "annotations[0]: 'segmentation'[1] must be a list x1, y1, x2, y2, … of at least 3 corners, got [1, 2, 3, 4, 5]",
    ),
    (
        coco(segmentation=[[1, 2, 3, 4]]),
        "annotations[0]: 'segmentation'[0] must be a list x1, y1, x2, y2, … of at least 3 corners, got [1, 2, 3, 4]",
    ),
    (coco(segmentation=[[1, 2, 3, 4, 5, None]]), "annotations[0]: 'segmentation'[0] must be a number, got null"),
    (
        coco(segmentation=[[1, 2, 1, 4, 1, 5]]),
        "annotations[0]: 'segmentation': the width of the outline must be above 0, got 0",
    ),
    (coco(bbox=[1, 2, 3, 4], iscrowd=2), "annotations[0]: 'iscrowd' must be 0 or 1, got 2"),
    (
        coco(bbox=[1, 2, 3, 4], score=1.5),
        "annotations[0]: 'score' must be from 0 to 1, got 1.5",
    ),
    (changed(LABELME, {}, "shapes"), "'shapes' must be a list, got an object"),
    (changed(LABELME, ["fork"], "shapes"), "shapes[0] must be an object {…}, got a string"),
    (changed(LABELME, "100", "imageHeight"), "'imageHeight' must be a number, got a string"),
    (changed(LABELME, 0, "imageHeight"), "'imageHeight' must be a number of pixels above 0, got 0"),
    (labelme(label="drop"), "shapes[1]: 'label' is missing"),
    (labelme(points="drop"), "shapes[1]: 'points' is missing"),
    (labelme(label=3), "shapes[1]: 'label' must be a string, got a number"),
    (labelme(label=""), "shapes[1]: 'label' must be a string that is not blank, got \"\""),
    (labelme(points=None), "shapes[1]: 'points' must be a list of points [x, y], got null"),
    (labelme(points=[]), "shapes[1]: 'points': a polygon must have 3 or more points, got 0"),
    (labelme(points=[[1, 2], [3, 4]]), "shapes[1]: 'points': a polygon must have 3 or more points, got 2"),
    (labelme(shape_type="circle"), "shapes[1]: 'points': a circle must have 2 points, got 3"),
    (
        labelme(points=[[1, 2]], shape_type="rectangle"),
        "shapes[1]: 'points': a rectangle must have 2 to 4 points, got 1",
    ),
    (labelme(points=[[1, 2], [3], [4, 5]]), "shapes[1]: 'points'[1] must be 2 numbers, x and y, got [3]"),
    (labelme(points=[[1, 2], [3, 4], [5, "6"]]), "shapes[1]: 'points'[2] must be a number, got a string"),
    (
        labelme(points=[[1, 2], [1, 2]], shape_type="circle"),
        "shapes[1]: 'points': the width of the outline must be above 0, got 0",
    ),
    (
        labelme(points=[[1, 2], [9, 2]], shape_type="line"),
        "shapes[1]: 'points': the height of the outline must be above 0, got 0",
    ),
    (
        labelme(points=[[1, 2]], shape_type="point"),
        "shapes[1]: a point has no extent; outline the object, or leave it out",
    ),
    (
        labelme(shape_type="blob"),
        "shapes[1]: unknown shape_type 'blob'; use one of polygon, rectangle, circle, line, linestrip, "
        "points, mask, oriented_rectangle",
    ),
    (labelme(shape_type=7), "shapes[1]: 'shape_type' must be a string, got a number"),
    (labelme(group_id=[1]), "shapes[1]: 'group_id' must be a whole number, a string or null, got a list"),
    (labelme(score="sure"), "shapes[1]: 'score' must be a number, got a string"),
]


@pytest.mark.parametrize(("data", "message"), CATALOGUE, ids=range(len(CATALOGUE)))
def test_a_malformed_file_is_refused_with_place_and_reason(data: Json, message: str, tmp_path: Path) -> None:
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
            "2 images are called 'dinner.jpg'; choose one by id: 'dinner.jpg' (id 1), 'dinner.jpg' (id 2)",
        ),
        (
            without(COCO, "images", 1, "file_name"),
            "dinner.jpg",
            "there is no image 'dinner.jpg' in this file; it has 'breakfast.jpg' (id 1), 2",
        ),
        (LABELME, "tea.jpg", "the only image of this file is 'photos/dinner.jpg', got 'tea.jpg'"),
        (without(LABELME, "imagePath"), "tea.jpg", "the only image of this file is '', got 'tea.jpg'"),
        ({"objects": []}, "tea.jpg", "an image ('tea.jpg') can be chosen in annotation files only; leave it out"),
    ],
)
def test_an_image_that_the_file_lacks_is_refused(data: Json, wanted: str | int, message: str) -> None:
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
    """Return the paths to all values of a file."""
    children = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    return [path for key, value in children for path in ((*above, key), *paths(value, *above, key))]


@settings(max_examples=60, deadline=None)
@given(data=st.data(), original=st.sampled_from([COCO, LABELME]), value=values, image=st.none() | st.just(1))
def test_a_changed_file_gives_a_scene_or_a_scene_error(
    data: st.DataObject, original: Json, value: Any, image: int | None
) -> None:
    spoilt = changed(original, value, *data.draw(st.sampled_from(paths(original))))
    refused_or_read(spoilt, image)


@given(st.dictionaries(st.sampled_from(["images", "annotations", "categories", "shapes", "version"]), values))
def test_an_arbitrary_file_gives_a_scene_or_a_scene_error(data: Json) -> None:
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


@settings(max_examples=100, deadline=None)
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
def test_the_command_reports_a_bad_scene_in_one_line(name: str, tmp_path: Path) -> None:
    file = tmp_path / "hostile.json"
    file.write_text(HOSTILE[name], encoding="utf-8")
    started = time.process_time()
    code, out, err = deixis("relate", file, "--calculus", "ra")
    assert (code, out) == (2, "") and err.startswith(f"deixis: {file}") and err.count("\n") == 1
    assert len(err) < len(str(file)) + 500 and time.process_time() - started < 10
