"""The senses of the robot: what is where, what is pointed at, and what is said, written to the blackboard.

Things are tracked from frame to frame. When nothing moves, the table is written as a scene, with the clouds of its
things, into a folder, so that other modules can look at it. A name that is said while a person points becomes a
statement about the thing (``t3 called fork``).
"""

from __future__ import annotations

import itertools
import json
import math
import threading
from collections import deque
from dataclasses import replace
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.grammar.utterances import Utterance
from deixis.memory.episodes.changes import Add, Change, Finish, Update
from deixis.memory.episodes.episode import Origin, Source, episodic
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.pointing.aim import Pointing, pointed_at
from deixis.perception.pointing.gesture import GestureDetector
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.scene import Scene
from deixis.perception.tracking.frame import Frame
from deixis.perception.tracking.thing import Situation, TrackedThing
from deixis.perception.tracking.tracker import Tracker
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.live.story import Story, recorded_story, simulated_story
from deixis.robot.modules import Board, Module
from deixis.robot.robot import perceived
from deixis.workflows.scenes.point import SAME_MOMENT, pointed_label, taught_labels

AT, TABLE, WATCHED, CALLED, NOT_CALLED, POINTED_AT, SAID, NOTICED, ENDED = (
    "at", "lookedLike", "watched", "called", "notCalled", "pointedAt", "said", "noticed", "ended",
)  # fmt: skip
"""Predicates: the box of a thing, the file of the scene, that the table is in view and does not change, what a thing is
called and is not called, what a person pointed at and said, what the robot noticed, and the end of the story."""

STILL = 0.6
"""Seconds without movement after which the table is written as a scene."""

WATCH = 1.0
"""Seconds between two notes that the table is still in view."""

PAUSE = 0.5
"""Seconds without a skeleton after which a gesture has ended."""

SAME_PLACE = 0.05
"""Distance in metres between the middles of a detected and a tracked thing up to which they are one."""

HELD_GESTURES = 20
"""Number of gestures that are kept for words that come later."""


