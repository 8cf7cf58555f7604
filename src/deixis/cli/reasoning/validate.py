"""The command ``deixis validate``: check RDF against SHACL shapes."""

from __future__ import annotations

import sys
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.common import NO, UNDECIDED, AsJson, MemoryDir, TimeLimit, print_json, print_line
from deixis.cli.progress import time_bar
from deixis.report.marks import violation


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
    from deixis.reasoning.errors import LimitError
    from deixis.workflows.reasoning.validate import validate_files, validate_memory

    if turtle and as_json:
        raise DeixisError("validate: --turtle and --json exclude each other")
    if files and memory is not None:
        raise DeixisError("validate: give files or --memory, not both")
    try:
        if files:
            with time_bar("checking the shapes", time_limit):
                report = validate_files(files, shapes or (), time_limit)
        else:
            from deixis.session import Session

            with Session(memory) as session, time_bar("checking the shapes", time_limit):
                report = validate_memory(session.memory(), shapes or (), time_limit)
    except LimitError as error:
        print(f"deixis: {error}", file=sys.stderr)
        raise typer.Exit(UNDECIDED) from None
    if as_json:
        print_json({"conforms": report.conforms, "results": [asdict(result) for result in report.results]})
    elif turtle:
        sys.stdout.write(report.turtle)
    else:
        for result in report.results:
            print_line(violation(f"{result.severity}: {result}"))
        number = len(report.results)
        print("conforms" if report.conforms else f"{number} result{'s' if number > 1 else ''}: does not conform")
    raise typer.Exit(0 if report.conforms else NO)
