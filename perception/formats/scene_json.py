"""Read and write scenes as JSON (``.scene.json``); errors name the place in the file.

Annotation files in the formats COCO and LabelMe are recognised by their content and read too.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from numbers import Integral
from pathlib import Path
from typing import Any

import numpy as np

from deixis.ontology.strict_json import json_type, parse_json
from deixis.ontology.tbox import default_ontology
from deixis.ontology.things.colours import Rgb, hex_of_rgb, rgb_of_hex
from deixis.perception.checks import MAX_SHOWN, mapping, number, shown, text
from deixis.perception.errors import SceneError
from deixis.perception.formats.coco import coco_scene, is_coco
from deixis.perception.formats.labelme import is_labelme, labelme_scene
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import DEFAULT_VIEWPOINT, PLACED_VIEWER, UNITS, UNNAMED, Heading, PerceivedObject, Scene
from deixis.spelling import nearest
from deixis.text_files import no_such_file

Reader = Callable[[Mapping[str, Any], str, str | int | None], Scene]
"""Function from parsed JSON, the name of the file and the chosen image (or None) to a scene; raises SceneError."""

FORMATS: tuple[tuple[Callable[[Any], bool], Reader], ...] = ((is_coco, coco_scene), (is_labelme, labelme_scene))


def annotation_reader(data: Any) -> Reader | None:
    """Return the reader of the annotation format of parsed JSON.

    Parameters
    ----------
    data
        Parsed JSON.

    Returns
    -------
    Reader or None
        The function that makes the scene, or None for other formats.

    Examples
    --------
    >>> annotation_reader({"images": [], "annotations": [], "categories": []}).__name__
    'coco_scene'
    >>> annotation_reader({"objects": []}) is None
    True
    """
    return next((reader for is_format, reader in FORMATS if is_format(data)), None)


MAX_BYTES = 256 * 2**20

MAX_WRONG_KEYS = 3
"""Maximum number of unknown keys that one message names."""

CORNERS_INSTEAD = {"centre", "center", "size", "extents", "dimensions", "bbox", "box", "position", "minimum", "maximum"}
"""Keys of other formats that give a box; a scene has corners."""

_SCENE_KEYS = {"frame", "viewpoint", "unit", "objects", "shows", "speaker", "addressee"}
_OBJECT_KEYS = {
    "id",
    "min",
    "max",
    "label",
    "confidence",
    "cloud",
    "colour",
    "oriented",
    "candidates",
    "front",
    "heading",
}
_HEADING_KEYS = {"part", "direction", "probability"}
_ORIENTED_KEYS = {"centre", "yaw", "extents"}


def read_scene(source: str | Path | Mapping[str, Any], image: str | int | None = None) -> Scene:
    """Read a scene from a ``.scene.json`` or an annotation file, or from parsed JSON.

    Parameters
    ----------
    source
        File, or parsed JSON of one.
    image
        File name or id of the image, in a COCO file with several images.

    Returns
    -------
    Scene
        The scene, in metres or pixels.

    Raises
    ------
    SceneError
        If the source is not a scene; the message names the file and the place in it.

    Examples
    --------
    >>> scene = read_scene({"objects": [{"id": "o1", "min": [0, 0], "max": [20, 1]}], "unit": "cm"})
    >>> scene.objects[0].maximum
    (0.2, 0.01)
    """
    if isinstance(source, Mapping):
        return scene_from_dict(source, UNNAMED, image)
    if not isinstance(source, str | Path):
        raise SceneError(
            f"a scene must be read from a file or from parsed JSON, not from {type(source).__name__};"
            " in Python, 'perceive' already returns a scene"
        )
    path = Path(source)
    try:
        if path.is_dir():
            raise SceneError(f"{source or '(an empty name)'}: this is a folder; give a .scene.json file")
        if not path.is_file() and path.exists():
            raise SceneError(f"{path}: not a regular file; give a .scene.json file")
        if path.suffix == ".layout":
            raise SceneError(f"{path}: this is a layout script, not a scene; give the script before the scene")
        if path.stat().st_size > MAX_BYTES:
            raise SceneError(f"{path}: the file is larger than {MAX_BYTES // 2**20} MiB; split the scene")
        content = path.read_text(encoding="utf-8-sig")
    except SceneError:
        raise
    except FileNotFoundError as error:
        raise SceneError(no_such_file(path)) from error
    except OSError as error:
        raise SceneError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise SceneError(
            f"{path}: the file is not UTF-8 (byte {error.start}), so not a scene; 'deixis perceive' reads point clouds"
        ) from error
    except ValueError as error:
        raise SceneError(f"{path}: cannot be read: {error}") from error
    return scene_from_dict(parse_json(content, str(path), SceneError, no_number=None), str(path), image)


def scene_from_dict(data: Any, file: str, image: str | int | None = None) -> Scene:
    """Return the scene of parsed JSON in any of the formats.

    Unknown keys of a ``.scene.json`` are errors, so that a misspelt key is not ignored.

    Parameters
    ----------
    data
        Parsed JSON.
    file
        Name of the file, for messages.
    image
        File name or id of the image, in a COCO file with several images.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    SceneError
        If the data is not a scene; the message names the place.
    """
    reader = annotation_reader(data)
    if reader is not None:
        return reader(data, file, image)
    found = _mapping(mapping(data, f"{file}: the scene"), file, _SCENE_KEYS)
    if "objects" not in found:
        raise SceneError(f"{file}: 'objects' is missing; add the list of the objects")
    if not isinstance(found["objects"], list):
        raise SceneError(f"{file}: 'objects' must be a list, got {json_type(found['objects'])}")
    unit = text(found.get("unit", "m"), f"{file}: 'unit'")
    if unit not in UNITS:
        raise SceneError(f"{file}: unknown unit '{unit}'; use one of {', '.join(UNITS)}")
    given = found.get("viewpoint", DEFAULT_VIEWPOINT)
    viewer = _place(given, f"{file}: 'viewpoint'", UNITS[unit]) if isinstance(given, list | tuple) else None
    viewpoint = PLACED_VIEWER if viewer is not None else text(given, f"{file}: 'viewpoint'")
    scene = Scene(
        objects=tuple(
            _object(entry, f"{file}: objects[{position}]", UNITS[unit])
            for position, entry in enumerate(found["objects"])
        ),
        frame=text(found.get("frame", "table"), f"{file}: 'frame'"),
        viewpoint=viewpoint,
        viewer=viewer,
        unit="px" if unit == "px" else "m",
        file=file,
        speaker=_place(found.get("speaker"), f"{file}: 'speaker'", UNITS[unit]),
        addressee=_place(found.get("addressee"), f"{file}: 'addressee'", UNITS[unit]),
    )
    if image is not None:
        raise SceneError(f"{file}: an image ('{shown(image)}') can be chosen in annotation files only; leave it out")
    return scene


def _object(data: Any, where: str, scale: float) -> PerceivedObject:
    entry = _mapping(data, where, _OBJECT_KEYS)
    _require_keys(entry, ("id", "min", "max"), where)
    label, confidence, cloud = entry.get("label"), entry.get("confidence", 1.0), entry.get("cloud")
    colour, oriented, front = entry.get("colour"), entry.get("oriented"), entry.get("front")
    return PerceivedObject(
        id=_id(entry["id"], f"{where}: 'id'"),
        minimum=_numbers(entry["min"], f"{where}: 'min'", scale, (2, 3)),
        maximum=_numbers(entry["max"], f"{where}: 'max'", scale, (2, 3)),
        label=None if label is None else text(label, f"{where}: 'label'"),
        confidence=1.0 if confidence is None else number(confidence, f"{where}: 'confidence'"),
        cloud=None if cloud is None else text(cloud, f"{where}: 'cloud'"),
        colour=None if colour is None else _colour(colour, f"{where}: 'colour'"),
        oriented=None if oriented is None else _oriented(oriented, f"{where}: 'oriented'", scale),
        candidates=_candidates(entry.get("candidates"), f"{where}: 'candidates'"),
        front=None if front is None else _direction(front, f"{where}: 'front'"),
        heading=None if entry.get("heading") is None else _heading(entry["heading"], f"{where}: 'heading'"),
    )


def _heading(data: Any, where: str) -> Heading:
    entry = _mapping(data, where, _HEADING_KEYS)
    _require_keys(entry, ("part", "direction"), where)
    return Heading(
        text(entry["part"], f"{where}: 'part'"),
        _direction(entry["direction"], f"{where}: 'direction'"),
        number(entry.get("probability", 1.0), f"{where}: 'probability'"),
    )


def _id(data: Any, where: str) -> str:
    """Return an id as text; integers are accepted, because detectors and trackers use them."""
    if isinstance(data, Integral) and not isinstance(data, bool):
        return str(int(data))
    return text(data, where)


def _candidates(data: Any, where: str) -> tuple[tuple[str, float], ...]:
    if data is None:
        return ()
    return tuple(
        (text(name, where), number(share, f"{where}: '{shown(name)}'")) for name, share in mapping(data, where).items()
    )


def _oriented(data: Any, where: str, scale: float) -> OrientedBox:
    entry = _mapping(data, where, _ORIENTED_KEYS)
    _require_keys(entry, ("centre", "extents", "yaw"), where)
    x, y, z = _numbers(entry["centre"], f"{where}: 'centre'", scale, (3,))
    length, width, height = _numbers(entry["extents"], f"{where}: 'extents'", scale, (3,))
    return OrientedBox((x, y, z), number(entry["yaw"], f"{where}: 'yaw'"), (length, width, height))


def _direction(data: Any, where: str) -> tuple[float, float]:
    x, y = _numbers(data, where, 1.0, (2,))
    return x, y


def _colour(data: Any, where: str) -> Rgb:
    """Return the colour of a word of the ontology (its prototype), of ``#rrggbb``, or of three numbers."""
    if isinstance(data, list | tuple):
        parts = [number(part, where) for part in data]
        if len(parts) != 3 or not all(0 <= part <= 255 for part in parts):
            raise SceneError(f"{where} as a list must be red, green and blue, each from 0 to 255, got {list(data)}")
        return round(parts[0]), round(parts[1]), round(parts[2])
    if not isinstance(data, str):
        raise SceneError(f"{where} must be a word such as red, #rrggbb, or [red, green, blue], got {json_type(data)}")
    word = text(data, where)
    if word.startswith("#"):
        if (found := rgb_of_hex(word)) is None:
            raise SceneError(f"{where}: '{shown(word)}' is not a colour; write #rrggbb in hexadecimal digits")
        return found
    colours = default_ontology().colours
    if (colour := colours.of_word(word)) is not None:
        return colour.prototype
    near = nearest(word.casefold(), list(colours.words)) if len(word) <= MAX_SHOWN else None
    suggestion = f"did you mean '{near}'?" if near else f"use one of {', '.join(c.label for c in colours)}, or #rrggbb"
    raise SceneError(f"{where}: there is no colour '{shown(word)}'; {suggestion}")


