"""The commands ``deixis activity ground``, ``learn``, ``recognise`` and ``predict``."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.answers import count
from deixis.cli.common import NO, AsJson, MemoryDir, TimeLimit, print_json, print_line, print_lines
from deixis.cli.progress import time_bar

if TYPE_CHECKING:
    from collections.abc import Iterator

    from deixis.memory.episodes.blackboard import Blackboard
    from deixis.reasoning.activities.activity import StepSequence

activity_app = typer.Typer(
    help="Ground, learn, recognise and predict activities: steps in the order of time.", no_args_is_help=True
)

Known = Annotated[Path, typer.Option("--known", metavar="FILE", help="File of learned activities (JSON).")]
Fluents = Annotated[
    Path | None, typer.Argument(metavar="[FILE]", help="Fluents (.fluents.json); without it, the episodes of --memory.")
]

Experience = Annotated[
    str | None,
    typer.Option("--experience", metavar="NAME", help="Experience of --memory, instead of all episodes."),
]


@activity_app.command("ground")
def ground(
    activity: Annotated[str, typer.Argument(metavar="TEXT", help="Such as 'first the plate, then the forks'.")],
    file: Fluents = None,
    time_limit: TimeLimit = 10.0,
    experience: Experience = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Match a described activity with fluents; exit 1 if a step is missing or in another order."""
    from deixis.report.reasoning.activities import grounded_lines, grounded_to_dict
    from deixis.workflows.reasoning.activities import ground as run

    sequence = _sequence(file, memory, experience)
    with time_bar("grounding", time_limit):
        found = run(activity, sequence, time_limit)
    if as_json:
        print_json(grounded_to_dict(found))
    else:
        print_lines(grounded_lines(found))
    if found.missing or found.swapped:
        raise typer.Exit(NO)


@activity_app.command("learn")
def learn(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the activity.")],
    files: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[FILE...]", help="Examples (.fluents.json); without them, experiences of --memory."),
    ] = None,
    known: Known = Path("activities.json"),
    experiences: Annotated[
        list[str] | None,
        typer.Option("--experience", metavar="NAME", help="Experience that is an example; default: all that finished."),
    ] = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Learn an activity from examples, and add it to a file of activities."""
    from deixis.workflows.reasoning.activities import learn as run
    from deixis.workflows.reasoning.activities import sequences_of_experiences

    if files:
        activity = run(name, files, known)
    else:
        with _episodes(memory) as board:
            activity = run(name, sequences_of_experiences(board, experiences or ()), known)
    if as_json:
        names = [str(step) for step in activity.steps]
        print_json({"activity": name, "examples": activity.examples, "steps": names, "known": str(known)})
        return
    steps = count(len(activity.steps), "step")
    print_line(f"Learned '{name}' from {count(activity.examples, 'example')}: {steps}; stored in {known}")


@activity_app.command("recognise")
def recognise(
    file: Fluents = None,
    known: Known = Path("activities.json"),
    time_limit: TimeLimit = 10.0,
    experience: Experience = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Find which of the known activities happened; exit 1 if none of them did."""
    from deixis.report.reasoning.activities import recognised_lines, recognised_to_dict
    from deixis.workflows.reasoning.activities import recognise as run

    sequence = _sequence(file, memory, experience)
    with time_bar("comparing", time_limit):
        found = run(sequence, known, time_limit)
    if as_json:
        print_json(recognised_to_dict(found))
    else:
        print_lines(recognised_lines(found))
    if found.name is None:
        raise typer.Exit(NO)


@activity_app.command("predict")
def predict(
    file: Fluents = None,
    known: Annotated[Path | None, typer.Option("--known", metavar="FILE", help="File of learned activities.")] = None,
    name: Annotated[str | None, typer.Option(metavar="NAME", help="Learned activity, where there are several.")] = None,
    told: Annotated[
        str | None, typer.Option(metavar="TEXT", help="Stated order: 'first the plate, then the forks'.")
    ] = None,
    experience: Experience = None,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Predict what is laid next and where; exit 1 if nothing more comes."""
    from deixis.report.reasoning.activities import predicted_lines, predicted_to_dict
    from deixis.workflows.reasoning.activities import predict as run

    found = run(_sequence(file, memory, experience), () if known is None else known, name, told)
    if as_json:
        print_json(predicted_to_dict(found))
    else:
        print_lines(predicted_lines(found))
    if not found.things or found.finished > found.things[0].probability:
        raise typer.Exit(NO)


def _sequence(file: Path | None, memory: Path | None, experience: str | None) -> StepSequence:
    """Return the sequence of a file, or of the episodes of a memory."""
    from deixis.workflows.reasoning.activities import sequence_of, sequence_of_episodes, sequences_of_experiences

    if file is not None:
        return sequence_of(file)
    with _episodes(memory) as board:
        return sequence_of_episodes(board) if experience is None else sequences_of_experiences(board, [experience])[0]


@contextmanager
def _episodes(memory: Path | None) -> Iterator[Blackboard]:
    """Open the episodes of a memory."""
    from deixis.memory.episodes.blackboard import Blackboard, has_episodes
    from deixis.memory.errors import MemoryFormatError
    from deixis.memory.on_demand import default_memory

    folder = memory or default_memory()
    if not has_episodes(folder):
        raise MemoryFormatError(f"the memory at {folder} has no episodes; name a file of fluents")
    with Blackboard.open(folder) as board:
        yield board
