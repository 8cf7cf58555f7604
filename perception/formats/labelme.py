"""Read scenes from LabelMe annotations: one JSON file per image, with a list of ``shapes``.

The format: https://github.com/wkentaro/labelme. A shape has a label and points (x, y), whose meaning depends on its
``shape_type``; the object has the bounding box of the shape. As in the exporters of LabelMe, shapes that share both a
label and a ``group_id`` are parts of one object. A single point, or an outline without width or height, is refused. A
``score``, which some related tools write, is the confidence of the label. Other keys are not read.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import PurePath
from typing import Any

from deixis.ontology.strict_json import json_type
from deixis.perception.checks import items, mapping, number, pixels, score, shown, text
from deixis.perception.errors import SceneError
from deixis.perception.formats.image_boxes import ImageBox, box_around, image_scene
from deixis.perception.scene import Scene

_Point = tuple[float, float]

POINTS = {
    "polygon": (3, None),
    "rectangle": (2, 4),
    "circle": (2, 2),
    "line": (2, 2),
    "linestrip": (2, None),
    "points": (2, None),
    "mask": (2, 2),
    "oriented_rectangle": (4, 4),
}
"""Minimum and maximum number of points of each type of shape.

A circle has its centre and a point on it, a mask and a rectangle two opposite corners (a rectangle may have all four).
"""

_MARKS = {"version", "flags", "imagePath", "imageData", "imageHeight", "imageWidth"}


def is_labelme(data: Any) -> bool:
    """Return whether parsed JSON has the keys of LabelMe annotations.

    Parameters
    ----------
    data
        Parsed JSON.

    Returns
    -------
    bool
        True for LabelMe annotations.
    """
    return isinstance(data, Mapping) and "shapes" in data and "objects" not in data and not _MARKS.isdisjoint(data)


def labelme_scene(data: Mapping[str, Any], file: str, image: str | int | None = None) -> Scene:
    """Return the scene of parsed LabelMe annotations, which describe one image.

    Parameters
    ----------
    data
        Parsed JSON of the annotations.
    file
        Name of the file, for messages.
    image
        None, or the image of the file (``imagePath``).

    Returns
    -------
    Scene
        The annotated boxes, in pixels.

    Raises
    ------
    SceneError
        If the file is malformed or is about another image; the message names the place.

    Examples
    --------
    >>> found = labelme_scene({"version": "5.4.1", "imageHeight": 100, "shapes": [
    ...     {"label": "plate", "points": [[50, 40], [50, 70]], "shape_type": "circle"}]}, "table.json")
    >>> found["o1"].label, found["o1"].minimum, found["o1"].maximum
    ('plate', (20.0, 30.0), (80.0, 90.0))
    """
    path = data.get("imagePath")
    own = path if isinstance(path, str) else ""
    if image is not None and str(image) not in (own, PurePath(own.replace("\\", "/")).name):
        raise SceneError(f"{file}: the only image of this file is '{shown(own)}', got '{shown(image)}'")
    height = pixels(data.get("imageHeight"), f"{file}: 'imageHeight'")
    boxes: dict[object, ImageBox] = {}
    for position, entry in enumerate(items(data, "shapes", file)):
        where = f"{file}: shapes[{position}]"
        box = _box(mapping(entry, where), where)
        group = entry.get("group_id")
        if group is not None and (isinstance(group, bool) or not isinstance(group, int | str)):
            raise SceneError(f"{where}: 'group_id' must be a whole number, a string or null, got {json_type(group)}")
        key = position if group is None else (box.label, group)
        boxes[key] = boxes[key].joined(box) if key in boxes else box
    return image_scene(list(boxes.values()), height, file)


def _box(entry: Mapping[str, Any], where: str) -> ImageBox:
    for key in ("label", "points"):
        if key not in entry:
            raise SceneError(f"{where}: '{key}' is missing")
    label = text(entry["label"], f"{where}: 'label'")
    shape = "polygon"  # the meaning of old files, which have no types
    if entry.get("shape_type") is not None:
        shape = text(entry["shape_type"], f"{where}: 'shape_type'")
    if shape == "point":
        raise SceneError(f"{where}: a point has no extent; outline the object, or leave it out")
    if shape not in POINTS:
        raise SceneError(f"{where}: unknown shape_type '{shown(shape)}'; use one of {', '.join(POINTS)}")
    data = entry["points"]
    at = f"{where}: 'points'"
    least, most = POINTS[shape]
    if not isinstance(data, list):
        raise SceneError(f"{at} must be a list of points [x, y], got {json_type(data)}")
    if len(data) < least or (most is not None and len(data) > most):
        number_of = f"{least} or more" if most is None else f"{least}" if least == most else f"{least} to {most}"
        raise SceneError(f"{at}: a {shape} must have {number_of} points, got {len(data)}")
    points = [_point(point, f"{at}[{position}]") for position, point in enumerate(data)]
    corners = _around(points) if shape == "circle" else points
    return box_around(corners, f"{where}: 'points'", label, score(entry, where))


def _point(data: Any, where: str) -> _Point:
    if not isinstance(data, list) or len(data) != 2:
        raise SceneError(f"{where} must be 2 numbers, x and y, got {shown(data)}")
    return number(data[0], where), number(data[1], where)


def _around(points: list[_Point]) -> list[_Point]:
    """Return two opposite corners of the square around a circle, given by its centre and a point on it."""
    (x, y), (rim_x, rim_y) = points
    radius = math.hypot(rim_x - x, rim_y - y)
    return [(x - radius, y - radius), (x + radius, y + radius)]