def _place(data: Any, where: str, scale: float) -> tuple[float, float] | None:
    if data is None:
        return None
    x, y = _numbers(data, where, scale, (2,))
    return x, y


def _mapping(data: Any, where: str, known: set[str]) -> Mapping[str, Any]:
    entry = mapping(data, where)
    unknown = sorted(set(entry) - known, key=str)
    if unknown:
        wrong = [_misspelt(key, known - set(entry)) for key in unknown[:MAX_WRONG_KEYS]]
        if "min" in known and not CORNERS_INSTEAD.isdisjoint(unknown):
            wrong.append("give the corners of a box as 'min' and 'max'")
        raise SceneError(f"{where}: {'; '.join(wrong)}; the keys are {', '.join(sorted(known))}")
    return entry


def _misspelt(key: Any, known: set[str]) -> str:
    """Return what is wrong with a key that is not known, with the key that was probably meant."""
    word = shown(key)
    near = nearest(word.casefold(), sorted(known)) if len(word) <= MAX_SHOWN else None
    return f"'{word}' is not a key here" + (f" (did you mean '{near}'?)" if near else "")


def _require_keys(entry: Mapping[str, Any], keys: Sequence[str], where: str) -> None:
    missing = [key for key in keys if key not in entry]
    if missing:
        raise SceneError(f"{where}: '{missing[0]}' is missing")


