"""The command ``deixis demo``: a tour of Deixis on the shipped data."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def demo(
    out: Annotated[
        Path, typer.Option("-o", "--out", metavar="DIR", help="Folder for the pictures and index.html.")
    ] = Path("out"),
) -> None:
    """Show every step on the shipped data, from a script to a recognised table."""
    from deixis.cli.robot.story import tell

    tell(out)
