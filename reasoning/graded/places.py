"""Where something absent may have stood: boxes that nobody perceived, spread evenly over the scene.

Who describes a table speaks of places, of that of a missing glass too. Facts about it hold together at some places and
nowhere else; were they chance, each by itself, then whatever lies near such a place would be taken for the glass.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

PLACES, MORE = 24, 4
"""Places in a scene, and how many more for each object that has to be absent: two are never at one place. Twice as many
changed little on generated tables."""

MOST = 60
"""Objects up to which there are places: in a larger description one that is absent says little."""

MARGIN = 0.5
"""How far around the scene places lie, in its extents: what is missing may have stood beside all that is there."""

STEP = np.array([0.7548776662466927, 0.5698402909980532])
"""Steps of the additive recurrence of low discrepancy in the plane (Roberts 2018): 1/g and 1/g**2, g**3 = g + 1."""


def places_for(objects: int, things: int) -> int:
    """How many places there are beside so many things for those that are absent of so many objects.

    >>> places_for(12, 12), places_for(15, 12), places_for(3, 0), places_for(100, 100)
    (24, 36, 0, 0)
    """
    return PLACES + MORE * max(0, objects - things) if things and objects <= MOST else 0


def spread(boxes: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """So many boxes (count, 2, d), each as large and as high up as one of the scene's (n, 2, d), with its centre
    anywhere in the scene or ``MARGIN`` around it; none where there is nothing.

    >>> spread(np.array([[[0.0, 0.0], [2.0, 2.0]]]), 2).round(2).tolist()
    [[[0.0, 0.0], [2.0, 2.0]], [[-0.98, -1.72], [1.02, 0.28]]]
    """
    if not len(boxes):
        return np.zeros((0, *boxes.shape[1:]))
    numbers = np.arange(count)
    low, high = boxes[:, 0, :2].min(axis=0), boxes[:, 1, :2].max(axis=0)
    shares = (0.5 + numbers[:, None] * STEP) % 1.0
    centres = low + ((1 + 2 * MARGIN) * shares - MARGIN) * (high - low)
    found: NDArray[np.float64] = boxes[numbers % len(boxes)].astype(np.float64)
    found[:, :, :2] += (centres - found[:, :, :2].mean(axis=1))[:, None]
    return found
