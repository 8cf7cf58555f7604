"""Scene files: reading back written scenes, units, and malformed scenes with their exact messages."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import deixis.perception.formats.scene_json as module
from deixis.errors import DeixisError
from deixis.perception.errors import SceneError
from deixis.perception.formats.scene_json import read_scene, scene_text, scene_to_dict
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import PerceivedObject, Scene

BOX: dict[str, Any] = {"id": "o1", "min": [0, 0], "max": [1, 1]}

texts = st.text(st.characters(exclude_categories=["Cs", "Cc"]), min_size=1, max_size=8).filter(
    lambda text: bool(text.strip())
)
coordinates = st.floats(-1e6, 1e6)

oriented_boxes = st.builds(
    OrientedBox,
    st.tuples(coordinates, coordinates, coordinates),
    st.floats(-np.pi / 2, np.pi / 2),
    st.tuples(*[st.floats(0, 1e6)] * 3),
)

directions = st.tuples(coordinates, coordinates).filter(any)


@st.composite
def objects(draw: st.DrawFn, id: str, axes: int) -> PerceivedObject:
    corners = [sorted((draw(coordinates), draw(coordinates))) for _ in range(axes)]
    label = draw(st.none() | texts)
    return PerceivedObject(
        id,
        tuple(low for low, _ in corners),
        tuple(high for _, high in corners),
        label=label,
        confidence=1.0 if label is None else draw(st.floats(0, 1)),
        cloud=draw(st.none() | texts),
        colour=draw(st.none() | st.tuples(*[st.integers(0, 255)] * 3)),
        oriented=draw(st.none() | oriented_boxes) if axes == 3 else None,
        candidates=tuple(draw(st.dictionaries(texts, st.floats(0, 0.3), max_size=3)).items()),
        front=draw(st.none() | directions),
    )


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    axes = draw(st.sampled_from([2, 3]))
    ids = draw(st.lists(texts, max_size=4, unique=True))
    return Scene(
        tuple(draw(objects(id, axes)) for id in ids),
        frame=draw(texts),
        viewpoint=draw(texts),
        unit=draw(st.sampled_from(["m", "px"])),
    )


@given(scenes())
def test_a_scene_is_read_back_from_its_dictionary(scene: Scene) -> None:
    assert read_scene(json.loads(json.dumps(scene_to_dict(scene)))) == scene


@settings(max_examples=10, deadline=None)
@given(scene=scenes())
def test_a_scene_is_read_back_from_its_file(scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.getbasetemp() / "written.scene.json"
    path.write_text(scene_text(scene), encoding="utf-8")
    assert read_scene(path) == scene
    assert read_scene(str(path)).file == str(path)


def test_a_written_scene_has_a_line_for_every_object() -> None:
    things = tuple(PerceivedObject(f"o{i}", (0.0, 0.0), (1.0, 1.0), label="café") for i in range(3))
    lines = scene_text(Scene(things)).splitlines()
    assert sum('"id"' in line for line in lines) == 3
    assert sum("café" in line for line in lines) == 3


@pytest.mark.parametrize(("unit", "metres"), [("m", 20.0), ("cm", 0.2), ("mm", 0.02), ("px", 20.0)])
def test_coordinates_become_metres_and_pixels_stay(unit: str, metres: float) -> None:
    scene = read_scene({"unit": unit, "objects": [{"id": "o1", "min": [0, 0, 0], "max": [20, 1, 2]}]})
    assert scene.objects[0].maximum[0] == pytest.approx(metres)
    assert scene.unit == ("px" if unit == "px" else "m")


def test_missing_keys_have_defaults() -> None:
    scene = read_scene({"objects": [BOX]})
    assert (scene.frame, scene.viewpoint, scene.unit, scene.file) == ("table", "chair", "m", "<scene>")
    assert scene.objects == (PerceivedObject("o1", (0.0, 0.0), (1.0, 1.0)),)


def test_null_counts_as_a_missing_value() -> None:
    assert read_scene({"objects": [{**BOX, "label": None, "confidence": None, "cloud": None}]}) == read_scene(
        {"objects": [BOX]}
    )


def test_integer_ids_and_arrays_are_accepted() -> None:
    scene = read_scene({"objects": [{"id": np.int64(4), "min": np.zeros(2), "max": np.ones(2)}, {**BOX, "id": 12}]})
    assert scene.ids == ("4", "12")


def test_a_scene_may_be_empty() -> None:
    assert read_scene({"objects": []}).ids == ()


def test_a_file_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "a.scene.json"
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps({"objects": [BOX]}).encode())
    assert read_scene(path).ids == ("o1",)


def one(**changes: Any) -> dict[str, Any]:
    return {"objects": [{**BOX, **changes}]}


def without(key: str) -> dict[str, Any]:
    return {"objects": [{k: v for k, v in BOX.items() if k != key}]}


@pytest.mark.parametrize(
    ("given_as", "rgb"),
    [
        ("red", (199, 38, 42)),
        ("Dark Blue", (91, 122, 191)),
        ("#Ff8000", (255, 128, 0)),
        ([255, 127.6, 0], (255, 128, 0)),
        (None, None),
    ],
)
def test_a_colour_is_a_word_or_hexadecimal_or_three_numbers(given_as: Any, rgb: tuple[int, ...] | None) -> None:
    scene = read_scene(one(colour=given_as))
    assert scene.objects[0].colour == rgb
    assert scene.without_labels().objects[0].colour == rgb
    assert np.isnan(scene.colours).all() if rgb is None else scene.colours.tolist() == [list(rgb)]


@pytest.mark.parametrize("colour", [(0, 0), (0, 0, 256), (-1, 0, 0), (0.0, float("nan"), 0.0)])
def test_an_invalid_colour_in_python_is_refused(colour: Any) -> None:
    with pytest.raises(SceneError, match="object 'o1': a colour must be red, green and blue, each from 0 to 255"):
        Scene((PerceivedObject("o1", (0.0, 0.0), (1.0, 1.0), colour=colour),))


def test_an_oriented_box_is_in_the_unit_of_its_scene() -> None:
    entry = {"id": "o1", "min": [0, 0, 0], "max": [20, 1, 2]}
    turned = {"centre": [10, 0.5, 1], "yaw": 0.1, "extents": [20, 1, 2]}
    scene = read_scene({"unit": "cm", "objects": [{**entry, "oriented": turned}]})
    box = scene.objects[0].oriented
    assert box is not None and box.yaw == 0.1
    assert box.centre == pytest.approx((0.1, 0.005, 0.01)) and box.extents == pytest.approx((0.2, 0.01, 0.02))


@pytest.mark.parametrize(
    ("oriented", "said"),
    [
        ([], "'oriented' must be an object {…}"),
        ({}, "'oriented': 'centre' is missing"),
        ({"centre": [0, 0, 0], "yaw": 0, "extents": [1, 1, 1], "roll": 0}, "'roll' is not a key here"),
        ({"centre": [0, 0], "yaw": 0, "extents": [1, 1, 1]}, "'centre' must be a list of 3 numbers"),
        ({"centre": [0, 0, 0], "yaw": "east", "extents": [1, 1, 1]}, "'yaw' must be a number"),
        ({"centre": [0, 0, 0], "yaw": 0, "extents": [1, -1, 1]}, "extents must be at least 0"),
        ({"centre": [0, 0, 2e9], "yaw": 0, "extents": [1, 1, 1]}, "beyond 1e\\+09"),
    ],
)
def test_an_invalid_oriented_box_is_refused(oriented: Any, said: str) -> None:
    with pytest.raises(SceneError, match=said):
        read_scene({"objects": [{"id": "o1", "min": [0, 0, 0], "max": [1, 1, 1], "oriented": oriented}]})


def test_a_2d_box_cannot_have_an_oriented_one() -> None:
    oriented = {"centre": [0, 0, 0], "yaw": 0, "extents": [1, 1, 1]}
    with pytest.raises(SceneError, match="give 'min' and 'max' 3 coordinates"):
        read_scene(one(oriented=oriented))


SCENE_KEYS = "addressee, frame, objects, shows, speaker, unit, viewpoint"
KEYS = "candidates, cloud, colour, confidence, front, heading, id, label, max, min, oriented"

CATALOGUE: list[tuple[Any, str]] = [
    ([], "the scene must be an object {…}, got a list"),
    (None, "the scene must be an object {…}, got null"),
    (3, "the scene must be an object {…}, got a number"),
    ("scene", "the scene must be an object {…}, got a string"),
    (True, "the scene must be an object {…}, got true"),
    ({}, "'objects' is missing; add the list of the objects"),
    ({"objects": None}, "'objects' must be a list, got null"),
    ({"objects": {}}, "'objects' must be a list, got an object"),
    ({"object": []}, f"'object' is not a key here (did you mean 'objects'?); the keys are {SCENE_KEYS}"),
    ({"objects": [], "Frame": "x"}, f"'Frame' is not a key here (did you mean 'frame'?); the keys are {SCENE_KEYS}"),
    ({"objects": [], "unit": "inch"}, "unknown unit 'inch'; use one of m, cm, mm, px"),
    ({"objects": [], "unit": 1}, "'unit' must be a string, got a number"),
    ({"objects": [], "unit": None}, "'unit' must be a string, got null"),
    ({"objects": [], "frame": ["table"]}, "'frame' must be a string, got a list"),
    ({"objects": [], "frame": "  "}, "'frame' must be a string that is not blank, got \"  \""),
    ({"objects": [], "viewpoint": {}}, "'viewpoint' must be a string, got an object"),
    ({"objects": [BOX, 7]}, "objects[1] must be an object {…}, got a number"),
    ({"objects": [None]}, "objects[0] must be an object {…}, got null"),
    ({"objects": [], "speaker": [1]}, "'speaker' must be a list of 2 numbers, got a list of 1"),
    (without("id"), "objects[0]: 'id' is missing"),
    (without("min"), "objects[0]: 'min' is missing"),
    (without("max"), "objects[0]: 'max' is missing"),
    (one(lable="fork"), f"objects[0]: 'lable' is not a key here (did you mean 'label'?); the keys are {KEYS}"),
    (
        one(centre=[0, 0], size=[1, 1]),
        "objects[0]: 'centre' is not a key here; 'size' is not a key here; "
        f"give the corners of a box as 'min' and 'max'; the keys are {KEYS}",
    ),
    (one(id=5.5), "objects[0]: 'id' must be a string, got a number"),
    (one(id=""), "objects[0]: 'id' must be a string that is not blank, got \"\""),
    (one(id="\ud800"), "objects[0]: 'id' contains half of a surrogate pair; correct it"),
    (one(label=False), "objects[0]: 'label' must be a string, got false"),
    (one(label=" "), "objects[0]: 'label' must be a string that is not blank, got \" \""),
    (one(cloud=1.5), "objects[0]: 'cloud' must be a string, got a number"),
    (one(min=[0]), "objects[0]: 'min' must be a list of 2 or 3 numbers, got a list of 1"),
    (one(min=[0, 0, 0, 0]), "objects[0]: 'min' must be a list of 2 or 3 numbers, got a list of 4"),
    (one(max="1, 1"), "objects[0]: 'max' must be a list of 2 or 3 numbers, got a string"),
    (one(max={"x": 1, "y": 1}), "objects[0]: 'max' must be a list of 2 or 3 numbers, got an object"),
    (one(max=[1, "1"]), "objects[0]: 'max'[1] must be a number, got a string"),
    (one(max=[1, None]), "objects[0]: 'max'[1] must be a number, got null"),
    (one(max=[1, True]), "objects[0]: 'max'[1] must be a number, got true"),
    (one(max=[1, [1]]), "objects[0]: 'max'[1] must be a number, got a list"),
    (one(max=[1, 1, 1]), "object 'o1': 'min' and 'max' must both have 2 coordinates, or both 3, got 2 and 3"),
    (one(min=[2, 0]), "object 'o1': on x its min 2 is above its max 1; swap them"),
    (one(min=[0, 1.5]), "object 'o1': on y its min 1.5 is above its max 1; swap them"),
    (
        one(min=[0, 0, 2], max=[1, 1, 1]),
        "object 'o1': on z its min 2 is above its max 1; swap them",
    ),
    (one(label="fork", confidence=1.5), "object 'o1': the confidence must be from 0 to 1, got 1.5"),
    (one(label="fork", confidence=-0.1), "object 'o1': the confidence must be from 0 to 1, got -0.1"),
    (
        one(candidates={"fork": 0.7, "cup": 0.5}),
        "object 'o1': the probabilities of 'candidates' must be at least 0, and their sum at most 1, got [0.7, 0.5]",
    ),
    (
        one(candidates={"fork": -0.1}),
        "object 'o1': the probabilities of 'candidates' must be at least 0, and their sum at most 1, got [-0.1]",
    ),
    (one(candidates={"fork": "sure"}), "objects[0]: 'candidates': 'fork' must be a number, got a string"),
    (one(label="fork", confidence="sure"), "objects[0]: 'confidence' must be a number, got a string"),
    (one(colour="rde"), "objects[0]: 'colour': there is no colour 'rde'; did you mean 'red'?"),
    (
        one(colour="transparent"),
        "objects[0]: 'colour': there is no colour 'transparent'; use one of beige, black, blue, brown, cyan, gold, "
        "green, grey, indigo, khaki, lavender, magenta, maroon, navy, orange, pink, purple, red, tan, teal, turquoise, "
        "white, yellow, or #rrggbb",
    ),
    (one(colour="#f80"), "objects[0]: 'colour': '#f80' is not a colour; write #rrggbb in hexadecimal digits"),
    (one(colour=[0, 0]), "objects[0]: 'colour' as a list must be red, green and blue, each from 0 to 255, got [0, 0]"),
    (
        one(colour=[0, 0, 256]),
        "objects[0]: 'colour' as a list must be red, green and blue, each from 0 to 255, got [0, 0, 256]",
    ),
    (one(colour=[0, 0, "9"]), "objects[0]: 'colour' must be a number, got a string"),
    (one(colour=7), "objects[0]: 'colour' must be a word such as red, #rrggbb, or [red, green, blue], got a number"),
    (one(colour=""), "objects[0]: 'colour' must be a string that is not blank, got \"\""),
    ({"objects": [BOX, BOX]}, "the id 'o1' is used twice; give each object its own id"),
    (
        {"objects": [BOX, {"id": "o2", "min": [0, 0, 0], "max": [1, 1, 1]}]},
        "some boxes have heights and others do not; give all of them 2 or 3 axes",
    ),
]


@pytest.mark.parametrize(("data", "message"), CATALOGUE, ids=range(len(CATALOGUE)))
def test_a_malformed_scene_is_refused_with_place_and_reason(data: Any, message: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.scene.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    assert str(caught.value) == f"{path}: {message}"
    assert isinstance(caught.value, DeixisError)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", ":1:1: this is not valid JSON: the text is empty"),
        ("{", ":1:2: this is not valid JSON: "),
        ('{"objects": [],}', ": this is not valid JSON: "),
        (
            '{\n  "objects": [}\n',
            ":2:15: this is not valid JSON: the '[' at 2:14 is not closed; add ']' before this '}'",
        ),
        ('{"objects": []} x', ":1:17: this is not valid JSON: there is more text after the end of the JSON"),
        ("{'objects': []}", ":1:2: this is not valid JSON: "),
        (
            '{"objects": [{"id": "o1", "min": [0, NaN], "max": [1, 1]}]}',
            ": objects[0]: 'min'[1] must be a finite number, got NaN",
        ),
        (
            '{"objects": [{"id": "o1", "min": [0, 0], "max": [Infinity, 1]}]}',
            "'max'[0] must be a finite number, got Infinity",
        ),
        (
            '{"objects": [{"id": "o1", "min": [-Infinity, 0], "max": [1, 1]}]}',
            "'min'[0] must be a finite number, got -Infinity",
        ),
        (
            '{"objects": [{"id": "o1", "min": [0, 0], "max": [1e999, 1]}]}',
            "'max'[0] must be a finite number, got Infinity",
        ),
        (
            '{"objects": [{"id": "o1", "min": [-1e999, 0], "max": [1, 1]}]}',
            "'min'[0] must be a finite number, got -Infinity",
        ),
        ('{"objects": [{"id": "o1", "min": [0, 0], "max": [' + "9" * 5000 + ", 1]}]}", ": "),
        ("[" * 200_000, ": "),
        ('{"objects": ' * 100_000, ": "),
        ("nul\x00", ": this is not valid JSON: "),
    ],
    ids=range(15),
)
def test_a_text_that_is_not_a_scene_is_refused_with_its_file(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.scene.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        read_scene(path)
    assert str(caught.value).startswith(str(path))
    assert message in str(caught.value)
    assert len(str(caught.value)) < len(str(path)) + 200


def test_a_file_that_is_not_utf_8_is_refused_with_the_byte(tmp_path: Path) -> None:
    path = tmp_path / "latin.scene.json"
    path.write_bytes('{"objects": [], "frame": "é"}'.encode("latin-1"))
    with pytest.raises(SceneError, match=r"the file is not UTF-8 \(byte 26\)"):
        read_scene(path)


def test_a_folder_a_missing_file_and_a_bad_name_are_refused(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"this is a folder; give a \.scene\.json file"):
        read_scene(tmp_path)
    with pytest.raises(SceneError, match=r"none\.scene\.json: there is no such file"):
        read_scene(tmp_path / "none.scene.json")
    with pytest.raises(SceneError, match="cannot be read"):
        read_scene("a\0b.scene.json")


def test_a_file_that_is_too_large_is_refused_before_it_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MAX_BYTES", 2**20)
    path = tmp_path / "large.scene.json"
    path.write_bytes(b" " * (2**20 + 1))
    with pytest.raises(SceneError, match="larger than 1 MiB"):
        read_scene(path)


def test_messages_call_a_parsed_scene_scene() -> None:
    with pytest.raises(SceneError, match=r"^<scene>: objects\[0\]: 'id' is missing$"):
        read_scene(without("id"))


def test_keys_that_are_not_texts_are_unknown() -> None:
    keys: Any = {1: "x", "objects": [], "zzz": 2}
    with pytest.raises(SceneError, match="is not a key here"):
        read_scene(keys)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('{"objects": [], "objects": []}', "the key 'objects' occurs twice in one object"),
        ("[" * 100_000, "the JSON is nested too deeply"),
        ('{"objects": ' + "9" * 5000 + "}", "a number of 5000 digits is too large"),
    ],
)
def test_json_that_python_misreads_is_refused(content: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "x.scene.json"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(SceneError, match=message):
        read_scene(path)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no /dev/zero")
def test_a_device_is_not_read() -> None:
    with pytest.raises(SceneError, match="not a regular file"):
        read_scene("/dev/zero")
