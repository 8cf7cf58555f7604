"""The command ``deixis show``: print a learned layout as a script."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from deixis.cli.common import (
    AsJson,
    MemoryDir,
    print_json,
)
from deixis.cli.completion import complete_layouts


def show(
    layout: Annotated[
        str,
        typer.Argument(
            metavar="LAYOUT", help="A learned layout's name, or a lesson's id.", autocompletion=complete_layouts
        ),
    ],
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Print a learned layout as a script."""
    from deixis.ontology.export import fact_to_dict
    from deixis.session import Session

    with Session(memory) as session:
        concept, text = session.layout(layout), session.show(layout)
    if as_json:
        facts = [fact_to_dict(fact) for fact in concept.facts]
        head = {"name": concept.name, "title": concept.title, "viewpoint": concept.viewpoint, "lesson": concept.lesson}
        print_json({**head, "facts": facts, "text": text})
    else:
        sys.stdout.write(text)
