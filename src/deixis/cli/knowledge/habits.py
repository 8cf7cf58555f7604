"""The command ``deixis habits``: rules about where a person puts things, and where other things go."""

from __future__ import annotations

from typing import Annotated

import typer

from deixis.cli.common import AsJson, TimeLimit, print_json, print_lines
from deixis.cli.progress import time_bar


def habits(
    file: Annotated[str, typer.Argument(metavar="FILE", help="Lines 'thing: place', or 'every soft toy: shelf'.")],
    things: Annotated[list[str] | None, typer.Argument(metavar="[THING]...", help="Things to place.")] = None,
    time_limit: TimeLimit = 10.0,
    as_json: AsJson = False,
) -> None:
    """Learn rules from examples of where a person puts things, and predict where other things go."""
    from deixis.report.knowledge.habits import habits_lines, habits_to_dict
    from deixis.workflows.knowledge.habits import habits as run

    with time_bar("finding the rules", time_limit, source=file):
        found = run(file, things or [], time_limit=time_limit)
    if as_json:
        print_json(habits_to_dict(found))
    else:
        print_lines(habits_lines(found))
