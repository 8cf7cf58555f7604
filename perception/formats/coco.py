"""Read and write scenes as COCO instance annotations: ``images``, ``annotations`` and ``categories`` in one JSON file.

The format: https://cocodataset.org/#format-data. Each annotation of the chosen image becomes an object, except crowds
(``"iscrowd": 1``), which outline several objects at once and are skipped without a note. The box is the ``bbox``
[x, y, width, height], or else the box around all polygons of ``segmentation``. Run-length encoded masks are not decoded
and need a ``bbox``. A ``score``, as detectors write it, is the confidence of the label; ``"category_id": null`` leaves
an object without a label. Other keys are not read. Of annotations of other images, only the ``image_id`` is read.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from typing import Any

from deixis.ontology.strict_json import json_type
from deixis.perception.checks import items, mapping, number, pixels, score, shown, text
from deixis.perception.errors import SceneError
from deixis.perception.formats.image_boxes import box_around, image_scene
from deixis.perception.scene import Scene

MAX_LISTED = 5
"""Maximum number of images that an error lists."""

_Id = int | str


@dataclass(frozen=True, slots=True)
class _Image:
    id: _Id
    name: str | None
    height: float | None

    def __str__(self) -> str:
        return f"{self.id}" if self.name is None else f"'{shown(self.name)}' (id {shown(self.id)})"


def is_coco(data: Any) -> bool:
    """Return whether parsed JSON has the keys of COCO annotations.

    Parameters
    ----------
    data
        Parsed JSON.

    Returns
    -------
    bool
        True for COCO annotations.
    """
    return isinstance(data, Mapping) and "images" in data and "annotations" in data and "objects" not in data


def coco_scene(data: Mapping[str, Any], file: str, image: str | int | None = None) -> Scene:
    """Return the scene of one image of parsed COCO annotations.

    Parameters
    ----------
    data
        Parsed JSON of the annotations.
    file
        Name of the file for error messages.
    image
        File name or id of the image; None if the file has only one.

    Returns
    -------
    Scene
        The annotated boxes, in pixels.

    Raises
    ------
    SceneError
        If the file is malformed, has no such image, or has several and ``image`` is None; the message names the place.

    Examples
    --------
    >>> found = coco_scene({
    ...     "images": [{"id": 1, "file_name": "table.jpg", "width": 640, "height": 480}],
    ...     "categories": [{"id": 7, "name": "fork"}],
    ...     "annotations": [{"id": 1, "image_id": 1, "category_id": 7, "bbox": [100, 80, 20, 200]}],
    ... }, "table.json")
    >>> found["o1"].label, found["o1"].minimum, found["o1"].maximum
    ('fork', (100.0, 200.0), (120.0, 400.0))
    """
    images = _images(data, file)
    chosen = _chosen(images, image, file)
    labels = _categories(data, file)
    known = {candidate.id for candidate in images}
    boxes = []
    for position, entry in enumerate(items(data, "annotations", file)):
        where = f"{file}: annotations[{position}]"
        belongs_to = _id(_required(mapping(entry, where), "image_id", where), f"{where}: 'image_id'")
        if belongs_to not in known:
            raise SceneError(f"{where}: 'image_id' {shown(belongs_to)} is not the id of an image in this file")
        if belongs_to == chosen.id and not _is_crowd(entry, where):
            label = _label(_required(entry, "category_id", where), labels, where)
            if entry.get("bbox") is not None:
                points, place = _bbox(entry["bbox"], f"{where}: 'bbox'"), f"{where}: 'bbox'"
            else:
                points, place = _polygons(entry.get("segmentation"), where), f"{where}: 'segmentation'"
            boxes.append(box_around(points, place, label, score(entry, where)))
    return image_scene(boxes, chosen.height, file)


def scene_to_coco(scene: Scene, size: tuple[int, int] | None = None, file_name: str | None = None) -> dict[str, Any]:
    """Return the COCO instance annotations of a scene in pixels, with one image and y downward.

    Parameters
    ----------
    scene
        A scene in pixels, with y upward.
    size
        Width and height of the image in pixels; None for the smallest image that holds all boxes.
    file_name
        File name of the image.

    Returns
    -------
    dict
        ``images``, ``annotations`` in the order of the objects, with ids from 1, and ``categories``. An object without
        a label has the category null; a confidence below 1 is the ``score``.

    Raises
    ------
    SceneError
        If the scene is not in pixels.
    """
    if scene.unit != "px":
        raise SceneError(f"{scene.file}: COCO boxes must be in pixels, and this scene is in metres")
    corners = [thing.maximum for thing in scene.objects]
    width, height = size or (ceil(max((top[k] for top in corners), default=1.0)) for k in (0, 1))
    labels = list(dict.fromkeys(thing.label for thing in scene.objects if thing.label is not None))
    annotations: list[dict[str, Any]] = []
    for id, thing in enumerate(scene.objects, start=1):
        (left, low), (right, top) = thing.minimum[:2], thing.maximum[:2]
        category = None if thing.label is None else labels.index(thing.label) + 1
        box = [left, height - top, right - left, top - low]
        entry = {
            "id": id,
            "image_id": 1,
            "category_id": category,
            "bbox": box,
            "area": box[2] * box[3],
            "iscrowd": 0,
        }
        annotations.append(entry if thing.confidence == 1 else entry | {"score": thing.confidence})
    image = {"id": 1, "width": width, "height": height}
    return {
        "images": [image if file_name is None else image | {"file_name": file_name}],
        "categories": [{"id": id, "name": label} for id, label in enumerate(labels, start=1)],
        "annotations": annotations,
    }


def _images(data: Mapping[str, Any], file: str) -> list[_Image]:
    images: dict[_Id, _Image] = {}
    for position, entry in enumerate(items(data, "images", file)):
        where = f"{file}: images[{position}]"
        identifier = _new_id(mapping(entry, where), images, where)
        name, height = entry.get("file_name"), entry.get("height")
        images[identifier] = _Image(
            identifier,
            None if name is None else text(name, f"{where}: 'file_name'"),
            pixels(height, f"{where}: 'height'"),
        )
    if not images:
        raise SceneError(f"{file}: 'images' must have at least one image, got none")
    return list(images.values())


def _chosen(images: list[_Image], wanted: str | int | None, file: str) -> _Image:
    """Return the image with a file name or else an id, which may be given as a text."""
    if wanted is None and len(images) == 1:
        return images[0]
    named = [image for image in images if image.name is not None and image.name == wanted]
    named = named or [image for image in images if image.id == wanted]
    named = named or [image for image in images if str(image.id) == wanted]
    if len(named) == 1:
        return named[0]
    listed = ", ".join(str(image) for image in (named or images)[:MAX_LISTED])
    listed += ", …" if len(named or images) > MAX_LISTED else ""
    if named:
        raise SceneError(f"{file}: {len(named)} images are called '{shown(wanted)}'; choose one by id: {listed}")
    if wanted is None:
        raise SceneError(f"{file}: the file has {len(images)} images; choose one by file name or id: {listed}")
    raise SceneError(f"{file}: there is no image '{shown(wanted)}' in this file; it has {listed}")


def _categories(data: Mapping[str, Any], file: str) -> dict[_Id, str]:
    labels: dict[_Id, str] = {}
    for position, entry in enumerate(items(data, "categories", file)):
        where = f"{file}: categories[{position}]"
        identifier = _new_id(mapping(entry, where), labels, where)
        labels[identifier] = text(_required(entry, "name", where), f"{where}: 'name'")
    return labels


def _is_crowd(entry: Mapping[str, Any], where: str) -> bool:
    crowd = entry.get("iscrowd", 0)
    if not isinstance(crowd, int) or crowd not in (0, 1):
        raise SceneError(f"{where}: 'iscrowd' must be 0 or 1, got {shown(crowd)}")
    return bool(crowd)


def _label(category: Any, labels: Mapping[_Id, str], where: str) -> str | None:
    if category is None:
        return None
    identifier = _id(category, f"{where}: 'category_id'")
    if identifier not in labels:
        raise SceneError(f"{where}: 'category_id' {shown(identifier)} is not the id of a category in this file")
    return labels[identifier]


def _bbox(data: Any, where: str) -> list[tuple[float, float]]:
    if not isinstance(data, list) or len(data) != 4:
        raise SceneError(f"{where} must be 4 numbers, x, y, width and height, got {shown(data)}")
    x, y, width, height = (number(value, where) for value in data)
    if width < 0 or height < 0:
        raise SceneError(f"{where}: width and height must be at least 0, got {width:g} and {height:g}")
    return [(x, y), (x + width, y + height)]


def _polygons(data: Any, where: str) -> list[tuple[float, float]]:
    """Return the corners of all polygons of a segmentation."""
    if data is None:
        raise SceneError(f"{where}: 'bbox' and 'segmentation' are both missing; give one of them")
    if isinstance(data, Mapping):
        raise SceneError(f"{where}: run-length encoded 'segmentation' cannot be read; add a 'bbox'")
    if not isinstance(data, list) or not data:
        raise SceneError(f"{where}: 'segmentation' must be a list of at least one polygon, got {shown(data)}")
    corners: list[tuple[float, float]] = []
    for part, flat in enumerate(data):
        place = f"{where}: 'segmentation'[{part}]"
        if not isinstance(flat, list) or len(flat) < 6 or len(flat) % 2:
            raise SceneError(f"{place} must be a list x1, y1, x2, y2, … of at least 3 corners, got {shown(flat)}")
        values = [number(value, place) for value in flat]
        corners += zip(values[::2], values[1::2], strict=True)
    return corners


def _new_id(entry: Mapping[str, Any], taken: Mapping[_Id, object], where: str) -> _Id:
    identifier = _id(_required(entry, "id", where), f"{where}: 'id'")
    if identifier in taken:
        raise SceneError(f"{where}: the id {shown(identifier)} is used twice")
    return identifier


def _id(data: Any, where: str) -> _Id:
    if isinstance(data, bool) or not isinstance(data, int | str):
        raise SceneError(f"{where} must be a whole number or a string, got {json_type(data)}")
    if isinstance(data, int) and abs(data) >= 2**63:
        raise SceneError(f"{where}: the number is too large")
    return data


def _required(entry: Mapping[str, Any], key: str, where: str) -> Any:
    if key not in entry:
        raise SceneError(f"{where}: '{key}' is missing")
    return entry[key]
