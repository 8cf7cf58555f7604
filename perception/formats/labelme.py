"""Scenes from LabelMe annotations: one JSON file an image, with a list of ``shapes``.

The format: https://github.com/wkentaro/labelme. A shape is a label and points (x, y), which its ``shape_type`` reads;
every shape gives its bounding box. As in LabelMe's own exporters, shapes that share both a label and a ``group_id``
are parts of one object. A single point has no extent and is refused, like every outline without width or height.
A ``score``, as some of its relatives write it, is the label's confidence. Other keys are not looked at.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import PurePath
from typing import Any

from deixis.perception.checks import items, kind, mapping, number, pixels, score, shown, text
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
"""How many points each type of shape has, from and to; a circle's are its centre and a point on it, a mask's and a
rectangle's two opposite corners (or all four of a rectangle)."""

_MARKS = {"version", "flags", "imagePath", "imageData", "imageHeight", "imageWidth"}


def is_labelme(data: Any) -> bool:
    """Return whether parsed JSON is meant as LabelMe annotations."""
    return isinstance(data, Mapping) and "shapes" in data and "objects" not in data and not _MARKS.isdisjoint(data)


def labelme_scene(data: Mapping[str, Any], file: str, image: str | int | None = None) -> Scene:
    """Return the scene of the one image; ``image`` need not be given, and must be the file's own (``imagePath``) if it
    is.

    >>> found = labelme_scene({"version": "5.4.1", "imageHeight": 100, "shapes": [
    ...     {"label": "plate", "points": [[50, 40], [50, 70]], "shape_type": "circle"}]}, "table.json")
    >>> found["o1"].label, found["o1"].minimum, found["o1"].maximum
    ('plate', (20.0, 30.0), (80.0, 90.0))

    Raises SceneError, with the place, where the file is malformed or ``image`` is another one.
    """
    path = data.get("imagePath")
    own = path if isinstance(path, str) else ""
    if image is not None and str(image) not in (own, PurePath(own.replace("\\", "/")).name):
        raise SceneError(f"{file}: this file is about the image '{shown(own)}' alone, not '{shown(image)}'")
    height = pixels(data.get("imageHeight"), f"{file}: 'imageHeight'")
    boxes: dict[object, ImageBox] = {}
    for position, entry in enumerate(items(data, "shapes", file)):
        where = f"{file}: shapes[{position}]"
        box = _box(mapping(entry, where), where)
        group = entry.get("group_id")
        if group is not None and (isinstance(group, bool) or not isinstance(group, int | str)):
            raise SceneError(f"{where}: 'group_id' is a whole number, a text or null, not {kind(group)}")
        key = position if group is None else (box.label, group)
        boxes[key] = boxes[key].joined(box) if key in boxes else box
    return image_scene(list(boxes.values()), height, file)


def _box(entry: Mapping[str, Any], where: str) -> ImageBox:
    for key in ("label", "points"):
        if key not in entry:
            raise SceneError(f"{where}: '{key}' is missing")
    label = text(entry["label"], f"{where}: 'label'")
    shape = "polygon"  # what old files mean, which have no types
    if entry.get("shape_type") is not None:
        shape = text(entry["shape_type"], f"{where}: 'shape_type'")
    if shape == "point":
        raise SceneError(f"{where}: a point has no extent, and an object needs a box; outline it, or leave it out")
    if shape not in POINTS:
        raise SceneError(f"{where}: the shape_type '{shown(shape)}' is not known; use one of {', '.join(POINTS)}")
    data = entry["points"]
    at = f"{where}: 'points'"
    least, most = POINTS[shape]
    if not isinstance(data, list):
        raise SceneError(f"{at} must be a list of points [x, y], not {kind(data)}")
    if len(data) < least or (most is not None and len(data) > most):
        number_of = f"{least} or more" if most is None else f"{least}" if least == most else f"{least} to {most}"
        raise SceneError(f"{at}: a {shape} has {number_of} points, not {len(data)}")
    points = [_point(point, f"{at}[{position}]") for position, point in enumerate(data)]
    corners = _around(points) if shape == "circle" else points
    return box_around(corners, f"{where}: 'points'", label, score(entry, where))


def _point(data: Any, where: str) -> _Point:
    if not isinstance(data, list) or len(data) != 2:
        raise SceneError(f"{where} must have 2 numbers: x and y")
    return number(data[0], where), number(data[1], where)


def _around(points: list[_Point]) -> list[_Point]:
    """Return two corners of the square around a circle, of which the centre and a point on it are given."""
    (x, y), (rim_x, rim_y) = points
    radius = math.hypot(rim_x - x, rim_y - y)
    return [(x - radius, y - radius), (x + radius, y + radius)]
