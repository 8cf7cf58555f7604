"""The senses of the robot: what is where, what is pointed at, and what is said, written to the blackboard.

Things are tracked from frame to frame. When nothing moves, the table is written as a scene, with the clouds of its
things, into a folder, so that other modules can look at it. A name that is said while a person points becomes a
statement about the thing (``t3 called fork``), and so does one that announces what is laid (*first the plate*): it
names the thing that comes to rest at that time. If the hand of a person was at a thing whose place changed, the act is
written too (``Ada moved t3``).
"""

from __future__ import annotations

import itertools
import json
import math
import re
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.grammar.activities import announced_thing
from deixis.grammar.utterances import MAX_CHARACTERS, Utterance
from deixis.memory.episodes.fluents.changes import Add, Change, Delete, Finish, Logged, Update
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.episodes.predicates import ACTS, AT, CALLED, MOVED, NOT_CALLED, POINTED_AT, PUT, SAID, TOOK
from deixis.memory.errors import MemoryWriteError
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.pointing.aim import SURE, Pointing, pointed_at
from deixis.perception.pointing.gesture import Gesture, GestureDetector
from deixis.perception.pointing.handling import Contact, HandLog
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.scene import PerceivedObject, Scene
from deixis.perception.tracking.frames.frame import Frame
from deixis.perception.tracking.situation import Situation, TrackedThing
from deixis.perception.tracking.tracker import Tracker
from deixis.printable import printed_line
from deixis.reasoning.temporal.bounds import to_ticks
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.live.outbox import Outbox
from deixis.robot.live.story import Event, Story, StorySettings
from deixis.robot.modules import Board, Module
from deixis.robot.robot import perceived
from deixis.workflows.scenes.point import (
    MIN_CONFIDENCE,
    MIN_SIZE_FIT,
    SAME_MOMENT,
    PointedLabel,
    SpokenName,
    pointed_label,
    size_weights,
    spoken_name,
    taught_labels,
    without_correction,
)

TABLE, WATCHED, TYPED, NOTICED, DROPPED, BEGAN, ENDED = (
    "lookedLike", "watched", "typed", "noticed", "dropped", "began", "ended",
)  # fmt: skip
"""Predicates: the file of the scene, that the table is in view and does not change, what a person typed, what the robot
noticed, the number of late frames, and the ends of the story."""

STILL_SECONDS = 0.6
"""Seconds without movement after which the table is written as a scene."""

WATCH_INTERVAL = 1.0
"""Seconds between two notes that the table is still in view."""

GESTURE_PAUSE = 0.5
"""Seconds without a skeleton after which a gesture has ended."""

MAX_BRINGING_SECONDS = 5.0
"""Maximum time in seconds between words that announce a thing (*first the plate*) and the thing's coming to rest."""

MAX_LATE_SECONDS = 15.0
"""Time in seconds after that in which a thing may still be found that came to rest in time but was hidden."""

HANDLING_SECONDS = 1.5
"""Seconds before a thing comes to rest, or after it was last seen at rest, in which a hand is looked for there."""

LATE_HAND_SECONDS = 0.3
"""Time in seconds by which the hand may still, or already, be at the thing on the other side of that time."""

REACH_SECONDS = 0.5
"""Longest time in seconds from the end of a gesture to the time when the hand may be at the thing, for the gesture to
be the slow end of a reach rather than pointing."""

BRINGING_SCALE = 0.5
"""Time in seconds by which things that come later, or earlier, than another one are e times less likely the announced
thing."""

MIN_DURATION = 1e-3
"""Shortest time in seconds that a statement holds."""

LONGEST_PAUSE = 86_400.0
"""Seconds up to which the clock of the story follows words and skeletons ahead of the clouds."""

MAX_NOTES = 1000
"""Number of different notes, after which no more are written."""

HELD_GESTURES = 20
"""Number of gestures that are kept for words that come later."""


POLL_INTERVAL = 0.1
"""Seconds for which typed words are waited for before the module looks whether it must stop."""

VIEW_ENDING = ".view.npz"
"""Ending of the file beside a scene that has the camera's image, the thing that each compared pixel shows (``owner``,
an index into ``ids``), and the transform from the camera's frame to the table's."""


