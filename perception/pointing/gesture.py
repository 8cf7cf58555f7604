"""Find the moments in which a person points: an arm is raised, moves, and then is held still.

People move the arm to a pointing pose, hold it there, and take it back; the hold is the part that is aimed (Nickel and
Stiefelhagen 2007, who measured holds of 0.76 s on average). A hold is therefore found first; what it points at, if
anything, is computed afterwards (:mod:`deixis.perception.pointing.aim`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.pointing.skeleton import SIDES, ArmTrack, Skeleton, arm_track

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MIN_HOLD = 0.3
"""Minimum duration of a hold, in seconds."""

MAX_SPEED = 0.25
"""Maximum speed of a fingertip that is held still, in metres per second; noise of joints of 1 cm shows as 0.1."""

MEDIAN_FRAMES = 5
"""Number of successive frames whose median replaces each place of the fingertip before speeds are fitted."""

BRIDGED = 0.2
"""Maximum time in which a hold may seem to move, in seconds."""

SPEED_WINDOW = 0.3
"""Length of the time window over which the speed is fitted, in seconds."""

MAX_GAP = 0.4
"""Maximum time without the arm's joints inside a hold, in seconds."""

MIN_APPROACH = 0.12
"""Minimum distance in metres from which the fingertip must have come to the hold, within ``APPROACH_TIME``."""

APPROACH_TIME = 2.0
"""Time before a hold in which the hand must have moved, in seconds."""

HANGING = 0.85
"""Minimum depth of the fingertip below the shoulder of an arm that hangs, as a share of the length of the arm."""

MAX_DRIFT = 0.05
"""Maximum distance between the places of the fingertip in the first and the last third of a hold, in metres."""

MIN_HAND = 0.03
"""Minimum distance from the wrist to the fingertip of a hand whose direction counts, in metres."""

MIN_FRAMES = 4
"""Minimum number of frames in a hold."""

BUFFER = 20.0
"""Time for which the detector keeps frames, in seconds; a longer hold is reported in parts."""


@dataclass(frozen=True, eq=False)
class Gesture:
    """A moment in which a person holds an arm as if to point.

    Parameters
    ----------
    person
        Name of the person.
    side
        ``left`` or ``right``.
    start, finish
        First and last time of the hold, in seconds.
    eye, elbow, wrist, tip
        Medians of the joints over the hold, shape (3,), in metres; ``eye`` is NaN if it was not seen. ``tip`` is the
        fingertip, else the hand, else the wrist.
    scatter
        Standard errors of the rays over the hold, shape (3,), in radians; NaN for a ray that was not seen.
    """

    person: str
    side: str
    start: float
    finish: float
    eye: Array
    elbow: Array
    wrist: Array
    tip: Array
    scatter: Array

    @property
    def at(self) -> float:
        """Middle of the hold, in seconds."""
        return (self.start + self.finish) / 2

    @property
    def rays(self) -> Array:
        """Directions from the eye to the fingertip, along the forearm, and along the hand, as rows, shape (3, 3).

        The forearm is from the elbow to the wrist, the hand from the wrist to the fingertip. A row is NaN if the eye,
        or the hand, was not seen.
        """
        hand = self.tip - self.wrist
        if not np.linalg.norm(hand) > MIN_HAND:
            hand = np.full(3, np.nan)
        return np.stack([unit(self.tip - self.eye), unit(self.wrist - self.elbow), unit(hand)])


def unit(vectors: Array) -> Array:
    """Return vectors divided by their lengths.

    Parameters
    ----------
    vectors
        Vectors, shape (…, 3).

    Returns
    -------
    ndarray
        Unit vectors of the same shape; 0 for a vector of length 0.
    """
    result: Array = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
    return result


def gestures(skeletons: Iterable[Skeleton]) -> tuple[Gesture, ...]:
    """Return the gestures in a recording of one or more persons, in order of time.

    Parameters
    ----------
    skeletons
        Skeletons in order of time.

    Returns
    -------
    tuple of Gesture
        Each moment in which an arm is held still after it was moved.
    """
    detector = GestureDetector()
    found = [gesture for skeleton in skeletons for gesture in detector.update(skeleton)]
    return tuple(sorted((*found, *detector.finish()), key=lambda one: (one.start, one.side)))


