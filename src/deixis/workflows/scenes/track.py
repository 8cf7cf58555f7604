"""Follow the things on a table through a stream of clouds: what is where since when, and what came, moved and went."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

from deixis.answers import Answer, count
from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.errors import CloudError
from deixis.perception.tracking.frames.frame import Frame
from deixis.perception.tracking.frames.stream import CloudSource, FileSource, FolderSource, LatestFrames
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.situation import Situation, TrackedThing
from deixis.perception.tracking.tracker import Tracker

Change = Literal["new", "moves", "rests", "hidden", "seen", "gone", "merged"]

MAX_NOTES = 100
"""Largest number of notes that are kept."""


@dataclass(frozen=True, slots=True)
class TrackedEvent:
    """Change of one thing at a time in seconds; ``centre`` is its middle in the table's frame, in metres."""

    at: float
    id: str
    change: Change
    centre: tuple[float, float, float]


@dataclass(frozen=True, eq=False, repr=False)
class Tracking(Answer):
    """Things and events of a stream of clouds.

    Parameters
    ----------
    things
        Things that are there at the end.
    gone
        Things that are gone; ``seen_at`` is the time since when.
    events
        Changes of the things, in order.
    frames, dropped, left_out
        Numbers of frames that were used, that came too fast, and that could not be used.
    notes
        Warnings with their times, at most ``MAX_NOTES``.
    seconds
        Time of the last frame, in seconds.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.Tracking(frames=20, seconds=1.9)
    >>> found
    <Tracking 0 things there, 0 gone, after 20 frames in 1.90 s>
    >>> print(found.to_text())
    Nothing was tracked.
    20 frames used, 1.90 s.
    """

    things: tuple[TrackedThing, ...] = ()
    gone: tuple[TrackedThing, ...] = ()
    events: tuple[TrackedEvent, ...] = ()
    frames: int = 0
    dropped: int = 0
    left_out: int = 0
    notes: tuple[str, ...] = ()
    seconds: float = 0.0

    def summary(self) -> str:
        """Return the numbers of things and frames."""
        there, gone = count(len(self.things), "thing"), len(self.gone)
        return f"{there} there, {gone} gone, after {count(self.frames, 'frame')} in {self.seconds:.2f} s"


@dataclass
class _Log:
    """Events of a stream so far."""

    events: list[TrackedEvent] = field(default_factory=list)
    gone: list[TrackedThing] = field(default_factory=list)
    before: dict[str, TrackedThing] = field(default_factory=dict)

    def add(self, now: Situation) -> None:
        for thing in now.things:
            if thing.id in now.came:
                self._note(now.at, thing, "new")
            elif thing.id in self.before:
                was = self.before[thing.id]
                if thing.moving != was.moving and (thing.moving or thing.state == "seen"):
                    self._note(now.at, thing, "moves" if thing.moving else "rests")
                elif thing.state != was.state:
                    self._note(now.at, thing, thing.state)
        for thing in now.went:
            self.gone.append(thing)
            self._note(now.at, thing, "gone")
        for thing in now.merged:
            self._note(now.at, thing, "merged")
        self.before = {thing.id: thing for thing in now.things}

    def _note(self, at: float, thing: TrackedThing, change: Change) -> None:
        x, y, z = (round(value, 4) for value in thing.centre.tolist())
        self.events.append(TrackedEvent(at, thing.id, change, (x, y, z)))


def cloud_source(
    files: Sequence[str | Path],
    rate: float = 10.0,
    grows: bool = False,
    patience: float = 10.0,
    intrinsics: str | Path | Intrinsics | None = None,
) -> CloudSource:
    """Return the source of frames that files or a folder are.

    Parameters
    ----------
    files
        One folder, or files of clouds in order.
    rate
        Frames per second where no times are known.
    grows
        True to wait for further files in the folder.
    patience
        Time in seconds without a new file after which a growing folder ends.
    intrinsics
        Camera of depth images; None for clouds.

    Returns
    -------
    CloudSource
        Source that reads the clouds one after another.

    Raises
    ------
    CloudError
        If there is no folder or file, or several folders are given.
    """
    if len(files) == 1 and Path(files[0]).is_dir():
        return FolderSource(files[0], rate, grows, patience, intrinsics)
    if grows or not files or any(Path(file).is_dir() for file in files):
        raise CloudError(f"give one folder or one or more files, got {', '.join(map(str, files)) or 'nothing'}")
    missing = next((file for file in files if not Path(file).is_file()), None)
    if missing is not None:
        raise CloudError(f"{missing}: there is no such file or folder")
    return FileSource(files, rate, intrinsics)


def track(
    source: CloudSource,
    *,
    settings: TrackingSettings | None = None,
    live: bool = False,
    each: Callable[[Situation, Sequence[TrackedEvent]], None] | None = None,
) -> Tracking:
    """Follow the things on a table through a stream of clouds.

    Parameters
    ----------
    source
        Source of frames.
    settings
        Options of the tracker; the default ones if None.
    live
        True to drop frames that come faster than they can be used; False to use all.
    each
        Called with the situation after every frame, and with what changed.

    Returns
    -------
    Tracking
        What is where since when at the end, and what happened.

    Examples
    --------
    >>> from deixis.perception.simulator.laying import Placement
    >>> from deixis.perception.simulator.films.stage import Rest, TakeAway, film
    >>> mug, plate = Placement("mug", "mug", 0.2, 0.0), Placement("plate", "dinner plate", -0.1, 0.0)
    >>> found = track(film([mug, plate], [Rest(0.3), TakeAway("mug"), Rest(1.2)]))
    >>> [thing.id for thing in found.things], [thing.id for thing in found.gone]
    (['t1'], ['t2'])
    """
    log, notes = _Log(), list[str]()
    frames = left_out = 0
    last: Situation | None = None
    latest = LatestFrames(source) if live else None
    with Tracker(settings) as tracker:
        for frame in (latest or source).frames():
            now, problem = _situation_after(tracker, frame, last)
            notes += [f"frame {frame.number}, {frame.at:.2f} s: {note}" for note in now.notes][: MAX_NOTES - len(notes)]
            left_out += problem
            frames += not problem
            known = len(log.events)
            log.add(now)
            last = now
            if each is not None:
                each(now, log.events[known:])
    return Tracking(
        () if last is None else last.things,
        tuple(log.gone),
        tuple(log.events),
        frames,
        0 if latest is None else latest.dropped,
        left_out,
        tuple(notes),
        0.0 if last is None else last.at,
    )


def _situation_after(tracker: Tracker, frame: Frame, last: Situation | None) -> tuple[Situation, bool]:
    """Return the situation after a frame, and True if the frame could not be used."""
    if frame.problem is not None:
        before = last or Situation(frame.at, frame.number)
        return Situation(
            before.at, frame.number, before.things, frame=before.frame, notes=(f"{frame.problem}; it is left out",)
        ), True
    now = tracker.update(frame.cloud, frame.at)
    return now, any("left out" in note for note in now.notes)
