"""The command ``deixis robot run``: a robot that sees, learns from people, and reports what it finds as it happens."""

from __future__ import annotations

import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from deixis.cli.common import AsJson, MemoryDir, print_json, print_line, print_written
from deixis.cli.output import StandardInput
from deixis.cli.progress import progress_bar
from deixis.errors import DeixisError

if TYPE_CHECKING:
    from deixis.robot.live.run import LiveRobot


class LiveError(DeixisError, ValueError):
    """Story that ended early."""


SHOWN_LINES = 12
"""Number of lines of the conversation in the terminal view."""

robot_app = typer.Typer(help="Run the robot on one memory.", rich_markup_mode=None, no_args_is_help=True)


@robot_app.callback()
def _robot() -> None:
    """Run a robot that sees a table, learns from people, and checks the next table."""


@robot_app.command("run")
def run(
    source: Annotated[
        str,
        typer.Option(
            "--from",
            metavar="SOURCE",
            help="A folder with clouds, a camera driver (package.module:Class), 'simulator' or 'laying'.",
        ),
    ] = "simulator",
    layout: Annotated[
        str | None, typer.Option(metavar="SCRIPT", help="Layout of the simulated table; default: a shipped one.")
    ] = None,
    seed: Annotated[
        int | None, typer.Option(metavar="N", min=0, help="Seed of the simulated story; default: 0.")
    ] = None,
    camera: Annotated[
        str | None,
        typer.Option(
            metavar="still|sway|walk", help="With --from laying: movement of the person's camera; default: sway."
        ),
    ] = None,
    rate: Annotated[
        float | None,
        typer.Option(metavar="HZ", min=0.5, max=30, help="Frames per second of the simulator; default: 4."),
    ] = None,
    intrinsics: Annotated[Path | None, typer.Option(metavar="FILE", help="Camera of depth images (.json).")] = None,
    grows: Annotated[bool, typer.Option("--grows", help="Wait for further clouds in the folder.")] = False,
    words: Annotated[
        Path | None,
        typer.Option("--say", metavar="FILE", help="Utterances of persons (.said.jsonl), besides those of the story."),
    ] = None,
    live: Annotated[bool, typer.Option("--live", help="Play the story at its own speed, as a camera does.")] = False,
    stay: Annotated[bool, typer.Option("--stay", help="Listen after the story until the input ends.")] = False,
    story: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write key frames and a page with the story.")
    ] = None,
    experience: Annotated[
        str | None, typer.Option(metavar="NAME", help="Record the story as an experience of this name.")
    ] = None,
    processes: Annotated[bool, typer.Option("--processes", help="Run each module in a process of its own.")] = False,
    plain: Annotated[bool, typer.Option("--plain", help="Print lines, without the view of the table.")] = False,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Run the robot on a story until it ends, and print what it sees, hears, says and learns.

    In a terminal, type to talk to it: names, layouts and questions. The robot keeps what it learns in the memory, which
    the first line names.
    """
    from deixis.memory.on_demand import default_memory
    from deixis.plots.figure import require_picture
    from deixis.plots.live_story import OVERVIEW, write_story
    from deixis.robot.live.run import live_robot
    from deixis.robot.live.story import StorySettings

    settings = StorySettings(source, layout, seed, rate, _text(intrinsics), grows, _text(words), live, camera)
    settings.check()
    view = not (plain or as_json) and sys.stdout is not None and sys.stdout.isatty()
    if story is not None:
        require_picture(story / OVERVIEW)  # before the story, which happens once
    lines: deque[str] = deque(maxlen=SHOWN_LINES)
    events, progress = 0, None

    def report(line: str) -> None:
        nonlocal events
        events += 1
        lines.append(line)
        if progress is not None:
            progress(events, None)
        if not view and not as_json:
            print_line(line)

    place = memory or default_memory()
    with live_robot(place, settings, report, processes) as robot:
        if experience is not None:
            robot.record(experience)
        typing = threading.Thread(target=_listen, args=(robot, report), name="typed words", daemon=True)
        if sys.stdin is not None and sys.stdin.isatty():
            typing.start()
        waiting = progress_bar("following the story, events") if as_json else nullcontext()
        with _watched(robot, lines) if view else waiting as progress:
            robot.wait()
            if robot.problem is not None:
                raise LiveError(f"{robot.problem}; the story has ended")
            if experience is not None:
                robot.finish_recording(experience)
            if stay:
                if not typing.is_alive():
                    typing.start()  # a file or a pipe is read after the story
                typing.join()
                robot.answered()
        answer = {
            "memory": str(place),
            "layout": robot.layout(),
            "things": [
                {"id": thing.id, "name": thing.name, "probability": round(thing.probability, 4), "since": thing.since}
                for thing in robot.things()
            ],
            "faults": list(robot.faults()),
            "dropped": robot.dropped,
        }
        written = None
        if story is not None:
            with progress_bar("drawing the story, pictures") as drawn:
                written = write_story(robot, story, drawn)
    if as_json:
        print_json(answer)
        return
    for line in _summary(answer):
        print_line(line)
    print_written(written)


def _text(path: Path | None) -> str | None:
    return None if path is None else str(path)


def _listen(robot: LiveRobot, report: Callable[[str], None]) -> None:
    """Tell the robot each line that is typed, until the input ends or cannot be read."""
    try:
        for line in StandardInput().lines():
            if line.strip():
                try:
                    robot.says(line.strip())
                except DeixisError as error:
                    report(str(error))
    except DeixisError as error:
        report(str(error))


@contextmanager
def _watched(robot: LiveRobot, lines: Sequence[str]) -> Iterator[None]:
    """Show the table and the conversation in the terminal."""
    from rich.console import Group
    from rich.live import Live
    from rich.table import Table
    from rich.text import Text

    def picture() -> Group:
        table = Table(
            "thing", "name", "probability", "here since", title=f"table: {robot.layout() or 'unknown layout'}"
        )
        for thing in robot.things():
            probability = f"{thing.probability:.2f}" if thing.name else ""
            table.add_row(thing.id, thing.name or "?", probability, f"{thing.since:.1f} s")
        return Group(
            table, *(Text(f"wrong: {fault}", style="red") for fault in robot.faults()), *map(Text, list(lines))
        )

    with Live(get_renderable=picture, refresh_per_second=4):
        yield


def _summary(answer: Mapping[str, Any]) -> list[str]:
    """Return what the robot knows at the end, in lines."""
    lines = [f"Layout: {answer['layout'] or 'unknown'}"]
    for thing in answer["things"]:
        name = f"{thing['name']}  {thing['probability']:.2f}" if thing["name"] else "unknown"
        lines.append(f"{thing['id']:<6} {name}")
    lines += [f"Wrong: {fault}" for fault in answer["faults"]]
    return lines