class GestureDetector:
    """Find gestures in a stream of skeletons; each is returned once, when its hold has ended.

    Skeletons of one person must come in order of time; one that is not later than the one before is counted in
    ``late`` and ignored.
    """

    def __init__(self) -> None:
        self.late = 0
        self._frames: dict[str, list[Skeleton]] = {}
        self._reported: dict[tuple[str, str], float] = {}
        self._checked: dict[str, float] = {}

    def update(self, skeleton: Skeleton) -> Iterator[Gesture]:
        """Take a skeleton and yield the gestures that have ended.

        Parameters
        ----------
        skeleton
            The next skeleton of a person.

        Yields
        ------
        Gesture
            A hold that ended at least ``MAX_GAP`` seconds ago.
        """
        frames = self._frames.setdefault(skeleton.person, [])
        if frames and skeleton.at <= frames[-1].at:
            self.late += 1
            return
        frames.append(skeleton)
        if skeleton.at - self._checked.setdefault(skeleton.person, skeleton.at) >= MIN_HOLD:
            self._checked[skeleton.person] = skeleton.at
            full = skeleton.at - frames[0].at > BUFFER
            yield from self._ended(skeleton.person, np.inf if full else skeleton.at - MAX_GAP - SPEED_WINDOW)
            kept = skeleton.at - (APPROACH_TIME + MIN_HOLD if full else BUFFER)
            if full:
                frames[:] = [one for one in frames if one.at >= kept]

    def finish(self) -> Iterator[Gesture]:
        """Yield the gestures whose holds last until the end of the stream.

        Yields
        ------
        Gesture
            The last hold of each arm, if it is long enough.
        """
        for person in self._frames:
            yield from self._ended(person, np.inf)

    def _ended(self, person: str, before: float) -> Iterator[Gesture]:
        """Yield the gestures that ended before a time and were not reported yet."""
        for side in SIDES:
            for gesture in _holds(arm_track(self._frames[person], side)):
                if gesture.finish < before and gesture.start > self._reported.get((person, side), -np.inf):
                    self._reported[person, side] = gesture.finish
                    yield gesture


def _holds(arm: ArmTrack) -> Iterator[Gesture]:
    """Yield the holds of an arm that is raised and was moved before."""
    if len(arm) < MIN_FRAMES:
        return
    speed = speeds(arm.times, _without_outliers(arm.tips))
    for run in _runs(arm.times, speed < MAX_SPEED):
        for hold in _split(arm, run, speed):
            tip = np.median(arm.tips[hold], axis=0)
            if not _hangs(arm, hold, tip) and _was_moved(arm, float(arm.times[hold[0]]), tip):
                yield _gesture(arm, hold, tip)


