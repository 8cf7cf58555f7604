"""Boxes in an image, turned into a scene: image coordinates have y downwards, and a scene has it upwards."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from deixis.perception.errors import SceneError
from deixis.perception.scene import PerceivedObject, Scene


@dataclass(frozen=True, slots=True)
class ImageBox:
    """What an annotator outlined: the bounding box in pixels, x to the right and y *down* from the top left corner."""

    left: float
    top: float
    right: float
    bottom: float
    label: str | None = None
    confidence: float = 1.0

    def joined(self, other: ImageBox) -> ImageBox:
        """Return the box around both, named and trusted as this one."""
        return ImageBox(
            min(self.left, other.left),
            min(self.top, other.top),
            max(self.right, other.right),
            max(self.bottom, other.bottom),
            self.label,
            self.confidence,
        )


def box_around(
    points: Iterable[Sequence[float]], where: str, label: str | None = None, confidence: float = 1.0
) -> ImageBox:
    """Return the bounding box of points (x, y).

    >>> box_around([(0, 4), (2, 0), (3, 1)], "polygon")
    ImageBox(left=0, top=0, right=3, bottom=4, label=None, confidence=1.0)

    Raises SceneError where a coordinate is not finite or the box has no width or no height.
    """
    xs, ys = zip(*points, strict=True)
    box = ImageBox(min(xs), min(ys), max(xs), max(ys), label, confidence)
    if not all(math.isfinite(value) for value in (*xs, *ys)):
        raise SceneError(f"{where}: a coordinate is not finite")
    if box.left >= box.right or box.top >= box.bottom:
        side = "width" if box.left >= box.right else "height"
        raise SceneError(f"{where}: the outline has no {side}; an object's box needs both")
    return box


def image_scene(boxes: Sequence[ImageBox], height: float | None, file: str) -> Scene:
    """Return the scene of an image, y turned upwards: what is higher in the image lies farther away, as seen in it.

    The origin is the image's bottom left corner where its ``height`` is known, else the height of the lowest
    outline, so that the least y is 0. The unit is px, the frame ``image``, and the image counts as seen from the
    chair, as in Figure 3 of the paper. Objects are called o1, o2, … in the order given.

    >>> scene = image_scene([ImageBox(10, 20, 30, 60, "fork")], 100, "table.json")
    >>> scene["o1"].minimum, scene["o1"].maximum
    ((10, 40), (30, 80))
    """
    floor = height if height is not None else max((box.bottom for box in boxes), default=0.0)
    things = [
        PerceivedObject(
            id=f"o{position}",
            minimum=(box.left, floor - box.bottom),
            maximum=(box.right, floor - box.top),
            label=box.label,
            confidence=box.confidence if box.label is not None else 1.0,
        )
        for position, box in enumerate(boxes, 1)
    ]
    return Scene(tuple(things), frame="image", unit="px", file=file)
