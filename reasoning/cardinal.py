"""Cardinal direction between the centres of boxes: eight cones of 45 degrees, as QSRlib's ``cardir`` has them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

CARDINAL_DIRECTIONS: tuple[str, ...] = ("n", "ne", "e", "se", "s", "sw", "w", "nw")
SAME_PLACE = "eq"
CONES: tuple[str, ...] = (*CARDINAL_DIRECTIONS, SAME_PLACE)


def cardinal_directions(boxes: NDArray[np.float64]) -> NDArray[np.str_]:
    """For every ordered pair, in which direction the subject's centre lies from the object's: shape (n, n).

    ``boxes`` has shape (n, 2, d), d at least 2; north is y up, east is x to the right. A direction on the border of
    two cones belongs to the clockwise one (22.5 degrees east of north is north-east). Equal centres are ``eq``.

    >>> cardinal_directions(np.array([[[0.0, 2], [1, 3]], [[0, 0], [1, 1]]])).tolist()
    [['eq', 'n'], ['s', 'eq']]
    """
    return np.array(CONES)[cardinal_cones(boxes)]


def cardinal_cones(boxes: NDArray[np.float64]) -> NDArray[np.int16]:
    """The same as positions in CONES, shape (n, n)."""
    centres = boxes.mean(axis=1)
    east = centres[:, None, 0] - centres[None, :, 0]
    north = centres[:, None, 1] - centres[None, :, 1]
    clockwise = np.degrees(np.arctan2(east, north))
    cone = np.floor((clockwise + 22.5) / 45.0).astype(np.int16) % 8
    return np.where((east == 0) & (north == 0), np.int16(8), cone)
