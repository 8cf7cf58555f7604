"""Know a table at rest, and compare each frame with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.frames.image import FrameImage, TableView
from deixis.perception.tracking.table.colours import TableColours
from deixis.perception.tracking.table.outline import Outline
from deixis.perception.tracking.table.reference import Changes, Reference


@dataclass(frozen=True, eq=False)
class Table:
    """Table at rest, as the frames so far have shown it.

    Parameters
    ----------
    reference
        Depth, colour and owner of every pixel.
    outline
        Outline in plan.
    colours
        Colours of the table without the things.
    noise
        Standard deviation of the depths of one frame at one metre.
    deviation
        Difference of two depths at one metre that counts as a change.
    laid_at
        Time in seconds of the last look at the whole table, from which the reference was made.
    """

    reference: Reference
    outline: Outline
    colours: TableColours
    noise: float
    deviation: float
    laid_at: float


@dataclass(frozen=True, eq=False)
class Observation:
    """One frame, compared with the table at rest.

    Parameters
    ----------
    image, view
        The frame, and its view of the table.
    changes
        State of each pixel. A pixel that is given to a thing becomes unchanged.
    hand
        Mask (r, c) of the pixels that show hands.
    at
        Time of the frame in seconds.
    hand_at
        Time in seconds of the last frame in which a hand, or something else that is not a thing, moved.
    is_camera_moving
        True if the camera has moved a short while ago.
    """

    image: FrameImage
    view: TableView
    changes: Changes
    hand: NDArray[np.bool_]
    at: float
    hand_at: float
    is_camera_moving: bool
