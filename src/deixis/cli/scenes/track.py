"""The command ``deixis track``: follow the things on a table through a stream of clouds."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.answers import count
from deixis.cli.common import AsJson, print_json, print_lines
from deixis.cli.progress import progress_bar

if TYPE_CHECKING:
    from deixis.perception.tracking.frames.frame import Frame
    from deixis.perception.tracking.frames.stream import CloudSource
    from deixis.perception.tracking.situation import Situation
    from deixis.workflows.scenes.track import TrackedEvent


def track(
    source: Annotated[
        list[str], typer.Argument(metavar="SOURCE...", help="A folder of clouds, cloud files, or 'simulator'.")
    ],
    rate: Annotated[float, typer.Option(metavar="HZ", help="Frames per second, if the source has no times.")] = 10.0,
    grows: Annotated[bool, typer.Option("--grows", help="Wait for further files in the folder.")] = False,
    patience: Annotated[
        float, typer.Option(metavar="SECONDS", help="Stop waiting after this time without a new file.")
    ] = 10.0,
    intrinsics: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Camera intrinsics (.json) of depth images.")
    ] = None,
    live: Annotated[bool, typer.Option("--live", help="Drop frames that come too fast.")] = False,
    things: Annotated[
        int, typer.Option(metavar="N", min=1, max=12, help="Simulator: number of things at the start.")
    ] = 4,
    actions: Annotated[
        int, typer.Option(metavar="N", min=0, max=100, help="Simulator: number of actions of the hand.")
    ] = 4,
    seed: Annotated[int, typer.Option(metavar="N", min=0, help="Simulator: seed of things, actions and noise.")] = 0,
    camera: Annotated[str, typer.Option(metavar="PATH", help="Simulator: still, sway or walk.")] = "still",
    record: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="Also write the frames as a recorded sequence.")
    ] = None,
    lines: Annotated[bool, typer.Option("--lines", help="Print a line of JSON after each frame.")] = False,
    as_json: AsJson = False,
) -> None:
    """Follow the things on a table through a stream of clouds: what is where, since when."""
    from deixis.perception.errors import CloudError
    from deixis.report.scenes.track import event_line, situation_to_dict, tracking_lines, tracking_to_dict
    from deixis.workflows.scenes.track import track as run

    frames = 0

    def each(now: Situation, events: Sequence[TrackedEvent]) -> None:
        nonlocal frames
        frames += 1
        if progress is not None:
            progress(frames, None)
        elif lines:
            print(json.dumps(situation_to_dict(now), ensure_ascii=False), flush=True)
        elif not as_json:
            print_lines(map(event_line, events))
            sys.stdout.flush()

    stream = _source(source, rate, grows, patience, intrinsics, (things, actions, seed), camera)
    is_printed = lines or not as_json  # then the lines show the progress
    with nullcontext() if is_printed else progress_bar("following, frames") as progress:
        found = run(stream if record is None else _Recorded(stream, record), live=live, each=each)
    if not found.frames:
        if not found.notes:
            raise CloudError("the source has no frames; name a folder of clouds, cloud files or 'simulator'")
        reason = found.notes[0].removesuffix("; it is left out")
        raise CloudError(f"none of the {count(found.left_out, 'frame')} can be used: {reason}")
    if as_json:
        print_json(tracking_to_dict(found))
    elif not lines:
        print_lines(tracking_lines(found))


def _source(
    names: list[str],
    rate: float,
    grows: bool,
    patience: float,
    intrinsics: Path | None,
    simulated: tuple[int, int, int],
    camera: str,
) -> CloudSource:
    from deixis.workflows.scenes.track import cloud_source

    if names == ["simulator"]:
        from deixis.perception.simulator.films.camera_paths import camera_path
        from deixis.perception.simulator.films.stories import FilmSource, random_film

        things, actions, seed = simulated
        return FilmSource(random_film(things, actions, seed, path=camera_path(camera, seed)), rate, seed)
    return cloud_source(names, rate, grows, patience, intrinsics)


class _Recorded:
    """Source whose frames are also written."""

    def __init__(self, source: CloudSource, folder: Path) -> None:
        self._source, self._folder = source, folder

    def frames(self) -> Iterator[Frame]:
        """Yield the frames after they were written."""
        from deixis.perception.tracking.frames.stream import recording

        return recording(self._source.frames(), self._folder)
