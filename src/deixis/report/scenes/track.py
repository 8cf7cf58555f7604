"""Tracked things as lines of text and plain data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.answers import count
from deixis.report.knowledge.rows import Row

if TYPE_CHECKING:
    from deixis.perception.tracking.situation import Situation, TrackedThing
    from deixis.workflows.scenes.track import TrackedEvent, Tracking

WORDS = {
    "new": "is new",
    "moves": "moves",
    "rests": "rests",
    "hidden": "is hidden",
    "seen": "is seen again",
    "gone": "is gone",
    "merged": "is a part of another thing",
}


def event_line(event: TrackedEvent) -> str:
    """Return one change of a thing as a line.

    Parameters
    ----------
    event
        The change.

    Returns
    -------
    str
        Time in seconds, thing, change, and place in centimetres.
    """
    x, y, z = (100 * value for value in event.centre)
    return f"{event.at:8.2f} s  {event.id:<4} {WORDS[event.change]:<13} at {x:.1f}, {y:.1f}, {z:.1f}"


def tracking_lines(found: Tracking) -> Iterator[str]:
    """Yield what is where since when, what is gone, and the numbers of frames.

    Parameters
    ----------
    found
        Answer of ``deixis track``.

    Yields
    ------
    str
        One line for each thing, in centimetres and seconds, then the notes.
    """
    for thing in found.things:
        x, y, z = (100 * value for value in thing.centre.tolist())
        sides = " by ".join(f"{100 * side:.1f}" for side in (thing.box[1] - thing.box[0]).tolist())
        state = "moving" if thing.moving else thing.state
        yield (
            f"{thing.id:<4} {state:<7} at {x:.1f}, {y:.1f}, {z:.1f}  ({sides} cm)  since {thing.since:.2f} s,"
            f" certainty {thing.certainty:.2f}"
        )
    for thing in found.gone:
        yield f"{thing.id:<4} gone    since {thing.seen_at:.2f} s; it came at {thing.first_seen:.2f} s"
    if not found.things and not found.gone:
        yield "Nothing was tracked."
    dropped = f", {found.dropped} dropped" if found.dropped else ""
    left_out = f", {found.left_out} left out" if found.left_out else ""
    yield f"{count(found.frames, 'frame')} used{dropped}{left_out}, {found.seconds:.2f} s."
    yield from found.notes


def tracking_to_dict(found: Tracking) -> dict[str, Any]:
    """Return what was tracked as plain data.

    Parameters
    ----------
    found
        Answer of ``deixis track``.

    Returns
    -------
    dict
        Things, gone things, events, numbers of frames and notes.
    """
    return {
        "seconds": found.seconds,
        "frames": found.frames,
        "dropped": found.dropped,
        "left_out": found.left_out,
        "things": [thing_to_dict(thing) for thing in found.things],
        "gone": [thing_to_dict(thing) for thing in found.gone],
        "events": [
            {"at": event.at, "id": event.id, "change": event.change, "centre": list(event.centre)}
            for event in found.events
        ],
        "notes": list(found.notes),
    }


def situation_to_dict(now: Situation) -> dict[str, Any]:
    """Return the situation after a frame as plain data.

    Parameters
    ----------
    now
        The situation.

    Returns
    -------
    dict
        Time, things, new ids, gone things and notes.
    """
    return {
        "at": now.at,
        "frame": now.number,
        "things": [thing_to_dict(thing) for thing in now.things],
        "came": list(now.came),
        "went": [thing_to_dict(thing) for thing in now.went],
        "notes": list(now.notes),
    }


def thing_to_dict(thing: TrackedThing) -> dict[str, Any]:
    """Return a tracked thing as plain data.

    Parameters
    ----------
    thing
        The thing.

    Returns
    -------
    dict
        Its id, state, box, pose and times, without its points.
    """
    return {
        "id": thing.id,
        "state": thing.state,
        "moving": thing.moving,
        "min": thing.box[0].round(4).tolist(),
        "max": thing.box[1].round(4).tolist(),
        "pose": thing.pose.round(6).tolist(),
        "certainty": round(thing.certainty, 4),
        "since": round(thing.since, 4),
        "first_seen": round(thing.first_seen, 4),
        "seen_at": round(thing.seen_at, 4),
    }


def tracking_rows(found: Tracking) -> Iterator[Row]:
    """Yield a row for each thing, those that are gone included.

    Parameters
    ----------
    found
        Answer of ``deixis track``.

    Yields
    ------
    dict
        ``id``, ``state`` (``gone`` for a thing that is gone), the centre as ``x``, ``y`` and ``z`` in metres, and
        ``since``, ``first_seen`` and ``seen_at`` in seconds.
    """
    for things, state in ((found.things, None), (found.gone, "gone")):
        for thing in things:
            x, y, z = thing.centre.tolist()
            times = {"since": thing.since, "first_seen": thing.first_seen, "seen_at": thing.seen_at}
            yield {"id": thing.id, "state": state or thing.state, "x": x, "y": y, "z": z} | times
