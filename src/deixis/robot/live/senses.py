"""The senses of the robot: what is where, what is pointed at, and what is said, written to the blackboard.

Things are tracked from frame to frame. When nothing moves, the table is written as a scene, with the clouds of its
things, into a folder, so that other modules can look at it. A name that is said while a person points becomes a
statement about the thing (``t3 called fork``).
"""

from __future__ import annotations

import itertools
import json
import math
import re
import threading
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.grammar.utterances import Utterance
from deixis.memory.episodes.changes import Add, Change, Delete, Finish, Logged, Update
from deixis.memory.episodes.episode import EpisodicFluent, Origin, Source, episodic
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.pointing.aim import Pointing, pointed_at
from deixis.perception.pointing.gesture import Gesture, GestureDetector
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.scene import PerceivedObject, Scene
from deixis.perception.tracking.frame import Frame
from deixis.perception.tracking.thing import Situation, TrackedThing
from deixis.perception.tracking.tracker import Tracker
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.live.story import StorySettings
from deixis.robot.modules import Board, Module
from deixis.robot.robot import perceived
from deixis.workflows.scenes.point import (
    SAME_MOMENT,
    PointedLabel,
    SpokenName,
    pointed_label,
    spoken_name,
    taught_labels,
)

AT, TABLE, WATCHED, CALLED, NOT_CALLED, POINTED_AT, SAID, TYPED, NOTICED, DROPPED, BEGAN, ENDED = (
    "at", "lookedLike", "watched", "called", "notCalled", "pointedAt", "said", "typed", "noticed", "dropped", "began",
    "ended",
)  # fmt: skip
"""Predicates: the box of a thing, the file of the scene, that the table is in view and does not change, what a thing is
called and is not called, what a person pointed at, said and typed, what the robot noticed, the number of late frames,
and the ends of the story."""

STILL = 0.6
"""Seconds without movement after which the table is written as a scene."""

WATCH = 1.0
"""Seconds between two notes that the table is still in view."""

PAUSE = 0.5
"""Seconds without a skeleton after which a gesture has ended."""

HELD_GESTURES = 20
"""Number of gestures that are kept for words that come later."""


POLL = 0.1
"""Seconds for which typed words are waited for before the module looks whether it must stop."""

VIEW = ".view.npz"
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
        for each in (AT, TABLE, WATCHED, CALLED, NOT_CALLED, POINTED_AT, SAID, TYPED, NOTICED, DROPPED, BEGAN, ENDED)
    )

    def __init__(self, story: Mapping[str, Any], folder: str) -> None:
        self._story, self._folder = StorySettings(**story), Path(folder)
        self._typed: SimpleQueue[EpisodicFluent] = SimpleQueue()

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
        """Take in the story until it ends, and then what is typed.

        Parameters
        ----------
        board
            The board of the module.
        stopped
            Set when the module must end.
        """
        with Tracker() as tracker:
            writer = _Writer(board, tracker, self._folder)
            try:
                story = self._story.story()
                for event in story.events():
                    if stopped.is_set():
                        return
                    writer.take(event, story.dropped)
                    while not self._typed.empty():
                        writer.hear(self._typed.get())
                writer.finish()
            except Exception as error:  # the story would begin again, which would only repeat the error
                writer.fail(f"{type(error).__name__}: {error}" if not isinstance(error, DeixisError) else str(error))
            while not stopped.is_set():
                with suppress(Empty):
                    writer.hear(self._typed.get(timeout=POLL), at_once=True)


