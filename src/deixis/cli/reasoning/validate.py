"""The command ``deixis validate``: check RDF against SHACL shapes."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.common import NO, UNDECIDED, AsJson, MemoryDir, TimeLimit, print_json, print_lines
from deixis.cli.progress import time_bar


def validate(
    files: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[FILE]...", help="Data (.ttl, .nt, .rdf, .owl); default: the memory."),
    ] = None,
    shapes: Annotated[
        list[Path] | None,
        typer.Option("--shapes", metavar="FILE", help="SHACL shapes, instead of those of Deixis."),
    ] = None,
    turtle: Annotated[bool, typer.Option("--turtle", help="Print the standard report as Turtle.")] = False,
    time_limit: TimeLimit = 60.0,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Check data against SHACL shapes; print the violations and exit 1 if there are any."""
    from deixis.errors import DeixisError
    from deixis.memory.semantic.rdf.package import SHAPES_FILE
    from deixis.reasoning.errors import LimitError
    from deixis.report.reasoning.validate import shapes_lines
    from deixis.workflows.reasoning.validate import validate as validated

    if turtle and as_json:
        raise DeixisError("validate: --turtle and --json exclude each other")
    if files and memory is not None:
        raise DeixisError("validate: give files or --memory, not both")
    chosen = shapes or SHAPES_FILE
    try:
        if files:
            with time_bar("checking the shapes", time_limit):
                report = validated(files, chosen, time_limit)
        else:
            from deixis.session import Session

            with Session(memory) as session, time_bar("checking the shapes", time_limit):
                report = validated(session.memory(), chosen, time_limit)
    except LimitError as error:
        print(f"deixis: {error}", file=sys.stderr)
        raise typer.Exit(UNDECIDED) from None
    if as_json:
        print_json(report.to_dict())
    elif turtle:
        sys.stdout.write(report.turtle)
    else:
        print_lines(shapes_lines(report))
    raise typer.Exit(0 if report.conforms else NO)
