"""The command ``deixis unlearn``: take back what a lesson, a sentence, a label, a table, a teacher or a day taught."""

from __future__ import annotations

from typing import Annotated

import typer

from deixis.cli.common import NO, AsJson, MemoryDir, print_json, print_lines, require_memory
from deixis.cli.completion import complete_categories, complete_lessons
from deixis.cli.output import note_change
from deixis.cli.progress import progress_bar


def unlearn(
    lesson: Annotated[
        str | None,
        typer.Option(metavar="ID", help="Take back what one lesson taught.", autocompletion=complete_lessons),
    ] = None,
    sentence: Annotated[
        str | None, typer.Option(metavar="TEXT", help="Take back what lessons with this text taught.")
    ] = None,
    label: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="Take back views that 'teach' gave this name.", autocompletion=complete_categories
        ),
    ] = None,
    view: Annotated[
        str | None, typer.Option(metavar="ID", help="Take back what 'teach' stated about one view.")
    ] = None,
    table: Annotated[
        str | None, typer.Option(metavar="SCENE", help="Take back what was taught with this scene.")
    ] = None,
    teacher: Annotated[str | None, typer.Option(metavar="NAME", help="Take back what this person taught.")] = None,
    day: Annotated[
        str | None,
        typer.Option(metavar="DATE", help="Take back what was taught on a day: 2026-11-23, today or yesterday."),
    ] = None,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Print what would be removed; change nothing.")] = False,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Take back what matches all given options, and all that came only from it; exit 1 if nothing matches."""
    from deixis.memory.episodes.blackboard import has_episodes
    from deixis.memory.on_demand import default_memory
    from deixis.report.knowledge.unlearn import unlearned_lines
    from deixis.session import Session
    from deixis.workflows.knowledge.unlearn import Selection, span_of_day

    since, until = (None, None) if day is None else span_of_day(day)
    selection = Selection(lesson, sentence, label, view, table, teacher, since, until)
    if not has_episodes(memory or default_memory()):
        require_memory(memory)
    with Session(memory) as session:
        with progress_bar("taking back what was taught") as progress:
            found = session.unlearn(selection, dry_run, progress)
        if found and not dry_run:
            note_change(session.path)
    if as_json:
        print_json(found.to_dict())
    else:
        print_lines(unlearned_lines(found))
    if not found:
        raise typer.Exit(NO)
