"""The command ``deixis lint``: print warnings about a script."""

from __future__ import annotations

from typing import Annotated

import typer

from deixis.cli.common import NO, UNDECIDED, AsJson, Script, TimeLimit, print_json, print_lines
from deixis.cli.progress import time_bar


def lint(
    script: Script,
    select: Annotated[
        str, typer.Option(metavar="CODES", help="Report only warnings with these codes: F, or N001,N003.")
    ] = "",
    ignore: Annotated[str, typer.Option(metavar="CODES", help="Omit warnings with these codes.")] = "",
    time_limit: TimeLimit = 5.0,
    as_json: AsJson = False,
) -> None:
    """Print warnings with codes about a script: misspellings, needless facts, contradictions (exit 1)."""
    from deixis.report.layouts.lint import lint_lines, lint_to_dict
    from deixis.workflows.layouts.lint import lint as run

    chosen, left_out = ([code.strip() for code in codes.split(",") if code.strip()] for codes in (select, ignore))
    with time_bar("checking the script", time_limit, source=script):
        found = run(script, select=chosen, ignore=left_out, time_limit=time_limit)
    if as_json:
        print_json(lint_to_dict(found))
    else:
        print_lines(lint_lines(found))
    if found.findings:
        raise typer.Exit(NO)
    if not found.complete:
        raise typer.Exit(UNDECIDED)