class Senses(Module):
    """Module that tracks things, watches people point, and hears.

    Parameters
    ----------
    story
        Fields of :class:`~deixis.robot.live.story.StorySettings`: what the robot looks at.
    folder
        Folder for the scenes of the table.
    """

    name: ClassVar[str] = "senses"
    reads: ClassVar[tuple[Pattern, ...]] = (Pattern(predicate=TYPED),)
    writes: ClassVar[tuple[Pattern, ...]] = tuple(
        Pattern(predicate=each)
        for each in (
            *sorted(ACTS),
            AT,
            TABLE,
            WATCHED,
            CALLED,
            NOT_CALLED,
            POINTED_AT,
            SAID,
            TYPED,
            NOTICED,
            DROPPED,
            BEGAN,
            ENDED,
        )
    )

    def __init__(self, story: Mapping[str, Any], folder: str) -> None:
        self._settings, self._folder = StorySettings(**story), Path(folder)
        self._typed: SimpleQueue[EpisodicFluent] = SimpleQueue()
        self._tracker = Tracker()
        self._writer: _Writer | None = None
        self._story: Story | None = None
        self._events: Iterator[Event] | None = None

    def story(self) -> Story:
        """Return the story to process.

        Returns
        -------
        Story
            Frames, words and skeletons.
        """
        return self._settings.story()

    def changed(self, change: Logged, board: Board) -> None:
        """Hear what is typed.

        Parameters
        ----------
        change
            A change of a fluent that the module reads.
        board
            The board of the module.
        """
        if change.kind == "add" and change.after is not None and change.after.statement.predicate == TYPED:
            self._typed.put(change.after)

    def run(self, board: Board, stopped: threading.Event) -> None:
        """Process the story until it ends, and typed words after that.

        Parameters
        ----------
        board
            The board of the module.
        stopped
            Set when the module must end.
        """
        if self._writer is None:
            self._writer = _Writer(board, self._tracker, self._folder)
        self._writer.flush()
        if not self._writer.ended:
            self._take_in(self._writer, stopped)
        while not stopped.is_set():
            with suppress(Empty):
                self._writer.hear(self._typed.get(timeout=POLL_INTERVAL), at_once=True)
        self._story = self._events = None
        self._tracker.close()

    def _take_in(self, writer: _Writer, stopped: threading.Event) -> None:
        """Process the rest of the story; typed words are heard between its events."""
        try:
            if self._story is None or self._events is None:
                story = self.story()
                writer.report(story.notes)
                self._story, self._events = story, story.events()
            for event in self._events:
                if stopped.is_set():
                    return
                writer.take(event, self._story.dropped)
                while not self._typed.empty():
                    writer.hear(self._typed.get())
            writer.finish()
        except MemoryWriteError:
            raise  # the runtime reports it, and calls run() again, which goes on with the next event
        except BaseException as error:  # the story would begin again, which would only repeat the error
            writer.fail(_reason(error))


