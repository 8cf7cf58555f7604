"""Boxes seen from another side: turned about the vertical axis, and mirrored."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.geometry.rectangle import require_boxes

Array = NDArray[np.float64]

MAX_ROUND_CONTRAST = 0.05
"""Contrast |W - H| / (W + H) below which a box is taken for that of a round object."""


def turned(boxes: Array, angle: float, mirrored: bool = False) -> Array:
    """Return the boxes of a scene turned about the origin; heights stay.

    Parameters
    ----------
    boxes
        Minimum and maximum corners, shape (n, 2, d).
    angle
        Angle in radians, counterclockwise seen from above.
    mirrored
        Mirror the scene left to right before turning it.

    Returns
    -------
    Array
        The turned boxes, shape (n, 2, d): the enclosing axis-aligned ones.

    Raises
    ------
    GraphError
        If the boxes are invalid.

    Examples
    --------
    >>> cup = np.array([[[1.0, 0.0], [3.0, 1.0]]])
    >>> turned(cup, math.pi / 2).tolist()
    [[[-1.0, 1.0], [0.0, 3.0]]]
    """
    require_boxes(boxes)
    quarters = angle / (math.pi / 2)
    low, high = boxes[:, 0, :2], boxes[:, 1, :2]
    if mirrored:
        flip = np.array([-1.0, 1.0])
        low, high = np.minimum(low * flip, high * flip), np.maximum(low * flip, high * flip)
    if abs(quarters - round(quarters)) < 1e-9:
        lower = low
        upper = high
        for _ in range(round(quarters) % 4):
            lower, upper = np.stack([-upper[:, 1], lower[:, 0]], axis=1), np.stack([-lower[:, 1], upper[:, 0]], axis=1)
        low, high = lower + 0.0, upper + 0.0
    else:
        cos, sin = math.cos(angle), math.sin(angle)
        centres = (low + high) / 2 @ np.array([[cos, sin], [-sin, cos]])
        width, height = (high - low).T
        total, difference = width + height, width - height
        spread, contrast = abs(cos) + abs(sin), abs(cos) - abs(sin)
        sum_, limit = total / spread, total / spread
        apart = np.clip(difference / contrast, -limit, limit) if abs(contrast) > 1e-9 else np.zeros(len(total))
        oblong = np.abs(difference) > MAX_ROUND_CONTRAST * total
        extents = np.stack([sum_ + apart, sum_ - apart], axis=1) / 2
        halves = np.where(oblong[:, None], extents, np.stack([width, height], axis=1)) / 2
        low, high = centres - halves, centres + halves
    result = boxes.astype(np.float64, copy=True)
    result[:, 0, :2], result[:, 1, :2] = low, high
    return result
