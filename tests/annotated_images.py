"""A COCO and a LabelMe file that are whole, for the tests to read and to spoil."""

from __future__ import annotations

from typing import Any

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


def coco(**annotation: Any) -> Json:
    """Make a COCO file with one image, 480 px high, and one annotation, of a fork."""
    entry = {"image_id": 1, "category_id": 10, **annotation}
    return {"images": COCO["images"][:1], "categories": COCO["categories"], "annotations": [entry]}


def shape(**changes: Any) -> Json:
    return {"label": "fork", "points": [[1, 2], [3, 4], [1, 4]], "shape_type": "polygon", **changes}
