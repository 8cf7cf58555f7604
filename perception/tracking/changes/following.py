"""Follow the things that move, by what frames show of them or with what carries them, until they rest or are gone."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.changes.hands import Hands
from deixis.perception.tracking.changes.ownership import MIN_WAY, claim
from deixis.perception.tracking.changes.rest import ABSENT, EXPOSED, start
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.observation import Observation, Table
from deixis.perception.tracking.things.collection import Things
from deixis.perception.tracking.things.particles import Estimate
from deixis.perception.tracking.things.pipeline import Pipeline

MAX_SPEED = 0.8
"""Speed in metres per second at which a thing may move while it is not found."""

MIN_GAIN, LEAST_EXPOSED, SEEN_WELL = 0.15, 0.1, 0.5
"""Minimum gain of agreement by which a thing that is mostly hidden has moved, the minimum share of its points that
nothing hides where it rested, for this comparison, and the minimum share that is seen elsewhere without it."""

TAKEN_AWAY = 0.05
"""Largest agreement of the points that nothing hides at which a thing whose place is mostly hidden is taken away."""

MOVED_FIT = 0.6
"""Minimum agreement elsewhere at which a thing whose place is mostly hidden has moved."""

MAX_SUNK = 0.006
"""Depth in metres below the table from which a thing cannot be where it was found."""

BY_HAND = 1.5
"""Time in seconds after a hand was seen in which a thing whose place is mostly hidden may have moved; any hand may have
come and gone between two frames that are farther apart."""

BACK, BACK_AFTER = 0.7, 0.3
"""Minimum agreement at which a thing that was not found is again where it rested, and how long it was not found."""

FAR_FIT, FAR_VISIBLE = 0.7, 0.5
"""Minimum agreement and share of points that are seen of a thing that is found far away."""

AROUND, MIN_EXPLAINED = 0.03, 0.6
"""Distance in metres around a thing that is found far away, and its least share of the points that changed there."""

REST_VISIBLE = 0.6
"""Minimum share of the points of a thing that are seen, for it to come to rest while a hand is near in time."""

FLAT = 0.002
"""Height in metres up to which a point may be the table's."""

Job = TypeVar("Job")


class Workers:
    """Threads that the pipelines of all things share.

    Parameters
    ----------
    count
        Number of threads.
    """

    def __init__(self, count: int) -> None:
        self._count = count
        self._pool: ThreadPoolExecutor | None = None

    def each(self, job: Callable[[Pipeline], Job], things: Sequence[Pipeline]) -> Iterator[Job]:
        """Run a job for each thing.

        Parameters
        ----------
        job
            Function of a thing.
        things
            The things.

        Yields
        ------
        object
            Results in the order of the things.
        """
        if len(things) == 1 or self._count == 1:
            return map(job, things)
        if self._pool is None:
            self._pool = ThreadPoolExecutor(self._count, thread_name_prefix="pipeline")
        return self._pool.map(job, things)

    def close(self) -> None:
        """End the threads."""
        if self._pool is not None:
            self._pool.shutdown()
            self._pool = None


@dataclass(frozen=True, eq=False)
class Sighting:
    """Place of a thing in a frame, as its particle filter finds it.

    ``fit`` is the mean agreement of the points that nothing hides, and ``visible`` the share of the points within the
    image that are seen.
    """

    thing: Pipeline
    found: Estimate
    fit: float
    visible: float


