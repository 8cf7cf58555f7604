"""The command ``deixis recall``: questions about then and now, answered from the episodes of the memory."""

from __future__ import annotations

from typing import Annotated

import typer

from deixis.cli.common import NO, AsJson, MemoryDir, print_json, print_line, print_lines
from deixis.cli.progress import progress_bar


def recall(
    question: Annotated[str, typer.Argument(metavar="QUESTION", help="Such as 'where was the fork before?'.")],
    at: Annotated[
        str | None, typer.Option(metavar="TIME", help="Time of asking, such as 2026-11-23T12:30; default: now.")
    ] = None,
    speaker: Annotated[str | None, typer.Option(metavar="NAME", help="The person who says 'I'.")] = None,
    sparql: Annotated[bool, typer.Option("--sparql", help="Print the query that finds the same fluents.")] = False,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Answer a question about then and now; if it is not known, print the reason and exit 1."""
    from deixis.report.knowledge.recall import recall_lines, recall_to_dict
    from deixis.session import Session
    from deixis.workflows.knowledge.recall import moment_of

    asked = None if at is None else moment_of(at)
    with Session(memory) as session, progress_bar("reading the episodes"):
        found = session.recall(question, asked, speaker)
    if as_json:
        print_json(recall_to_dict(found))
    elif sparql and found.search is not None:
        for line in found.search.sparql().splitlines():
            print_line(line)
    else:
        print_lines(recall_lines(found))
    if not found.known:
        raise typer.Exit(NO)
