"""The command ``deixis fmt``: format a script."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.common import NO, AsJson, Script, print_json


def fmt(
    script: Script,
    write: Annotated[
        bool, typer.Option("--write", "-w", help="Write the result to the file instead of printing it.")
    ] = False,
    check: Annotated[bool, typer.Option("--check", help="Print nothing; exit 1 if the file would change.")] = False,
    as_json: AsJson = False,
) -> None:
    """Print a script in its canonical form, with its comments."""
    from deixis.errors import DeixisError
    from deixis.grammar.layout.format import format_script
    from deixis.grammar.layout.parser import read_layout
    from deixis.text_files import replace_text

    if write and check:
        raise DeixisError("fmt: --check and --write exclude each other")
    formatted = format_script(read_layout(script))
    same = formatted == Path(script).read_bytes().decode("utf-8-sig")
    if write and not same:
        replace_text(script, formatted)
    if as_json:
        print_json({"file": script, "canonical": same, "text": formatted})
    elif not check and not write:
        sys.stdout.write(formatted)
    if check and not same:
        raise typer.Exit(NO)
