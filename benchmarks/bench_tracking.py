"""Measure the tracker on films of simulated tables, on which a hand moves, brings, takes and hides things.

    python benchmarks/bench_tracking.py
    python benchmarks/bench_tracking.py --films 12 --actions 8
    python benchmarks/bench_tracking.py --seeds 303 304 308 309 313 314 --cameras still --no-pcl --peer-every 0

A film of a seed has 1, 2, 4, 8 or 12 things for seeds that end in 0 or 5, 1 or 6, and so on, whatever the other seeds
are: the last line prints films that the tracker was not developed on.
Each film has 1 to 12 things, and a forearm that hides one of them for two seconds at least once. It is seen by a camera
that stands still, by one that sways with a person's head (5 cm and 4 degrees), and by one that also walks around a side
of the table (60 degrees in 12 s, and back). Places are compared in the frame of the table, so that errors of the
camera's pose count. A thing counts in every frame that shows it, from a second after it first lies in view. Its
identity is kept if its first track is still there and within 5 cm of it. Errors are distances between the middles of
kept things and the true ones. Seconds are of processor time of the tracker alone. ``--scale 0.5`` films half of the
rows and columns and compares all of them.

The peer detects all things in a frame of the camera that stands still, and assigns them to the tracks by the Hungarian
method, with a gate of 15 cm; a track that is not seen for two seconds ends. Detection takes longer than a tenth of a
second, so that it gets every ``--peer-every``-th frame (5, two frames a second); 0 leaves it out. The other peer is the
particle filter of the Point Cloud Library (Debian: libpcl-dev), with an adaptive number of particles and the settings
of the library's example. It neither finds things nor notices that they go: it begins to follow each thing when our
tracker does, with the same points, and gets the points above the table in every frame of the camera that stands still.
``--no-pcl`` leaves it out.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from peers import tracking_pcl
from records import command_line, figure, recorded, share

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import detect
from deixis.perception.simulator.films.camera_paths import CAMERA_PATHS, camera_path
from deixis.perception.simulator.films.film import FilmedFrame
from deixis.perception.simulator.films.stories import random_film
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.situation import Situation
from deixis.perception.tracking.tracker import Tracker

THINGS = (1, 2, 4, 8, 12)
FIRST, NEAR, CLOSE = 0.04, 0.05, 0.01
"""Distances in metres: of a track from the thing that gets it, of a kept one, and of a right one."""

SETTLING = 1.0
"""Minimum time in seconds at which a thing that lies in view must be tracked."""

LOWEST, HIGHEST = 0.004, 0.5
"""Heights above the table in metres between which the filters of the library get points."""

Tracks = Mapping[str, NDArray[np.float64]]
"""Middles (3,) of the tracks in the frame of the camera, by id."""


@dataclass
class Score:
    """Kept and all frames of things, errors of kept ones in metres, and seconds of processor time of each frame."""

    kept: int = 0
    frames: int = 0
    errors: list[float] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    _tracks: dict[str, str] = field(default_factory=dict)
    _since: dict[str, float] = field(default_factory=dict)

    def begin(self) -> None:
        """Forget the things of the film before."""
        self._tracks, self._since = {}, {}

    def add(self, frame: FilmedFrame, tracks: Tracks) -> None:
        """Compare the tracks of a frame with the truth."""
        places = {name: frame.camera.to_table(place[None])[0] for name, place in tracks.items()}
        for thing in frame.things:
            if not thing.held and thing.visible:
                self._since.setdefault(thing.name, frame.at)
        self._assign(frame, places)
        for thing in frame.things:
            if not thing.visible or frame.at < self._since.get(thing.name, np.inf) + SETTLING:
                continue
            self.frames += 1
            place = places.get(self._tracks.get(thing.name, ""))
            away = np.inf if place is None else float(np.linalg.norm(place - thing.centre))
            if away < NEAR:
                self.kept += 1
                self.errors.append(away)

    def _assign(self, frame: FilmedFrame, places: Tracks) -> None:
        """Give things without a track the free ones within ``FIRST``, so that the sum of distances is least."""
        from scipy.optimize import linear_sum_assignment

        new = [
            thing
            for thing in frame.things
            if thing.name not in self._tracks and thing.name in self._since and not thing.held
        ]
        free = [name for name in places if name not in self._tracks.values()]
        if not new or not free:
            return
        apart = np.array([[np.linalg.norm(places[name] - thing.centre) for name in free] for thing in new])
        for row, column in zip(*linear_sum_assignment(np.minimum(apart, 10 * FIRST)), strict=True):
            if apart[row, column] < FIRST:
                self._tracks[new[row].name] = free[column]


class Association:
    """Detection in every frame, and assignment of what was detected to tracks by the Hungarian method."""

    def __init__(self, gate: float = 0.15, patience: float = 2.0) -> None:
        self._gate, self._patience = gate, patience
        self._tracks: dict[str, tuple[NDArray[np.float64], float]] = {}
        self._names = 0

    def __call__(self, cloud: PointCloud, at: float) -> Tracks:
        """Return the tracks after a frame."""
        from scipy.optimize import linear_sum_assignment

        found = detect(cloud)
        back = np.linalg.inv(found.frame)
        middles = found.boxes.mean(axis=1) @ back[:3, :3].T + back[:3, 3]
        names = list(self._tracks)
        known = np.array([self._tracks[name][0] for name in names]).reshape(-1, 3)
        apart = np.linalg.norm(known[:, None] - middles[None], axis=2)
        taken = set()
        for row, column in zip(*linear_sum_assignment(np.minimum(apart, 10 * self._gate)), strict=True):
            if apart[row, column] < self._gate:
                self._tracks[names[row]] = middles[column], at
                taken.add(int(column))
        for column in set(range(len(middles))) - taken:
            self._names += 1
            self._tracks[f"d{self._names}"] = middles[column], at
        self._tracks = {name: track for name, track in self._tracks.items() if at - track[1] <= self._patience}
        return {name: place for name, (place, _) in self._tracks.items()}


def tracks_of(now: Situation) -> Tracks:
    """Return our tracks in the frame of the camera."""
    if now.frame is None:
        return {}
    back = np.linalg.inv(now.frame)
    return {thing.id: back[:3, :3] @ thing.centre + back[:3, 3] for thing in now.things}


class LibraryFilters:
    """The particle filters of the Point Cloud Library, which begin with the things of our tracker."""

    def __init__(self, filters: tracking_pcl.Filters) -> None:
        self._filters = filters
        self._names: list[str] = []

    def __call__(self, cloud: PointCloud, now: Situation) -> tuple[Tracks, float]:
        """Return the tracks after a frame of which our tracker knows ``now``, and the seconds of processor time."""
        if now.frame is None:
            return {}, 0.0
        back = np.linalg.inv(now.frame)
        for thing in now.things:
            if thing.id in now.came:
                points = thing.cloud.points @ back[:3, :3].T + back[:3, 3]
                self._filters.begin(points, back[:3, :3] @ thing.centre + back[:3, 3])
                self._names.append(thing.id)
        heights = cloud.points @ now.frame[2, :3] + now.frame[2, 3]
        places, seconds = self._filters.follow(cloud.points[(heights > LOWEST) & (heights < HIGHEST)])
        return dict(zip(self._names, places, strict=True)), seconds


def main() -> None:
    """Print the shares of kept identities, the errors, and the processor time of a frame, by camera and things."""
    parser = command_line(__file__, __doc__)
    parser.add_argument("--films", type=int, default=len(THINGS), help="films, with 1 to 12 things by their seeds")
    parser.add_argument("--actions", type=int, default=4, help="random actions of a film")
    parser.add_argument("--first", type=int, default=100, help="seed of the first film")
    parser.add_argument("--seeds", type=int, nargs="+", help="seeds of the films, instead of --films and --first")
    parser.add_argument("--scale", type=float, default=1.0, help="factor on the rows and columns of the images")
    parser.add_argument("--cameras", nargs="+", choices=CAMERA_PATHS, default=CAMERA_PATHS, help="paths of the camera")
    parser.add_argument("--peer-every", type=int, default=5, help="frames of which the peer gets one; 0: no peer")
    parser.add_argument("--no-pcl", action="store_true", help="without the Point Cloud Library")
    with recorded(parser) as arguments, tempfile.TemporaryDirectory() as folder:
        program = None if arguments.no_pcl else tracking_pcl.build(Path(folder))
        if program is None and not arguments.no_pcl:
            print("the Point Cloud Library is not installed (Debian: libpcl-dev): it was not run", file=sys.stderr)
        arguments.program = program
        short = argparse.Namespace(actions=1, scale=0.25, peer_every=0, program=None)
        _run(arguments.cameras[-1], 1, 0, short, Score(), Score(), Score())  # compiles before times are measured
        peer, library = Score(), Score()
        for camera in arguments.cameras:
            scores: dict[int, Score] = {}
            for seed in arguments.seeds or range(arguments.first, arguments.first + arguments.films):
                things = THINGS[seed % len(THINGS)]
                score = scores.setdefault(things, Score())
                _run(camera, things, seed, arguments, score, peer, library)
                print(f"{camera}, film {seed}: {things} things: {_line(score)}", flush=True)
            for things, score in sorted(scores.items()):
                print(f"{camera}, {things:>2} things: {_line(score)}")
                figure(
                    f"{camera} camera, {things} things: processor time of a frame", float(np.mean(score.seconds)), "s"
                )
            if len(scores) > 2:
                _linear_load(camera, scores)
            everything = Score(
                sum(score.kept for score in scores.values()),
                sum(score.frames for score in scores.values()),
                list(chain.from_iterable(score.errors for score in scores.values())),
                list(chain.from_iterable(score.seconds for score in scores.values())),
            )
            errors = np.array(everything.errors)
            print(f"{camera}, all: {_line(everything)}")
            share(f"{camera} camera: identity kept, frames of things", everything.kept, everything.frames)
            share(f"{camera} camera: error below 1 cm, frames of kept things", int((errors < CLOSE).sum()), len(errors))
            figure(f"{camera} camera: median error of the middle", float(np.median(errors)), "m")
            if camera == "still" and peer.frames:
                print(f"peer, detection and Hungarian assignment: {_line(peer)}")
                figure("identity kept by detection and assignment", peer.kept / peer.frames, "share", peer="scipy")
                times = float(np.mean(peer.seconds)) / float(np.mean(everything.seconds))
                figure("time of a frame of detection and assignment", times, "times as long", peer="scipy")
            if camera == "still" and library.frames:
                print(f"peer, particle filters of the Point Cloud Library: {_line(library)}")
                close = float((np.array(library.errors) < CLOSE).mean()) if library.errors else 0.0
                figure("identity kept by the particle filters", library.kept / library.frames, "share", peer="PCL")
                figure("error of the particle filters below 1 cm, frames of kept things", close, "share", peer="PCL")
                times = float(np.mean(library.seconds)) / float(np.mean(everything.seconds))
                figure("time of a frame of the particle filters", times, "times as long", peer="PCL")


def _run(
    camera: str, things: int, seed: int, arguments: argparse.Namespace, score: Score, peer: Score, library: Score
) -> None:
    """Track the things of one film, seen by a camera, and add what is found to a score; and the peers to their own."""
    for each in (score, peer, library):
        each.begin()
    association = Association()
    film = random_film(things, arguments.actions, seed, sure_pass=True, path=camera_path(camera, seed))
    every = arguments.peer_every if camera == "still" else 0
    settings = TrackingSettings(stride=2 if arguments.scale > 0.6 else 1)
    with Tracker(settings) as tracker, _filters(arguments.program if camera == "still" else None) as filters:
        for frame in film.frames(10.0, seed, scale=arguments.scale):
            started = time.process_time()
            now = tracker.update(frame.cloud, frame.at)
            tracks = tracks_of(now)
            score.seconds.append(time.process_time() - started)
            score.add(frame, tracks)
            if every and frame.number % every == 0:
                started = time.process_time()
                tracks = association(frame.cloud, frame.at)
                peer.seconds.append(time.process_time() - started)
                peer.add(frame, tracks)
            if filters is not None:
                tracks, seconds = filters(frame.cloud, now)
                library.seconds.append(seconds)
                library.add(frame, tracks)


@contextmanager
def _filters(program: Path | None) -> Iterator[LibraryFilters | None]:
    """Yield new particle filters of the library, or None without its program."""
    if program is None:
        yield None
        return
    with tracking_pcl.Filters(program) as filters:
        yield LibraryFilters(filters)


def _linear_load(camera: str, scores: Mapping[int, Score]) -> None:
    """Print the straight line through the processor times of a frame by the number of things at the start."""
    counts = np.array(sorted(scores), dtype=np.float64)
    times = np.array([np.mean(scores[int(count)].seconds) for count in counts])
    slope, base = np.polyfit(counts, times, 1)
    off = float(np.abs(base + slope * counts - times).max() / times.max())
    print(
        f"{camera}, load: {1000 * base:.1f} ms a frame and {1000 * slope:.2f} ms more for each thing;"
        f" largest difference from this line {off:.2f} of the largest time"
    )
    figure(f"{camera} camera: processor time of a frame for each further thing", float(slope), "s")
    figure(f"{camera} camera: difference of the load from a straight line", off, "share of the largest time")


def _line(score: Score) -> str:
    errors, seconds = np.array(score.errors or [np.nan]), np.array(score.seconds)
    return (
        f"identity kept {score.kept / max(score.frames, 1):.3f} of {score.frames}, error {1000 * errors.mean():.1f} mm"
        f" (median {1000 * np.median(errors):.1f}), below 1 cm {np.mean(errors < CLOSE):.3f},"
        f" {1000 * seconds.mean():.0f} ms a frame (median {1000 * np.median(seconds):.0f},"
        f" 95 % {1000 * np.quantile(seconds, 0.95):.0f})"
    )


if __name__ == "__main__":
    main()
