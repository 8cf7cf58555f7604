"""Annotation files as scenes: COCO and LabelMe, told apart by what is in them.

The readers know nothing of each other; a further format is one more line in :data:`FORMATS`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from deixis.perception.coco import coco_scene, is_coco
from deixis.perception.labelme import is_labelme, labelme_scene
from deixis.perception.scene import Scene

Reader = Callable[[Mapping[str, Any], str, str | int | None], Scene]
"""From parsed JSON, the file's name and the chosen image (or None) to a scene; raises SceneError."""

FORMATS: tuple[tuple[Callable[[Any], bool], Reader], ...] = ((is_coco, coco_scene), (is_labelme, labelme_scene))


def annotation_reader(data: Any) -> Reader | None:
    """The reader of the annotation format that parsed JSON is in, or None where it is in none.

    >>> annotation_reader({"images": [], "annotations": [], "categories": []}).__name__
    'coco_scene'
    >>> annotation_reader({"objects": []}) is None
    True
    """
    return next((reader for is_format, reader in FORMATS if is_format(data)), None)
