"""The command ``deixis demo``: the whole story on shipped data."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def demo(
    out: Annotated[Path, typer.Option("-o", "--out", metavar="DIR", help="Where the pictures go.")] = Path("out"),
) -> None:
    """Tell the whole story on shipped data."""
    from deixis.cli.story import tell

    tell(out)