def follow(
    things: Things,
    table: Table,
    seen: Observation,
    hands: Hands,
    seconds: float,
    workers: Workers,
    settings: TrackingSettings,
) -> None:
    """Look for the things that move, and for those whose places are mostly hidden.

    Parameters
    ----------
    things
        All things.
    table
        The table.
    seen
        The frame.
    hands
        The hands in it.
    seconds
        Time since the last frame.
    workers
        Threads of the pipelines.
    settings
        Options of the tracker.
    """
    view, reference, image = seen.view, table.reference, seen.image
    for thing in things.resting:
        if thing.seen_at < seen.at and thing.is_carried_off(MIN_WAY):
            start(thing, things, reference)
    moving = sorted((thing for thing in things if thing.active), key=lambda thing: -thing.reach)
    doubtful = [thing for thing in things.resting if thing.seen_at < seen.at and view.shows(thing.pose[:3, 3])]
    if not moving and not doubtful:
        return
    same = seen.changes.same
    free = np.flatnonzero(~same & (image.depth > 0))
    points, shades = image.places(free, view.back), image.colour.reshape(-1, 3)[free]
    above = (points[:, 2] > FLAT) | ~table.colours.include(shades)
    free, points, tints = free[above], points[above], shades[above].astype(np.float64)
    others = np.zeros(same.shape, np.bool_)

    def sighted(thing: Pipeline) -> Sighting:
        own = reference.owner == thing.slot
        if thing.carrier is not None:  # which may have been given its pixels
            own |= reference.owner == thing.carrier.slot
        taken = (same & ~own) | others
        return Sighting(thing, *thing.follow(image, view, taken, points, tints, seconds, table.noise))

    for thing in moving:
        if not thing.found:
            carry(thing, hands)
    for sighting in list(workers.each(sighted, moving)):  # before one of them claims pixels that another compares
        thing = sighting.thing
        if not thing.active:  # it was set down with what it lies on
            continue
        if not _is_certain(sighting, seen.at, seconds, points, settings):
            if _is_back(thing, things, table, seen, same):
                claim(thing, things, table, seen, settings)
                continue
            if thing.found or thing.is_carried_off(MIN_WAY):
                carry(thing, hands)
            if seen.is_camera_moving and not table.outline.beyond(thing.pose[None, :2, 3])[0]:
                thing.out_of_view |= thing.is_leaving(view, seconds)
            thing.lost()
            continue
        thing.moved_to(sighting.found.pose, seen.at, sighting.fit)
        thing.visible = sighting.visible
        is_free = sighting.visible > REST_VISIBLE or seen.at - seen.hand_at > settings.still_for
        if thing.is_still(seen.at) and is_free:
            things.settle(thing)
            loads = [load for load in moving if _is_set_down_with(load, thing, things, table, seen, same)]
            for each in (thing, *loads):
                claim(each, things, table, seen, settings)
    for thing in moving:  # what is theirs is not another thing that left its place unseen
        if thing.found:
            others.ravel()[free[thing.contains(points, settings.margin)]] = True
    left = ~others.ravel()[free]
    points, tints = points[left], tints[left]
    is_by_hand = seen.at - seen.hand_at < BY_HAND or seconds > BY_HAND  # nothing moves by itself
    for sighting in list(workers.each(sighted, doubtful)):
        thing = sighting.thing
        way = float(np.linalg.norm(sighting.found.place - thing.pose[:3, 3]))
        is_elsewhere = MIN_WAY < way < settings.jump and sighting.fit > MOVED_FIT and not _is_sunk(sighting)
        if (
            is_by_hand
            and is_elsewhere
            and sighting.visible > settings.visible
            and not _is_as_likely_at_rest(sighting, table, seen, same)
        ):
            start(thing, things, reference)
            thing.moved_to(sighting.found.pose, seen.at, sighting.fit)
            continue
        thing.rest_again()
        thing.lost()
        if is_by_hand:
            take_away(thing, things, table, seen, same, hands)


def carry(thing: Pipeline, hands: Hands) -> None:
    """Move a thing that left its place and is not seen with what it lay on, or with the hand that may hold it.

    Parameters
    ----------
    thing
        The thing.
    hands
        The hands in the frame.
    """
    if thing.is_carried_off(MIN_WAY):
        thing.ride()
        return
    step = hands.carried(thing.pose[:3, 3], thing.reach)
    if step is not None:
        thing.carry(step)


def take_away(
    thing: Pipeline, things: Things, table: Table, seen: Observation, same: NDArray[np.bool_], hands: Hands
) -> None:
    """Let a thing move with a hand that hides it, if what is seen of its place shows that it is no longer there.

    It has moved as the hand has since the last frame that showed a part of the thing at its place.

    Parameters
    ----------
    thing
        Thing at rest whose place is mostly hidden.
    things
        All things.
    table
        The table.
    seen
        The frame.
    same
        Mask (r, c) of the pixels that are unchanged.
    hands
        The hands in the frame.
    """
    agreement, exposed = _seen_where_it_rested(thing, table, seen, same)
    if agreement > MOVED_FIT:
        thing.there_at = seen.at
    if exposed <= LEAST_EXPOSED or agreement >= TAKEN_AWAY:
        return
    way = hands.moved_since(thing.there_at, thing.pose[:3, 3], thing.reach)
    if way is not None and np.linalg.norm(way) > MIN_WAY:
        start(thing, things, table.reference)
        thing.carry(way)