class _Writer:
    """Turns the events of one story into changes of the blackboard."""

    def __init__(self, board: Board, tracker: Tracker, folder: Path) -> None:
        self._board, self._tracker, self._folder = board, tracker, folder
        self._origin: float | None = None
        self._ids: dict[str, str] = {}
        self._places: dict[str, tuple[str, float]] = {}  # fluent of the place by thing, and since when it is there
        self._table: str | None = None
        self._written: tuple[tuple[str, float, str], ...] | None = None
        self._watched: tuple[str, float] | None = None  # fluent that the written table is in view, and its finish
        self._moved_at = -math.inf
        self._situation = Situation(0.0, 0)
        self._things = Scene(())  # of the situation, with the names on the blackboard
        self._cloud: PointCloud | None = None
        self._detector = GestureDetector()
        self._watched_at = math.inf  # time of the last skeleton, until its gestures are finished
        self._pointings: deque[Pointing] = deque(maxlen=HELD_GESTURES)
        self._waiting: list[tuple[Utterance, str | None]] = []  # words, and the fluent of those that were typed
        self._notes: set[str] = set()
        self._dropped: tuple[int, str | None] = (0, None)  # number of late frames, and its fluent
        self._frames = itertools.count(1)
        self._at = 0.0

    def take(self, event: Frame | Skeleton | Utterance, dropped: int = 0) -> None:
        """Take in one event; ``dropped`` is the number of frames that came too late."""
        if event.at - self._watched_at > PAUSE:
            self._watched_at = math.inf
            self._point(self._detector.finish())
        self._at = event.at
        self._begin()
        if isinstance(event, Frame):
            self._cloud = event.cloud
            self._see(self._tracker.update(event.cloud, event.at), event.problem)
            self._count(dropped)
        elif isinstance(event, Skeleton):
            self._watch(event)
        else:
            self._waiting.append((event, None))
        self._hear(event.at)

    def hear(self, typed: EpisodicFluent, at_once: bool = False) -> None:
        """Take in typed words, which are said at the present time of the story."""
        self._begin()
        said = Utterance(typed.statement.object or "", self._at, speaker=typed.statement.subject)
        self._waiting.append((said, typed.id))
        if at_once:
            self._hear(math.inf)

    def finish(self) -> None:
        """Write what waits for the end of the story."""
        self._begin()
        self._point(self._detector.finish())
        if self._cloud is not None and self._situation.frame is not None:
            self._look()
        self._hear(math.inf)
        self._write([self._add(("story", ENDED), self._at, Source(Origin.SEEN, "senses"))])

    def fail(self, reason: str) -> None:
        """Write that the story cannot go on."""
        self._begin()
        self._write([self._add(("story", ENDED, reason), self._at, Source(Origin.SEEN, "senses"))])

    def _begin(self) -> None:
        """Write the beginning of the story before all else."""
        if self._origin is None:
            self._write([self._add(("story", BEGAN), 0.0, Source(Origin.SEEN, "senses"))])

    # ---- seeing

    def _see(self, situation: Situation, problem: str | None) -> None:
        seen = Source(Origin.SEEN, "tracker", f"frame {next(self._frames)}")
        changes: list[Change] = []
        for thing in situation.went:
            fluent, _ = self._places.pop(thing.id, (None, 0.0))
            if fluent is not None:
                changes.append(Finish(fluent, self._time(max(thing.seen_at, 0.0))))
        changes += self._places_of(situation, seen)
        for note in (*situation.notes, *([problem] if problem else [])):
            if note not in self._notes:
                self._notes.add(note)
                changes.append(self._add(("camera", NOTICED, note), self._at, seen))
        self._write(changes)
        if situation.busy or any(thing.moving for thing in situation.things) or situation.went or situation.came:
            self._moved_at = situation.at
        self._take(situation)
        key = tuple((thing.id, thing.since, thing.state) for thing in situation.things)
        if situation.frame is None or situation.at - self._moved_at < STILL:
            return
        if key != self._written:
            self._look()
        else:
            self._write_watched(situation.at)

    def _take(self, situation: Situation) -> None:
        """Take a situation as the present one."""
        scene = situation.scene()
        named = tuple(replace(thing, id=self._id(thing.id)) for thing in scene.objects)
        self._situation, self._things = situation, replace(scene, objects=named)

    def _count(self, dropped: int) -> None:
        """Write how many frames came too late, if there are more."""
        known, fluent = self._dropped
        if dropped > known:
            added = self._add(("camera", DROPPED, str(dropped)), self._at, Source(Origin.SEEN, "senses"))
            self._write([added] if fluent is None else [Finish(fluent, self._time(self._at)), added])
            self._dropped = dropped, added.fluent.id

    def _places_of(self, situation: Situation, seen: Source) -> list[Change]:
        """Return the changes by which the blackboard has the places of all things that rest."""
        changes: list[Change] = []
        for thing in situation.things:
            known = self._places.get(thing.id)
            if thing.moving or (known is not None and known[1] == thing.since):
                continue
            if known is not None:
                changes.append(Finish(known[0], self._time(thing.since)))
            changes.append(self._place(thing, seen))
        return changes

    def _place(self, thing: TrackedThing, seen: Source) -> Change:
        added = self._add(
            (self._id(thing.id), AT, json.dumps(thing.box.round(4).tolist())), thing.since, seen, thing.certainty
        )
        self._places[thing.id] = (added.fluent.id, thing.since)
        return added

    def _look(self) -> None:
        """Detect everything on the table that lies still, correct what is tracked by it, and write it as a scene.

        The tracker segments only what changed; a look at the whole table, as at one that is seen for the first time, is
        what the robot learns from and compares with.
        """
        from deixis.workflows.scenes.perceive import write_scene

        scene = self._detected()
        situation = self._situation
        self._written = tuple((thing.id, thing.since, thing.state) for thing in situation.things)
        self._watched = None
        seen = Source(Origin.SEEN, "tracker")
        file = self._folder / f"{self._board.new_id('table')}.scene.json"
        write_scene(scene, file)
        self._write_view(file.with_suffix("").with_suffix(VIEW))
        added = self._add(("table", TABLE, str(file)), self._at, seen)
        changes: list[Change] = [] if self._table is None else [Finish(self._table, self._time(self._at))]
        self._table = added.fluent.id
        self._write([*changes, added])

    def _write_watched(self, at: float) -> None:
        """Write that the table is still in view and looks as before, at most once in ``WATCH`` seconds."""
        if self._watched is None:
            added = self._add(("table", WATCHED), at, Source(Origin.SEEN, "tracker"), finish=at + 1e-3)
            self._watched = added.fluent.id, at
            self._write([added])
        elif at - self._watched[1] >= WATCH:
            self._watched = self._watched[0], at
            self._write([Update(self._watched[0], finish=self._time(at))])

    def _detected(self) -> Scene:
        """Return the things of the whole table with the names of those that are tracked."""
        try:
            found = None if self._cloud is None else perceived(self._cloud)
        except DeixisError:
            found = None
        if found is None or found.detection is None or found.detection.table is None:
            return self._things
        situation, ids = self._tracker.look_again(found)
        seen = Source(Origin.SEEN, "tracker", "look at the whole table")
        parts = [self._places.pop(thing.id, None) for thing in situation.merged]
        self._write([Delete(part[0]) for part in parts if part is not None] + self._places_of(situation, seen))
        self._take(situation)
        things = [replace(thing, id=self._id(ids[thing.id])) for thing in found.objects if thing.id in ids]
        onto = found.detection.frame @ np.linalg.inv(_required(situation.frame))
        things += [  # what something hides is still there
            _hidden(thing, self._id(thing.id), onto)
            for thing in situation.things
            if thing.id not in ids.values() and thing.state == "hidden" and not thing.moving
        ]
        return replace(found, objects=tuple(things), detection=None)

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
        self._point(self._detector.update(replace(skeleton, joints=joints)))

    def _point(self, gestures: Iterable[Gesture]) -> None:
        for gesture in gestures:
            if not self._things.objects:
                continue
            pointing = pointed_at(gesture, self._things)
            self._pointings.append(pointing)
            if pointing.decided is not None:
                source = Source(Origin.SHOWN, gesture.person, f"gesture at {gesture.at:.1f} s")
                probability = pointing.probabilities[pointing.decided]
                statement = (gesture.person, POINTED_AT, pointing.decided)
                added = self._add(statement, gesture.start, source, probability, gesture.finish)
                self._write([added])

    def _hear(self, now: float) -> None:
        """Write the words of which the moment, in which people may still point, has passed."""
        while self._waiting and now > self._waiting[0][0].end + SAME_MOMENT + STILL:
            said, typed = self._waiting.pop(0)
            source = Source(Origin.SAID, said.speaker, f"words at {said.at:.1f} s")
            finish = said.end if said.end > said.at else said.at + 1e-3
            changes: list[Change] = [
                self._add((said.speaker, SAID, said.text), said.at, source, max(said.confidence, 0.01), finish)
            ]
            shown = replace(source, origin=Origin.SHOWN)
            for label in self._labels(said):
                if label.target is not None and label.refused is None and label.name is not None:
                    what = (label.target, CALLED if label.positive else NOT_CALLED, label.name)
                    changes.append(self._add(what, said.at, shown, label.probability))
                elif label.name is not None and label.refused is not None:
                    noticed = f"'{label.name}' was not learned: {label.refused}. {label.question or ''}".strip()
                    changes.append(self._add((said.speaker, NOTICED, noticed), said.at, shown))
            if typed is not None:
                changes.append(Finish(typed, max(self._board.seconds(), self._time(said.at))))
            self._write(changes)

    def _labels(self, said: Utterance) -> Sequence[PointedLabel]:
        """Return what words name: the thing whose id they have (*t3 is a fork*), or what is pointed at meanwhile."""
        if not self._things.objects:
            return ()
        thing, name = named(said.text)
        if thing is not None and name is not None:
            label = PointedLabel(said, name.name, name.positive, thing, said.confidence)
            known = thing in self._things.ids
            return (label if known else replace(label, refused=f"there is no {thing} on the table"),)
        return taught_labels([pointed_label(said, tuple(self._pointings), self._things)], self._things)[0]

    # ---- writing

    def _id(self, thing: str) -> str:
        """Return the name of a tracked thing on the blackboard, which no other thing ever had."""
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
                self._board.new_id("f"),
                statement,
                start=self._time(start),
                finish=ends,
                certainty=min(max(certainty, 1e-3), 1.0),
                source=source,
            )
        )

    def _write(self, changes: list[Change]) -> None:
        if changes:
            self._board.write(*changes)


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
    """
    known = re.match(r"\s*(t\d+)\s+", text)
    return (None, spoken_name(text)) if known is None else (known[1], spoken_name(f"this {text[known.end() :]}"))


def _required(frame: NDArray[np.float64] | None) -> NDArray[np.float64]:
    assert frame is not None, "a table was found"
    return frame


def _hidden(thing: TrackedThing, id: str, onto: NDArray[np.float64]) -> PerceivedObject:
    """Return a thing that is hidden, as it was last seen, moved into another frame."""
    points = thing.cloud.points @ onto[:3, :3].T + onto[:3, 3]
    cloud = replace(thing.cloud, points=points.astype(np.float32))
    low, high = (tuple(side.round(6).tolist()) for side in (points.min(axis=0), points.max(axis=0)))
    return PerceivedObject(id, low, high, cloud=cloud)


def _moved(frame: NDArray[np.float64], place: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = (frame[:3, :3] @ np.array(place) + frame[:3, 3]).tolist()
    return x, y, z
