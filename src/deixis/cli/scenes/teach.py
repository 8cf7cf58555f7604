"""The command ``deixis teach``: teach the robot what a word refers to, or correct it."""

from __future__ import annotations

from typing import Annotated

import typer

from deixis.cli.common import AsJson, MemoryDir, PerceivedScene, print_json, print_lines
from deixis.cli.completion import complete_categories
from deixis.cli.output import note_change
from deixis.cli.progress import progress_bar


def teach(
    scene: PerceivedScene,
    object: Annotated[str, typer.Argument(metavar="OBJECT", help="The id of a thing in the scene.")],
    label: Annotated[
        str,
        typer.Argument(metavar="LABEL", help="The name of its category.", autocompletion=complete_categories),
    ],
    teacher: Annotated[str, typer.Option(metavar="NAME", help="Name of the teacher.")] = "user",
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Teach one more view of a category; teaching the same view again corrects its category."""
    from deixis.report.scenes.seen import meant_lines, taught_line, taught_to_dict
    from deixis.session import Session
    from deixis.view_store import category_name

    with Session(memory) as session:
        with progress_bar("learning the view"):
            taught = session.teach(scene, object, label, teacher)
        note_change(session.path)
    if as_json:
        print_json(taught_to_dict(taught))
    else:
        print_lines([*meant_lines(category_name(label), taught.category), taught_line(taught, object)])