def let_go(things: Things, at: float, hand_at: float, settings: TrackingSettings) -> tuple[Pipeline, ...]:
    """End the pipelines of things that left their places and were not found for a while.

    Parameters
    ----------
    things
        All things.
    at
        Time of the frame in seconds.
    hand_at
        Time in seconds of the last frame with a hand.
    settings
        Options of the tracker.

    Returns
    -------
    tuple of Pipeline
        The things that are gone.
    """
    gone = []
    for thing in things:
        if thing.active and not thing.found:
            alone = at - max(thing.seen_at, hand_at)
            patience = settings.away_after if thing.out_of_view else settings.gone_after
            if alone > patience or at - thing.seen_at > settings.lost_after:
                thing.lost("gone")
                gone.append(thing)
    things.leave(gone)
    return tuple(gone)


def _is_certain(
    sighting: Sighting, at: float, seconds: float, points: NDArray[np.float64], settings: TrackingSettings
) -> bool:
    """Return True if a frame shows a thing where it was found.

    Far from where it was, it must be seen well, and be more than a part of what changed there.
    """
    thing, found = sighting.thing, sighting.found
    if sighting.fit <= settings.fit or sighting.visible <= settings.visible:
        return False
    way = thing.way_from_expected(found.place, seconds)
    lost = at - thing.seen_at - seconds if thing.active and not thing.in_hand else 0.0
    if way < settings.jump + MAX_SPEED * max(lost, 0.0):
        return True
    own, around = (thing.contains(points, margin, found.pose).sum() for margin in (settings.margin, AROUND))
    is_seen_well = sighting.fit > FAR_FIT and sighting.visible > FAR_VISIBLE
    return bool(is_seen_well and own > MIN_EXPLAINED * around)


def _is_sunk(sighting: Sighting) -> bool:
    """Return True if a thing was found so low that it would reach below the table in any direction."""
    box, pose = sighting.thing.oriented, sighting.found.pose
    height = float(pose[2, :3] @ np.array(box.centre) + pose[2, 3])
    return height - min(box.extents) / 2 < -MAX_SUNK


def _is_as_likely_at_rest(sighting: Sighting, table: Table, seen: Observation, same: NDArray[np.bool_]) -> bool:
    """Return True if a thing may as well be where it rested as where it was found.

    It agrees as well with the frame there, or its place is hidden and too little of it is seen where it was found.
    """
    agreement, exposed = _seen_where_it_rested(sighting.thing, table, seen, same)
    return agreement > sighting.fit - MIN_GAIN if exposed > LEAST_EXPOSED else sighting.visible < SEEN_WELL


def _is_back(thing: Pipeline, things: Things, table: Table, seen: Observation, same: NDArray[np.bool_]) -> bool:
    """Let a thing that was not found rest where it rested before, if the frame shows it there."""
    if seen.at - thing.seen_at < BACK_AFTER:
        return False
    agreement, exposed = _seen_where_it_rested(thing, table, seen, same)
    if exposed < EXPOSED or agreement < BACK:
        return False
    thing.put(thing.last_rest)
    thing.moved_to(thing.last_rest, seen.at, agreement)
    things.settle(thing)
    return True


def _seen_where_it_rested(
    thing: Pipeline, table: Table, seen: Observation, same: NDArray[np.bool_]
) -> tuple[float, float]:
    """Return the agreement of a thing with the frame at its last rest, and the share of its points in view there."""
    taken = same & (table.reference.owner != thing.slot)
    return thing.seen_at_place(seen.image, seen.view, taken, table.noise, thing.last_rest)


def _is_set_down_with(
    load: Pipeline, carrier: Pipeline, things: Things, table: Table, seen: Observation, same: NDArray[np.bool_]
) -> bool:
    """Let a thing that was not found rest on what carried it and was set down, if the frame does not contradict it."""
    if not load.active or load.found or load.carrier is not carrier or not load.is_carried_off(MIN_WAY):
        return False
    load.ride()
    taken = same & ~np.isin(table.reference.owner, (load.slot, carrier.slot))
    agreement, exposed = load.seen_at_place(seen.image, seen.view, taken, table.noise)
    if exposed > EXPOSED and agreement < ABSENT:
        return False
    load.moved_to(load.pose, seen.at, agreement)
    things.settle(load)
    return True
