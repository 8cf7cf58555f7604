"""Complete things at rest, one in each frame: correct the pose, add what the model lacks, and suppose hidden ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.completion.hidden_ends import hidden_lengths, likely_length
from deixis.perception.tracking.completion.missing_parts import BEYOND, MARGIN, FlatThing, revealed_part
from deixis.perception.tracking.completion.pieces import fits_another, floating_parts, supporting_parts
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.observation import Observation, Table
from deixis.perception.tracking.table.reference import Reference
from deixis.perception.tracking.things.collection import Things
from deixis.perception.tracking.things.pipeline import Pipeline

CONFIRM_AFTER = 0.3
"""Time in seconds after which what a moving camera may have shown of a thing is compared with the next view."""

AFTER_HAND = 0.6
"""Time in seconds since a hand was in view after which a thing that was followed is completed, and after which one that
was completed while the hand was in view is completed again."""

AGAIN_AFTER = 1.0
"""Time in seconds after which a moving camera may show the other end of a thing that something partly hides."""


def complete(things: Things, table: Table, seen: Observation, settings: TrackingSettings) -> tuple[Pipeline, ...]:
    """Add the missing parts to one of the things that have rested for a while.

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

    Returns
    -------
    tuple of Pipeline
        Things that turned out to be parts of this one, which have ended.
    """
    thing = _next(things, table.reference, seen, settings)
    if thing is None:
        return ()
    thing.completed, thing.completed_at = True, seen.at
    thing.is_provisional = seen.at - seen.hand_at < AFTER_HAND
    reference, view, image, changes = table.reference, seen.view, seen.image, seen.changes
    own = np.flatnonzero(reference.owner == thing.slot)
    if not thing.first_rest and len(own) >= settings.least_pixels:
        taken = (changes.same & (reference.owner != thing.slot)) | seen.hand
        thing.align(image, view, taken, reference.points(own, view), table.noise)
    changed = _changed(reference, seen, settings)

    def flat(each: Pipeline) -> FlatThing:
        eye = float(view.back[2, :3] @ image.optics.eye + view.back[2, 3])
        return FlatThing(each, reference, view, eye, table.noise, settings.colour, image, changed, each.views)

    around = flat(thing)
    resting = [other for other in things.resting if other is not thing]
    parts_below = supporting_parts(thing, resting)
    pieces = [piece for piece in around.pieces(resting) if not fits_another(piece, thing, resting, flat)]
    merged = list(dict.fromkeys([*pieces, *floating_parts(thing, resting), *parts_below]))
    resting = [other for other in resting if other not in merged]
    parts = np.flatnonzero(np.isin(reference.owner, [piece.slot for piece in merged]))
    if merged:
        reference.owner.ravel()[parts] = thing.slot
        around = flat(thing)
    new, revealed = around.missing_part(), revealed_part(thing, resting, reference, view)
    thing.cut_off = around.is_cut_off
    if around.is_seen_again or (seen.is_camera_moving and around.is_carried and thing.views > 0):
        # what one view shows may be something else
        both = np.union1d(new, revealed)
        is_new = changed.ravel()[both, None]
        seen_now = np.where(is_new, image.places(both, view.back), reference.points(both, view))
        seen_twice = both[thing.confirms(seen_now) & (~thing.contains(seen_now, BEYOND) | around.is_carried)]
        new, revealed = np.intersect1d(new, seen_twice), np.intersect1d(revealed, seen_twice)
    thing.views += 1
    reference.owner.ravel()[new] = thing.slot
    reference.give(new[changed.ravel()[new]], thing.slot, image)
    new = np.union1d(np.union1d(new, parts), revealed)
    if len(new):
        each = np.repeat(new, settings.stride**2)  # as dense as the thing's own points, of all rows and columns
        colours = reference.colour.reshape(-1, 3)[each]
        thing.extend(reference.points(each, view), colours, settings.detection.outlines)
    ends = thing.unseen_ends(hidden_lengths(thing, resting, reference, view))
    length, width, height = thing.oriented.extents
    thing.suppose(ends, *(likely_length(length, width, height, length + sum(ends)) if any(ends) else (length, 0.0)))
    if merged:
        thing.take_name(merged, seen.at)
    things.leave(merged)
    return tuple(merged)


def _next(things: Things, reference: Reference, seen: Observation, settings: TrackingSettings) -> Pipeline | None:
    """Return the thing that has waited longest for its completion, or for the confirmation of its parts.

    A moving camera leaves no time to complete all things.
    """
    at = seen.at
    ready = (
        thing
        for thing in things.resting
        if thing.seen_at == at
        and (not thing.completed or (thing.is_suspected and at - thing.completed_at >= CONFIRM_AFTER)
             or (thing.is_provisional and at - seen.hand_at >= AFTER_HAND)
             or (seen.is_camera_moving and thing.cut_off and at - thing.completed_at >= AGAIN_AFTER))
        and at - max(thing.at, thing.settled_at) >= settings.complete_after and _is_clear(thing, reference, seen)
    )  # fmt: skip
    return min(ready, key=lambda each: (not each.is_suspected, each.completed_at), default=None)


def _is_clear(thing: Pipeline, reference: Reference, seen: Observation) -> bool:
    """Return True if nothing moves over the table, or only a hand that is far from a thing in the image.

    A thing that was followed has pixels that a hand may have spoilt or hidden: it is clear when they have been steady
    for a while since a hand was in view.
    """
    if seen.at - seen.hand_at > (0.0 if thing.first_rest else AFTER_HAND):
        return True
    own = reference.owner == thing.slot
    rows, columns = (np.flatnonzero(own.any(axis=axis)) for axis in (1, 0))
    if not seen.hand.any() or not len(rows) or not thing.first_rest:
        return False
    top, left = max(int(rows[0]) - MARGIN, 0), max(int(columns[0]) - MARGIN, 0)
    return not seen.hand[top : int(rows[-1]) + MARGIN + 1, left : int(columns[-1]) + MARGIN + 1].any()


def _changed(reference: Reference, seen: Observation, settings: TrackingSettings) -> NDArray[np.bool_]:
    """Return a mask (r, c) of the pixels at which the frame has shown something else for a while."""
    differs = ~seen.changes.same
    if seen.is_camera_moving:  # at the edges of things, pixels are compared with those beside them
        differs |= np.linalg.norm(seen.image.colour - reference.colour, axis=-1) > settings.colour
    steady = seen.at - reference.since >= settings.steady
    changed: NDArray[np.bool_] = differs & (seen.image.depth > 0) & steady & ~seen.hand
    return changed