class Senses(Module):
    """Module that tracks things, watches people point, and hears.

    Parameters
    ----------
    source
        ``simulator``, or a folder with clouds.
    folder
        Folder for the scenes of the table.
    layout
        Script of the simulated table.
    seed
        Seed of the simulated story.
    rate
        Frames a second of the simulator.
    intrinsics
        File with the intrinsics of the camera, for depth images.
    grows
        True if the folder grows.
    """

    name: ClassVar[str] = "senses"
    writes: ClassVar[tuple[Pattern, ...]] = tuple(
        Pattern(predicate=each) for each in (AT, TABLE, WATCHED, CALLED, NOT_CALLED, POINTED_AT, SAID, NOTICED, ENDED)
    )

    def __init__(
        self,
        source: str,
        folder: str,
        layout: str | None = None,
        seed: int = 0,
        rate: float = 4.0,
        intrinsics: str | None = None,
        grows: bool = False,
    ) -> None:
        self._source, self._folder = source, Path(folder)
        self._layout, self._seed, self._rate = layout, seed, rate
        self._intrinsics, self._grows = intrinsics, grows

    def story(self) -> Story:
        """Return the story that the senses take in.

        Returns
        -------
        Story
            Frames, words and skeletons.
        """
        if self._source != "simulator":
            return recorded_story(self._source, self._intrinsics, self._grows)
        from deixis.workflows.layouts.read import as_script

        assert self._layout is not None, "the simulator needs a layout"
        return simulated_story(as_script(self._layout), self._seed, self._rate)

    def run(self, board: Board, stopped: threading.Event) -> None:
        """Take in the story until it ends.

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
                for event in self.story().events():
                    if stopped.is_set():
                        return
                    writer.take(event)
                writer.finish()
            except Exception as error:  # the story would begin again, which would only repeat the error
                writer.fail(f"{type(error).__name__}: {error}" if not isinstance(error, DeixisError) else str(error))
        stopped.wait()


class _Writer:
    """Turns the events of one story into changes of the blackboard."""

    def __init__(self, board: Board, tracker: Tracker, folder: Path) -> None:
        self._board, self._tracker, self._folder = board, tracker, folder
        self._origin: float | None = None
        self._ids: dict[str, str] = {}
        self._places: dict[str, tuple[str, float]] = {}  # fluent of the place by thing, and since when it is there
        self._table: str | None = None
        self._written: tuple[tuple[str, float], ...] | None = None
        self._watched: tuple[str, float] | None = None  # fluent that the written table is in view, and its finish
        self._moved_at = -math.inf
        self._situation: Situation | None = None
        self._cloud: PointCloud | None = None
        self._detector = GestureDetector()
        self._watched_at = math.inf  # time of the last skeleton, until its gestures are finished
        self._pointings: deque[Pointing] = deque(maxlen=HELD_GESTURES)
        self._waiting: list[Utterance] = []
        self._notes: set[str] = set()
        self._frames = itertools.count(1)
        self._at = 0.0

    def take(self, event: Frame | Skeleton | Utterance) -> None:
        """Take in one event."""
        if event.at - self._watched_at > PAUSE:
            self._watched_at = math.inf
            self._point(self._detector.finish())
        self._at = event.at
        if isinstance(event, Frame):
            self._cloud = event.cloud
            self._see(self._tracker.update(event.cloud, event.at))
        elif isinstance(event, Skeleton):
            self._watch(event)
        else:
            self._waiting.append(event)
        self._hear(event.at)

    def finish(self) -> None:
        """Write what waits for the end of the story."""
        self._point(self._detector.finish())
        if self._situation is not None:
            self._write_table(self._situation)
        self._hear(math.inf)
        self._write([self._add(("story", ENDED), self._at, Source(Origin.SEEN, "senses"))])

    def fail(self, reason: str) -> None:
        """Write that the story cannot go on."""
        source = Source(Origin.SEEN, "senses")
        note = self._add(("senses", NOTICED, f"the story ends early: {reason}"), self._at, source)
        self._write([note, self._add(("story", ENDED), self._at, source)])

    # ---- seeing

    def _see(self, situation: Situation) -> None:
        seen = Source(Origin.SEEN, "tracker", f"frame {next(self._frames)}")
        changes: list[Change] = []
        for thing in situation.went:
            fluent, _ = self._places.pop(thing.id, (None, 0.0))
            if fluent is not None:
                changes.append(Finish(fluent, self._time(max(thing.seen_at, 0.0))))
        for thing in situation.things:
            known = self._places.get(thing.id)
            if thing.moving or (known is not None and known[1] == thing.since):
                continue
            if known is not None:
                changes.append(Finish(known[0], self._time(thing.since)))
            changes.append(self._place(thing, seen))
        for note in situation.notes:
            if note not in self._notes:
                self._notes.add(note)
                changes.append(self._add(("camera", NOTICED, note), situation.at, seen))
        self._write(changes)
        if any(thing.moving for thing in situation.things) or situation.went or situation.came:
            self._moved_at = situation.at
        self._situation = situation
        if situation.at - self._moved_at >= STILL:
            self._write_table(situation)

    def _place(self, thing: TrackedThing, seen: Source) -> Change:
        added = self._add(
            (self._id(thing.id), AT, json.dumps(thing.box.round(4).tolist())), thing.since, seen, thing.certainty
        )
        self._places[thing.id] = (added.fluent.id, thing.since)
        return added

    def _write_table(self, situation: Situation) -> None:
        """Write the present table as a scene, unless it was written already."""
        from deixis.workflows.scenes.perceive import write_scene

        key = tuple((thing.id, thing.since) for thing in situation.things)
        if key == self._written:
            self._write_watched(situation.at)
            return
        self._written, self._watched = key, None
        file = self._folder / f"{self._board.new_id('table')}.scene.json"
        write_scene(self._detected(situation), file)
        added = self._add(("table", TABLE, str(file)), situation.at, Source(Origin.SEEN, "tracker"))
        changes: list[Change] = [] if self._table is None else [Finish(self._table, self._time(situation.at))]
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

    def _detected(self, situation: Situation) -> Scene:
        """Detect all things of the table that lies still, with the names of those that are tracked.

        The tracker segments only what changed; a whole look, as at a table that is seen for the first time, is what the
        robot learns from and compares with.
        """
        from scipy.optimize import linear_sum_assignment

        tracked = self._scene(situation)
        if self._cloud is None or situation.frame is None or not tracked.objects:
            return tracked
        try:
            found = perceived(self._cloud)
        except DeixisError:
            return tracked
        if found.detection is None or not found.objects:
            return tracked
        onto = situation.frame @ np.linalg.inv(found.detection.frame)
        middles = found.boxes.mean(axis=1) @ onto[:3, :3].T + onto[:3, 3]
        apart = np.linalg.norm(middles[:, None] - tracked.boxes.mean(axis=1)[None], axis=2)
        ids: dict[str, str] = {}
        for place, other in zip(*linear_sum_assignment(apart), strict=True):
            if apart[place, other] <= SAME_PLACE:
                ids[found.ids[place]] = tracked.ids[other]
        for name in found.ids:
            ids.setdefault(name, self._board.new_id("t"))
        return replace(
            found, objects=tuple(replace(thing, id=ids[thing.id]) for thing in found.objects), detection=None
        )

    def _scene(self, situation: Situation) -> Scene:
        scene = situation.scene()
        return replace(scene, objects=tuple(replace(thing, id=self._id(thing.id)) for thing in scene.objects))

    # ---- pointing and hearing

    def _watch(self, skeleton: Skeleton) -> None:
        if self._situation is None or self._situation.frame is None:
            return
        self._watched_at = skeleton.at
        joints = {name: _moved(self._situation.frame, place) for name, place in skeleton.joints.items()}
        self._point(self._detector.update(replace(skeleton, joints=joints)))

    def _point(self, gestures) -> None:  # type: ignore[no-untyped-def]
        for gesture in gestures:
            if self._situation is None or not self._situation.things:
                continue
            pointing = pointed_at(gesture, self._scene(self._situation))
            self._pointings.append(pointing)
            if pointing.decided is not None:
                source = Source(Origin.SHOWN, gesture.person, f"gesture at {gesture.at:.1f} s")
                probability = pointing.probabilities[pointing.decided]
                statement = (gesture.person, POINTED_AT, pointing.decided)
                added = self._add(statement, gesture.start, source, probability, gesture.finish)
                self._write([added])

    def _hear(self, now: float) -> None:
        """Write the words of which the moment, in which people may still point, has passed."""
        while self._waiting and now > self._waiting[0].end + SAME_MOMENT + STILL:
            said = self._waiting.pop(0)
            source = Source(Origin.SAID, said.speaker, f"words at {said.at:.1f} s")
            finish = said.end if said.end > said.at else said.at + 1e-3
            changes: list[Change] = [
                self._add((said.speaker, SAID, said.text), said.at, source, max(said.confidence, 0.01), finish)
            ]
            scene = None if self._situation is None else self._scene(self._situation)
            if scene is not None and scene.objects:
                for label in taught_labels([pointed_label(said, tuple(self._pointings), scene)], scene)[0]:
                    shown = replace(source, origin=Origin.SHOWN)
                    if label.target is not None and label.refused is None and label.name is not None:
                        what = (label.target, CALLED if label.positive else NOT_CALLED, label.name)
                        changes.append(self._add(what, said.at, shown, label.probability))
                    elif label.name is not None and label.refused is not None:
                        noticed = f"'{label.name}' was not learned: {label.refused}. {label.question or ''}".strip()
                        changes.append(self._add((said.speaker, NOTICED, noticed), said.at, shown))
            self._write(changes)

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


def _moved(frame: NDArray[np.float64], place: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = (frame[:3, :3] @ np.array(place) + frame[:3, 3]).tolist()
    return x, y, z
