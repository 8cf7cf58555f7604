"""Scenes from COCO instance annotations: ``images``, ``annotations`` and ``categories`` in one JSON file.

The format: https://cocodataset.org/#format-data. Of the chosen image every annotation becomes an object, but crowds
(``"iscrowd": 1``), which outline many things at once and none of them, are left out without a word. A ``bbox``
[x, y, width, height] gives the box; without one the polygons of ``segmentation`` do, all parts of an object in one
box. Run-length encoded masks are not decoded: they need a ``bbox`` beside them. A ``score``, as detectors write it,
is the label's confidence; ``"category_id": null`` leaves an object unnamed. Keys that are not needed are not looked
at, and of the annotations of other images nothing but the image that they belong to.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from deixis.perception.checks import items, kind, mapping, number, pixels, score, shown, text
from deixis.perception.errors import SceneError
from deixis.perception.formats.image_boxes import box_around, image_scene
from deixis.perception.scene import Scene

MAX_LISTED = 5
"""How many images an error lists to choose from."""

_Id = int | str


@dataclass(frozen=True, slots=True)
class _Image:
    id: _Id
    name: str | None
    height: float | None

    def __str__(self) -> str:
        return f"{self.id}" if self.name is None else f"'{shown(self.name)}' (id {shown(self.id)})"


def is_coco(data: Any) -> bool:
    """Return whether parsed JSON is meant as COCO annotations."""
    return isinstance(data, Mapping) and "images" in data and "annotations" in data and "objects" not in data


def coco_scene(data: Mapping[str, Any], file: str, image: str | int | None = None) -> Scene:
    """Return the scene of one image; ``image`` chooses it by file name or id where there are several.

    >>> found = coco_scene({
    ...     "images": [{"id": 1, "file_name": "table.jpg", "width": 640, "height": 480}],
    ...     "categories": [{"id": 7, "name": "fork"}],
    ...     "annotations": [{"id": 1, "image_id": 1, "category_id": 7, "bbox": [100, 80, 20, 200]}],
    ... }, "table.json")
    >>> found["o1"].label, found["o1"].minimum, found["o1"].maximum
    ('fork', (100.0, 200.0), (120.0, 400.0))

    Raises SceneError, with the place, where the file is malformed, the image is none of its, or none is chosen.
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
            raise SceneError(f"{where}: 'image_id' {shown(belongs_to)} is the id of no image in this file")
        if belongs_to == chosen.id and not _is_crowd(entry, where):
            label = _label(_required(entry, "category_id", where), labels, where)
            if entry.get("bbox") is not None:
                points, place = _bbox(entry["bbox"], f"{where}: 'bbox'"), f"{where}: 'bbox'"
            else:
                points, place = _polygons(entry.get("segmentation"), where), f"{where}: 'segmentation'"
            boxes.append(box_around(points, place, label, score(entry, where)))
    return image_scene(boxes, chosen.height, file)


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
        raise SceneError(f"{file}: 'images' is empty, so there is no scene in this file")
    return list(images.values())


def _chosen(images: list[_Image], wanted: str | int | None, file: str) -> _Image:
    """Return the image of a file name, else of an id, which may be given as a text."""
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
        raise SceneError(f"{file}: {len(named)} images are called '{shown(wanted)}'; choose one by its id: {listed}")
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
        raise SceneError(f"{where}: 'iscrowd' must be 0 or 1")
    return bool(crowd)


def _label(category: Any, labels: Mapping[_Id, str], where: str) -> str | None:
    if category is None:
        return None
    identifier = _id(category, f"{where}: 'category_id'")
    if identifier not in labels:
        raise SceneError(f"{where}: 'category_id' {shown(identifier)} is the id of no category in this file")
    return labels[identifier]


def _bbox(data: Any, where: str) -> list[tuple[float, float]]:
    if not isinstance(data, list) or len(data) != 4:
        raise SceneError(f"{where} must have 4 numbers: x, y, width and height")
    x, y, width, height = (number(value, where) for value in data)
    if width < 0 or height < 0:
        raise SceneError(f"{where}: a width or height below 0")
    return [(x, y), (x + width, y + height)]


def _polygons(data: Any, where: str) -> list[tuple[float, float]]:
    """Return the corners of all parts."""
    if data is None:
        raise SceneError(f"{where}: 'bbox' is missing, and so is 'segmentation'; an object needs one of them")
    if isinstance(data, Mapping):
        raise SceneError(f"{where}: 'segmentation' is run-length encoded, which is not read; give a 'bbox' beside it")
    if not isinstance(data, list) or not data:
        raise SceneError(f"{where}: 'segmentation' must be a list of polygons, with one at least")
    corners: list[tuple[float, float]] = []
    for part, flat in enumerate(data):
        place = f"{where}: 'segmentation'[{part}]"
        if not isinstance(flat, list) or len(flat) < 6 or len(flat) % 2:
            raise SceneError(f"{place} must be a list x1, y1, x2, y2, … of 3 corners or more")
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
        raise SceneError(f"{where}: an id is a whole number or a text, not {kind(data)}")
    if isinstance(data, int) and abs(data) >= 2**63:
        raise SceneError(f"{where}: the number is too large")
    return data


def _required(entry: Mapping[str, Any], key: str, where: str) -> Any:
    if key not in entry:
        raise SceneError(f"{where}: '{key}' is missing")
    return entry[key]
