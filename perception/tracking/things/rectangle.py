"""Find the hidden corners of a flat rectangular thing, such as a napkin, from what is seen of its sides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.oriented_box import OrientedBox, turned_axes

MAX_HEIGHT = 0.04
"""Largest height in metres of a flat thing."""

MAX_ELONGATION = 2.0
"""Largest ratio of the sides of a rectangle of which a corner may be hidden."""

EDGE, STEP = 0.004, 0.01
"""Distance in metres from a side of the rectangle within which a point is at this side, and the length of the pieces of
a side that are seen or not."""

MIN_SIDE, MIN_CORNERS = 0.5, 3
"""Minimum share of each side that is seen, or minimum number of corners. A side touches a round thing in less than 0.4
of its length."""


def is_rectangular(points: NDArray[np.float64], box: OrientedBox) -> bool:
    """Return True if a flat thing shows so much of the sides of its box, or of its corners, that it fills the box.

    Parameters
    ----------
    points
        Points of the thing, shape (n, 3), in metres.
    box
        Smallest upright box around them.

    Returns
    -------
    bool
        False for a round thing, and for one that is high or long.
    """
    sides = np.array(box.extents[:2])
    if box.extents[2] > MAX_HEIGHT or sides.min() < 2 * STEP or sides.max() > MAX_ELONGATION * sides.min():
        return False
    own = ((points - np.array(box.centre)) @ turned_axes(box.yaw).T)[:, :2]
    from_corner = [np.abs(own - np.array([x, y]) * sides / 2).max(axis=1).min() for x in (-1, 1) for y in (-1, 1)]
    if sum(away < 2 * EDGE for away in from_corner) >= MIN_CORNERS:
        return True
    for axis in (0, 1):
        pieces = int(np.ceil(sides[1 - axis] / STEP))
        for sign in (-1, 1):
            at_side = own[sign * own[:, axis] > sides[axis] / 2 - EDGE, 1 - axis]
            seen = np.unique(np.floor((at_side / sides[1 - axis] + 0.5) * pieces).clip(0, pieces - 1))
            if len(seen) < MIN_SIDE * pieces:
                return False
    return True