def _split(arm: ArmTrack, run: Indices, speed: Array) -> Iterator[Indices]:
    """Yield the parts of a run in which the fingertip stays in one place, split where it moves fastest."""
    times = arm.times[run]
    if len(run) < MIN_FRAMES or times[-1] - times[0] < MIN_HOLD:
        return
    third = max(1, len(run) // 3)
    first, last = (np.median(arm.tips[part], axis=0) for part in (run[:third], run[-third:]))
    if np.linalg.norm(last - first) <= MAX_DRIFT:
        yield run
        return
    fastest = times[1 + int(np.argmax(speed[run[1:-1]]))]
    half = SPEED_WINDOW / 4
    yield from _split(arm, run[times < fastest - half], speed)
    yield from _split(arm, run[times > fastest + half], speed)


def _without_outliers(places: Array) -> Array:
    """Return running medians of places, shape (n, 3)."""
    half = MEDIAN_FRAMES // 2
    padded = np.concatenate([places[:1]] * half + [places] + [places[-1:]] * half)
    result: Array = np.median(np.lib.stride_tricks.sliding_window_view(padded, MEDIAN_FRAMES, axis=0), axis=-1)
    return result


def speeds(times: Array, places: Array) -> Array:
    """Return the speeds along a path, each as the slope of a line through the places near it in time.

    Parameters
    ----------
    times
        Times in seconds, increasing, shape (n,).
    places
        Places, shape (n, 3), in metres.

    Returns
    -------
    ndarray
        Speeds, shape (n,), in metres per second; infinite where no other place is near in time.
    """
    first = np.searchsorted(times, times - SPEED_WINDOW / 2, side="left")
    last = np.searchsorted(times, times + SPEED_WINDOW / 2, side="right")
    sums = [np.concatenate([np.zeros((1, v.shape[1])), np.cumsum(v, axis=0)]) for v in _moments(times, places)]
    n = (last - first)[:, None].astype(np.float64)
    t, tt, x, tx = (total[last] - total[first] for total in sums)
    spread = n * tt - t * t
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes = np.where(spread > 1e-12, (n * tx - t * x) / spread, np.inf)
    result: Array = np.linalg.norm(slopes, axis=1)
    return result


def _moments(times: Array, places: Array) -> tuple[Array, Array, Array, Array]:
    t = (times - times[0])[:, None]
    x = places - places[0]
    return t, t * t, x, t * x


def _runs(times: Array, still: NDArray[np.bool_]) -> Iterator[Indices]:
    """Yield the positions of the still frames of each hold; holds are apart by more than a short movement."""
    places = np.flatnonzero(still)
    if not len(places):
        return
    apart = np.diff(times[places])
    breaks = ((np.diff(places) > 1) & (apart > BRIDGED)) | (apart > MAX_GAP)
    yield from np.split(places, np.flatnonzero(breaks) + 1)


def _hangs(arm: ArmTrack, run: Indices, tip: Array) -> bool:
    """Return whether the arm hangs straight down."""
    shoulder, elbow, wrist = (np.median(part[run], axis=0) for part in (arm.shoulders, arm.elbows, arm.wrists))
    length = sum(float(np.linalg.norm(b - a)) for a, b in ((shoulder, elbow), (elbow, wrist), (wrist, tip)))
    return bool(shoulder[2] - tip[2] > HANGING * length)


def _was_moved(arm: ArmTrack, start: float, tip: Array) -> bool:
    before = (arm.times < start) & (arm.times >= start - APPROACH_TIME)
    return bool((np.linalg.norm(arm.tips[before] - tip, axis=1) > MIN_APPROACH).any())


def _gesture(arm: ArmTrack, run: Indices, tip: Array) -> Gesture:
    eyes = arm.eyes[run]
    seen = np.isfinite(eyes).all(axis=1)
    eye = np.median(eyes[seen], axis=0) if seen.any() else np.full(3, np.nan)
    elbow, wrist = np.median(arm.elbows[run], axis=0), np.median(arm.wrists[run], axis=0)
    tips, elbows, wrists = arm.tips[run], arm.elbows[run], arm.wrists[run]
    hands = np.linalg.norm(tips - wrists, axis=1) > MIN_HAND
    scatter = np.array([_error((tips - eyes)[seen]), _error(wrists - elbows), _error((tips - wrists)[hands])])
    start, finish = float(arm.times[run[0]]), float(arm.times[run[-1]])
    return Gesture(arm.person, arm.side, start, finish, eye, elbow, wrist, tip, scatter)


CORRELATED_FRAMES = 6
"""Number of successive frames whose noise counts as one independent measurement."""


def _error(vectors: Array) -> float:
    """Return the standard error of the median direction of vectors, in radians; NaN without vectors."""
    if not len(vectors):
        return float("nan")
    directions = unit(vectors)
    off = np.linalg.norm(directions - unit(np.median(directions, axis=0)), axis=1)
    independent = max(1.0, len(vectors) / CORRELATED_FRAMES)
    return float(1.48 * np.median(off) / np.sqrt(2) * 1.25 / np.sqrt(independent))


def arms_seen(skeletons: Sequence[Skeleton]) -> bool:
    """Return whether any frame has a shoulder, an elbow and a wrist of one arm.

    Parameters
    ----------
    skeletons
        Skeletons.

    Returns
    -------
    bool
        False if no arm can be used, as with names of joints that are not known.
    """
    return any(
        all(f"{side}_{name}" in one.joints for name in ("shoulder", "elbow", "wrist"))
        for one in skeletons
        for side in SIDES
    )
