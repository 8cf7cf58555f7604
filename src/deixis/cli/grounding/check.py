"""The command ``deixis check``: compare a table with a layout."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.common import (
    NO,
    UNDECIDED,
    AsJson,
    HideLabels,
    Image,
    MemoryDir,
    NoMemory,
    SceneFile,
    TimeLimit,
    print_json,
    print_lines,
    print_written,
    require_plot,
    require_writable,
    tell_of_compiling,
)
from deixis.cli.completion import complete_layouts
from deixis.cli.progress import progress_bar, time_bar


def check(
    layout: Annotated[
        str,
        typer.Argument(metavar="LAYOUT", help="A learned layout's name, or a script.", autocompletion=complete_layouts),
    ],
    scene: SceneFile,
    report: Annotated[Path | None, typer.Option(metavar="FILE", help="Write the SHACL report (Turtle).")] = None,
    turtle: Annotated[bool, typer.Option("--turtle", help="Print the SHACL report (Turtle).")] = False,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the table with its errors.")] = None,
    time_limit: TimeLimit = 10.0,
    hide_labels: HideLabels = False,
    image: Image = None,
    memory: MemoryDir = None,
    no_memory: NoMemory = False,
    as_json: AsJson = False,
) -> None:
    """Print what is missing, misplaced, miscoloured and extra on a table; exit 1 if anything is."""
    from deixis.report.json_answers import check_to_dict
    from deixis.report.layouts.script import check_lines
    from deixis.session import Session
    from deixis.text_files import replace_text
    from deixis.workflows.grounding.check import check as run
    from deixis.workflows.layouts.read import load_scene

    require_plot(plot)
    require_writable([report, plot], [layout, scene])
    seen = load_scene(scene, hide_labels, image)
    tell_of_compiling()
    with Session(memory) as session, time_bar("grounding", time_limit):
        checked = run(layout, seen, time_limit, None if no_memory else session.knowledge_store)
    if report is not None:
        replace_text(report, checked.report)
    if plot is not None:
        from deixis.plots.check import plot_check

        with progress_bar("drawing"):
            plot_check(checked, plot)
    if turtle:
        sys.stdout.write(checked.report)
    elif as_json:
        print_json(check_to_dict(checked))
    else:
        print_lines(check_lines(checked))
        print_written(report, plot)
    if not checked.table.grounding.proved_best:
        raise typer.Exit(UNDECIDED)
    if not checked.table.well:
        raise typer.Exit(NO)
