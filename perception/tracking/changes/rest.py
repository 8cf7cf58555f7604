"""Decide by their pixels which things are still at rest at their places, and let others move."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.observation import Observation, Table
from deixis.perception.tracking.table.reference import TABLE, Changes, Reference
from deixis.perception.tracking.things.collection import Things
from deixis.perception.tracking.things.pipeline import Pipeline

MIN_OWN_PIXELS = 6
"""Minimum number of measured pixels of a thing that decide whether it rests."""

MIN_VISIBLE = 0.25
"""Minimum share of the measured pixels of a thing that nothing hides, for it to have left its place."""

FOOT, MIN_LIFTED_FOOT = 0.02, 0.7
"""Height in metres of the foot of a thing, and the minimum share of its visible pixels that show what is behind it, for
the thing to be lifted. While a bottle rises, the pixels above its foot still show bottle."""

LIFTED_BY_HAND = 1.0
"""Time in seconds after a hand was seen in which a thing may be lifted."""

EXPOSED = 0.3
"""Minimum share of the points of a thing that nothing hides, for its place to be called empty or not."""

MIN_KNOWN = 0.25
"""Minimum share of the pixels of a thing that the reference of a moving camera has, for them to tell that it left."""

ABSENT = 0.2
"""Largest share of agreeing points, of those that nothing hides, at which the place of a thing is empty."""


def look_at_resting(things: Things, table: Table, seen: Observation, settings: TrackingSettings) -> None:
    """Note which resting things a frame shows at their places, and let those move that have left them.

    Parameters
    ----------
    things
        All things.
    table
        The table.
    seen
        The frame.
    settings
        Options of the tracker.
    """
    from deixis.perception.tracking.kernels import EDGE, MISSING, NEARER, SAME

    for thing in things.resting:
        count = seen.changes.counts[thing.slot]
        measured = int(count.sum() - count[MISSING] - count[EDGE])
        visible = measured - int(count[NEARER])
        left = has_left(thing, seen.changes, settings.moved) or is_lifted(thing, table.reference, seen)
        if measured < MIN_OWN_PIXELS or (left and seen.is_camera_moving and _is_forgotten(thing, measured, seen)):
            _look_once_more(thing, things, table, seen, settings)
        elif left:
            start(thing, things, table.reference)
        elif count[SAME] >= settings.doubtful * measured:
            thing.seen_at_rest(seen.at, float(count[SAME]) / max(visible, 1))
            thing.particles = 0


def has_left(thing: Pipeline, changes: Changes, least: float) -> bool:
    """Return True if the place of a thing that was at rest shows what is behind it.

    Parameters
    ----------
    thing
        The thing.
    changes
        Comparison of the frame with the reference.
    least
        Share of the pixels that nothing hides, more than which must show what is behind it.

    Returns
    -------
    bool
        False for a thing that is mostly hidden.
    """
    from deixis.perception.tracking.kernels import COLOUR, EDGE, FARTHER, MISSING, NEARER

    count = changes.counts[thing.slot]
    measured = int(count.sum() - count[MISSING] - count[EDGE])
    visible, left = measured - int(count[NEARER]), int(count[FARTHER] + count[COLOUR])
    return visible >= max(MIN_OWN_PIXELS, MIN_VISIBLE * measured) and left > least * visible


def is_lifted(thing: Pipeline, reference: Reference, seen: Observation) -> bool:
    """Return True if the place of the foot of a thing shows what is behind it, although the rest looks unchanged.

    Parameters
    ----------
    thing
        The thing, at rest.
    reference
        The table at rest.
    seen
        The frame.

    Returns
    -------
    bool
        False for a flat thing, for one whose foot is hidden, and if no hand has been seen for a while.
    """
    from deixis.perception.tracking.kernels import COLOUR, FARTHER, SAME

    count = seen.changes.counts[thing.slot]
    if seen.at - seen.hand_at > LIFTED_BY_HAND or count[FARTHER] + count[COLOUR] < MIN_OWN_PIXELS:
        return False
    bottom, top = np.sort(thing.placed_corners[:, 2])[[0, -1]]
    if top - bottom < 2 * FOOT:
        return False
    own = np.flatnonzero(reference.owner == thing.slot)
    state = seen.changes.state.ravel()[own[reference.points(own, seen.view)[:, 2] < bottom + FOOT]]
    left = int(((state == FARTHER) | (state == COLOUR)).sum())
    return left >= MIN_OWN_PIXELS and left > MIN_LIFTED_FOOT * (left + int((state == SAME).sum()))


def is_laid_anew(things: Collection[Pipeline], changes: Changes, least: float) -> bool:
    """Return True if most things that were at rest left their places at once.

    Parameters
    ----------
    things
        Things at rest.
    changes
        Comparison of the frame with the reference.
    least
        As in :func:`has_left`.

    Returns
    -------
    bool
        False if only one thing left its place.
    """
    left = sum(has_left(thing, changes, least) for thing in things)
    return left >= 2 and 2 * left >= len(things)


def start(thing: Pipeline, things: Things, reference: Reference) -> None:
    """Let a thing move: its pixels are free.

    Parameters
    ----------
    thing
        The thing.
    things
        All things, some of which may lie on it and move with it.
    reference
        The table at rest.
    """
    others = [other for other in things if other is not thing]
    for other in others:
        if not other.active and other.lies_on(thing):
            other.load_onto(thing)
    thing.active = True
    reference.take(thing.slot, thing.beneath, {other.slot for other in others})
    thing.beneath = None


def _is_forgotten(thing: Pipeline, measured: int, seen: Observation) -> bool:
    """Return True if the reference has few of the pixels that a thing should have.

    A camera that moves does not know what it sees beside a hand that hid the thing before.
    """
    pixels = np.unique(seen.view.pixels(thing.placed_points)[0])
    return measured < MIN_KNOWN * len(pixels)


def _look_once_more(
    thing: Pipeline, things: Things, table: Table, seen: Observation, settings: TrackingSettings
) -> None:
    """Compare a resting thing without pixels in the reference, such as one that comes into view, with the frame."""
    reference = table.reference
    others = (reference.owner != TABLE) & (reference.owner != thing.slot)
    taken = others & (reference.depth > 0)
    agreement, exposed = thing.seen_at_place(seen.image, seen.view, taken, table.noise)
    if exposed < EXPOSED or ABSENT < agreement < settings.fit:
        thing.lost()
    elif agreement <= ABSENT:
        start(thing, things, reference)
    else:
        thing.seen_at_rest(seen.at, agreement)