class _Writer:
    """Turns the events of one story into changes of the blackboard."""

    def __init__(self, board: Board, tracker: Tracker, folder: Path) -> None:
        self._board, self._tracker, self._folder = board, tracker, folder
        self._origin: float | None = None
        self._ids: dict[str, str] = {}
        self._outbox = Outbox()
        self._outbox.new_id(board)
        self._undone: Callable[[], None] | None = None  # what waits for ids, which a full disk does not give
        self._last_steps = deque((self._finish_gestures, self._look_at_end, self._hear_all))
        self.ended = False
        self._places: dict[str, tuple[str, float]] = {}  # fluent of the place by thing, and since when it is there
        self._table: tuple[str, float] | None = None  # fluent of the scene, and since when
        self._written: tuple[tuple[str, float, str], ...] | None = None
        self._watched: tuple[str, float] | None = None  # fluent that the written table is in view, and its finish
        self._moved_at = -math.inf
        self._situation = Situation(0.0, 0)
        self._things = Scene(())  # of the situation, with the names on the blackboard
        self._cloud: PointCloud | None = None  # of the last frame that was used, and its time
        self._seen_at = math.nan
        self._detector = GestureDetector()
        self._hands = HandLog()
        self._aims: deque[tuple[Gesture, str]] = deque(maxlen=HELD_GESTURES)  # gestures and their fluents
        self._grips: deque[tuple[str, Sequence[Contact]]] = deque(maxlen=HELD_GESTURES)  # of things that persons moved
        self._rested: dict[str, tuple[float, NDArray[np.float64]]] = {}  # when each thing last lay still, and its box
        self._moving_since: dict[str, float] = {}  # when each thing that moves left its place
        # the fluent of the place before the present one, and when the thing last lay there, and its box
        self._before: dict[str, tuple[str, tuple[float, NDArray[np.float64]]]] = {}
        self._acts: dict[str, list[tuple[str, float]]] = {}  # fluents of what persons did with each thing, and when
        self._watched_at = math.inf  # time of the last skeleton, until its gestures are finished
        self._pointings: deque[Pointing] = deque(maxlen=HELD_GESTURES)
        self._events: dict[Utterance, str] = {}
        self._given: list[tuple[PointedLabel, str]] = []  # names that things got, each with its fluent
        self._waiting: list[_Words] = []
        self._came: dict[str, float] = {}  # time at which each thing came to the table; -inf if it lay there at first
        self._announced: dict[str, _Announced] = {}  # words that announced each thing
        self._unmet: list[_Announced] = []  # words whose things have not come yet, in order
        self._announcing: list[float] = []  # times of all words that announced something
        self._looked_at = -math.inf
        self._notes: set[str] = set()
        self._dropped: tuple[int, str | None, float] = (
            0,
            None,
            0.0,
        )  # number of late frames, its fluent, and since when
        self._frames = itertools.count(1)
        self._at = 0.0

    def report(self, notes: Iterable[str]) -> None:
        """Write notes about the files of the story."""
        self._begin()
        for note in notes:
            self._note("files", note)
        self.flush()

    def take(self, event: Event, dropped: int = 0) -> None:
        """Process one event; write a note about an event that cannot be used, and go on.

        ``dropped`` is the number of frames that came too late.
        """
        self._begin()
        self._attempt(lambda: self._take_event(event, dropped), f"what came at {event.at:g} s could not be used")
        self.flush()

    def hear(self, typed: EpisodicFluent, at_once: bool = False) -> None:
        """Process typed words as said at the present time of the story, or at the present one after its end."""
        self._begin()
        if self.ended and self._origin is not None:
            self._at = max(self._at + MIN_DURATION, self._board.seconds() - self._origin)
        utterance = Utterance(
            printed_line(typed.statement.object or "", MAX_CHARACTERS), self._at, speaker=typed.statement.subject
        )
        self._wait_for(_Words(utterance, typed.id))
        if at_once:
            self._hear(math.inf)
        self.flush()

    def finish(self) -> None:
        """Take the steps that were held back until the end of the story, and write the end."""
        self._begin()
        while self._last_steps:
            self._attempt(self._last_steps.popleft(), "the end of the story could not be used")
        self._end()

    def fail(self, reason: str) -> None:
        """Write that the story cannot go on."""
        self._begin()
        self._end(printed_line(reason))

    def flush(self) -> None:
        """Write all queued changes, also those that a full disk held up."""
        work, self._undone = self._undone, None
        if work is not None:
            self._attempt(work, "what was seen before could not be used")
        for reason in self._outbox.flush(self._board):
            self._note("senses", f"a change was refused: {reason}")
        self._outbox.flush(self._board)

    def _attempt(self, work: Callable[[], None], trouble: str) -> None:
        try:
            work()
        except MemoryWriteError:
            raise
        except Exception as error:
            self._note("senses", f"{trouble}: {_reason(error)}")

    def _take_event(self, event: Event, dropped: int) -> None:
        if math.isfinite(event.at):
            to_ticks(self._time(event.at))  # raises if the blackboard has no such time
        if event.at - self._watched_at > GESTURE_PAUSE:
            self._watched_at = math.inf
            self._point(self._detector.finish())
        if isinstance(event, Frame):
            self._take_frame(event)
            self._count(dropped)
        else:
            if 0 <= event.at - self._at <= LONGEST_PAUSE:
                self._at = event.at
            if isinstance(event, Skeleton):
                self._watch(event)
            else:
                self._wait_for(_Words(event))
        self._hear(event.at)

    def _take_frame(self, frame: Frame) -> None:
        if frame.problem is not None:
            self._note("camera", f"{frame.problem}; the frame is left out")
            return
        situation = self._tracker.update(frame.cloud, frame.at)
        if not math.isfinite(situation.at):
            for note in situation.notes:
                self._note("camera", note)
            return
        self._at = max(self._at, situation.at)
        if situation.at == frame.at != self._seen_at:  # else the frame was left out
            self._seen_at, self._cloud = frame.at, frame.cloud
        self._see(situation)

    def _begin(self) -> None:
        """Write the beginning of the story before any other fluent."""
        if self._origin is None:
            self._outbox.add(self._add(("story", BEGAN), 0.0, Source(Origin.SEEN, "senses")))

    def _finish_gestures(self) -> None:
        self._point(self._detector.finish())

    def _look_at_end(self) -> None:
        if self._cloud is not None and self._situation.frame is not None:
            self._look()

    def _hear_all(self) -> None:
        self._hear(math.inf)

    def _end(self, reason: str | None = None) -> None:
        """Write that the story has ended, once."""
        if not self.ended:
            self.ended = True
            statement = ("story", ENDED) if reason is None else ("story", ENDED, reason)
            self._outbox.add(self._add(statement, self._at, Source(Origin.SEEN, "senses")))
        self.flush()

    def _note(self, about: str, text: str) -> None:
        """Write what was noticed, once."""
        if text not in self._notes and len(self._notes) < MAX_NOTES:
            added = self._add((about, NOTICED, printed_line(text)), self._at, Source(Origin.SEEN, "senses"))
            self._notes.add(text)
            self._outbox.add(added)

    # ---- seeing

    def _see(self, situation: Situation) -> None:
        """Write where things are, and detect the whole table once nothing moves."""
        self._undone = lambda: self._see(situation)
        self._name(situation)
        self._undone = None
        seen = Source(Origin.SEEN, "tracker", f"frame {next(self._frames)}")
        for thing in situation.went:
            if thing.id in self._places:
                self._outbox.add(self._left(thing, thing.seen_at), *self._act_of(thing, TOOK, seen))
            self._rested.pop(thing.id, None)
            self._before.pop(thing.id, None)
            self._moving_since.pop(thing.id, None)
        self._drop_merged(situation)
        self._outbox.add(*self._places_of(situation, seen))
        for note in situation.notes:
            self._note("camera", note)
        if situation.busy or any(thing.moving for thing in situation.things) or situation.went or situation.came:
            self._moved_at = situation.at
        self._take(situation)
        if situation.frame is None or situation.at - self._moved_at < STILL_SECONDS:
            return
        if _states(situation) != self._written or self._looked_at < self._moved_at:
            self._look()
        else:
            self._write_watched(situation.at)

    def _name(self, situation: Situation) -> None:
        """Give each thing its name on the blackboard."""
        for thing in situation.things:
            self._id(thing.id)

    def _take(self, situation: Situation) -> None:
        """Set the present situation."""
        scene = situation.scene()
        named = tuple(replace(thing, id=self._id(thing.id)) for thing in scene.objects)
        self._situation, self._things = situation, replace(scene, objects=named)

    def _count(self, dropped: int) -> None:
        """Write how many frames came too late, if there are more."""
        known, fluent, since = self._dropped
        if dropped > known:
            added = self._add(("camera", DROPPED, str(dropped)), self._at, Source(Origin.SEEN, "senses"))
            if fluent is not None:
                self._outbox.add(self._finished(fluent, since, self._at))
            self._outbox.add(added)
            self._dropped = dropped, added.fluent.id, self._at

    def _places_of(self, situation: Situation, seen: Source) -> list[Change]:
        """Return the changes by which the blackboard has the places of all things that rest."""
        changes: list[Change] = []
        for thing in situation.things:
            known = self._places.get(thing.id)
            if thing.moving or (known is not None and known[1] == thing.since):
                continue
            if known is not None:
                changes += self._left_for(thing)
            changes.append(self._place(thing, seen))
            if known is not None or self._came[self._id(thing.id)] > -math.inf:
                changes += self._act_of(thing, PUT if known is None else MOVED, seen)
        for thing in situation.things:
            place = self._places.get(thing.id)
            if thing.moving:
                self._moving_since.setdefault(thing.id, situation.at)
            elif thing.state == "seen" and place is not None and place[1] == thing.since:
                self._rested[thing.id] = situation.at, thing.box
                self._moving_since.pop(thing.id, None)
        return changes

    def _act_of(self, thing: TrackedThing, act: str, seen: Source) -> list[Change]:
        """Return the fluent of who changed the place of a thing; nothing if no person was seen to do it."""
        contacts = []
        if act != PUT and thing.id in self._rested:
            at, box = self._rested[thing.id]
            contacts.append(Contact(box, at - LATE_HAND_SECONDS, at + HANDLING_SECONDS))
        if act != TOOK:
            contacts.append(Contact(thing.box, thing.since - HANDLING_SECONDS, thing.since + LATE_HAND_SECONDS))
        actor = self._hands.actor(contacts) if contacts else None
        if actor is None:
            return []
        at = thing.seen_at if act == TOOK else thing.since
        statement = (printed_line(actor.person), act, self._id(thing.id))
        added = self._add(statement, at, seen, actor.probability, at + MIN_DURATION)
        self._acts.setdefault(thing.id, []).append((added.fluent.id, at))
        return [added, *self._no_longer_aims(actor.person, contacts)]

    def _no_longer_aims(self, person: str, contacts: Sequence[Contact]) -> list[Change]:
        """Return the deletions of gestures in which a person gripped a thing rather than pointed at it."""
        gripped = [
            (gesture, fluent)
            for gesture, fluent in self._aims
            if gesture.person == person and _overlap(gesture, contacts)
        ]
        self._grips.append((person, contacts))
        for each in gripped:
            self._aims.remove(each)
        return [Delete(fluent) for _, fluent in gripped]

    def _place(self, thing: TrackedThing, seen: Source) -> Change:
        added = self._add(
            (self._id(thing.id), AT, json.dumps(thing.box.ravel().round(4).tolist())),
            thing.since,
            seen,
            thing.certainty,
        )
        self._places[thing.id] = (added.fluent.id, thing.since)
        self._came.setdefault(self._id(thing.id), thing.since if self._written is not None else -math.inf)
        return added

    def _left_for(self, thing: TrackedThing) -> list[Change]:
        """Return the changes that end the place of a thing that has moved.

        A place that it only passed on its way is deleted, with the act that led there.
        """
        fluent, since = self._places[thing.id]
        if thing.id not in self._before or self._moving_since.get(thing.id, math.inf) >= since + STILL_SECONDS:
            self._before[thing.id] = fluent, self._rested.get(thing.id, (since, thing.box))
            return [self._left(thing, thing.since)]
        del self._places[thing.id]
        before, self._rested[thing.id] = self._before[thing.id]
        led = [act for act, at in self._acts.get(thing.id, ()) if at == since]
        self._acts[thing.id] = [(act, at) for act, at in self._acts.get(thing.id, ()) if at != since]
        return [Update(before, finish=self._time(thing.since)), Delete(fluent), *map(Delete, led)]

    def _left(self, thing: TrackedThing, at: float) -> Change:
        """Return the change that ends the place of a thing."""
        return self._finished(*self._places.pop(thing.id), at)

    def _finished(self, fluent: str, since: float, at: float) -> Change:
        """Return the change that finishes a fluent, which lasts a moment at least."""
        return Finish(fluent, self._time(max(at, since + MIN_DURATION)))

    def _look(self) -> None:
        """Detect all resting things on the table, correct the tracked things by them, and write them as a scene.

        The tracker segments only what changed. The robot learns from a segmentation of the whole table, as of one that
        is seen for the first time, and compares others with it.
        """
        self._undone, self._looked_at = self._look, self._situation.at
        file = self._folder / f"{self._board.new_id('table')}.scene.json"
        self._undone = None
        found = self._detected()
        if found is None:
            self._write_table(self._things, file)
            return
        situation, ids = self._tracker.look_again(found)
        if _states(situation) == self._written and not situation.merged:
            self._write_watched(situation.at)  # a hand passed over the table
        else:
            self._correct(found, situation, ids, file)

    def _detected(self) -> Scene | None:
        """Return the things of the whole table; None where it is not found."""
        try:
            found = None if self._cloud is None else perceived(self._cloud, self._situation.frame)
        except DeixisError:
            return None
        return None if found is None or found.detection is None or found.detection.table is None else found

    def _correct(self, found: Scene, situation: Situation, ids: Mapping[str, str], file: Path) -> None:
        """Correct the tracked things by the detection of the whole table, and write the table as a scene."""
        self._undone = lambda: self._correct(found, situation, ids, file)
        self._name(situation)
        self._undone = None
        assert found.detection is not None
        self._drop_merged(situation)
        self._outbox.add(*self._places_of(situation, Source(Origin.SEEN, "tracker", "look at the whole table")))
        self._take(situation)
        things = [replace(thing, id=self._id(ids[thing.id])) for thing in found.objects if thing.id in ids]
        to_table = found.detection.frame @ np.linalg.inv(_required(situation.frame))
        things += [  # what something hides is still there
            _hidden(thing, self._id(thing.id), to_table)
            for thing in situation.things
            if thing.id not in ids.values() and thing.state == "hidden" and not thing.moving
        ]
        self._write_table(replace(found, objects=tuple(things), detection=None), file)

    def _drop_merged(self, situation: Situation) -> None:
        """Delete the places of things that turned out to be parts of others."""
        parts = [self._places.pop(thing.id, None) for thing in situation.merged]
        for thing in situation.merged:
            if announced := self._announced.pop(self._id(thing.id), None):  # the whole thing was meant
                self._unmet.append(announced)
                self._unmet.sort(key=lambda each: each.utterance.at)
        acts = (act for thing in situation.merged for act, _ in self._acts.pop(thing.id, ()))
        self._outbox.add(*(Delete(part[0]) for part in parts if part is not None), *map(Delete, acts))

    def _write_table(self, scene: Scene, file: Path) -> None:
        """Write the present table as a scene, and name the things that came with it."""
        from deixis.workflows.scenes.perceive import write_scene

        self._undone = lambda: self._write_table(scene, file)
        try:
            write_scene(scene, file)
            self._write_view(file.with_suffix("").with_suffix(VIEW_ENDING))
        except (OSError, DeixisError) as error:
            full = error if isinstance(error, OSError) else error.__cause__
            if not isinstance(full, OSError):
                raise
            raise MemoryWriteError(f"the scene of the table cannot be written: {full.strerror}") from error
        self._undone = None
        added = self._add(("table", TABLE, str(file)), self._at, Source(Origin.SEEN, "tracker"))
        if self._table is not None:
            self._outbox.add(self._finished(*self._table, self._at))
        self._table, self._watched = (added.fluent.id, self._at), None
        self._written = _states(self._situation)
        self._outbox.add(added)
        self._name_announced()

    def _write_watched(self, at: float) -> None:
        """Write that the table is still in view and looks as before, at most once in ``WATCH_INTERVAL`` seconds."""
        if self._watched is None:
            added = self._add(("table", WATCHED), at, Source(Origin.SEEN, "tracker"), finish=at + MIN_DURATION)
            self._watched = added.fluent.id, at
            self._outbox.add(added)
        elif at - self._watched[1] >= WATCH_INTERVAL:
            self._watched = self._watched[0], at
            self._outbox.add(Update(self._watched[0], finish=self._time(at)))

    def _write_view(self, file: Path) -> None:
        """Write the camera's image, and the thing that each of its pixels shows."""
        if self._cloud is None or self._cloud.colours is None or self._cloud.organised is None:
            return
        owners = self._tracker.owners()
        np.savez_compressed(
            file,
            frame=_required(self._situation.frame),
            image=self._cloud.colours.reshape(*self._cloud.organised, 3).astype(np.uint8),
            owner=owners,
            ids=np.array([self._id(thing.id) for thing in self._situation.things], dtype=np.str_),
        )

    # ---- pointing and hearing

    def _watch(self, skeleton: Skeleton) -> None:
        if self._situation.frame is None:
            return
        self._watched_at = skeleton.at
        joints = {name: _moved(self._situation.frame, place) for name, place in skeleton.joints.items()}
        seen = replace(skeleton, joints=joints)
        self._hands.add(seen)
        self._point(self._detector.update(seen))

    def _point(self, gestures: Iterable[Gesture]) -> None:
        for gesture in gestures:
            if not self._things.objects:
                continue
            if any(gesture.person == person and _overlap(gesture, contacts) for person, contacts in self._grips):
                continue
            pointing = pointed_at(gesture, self._things)
            self._pointings.append(pointing)
            if pointing.decided is not None:
                event = f"gesture {self._outbox.new_id(self._board)}"
                source = Source(Origin.SHOWN, printed_line(gesture.person), event)
                probability = pointing.probabilities[pointing.decided]
                statement = (printed_line(gesture.person), POINTED_AT, pointing.decided)
                added = self._add(statement, gesture.start, source, probability, gesture.finish)
                self._aims.append((gesture, added.fluent.id))
                self._outbox.add(added)

    def _wait_for(self, words: _Words) -> None:
        """Keep words until their moment has passed."""
        self._waiting.append(words)
        if words.announced is not None:
            self._announcing.append(words.utterance.at)

    def _hear(self, now: float) -> None:
        """Write the words of which the moment has passed, in which people may still point or lay things."""
        while self._waiting and now > self._waiting[0].until:
            words = self._waiting.pop(0)
            failure = f"the utterance at {words.utterance.at:g} s could not be used"
            self._attempt(partial(self._write_utterance, _printable(words.utterance)), failure)
            if words.typed is not None:
                self._outbox.add(Finish(words.typed, max(self._board.seconds(), self._time(words.utterance.at))))
        while self._unmet and now > self._unmet[0].utterance.end + MAX_BRINGING_SECONDS + MAX_LATE_SECONDS:
            self._write_label(self._announced_label(self._unmet[0]))
            del self._unmet[0]

    def _write_utterance(self, utterance: Utterance) -> None:
        """Write words, and the names that they give to things."""
        source = Source(Origin.SAID, utterance.speaker, self._event(utterance))
        finish = utterance.end if utterance.end > utterance.at else utterance.at + MIN_DURATION
        statement, certainty = (utterance.speaker, SAID, utterance.text), max(utterance.confidence, 0.01)
        self._outbox.add(self._add(statement, utterance.at, source, certainty, finish))
        announced = announced_thing(utterance.text)
        if announced is not None and utterance.confidence >= MIN_CONFIDENCE:
            self._unmet.append(_Announced(utterance, announced))
            self._name_announced()
        else:
            for label in self._labels(utterance, announced):
                self._write_label(self._agreeing(label))

    def _event(self, utterance: Utterance) -> str:
        """Return the id of the event of words, which those of another story on this memory do not have."""
        if utterance not in self._events:
            self._events[utterance] = f"words {self._outbox.new_id(self._board)}"
        return self._events[utterance]

    def _write_label(self, label: PointedLabel) -> None:
        """Write a name that words give to a thing, or why nothing is taught."""
        utterance = label.utterance
        shown = Source(Origin.SHOWN, utterance.speaker, self._event(utterance))
        if label.target is not None and label.refused is None and label.name is not None:
            what = (label.target, CALLED if label.positive else NOT_CALLED, label.name)
            added = self._add(what, utterance.at, shown, label.probability)
            self._outbox.add(added)
            self._given.append((label, added.fluent.id))
        elif label.name is not None and label.refused is not None:
            noticed = f"'{label.name}' was not learned: {label.refused}. {label.question or ''}".strip()
            self._outbox.add(self._add((utterance.speaker, NOTICED, noticed), utterance.at, shown))

    def _name_announced(self) -> None:
        """Give the things that came, also those that were found late, the names that announced them."""
        number = 0
        while number < len(self._unmet):
            label = self._announced_label(self._unmet[number])
            if label.target is None or label.refused is not None:
                number += 1
                continue
            self._write_label(label)
            self._announced[label.target] = self._unmet.pop(number)
            number = 0  # one thing fewer that the others may mean

    def _labels(self, utterance: Utterance, announced: str | None) -> Sequence[PointedLabel]:
        """Return what words name.

        That is the thing whose id they have (*t3 is a fork*), or what is pointed at meanwhile.
        """
        if announced is not None:
            unsure = f"recognised with a confidence of {utterance.confidence:.2f} only"
            return (PointedLabel(utterance, announced, probability=utterance.confidence, refused=unsure),)
        thing, name = named(utterance.text)
        if name is not None and (thing is not None or not self._things.objects):
            label = PointedLabel(utterance, name.name, name.positive, thing, utterance.confidence)
            if thing in self._things.ids:
                return (label,)
            table = "no table was seen yet" if self._situation.frame is None else "nothing is on the table"
            why = f"there is no {thing} on the table" if thing is not None and self._things.objects else table
            return (replace(label, refused=why),)
        if not self._things.objects:
            return ()
        return (pointed_label(utterance, tuple(self._pointings), self._things),)

    def _agreeing(self, label: PointedLabel) -> PointedLabel:
        """Return a label, refused if it contradicts an earlier name of the thing; a correction ends that name."""
        *earlier, checked = taught_labels([*(given for given, _ in self._given), label], self._things)[0]
        kept = []
        for (given, fluent), now in zip(self._given, earlier, strict=True):
            if now.refused is None:
                kept.append((given, fluent))
            else:
                self._outbox.add(self._finished(fluent, given.utterance.at, label.utterance.at))
        self._given = kept
        return checked

    def _announced_label(self, announced: _Announced) -> PointedLabel:
        """Return what was announced with the thing that came to rest nearest in time, or why no thing gets the name.

        A thing that came between earlier words and the next ones belongs to the earlier words, unless the person says
        what she has just laid.
        """
        utterance, name = announced.utterance, announced.name
        label = PointedLabel(utterance, name, probability=utterance.confidence)
        ahead = [each for thing, each in self._announced.items() if self._came[thing] >= each.utterance.at]
        earlier = [each.utterance.at for each in (*self._unmet, *ahead) if each.utterance.at < utterance.at]
        spans = [(at, min((later for later in self._announcing if later > at), default=math.inf)) for at in earlier]
        away = {
            thing: max(utterance.at - at, at - utterance.end, 0.0)
            for thing, at in self._came.items()
            if thing in self._things.ids
            and thing not in self._announced
            and not any(start <= at < end for start, end in spans)
        }
        near = [thing for thing, seconds in away.items() if seconds <= MAX_BRINGING_SECONDS]
        if not near:
            return replace(label, refused=f"nothing came to the table within {MAX_BRINGING_SECONDS:g} s of the words")
        sizes = size_weights(name, self._things)
        weights = {thing: sizes[thing] * math.exp(-away[thing] / BRINGING_SCALE) for thing in near}
        thing = max(near, key=weights.__getitem__)
        share = weights[thing] / sum(weights.values())
        if sizes[thing] <= MIN_SIZE_FIT:
            return replace(label, refused=f"{thing} came, but does not have the size of a {name}")
        if share < SURE:
            return replace(label, refused=f"several things came: {', '.join(sorted(near))}")
        return replace(label, target=thing, probability=share * utterance.confidence)

    # ---- writing

    def _id(self, thing: str) -> str:
        """Return the id of a tracked thing on the blackboard, which no other thing ever has."""
        if thing not in self._ids:
            self._ids[thing] = self._board.new_id("t")
        return self._ids[thing]

    def _time(self, at: float) -> float:
        """Return a time of the story on the clock of the blackboard; the story begins when it is first asked for."""
        if self._origin is None:
            self._origin = self._board.seconds() - at
        return self._origin + at

    def _add(
        self,
        statement: tuple[str, str] | tuple[str, str, str],
        start: float,
        source: Source,
        certainty: float = 1.0,
        finish: float | None = None,
    ) -> Add:
        ends = None if finish is None else self._time(finish)
        return Add(
            episodic(
                self._outbox.new_id(self._board),
                statement,
                start=self._time(start),
                finish=ends,
                certainty=min(max(certainty, 1e-3), 1.0),
                source=source,
            )
        )


