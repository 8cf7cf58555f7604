"""The command ``deixis teach``: show what a word looks like, or correct it."""

from __future__ import annotations

from typing import Annotated

import typer

from deixis.cli.common import AsJson, MemoryDir, PerceivedScene, print_json, print_lines
from deixis.cli.output import note_change


def teach(
    scene: PerceivedScene,
    object: Annotated[str, typer.Argument(metavar="OBJECT", help="The id of a thing in the scene.")],
    label: Annotated[str, typer.Argument(metavar="LABEL", help="What it is.")],
    teacher: Annotated[str, typer.Option(metavar="NAME", help="Who says so.")] = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Show what a word looks like: one view more of a category; said again of the same view, a correction."""
    from deixis.report.seen import meant_lines, taught_line
    from deixis.session import Session
    from deixis.view_store import category_name

    with Session(memory) as session:
        taught = session.teach(scene, object, label, teacher)
        note_change(session.path)
    if as_json:
        print_json({"view": taught.view, "category": taught.category, "views": taught.views, "before": taught.before})
    else:
        print_lines([*meant_lines(category_name(label), taught.category), taught_line(taught, object)])