def _numbers(data: Any, where: str, scale: float, counts: Sequence[int]) -> tuple[float, ...]:
    if isinstance(data, np.ndarray):
        data = data.tolist()
    if not isinstance(data, list | tuple) or len(data) not in counts:
        given = f"a list of {len(data)}" if isinstance(data, list | tuple) else json_type(data)
        raise SceneError(f"{where} must be a list of {' or '.join(map(str, counts))} numbers, got {given}")
    return tuple(number(value, f"{where}[{i}]") * scale for i, value in enumerate(data))


def scene_to_dict(scene: Scene) -> dict[str, Any]:
    """Return the scene as a dictionary for :func:`read_scene`, in metres or pixels, without points in memory.

    Parameters
    ----------
    scene
        Scene in metres or pixels.

    Returns
    -------
    dict
        Data for :func:`read_scene`, in metres or pixels, without points in memory.
    """
    objects = []
    for thing in scene.objects:
        entry: dict[str, Any] = {"id": thing.id, "min": list(thing.minimum), "max": list(thing.maximum)}
        entry["label"] = thing.label
        if thing.label is not None and thing.confidence < 1:
            entry["confidence"] = thing.confidence
        if thing.candidates:
            entry["candidates"] = dict(thing.candidates)
        if isinstance(thing.cloud, str):
            entry["cloud"] = thing.cloud
        if thing.colour is not None:
            entry["colour"] = hex_of_rgb(thing.colour)
        if thing.oriented is not None:
            box = thing.oriented
            entry["oriented"] = {"centre": list(box.centre), "yaw": box.yaw, "extents": list(box.extents)}
        if thing.front is not None:
            entry["front"] = list(thing.front)
        if thing.heading is not None:
            found = thing.heading
            entry["heading"] = {
                "part": found.part,
                "direction": list(found.direction),
                "probability": found.probability,
            }
        objects.append(entry)
    people = {"speaker": scene.speaker, "addressee": scene.addressee}
    placed = {person: list(place) for person, place in people.items() if place is not None}
    viewpoint = scene.viewpoint if scene.viewer is None else list(scene.viewer)
    return {"frame": scene.frame, "viewpoint": viewpoint, "unit": scene.unit, **placed, "objects": objects}


def scene_text(scene: Scene) -> str:
    """Return the text of a ``.scene.json``, one object per line.

    Parameters
    ----------
    scene
        Scene in metres or pixels.

    Returns
    -------
    str
        The text, with a line end at its end.
    """
    data = scene_to_dict(scene)
    lines = ",\n".join("    " + json.dumps(entry, ensure_ascii=False) for entry in data.pop("objects"))
    head = "".join(f'  "{key}": {json.dumps(value, ensure_ascii=False)},\n' for key, value in data.items())
    return f'{{\n{head}  "objects": [\n{lines}\n  ]\n}}\n'
