"""Convert boxes of an image, where y points down, to a scene, where y points up."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from deixis.perception.errors import SceneError
from deixis.perception.scene import PerceivedObject, Scene


@dataclass(frozen=True, slots=True)
class ImageBox:
    """Bounding box of an annotation in pixels, x to the right and y *down* from the top left corner."""

    left: float
    top: float
    right: float
    bottom: float
    label: str | None = None
    confidence: float = 1.0

    def joined(self, other: ImageBox) -> ImageBox:
        """Return the box around both boxes, with the label and confidence of this one.

        Parameters
        ----------
        other
            The other box.

        Returns
        -------
        ImageBox
            The box around both, with the label and the confidence of this one.
        """
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
    """Return the bounding box of points.

    Parameters
    ----------
    points
        Points (x, y) in pixels.
    where
        Their place in the file, for the message.
    label
        Label of the box.
    confidence
        Probability that the label is right.

    Returns
    -------
    ImageBox
        The box.

    Raises
    ------
    SceneError
        If a coordinate is not finite, or the width or the height is 0.

    Examples
    --------
    >>> box_around([(0, 4), (2, 0), (3, 1)], "polygon")
    ImageBox(left=0, top=0, right=3, bottom=4, label=None, confidence=1.0)
    """
    xs, ys = zip(*points, strict=True)
    box = ImageBox(min(xs), min(ys), max(xs), max(ys), label, confidence)
    if not all(math.isfinite(value) for value in (*xs, *ys)):
        raise SceneError(f"{where}: a coordinate is not finite")
    if box.left >= box.right or box.top >= box.bottom:
        side = "width" if box.left >= box.right else "height"
        raise SceneError(f"{where}: the {side} of the outline must be above 0, got 0")
    return box


def image_scene(boxes: Sequence[ImageBox], height: float | None, file: str) -> Scene:
    """Return the scene of an image, with y upwards: an object higher in the image is farther away.

    The unit is px, the frame ``image``, and the viewpoint the chair, as in Figure 3 of the paper. The objects are named
    o1, o2, … in the given order.

    Parameters
    ----------
    boxes
        Boxes in pixels, with y downwards.
    height
        Height of the image; the origin is its bottom left corner. None makes the lowest box have y = 0.
    file
        Name of the file, for messages.

    Returns
    -------
    Scene
        The scene.

    Examples
    --------
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
