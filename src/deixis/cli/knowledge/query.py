"""The command ``deixis query``: run SPARQL over the memory."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.common import (
    NO,
    AsJson,
    MemoryDir,
    TimeLimit,
    print_lines,
    print_note,
)
from deixis.cli.progress import time_bar
from deixis.memory.semantic.queries.limits import QUERY_MEMORY_LIMIT, QUERY_TIME_LIMIT


class TableFormat(StrEnum):
    """Formats of ``deixis query``."""

    TABLE = "table"
    JSON = "json"
    CSV = "csv"
    TURTLE = "turtle"


def query(
    sparql: Annotated[str | None, typer.Argument(metavar="SPARQL", help="SELECT, ASK, CONSTRUCT or DESCRIBE.")] = None,
    file: Annotated[
        Path | None, typer.Option("-f", "--file", metavar="FILE", help="Read the query from a file.")
    ] = None,
    format: Annotated[TableFormat, typer.Option("--format", help="Format of the output.")] = TableFormat.TABLE,
    time_limit: TimeLimit = QUERY_TIME_LIMIT,
    memory_limit: Annotated[
        int, typer.Option(min=1, metavar="MIB", help="Stop a query that needs more memory, in MiB.")
    ] = QUERY_MEMORY_LIMIT // 2**20,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Run a SPARQL query over the memory; if it reaches a limit, exit 3 and print no rows."""
    from deixis.errors import DeixisError
    from deixis.session import Session
    from deixis.text_files import read_text

    if (sparql is None) == (file is None):
        raise DeixisError("query: give either a query or a file with -f")
    with Session(memory) as session:
        text = read_text(file) if file is not None else sparql or ""
        with time_bar("querying", time_limit):
            result = session.query(text, time_limit, memory_limit * 2**20)
        if as_json or format is TableFormat.JSON:
            sys.stdout.writelines(result.json_parts())
            sys.stdout.write("\n")
        elif format is TableFormat.CSV:
            sys.stdout.write(result.to_csv())
        elif format is TableFormat.TURTLE:
            sys.stdout.write(result.to_turtle())
        else:
            print_lines(result.to_table())
        for remark in result.remarks():
            print_note(remark)
        if result.boolean is False:
            raise typer.Exit(NO)