@dataclass(frozen=True, slots=True)
class _Announced:
    """Words that announce a thing, and its name."""

    utterance: Utterance
    name: str


@dataclass(frozen=True, slots=True)
class _Words:
    """Words that wait until their moment has passed, the thing that they announce, and the fluent of typed ones."""

    utterance: Utterance
    typed: str | None = None
    announced: str | None = field(init=False)
    until: float = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "announced", announced_thing(self.utterance.text))
        moment = SAME_MOMENT + STILL_SECONDS if self.announced is None else MAX_BRINGING_SECONDS
        object.__setattr__(self, "until", self.utterance.end + moment)


def _states(situation: Situation) -> tuple[tuple[str, float, str], ...]:
    return tuple((thing.id, thing.since, thing.state) for thing in situation.things)


def _printable(utterance: Utterance) -> Utterance:
    """Return words with the characters that the blackboard keeps."""
    text, speaker = printed_line(utterance.text, MAX_CHARACTERS), printed_line(utterance.speaker)
    return replace(utterance, text=text, speaker=speaker)


def _reason(error: BaseException) -> str:
    return str(error) if isinstance(error, DeixisError) else f"{type(error).__name__}: {error}"


def named(text: str) -> tuple[str | None, SpokenName | None]:
    """Return the name that a sentence gives to a thing, and the id of the thing if the sentence has it.

    Parameters
    ----------
    text
        English: *this is a fork*, *t3 is a fork*.

    Returns
    -------
    tuple
        The id, or None for a thing that is pointed at; and the name, or None if the sentence names nothing.

    Examples
    --------
    >>> named("t3 is a fork.")
    ('t3', SpokenName(name='fork', positive=True, corrects=False))
    >>> named("No, t3 is a spoon.")
    ('t3', SpokenName(name='spoon', positive=True, corrects=True))
    """
    plain, corrects = without_correction(text)
    known = re.match(r"\s*(t\d+)\s+", plain)
    if known is None:
        return None, spoken_name(text)
    return known[1], spoken_name(f"{'no, ' if corrects else ''}this {plain[known.end() :]}")


def _overlap(gesture: Gesture, contacts: Iterable[Contact]) -> bool:
    """Return whether a gesture was held while a hand may have been at a thing, or just before that."""
    return any(gesture.start <= each.finish and gesture.finish >= each.start - REACH_SECONDS for each in contacts)


def _required(frame: NDArray[np.float64] | None) -> NDArray[np.float64]:
    assert frame is not None, "a table was found"
    return frame


def _hidden(thing: TrackedThing, id: str, to_table: NDArray[np.float64]) -> PerceivedObject:
    """Return a thing that is hidden, as it was last seen, moved into another frame."""
    points = thing.cloud.points @ to_table[:3, :3].T + to_table[:3, 3]
    cloud = replace(thing.cloud, points=points.astype(np.float32))
    low, high = (tuple(side.round(6).tolist()) for side in (points.min(axis=0), points.max(axis=0)))
    return PerceivedObject(id, low, high, cloud=cloud)


def _moved(frame: NDArray[np.float64], place: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = (frame[:3, :3] @ np.array(place) + frame[:3, 3]).tolist()
    return x, y, z
