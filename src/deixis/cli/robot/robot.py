"""The command ``deixis robot run``: a robot that sees, is shown and told, and says what it found, while it happens."""

from __future__ import annotations

import sys
import threading
from collections import deque
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from deixis.cli.common import AsJson, MemoryDir, print_json, print_line

if TYPE_CHECKING:
    from deixis.robot.live.run import LiveRobot

SHOWN_LINES = 12
"""Number of lines of the conversation in the terminal view."""

robot_app = typer.Typer(help="Run the robot on one memory.", rich_markup_mode=None, no_args_is_help=True)


@robot_app.callback()
def _robot() -> None:
    """Run a robot that sees, is shown and told, and learns."""


@robot_app.command("run")
def run(
    source: Annotated[
        str, typer.Option("--from", metavar="SOURCE", help="A folder with clouds, or 'simulator'.")
    ] = "simulator",
    layout: Annotated[
        str | None, typer.Option(metavar="SCRIPT", help="How the simulated table is laid; default: a shipped one.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the simulated story.")] = 0,
    rate: Annotated[float, typer.Option(min=0.5, max=30, help="Frames a second of the simulator.")] = 4.0,
    intrinsics: Annotated[Path | None, typer.Option(metavar="FILE", help="Camera of depth images (.json).")] = None,
    grows: Annotated[bool, typer.Option("--grows", help="Wait for further clouds in the folder.")] = False,
    processes: Annotated[bool, typer.Option("--processes", help="Run each module in a process of its own.")] = False,
    plain: Annotated[bool, typer.Option("--plain", help="Print lines, without the view of the table.")] = False,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Run the robot on a story until it ends, and print what it sees, hears, says and learns.

    In a terminal, type to talk to it: names, layouts and questions.
    """
    from deixis.examples_data import example
    from deixis.memory.on_demand import default_memory
    from deixis.robot.live.run import LiveSettings, live_robot
    from deixis.robot.live.story import recorded_story

    if source != "simulator":
        recorded_story(source, intrinsics, grows)  # raises the error of a folder that cannot be used
    settings = LiveSettings(
        source if source == "simulator" else str(Path(source)),
        str(layout or example("tea.layout")),
        seed,
        rate,
        None if intrinsics is None else str(intrinsics),
        grows,
        processes,
    )
    view = not (plain or as_json) and sys.stdout.isatty()
    lines: deque[str] = deque(maxlen=SHOWN_LINES)

    def report(line: str) -> None:
        lines.append(line)
        if not view and not as_json:
            print_line(line)

    with live_robot(memory or default_memory(), settings, report) as robot:
        if sys.stdin.isatty():
            threading.Thread(target=_listen, args=(robot,), name="typed words", daemon=True).start()
        if view:
            _watch(robot, lines)
        else:
            robot.wait()
        answer = {
            "layout": robot.layout(),
            "things": [
                {"id": thing.id, "name": thing.name, "probability": round(thing.probability, 4), "since": thing.since}
                for thing in robot.things()
            ],
            "faults": list(robot.faults()),
        }
    if as_json:
        print_json(answer)
        return
    for line in _summary(answer):
        print_line(line)


def _listen(robot: LiveRobot) -> None:
    """Tell the robot each line that is typed."""
    for line in sys.stdin:
        if line.strip():
            robot.says(line.strip())


def _watch(robot: LiveRobot, lines: deque[str]) -> None:
    """Show the table and the conversation in the terminal until the story ends."""
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
        return Group(table, *(Text(f"wrong: {fault}", style="red") for fault in robot.faults()), *map(Text, lines))

    with Live(picture(), refresh_per_second=4) as live:
        while not robot.wait(0.25):
            live.update(picture())
        live.update(picture())


def _summary(answer: Mapping[str, Any]) -> list[str]:
    """Return what the robot knows at the end, in lines."""
    lines = [f"Layout: {answer['layout'] or 'unknown'}"]
    for thing in answer["things"]:
        name = f"{thing['name']}  {thing['probability']:.2f}" if thing["name"] else "unknown"
        lines.append(f"{thing['id']:<6} {name}")
    lines += [f"Wrong: {fault}" for fault in answer["faults"]]
    return lines
