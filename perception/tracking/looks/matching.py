"""Match the objects of a look at the whole table with the things that are tracked, by the pixels that both have."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.frames.image import FrameImage
from deixis.perception.tracking.table.reference import Reference
from deixis.perception.tracking.things.pipeline import Pipeline

SAME_PIXELS = 0.3
"""Minimum intersection over union of pixels at which a detected and a tracked thing may be one."""


def matches(
    of: NDArray[np.int32],
    count: int,
    image: FrameImage,
    back: NDArray[np.float64],
    reference: Reference,
    things: Sequence[Pipeline],
) -> dict[int, Pipeline]:
    """Return which of the things each detected object is.

    Pixels beside each other count: a moving camera shows thin things a pixel beside where they were.

    Parameters
    ----------
    of
        Number of the object that each pixel shows, shape (r, c); negative for none.
    count
        Number of objects.
    image
        The frame.
    back
        Transform (4, 4) from the frame of the cloud to that of the table.
    reference
        The table at rest.
    things
        Things that the objects may be.

    Returns
    -------
    dict
        Things by the numbers of objects; not all objects and things have a match.
    """
    from scipy.ndimage import binary_dilation
    from scipy.optimize import linear_sum_assignment

    overlaps, square = np.zeros((count, len(things))), np.ones((3, 3))
    around = [binary_dilation(of == k, square) for k in range(count)]
    sizes = np.bincount(of[of >= 0], minlength=count)
    above = np.flatnonzero(of >= 0)
    points = image.places(above, back)
    for column, thing in enumerate(things):
        own = np.zeros(of.shape, np.bool_)
        if not thing.active:
            own = reference.owner == thing.slot
        elif thing.found:
            own.ravel()[above] = thing.contains(points, thing.settings.margin)
        near = binary_dilation(own, square)
        both = np.array([near[of == k].sum() + around[k][own].sum() for k in range(count)]) / 2
        overlaps[:, column] = both / np.maximum(sizes + own.sum() - both, 1)
    pairs = zip(*linear_sum_assignment(-overlaps), strict=True)
    return {int(k): things[column] for k, column in pairs if overlaps[k, column] >= SAME_PIXELS}


def overlap(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> float:
    """Return the intersection over union of two masks.

    Parameters
    ----------
    first, second
        Masks of one shape.

    Returns
    -------
    float
        Share in [0, 1].
    """
    return float((first & second).sum()) / max(int((first | second).sum()), 1)
