"""The command ``deixis read``: print what each sentence of an English text states."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import Annotated

import typer

from deixis.cli.common import AsJson, TimeLimit, deadline_of, print_json, print_lines
from deixis.cli.progress import time_bar


class ReadFormat(StrEnum):
    """Formats of ``deixis read``."""

    TEXT = "text"
    JSON = "json"
    LAYOUT = "layout"


def read(
    text: Annotated[str, typer.Argument(metavar="TEXT", help="An English text (.txt), or - for standard input.")],
    format: Annotated[ReadFormat, typer.Option("--format", help="Format of the output.")] = ReadFormat.TEXT,
    strict: Annotated[bool, typer.Option("--strict", help="Refuse a text that is not understood whole.")] = False,
    time_limit: TimeLimit = 10.0,
    as_json: AsJson = False,
) -> None:
    """Print each sentence of an English text with its facts and a paraphrase."""
    from deixis.report.layouts.read import reading_lines, reading_to_dict
    from deixis.workflows.layouts.read import read_english_file

    with time_bar("reading", time_limit, source=text):
        script = read_english_file(text, deadline_of(time_limit), strict)
    if as_json or format is ReadFormat.JSON:
        print_json(reading_to_dict(script))
    elif format is ReadFormat.LAYOUT:
        from deixis.grammar.layout.format import format_script

        sys.stdout.write(format_script(script))
    else:
        print_lines(reading_lines(script))
