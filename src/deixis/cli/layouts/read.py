"""The command ``deixis read``: print what each sentence of an English text states."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import Annotated

import typer

from deixis.cli.common import AsJson, TimeLimit, print_json, print_lines
from deixis.cli.progress import time_bar


class ReadFormat(StrEnum):
    """Formats of ``deixis read``."""

    TEXT = "text"
    JSON = "json"
    LAYOUT = "layout"


def read(
    text: Annotated[str, typer.Argument(metavar="TEXT", help="An English text (.txt), or - for standard input.")],
    format: Annotated[ReadFormat, typer.Option("--format", help="Format of the output.")] = ReadFormat.TEXT,
    strict: Annotated[bool, typer.Option("--strict", help="Refuse a text that is not understood completely.")] = False,
    time_limit: TimeLimit = 10.0,
    as_json: AsJson = False,
) -> None:
    """Print each sentence of an English text with its facts and a paraphrase."""
    from deixis.grammar.errors import ScriptTimeError
    from deixis.report.layouts.read import reading_lines
    from deixis.workflows.layouts.read_english import ReadText
    from deixis.workflows.layouts.read_english import read as read_text

    late: ScriptTimeError | None = None
    with time_bar("reading", time_limit, source=text):
        try:
            found = read_text(text, strict=strict, time_limit=time_limit)
        except ScriptTimeError as error:
            if error.read is None or error.read.reading is None or strict:
                raise
            late, found = error, ReadText(error.read, error.read.reading)
    if as_json or format is ReadFormat.JSON:
        print_json(found.to_dict())
    elif format is ReadFormat.LAYOUT:
        from deixis.grammar.layout.format import format_script

        sys.stdout.write(format_script(found.script))
    else:
        print_lines(reading_lines(found.script))
    if late is not None:
        raise late
