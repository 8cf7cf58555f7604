"""The command ``deixis parse``: print the facts of a script with their lines."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import Annotated

import typer

from deixis.cli.common import AsJson, Script, print_json, print_lines


class GraphFormat(StrEnum):
    """Formats of ``deixis parse``."""

    TEXT = "text"
    JSON = "json"
    TURTLE = "turtle"
    DOT = "dot"


def parse(
    script: Script,
    format: Annotated[GraphFormat, typer.Option("--format", help="Format of the output.")] = GraphFormat.TEXT,
    as_json: AsJson = False,
) -> None:
    """Print the facts of a script with their lines."""
    from deixis.grammar.read import read_script_file

    parsed = read_script_file(script)
    if as_json or format is GraphFormat.JSON:
        from deixis.report.json_answers import script_to_dict

        print_json(script_to_dict(parsed))
    elif format is GraphFormat.TEXT:
        from deixis.report.layouts.script import script_lines

        print_lines(script_lines(parsed))
    else:
        from deixis.ontology.graph.export import graph_to_dot, graph_to_turtle

        written = graph_to_turtle if format is GraphFormat.TURTLE else graph_to_dot
        sys.stdout.write(written(parsed.graph()))
