"""Decide which of the things on the table each changed pixel shows."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.frames.image import FrameImage
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.observation import Observation, Table
from deixis.perception.tracking.things.collection import Things
from deixis.perception.tracking.things.pipeline import Pipeline

MIN_WAY = 0.012
"""Minimum distance in metres to its old place at which a thing has moved while this place is hidden."""

MIN_CLAIMED = 0.001
"""Minimum height in metres of a point that a thing which has come to rest claims from the table."""


def things_around(
    image: FrameImage,
    pixels: NDArray[np.intp],
    points: NDArray[np.float64],
    at: float,
    things: Iterable[Pipeline],
    settings: TrackingSettings,
) -> tuple[list[Pipeline], NDArray[np.intp]]:
    """Return the things that were found, and the number of the one that each pixel may show, or -1.

    Of several things whose boxes contain a point, it is the one whose points agree best with it in place and colour, as
    for a knife on a plate that were set down together.

    Parameters
    ----------
    image
        The frame.
    pixels
        Flat indices of shape (k,).
    points
        Their points (k, 3) in the table's frame, in metres.
    at
        Time in seconds.
    things
        All things.
    settings
        Options of the tracker.

    Returns
    -------
    tuple
        Things by the size of their boxes, and numbers of shape (k,) among them.
    """
    around = [thing for thing in things if thing.found or not thing.active or thing.is_carried_off(MIN_WAY)]
    around.sort(key=lambda thing: float(np.prod(thing.oriented.extents)))
    if not around:
        return around, np.full(len(pixels), -1)
    inside = np.array([thing.contains(points, settings.margin) for thing in around])
    wide = np.array([
        thing.contains(points, settings.turned_margin)
        if at - thing.settled_at < settings.turned_for and not thing.active else np.zeros(len(points), np.bool_)
        for thing in around
    ])  # fmt: skip
    inside = np.where(inside.any(axis=0), inside, wide)
    of = np.where(inside.any(axis=0), inside.argmax(axis=0), -1)
    several = np.flatnonzero(inside.sum(axis=0) > 1)
    if len(several):
        unlike = np.full((len(around), len(several)), np.inf)
        for number in np.flatnonzero(inside[:, several].any(axis=1)):
            own = inside[number, several]
            tints = image.colour.reshape(-1, 3)[pixels[several[own]]].astype(np.float64)
            unlike[number, own] = around[number].unlikeness(points[several[own]], tints)
        of[several] = unlike.argmin(axis=0)
    return around, of


def claim(thing: Pipeline, things: Things, table: Table, seen: Observation, settings: TrackingSettings) -> None:
    """Assign the changed pixels within the box of a thing that has come to rest to this thing.

    What it lies on may own pixels that show the thing.

    Parameters
    ----------
    thing
        The thing.
    things
        All things.
    table
        The table.
    seen
        The frame; the pixels become unchanged.
    settings
        Options of the tracker.
    """
    from deixis.perception.tracking.kernels import SAME

    below = [other.slot for other in things.resting if thing.lies_on(other)]
    free = np.flatnonzero((~seen.changes.same | np.isin(table.reference.owner, below)) & (seen.image.depth > 0))
    points = seen.image.places(free, seen.view.back)
    around, of = things_around(seen.image, free, points, thing.settled_at, things, settings)
    is_own = (of == around.index(thing)) & thing.contains(points, settings.margin) & (points[:, 2] > MIN_CLAIMED)
    own = free[is_own]
    thing.beneath = table.reference.give(own, thing.slot, seen.image)
    seen.changes.state.ravel()[own] = SAME
