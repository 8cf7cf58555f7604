"""The command ``deixis tell``: describe a layout or a scene in English."""

from __future__ import annotations

from typing import Annotated

import typer

from deixis.cli.common import NO, AsJson, HideLabels, Image, TimeLimit, note_unit, print_json, print_lines
from deixis.cli.progress import time_bar


def tell(
    source: Annotated[
        str, typer.Argument(metavar="LAYOUT|SCENE", help="A layout (.layout), a text (.txt), or a scene (.scene.json).")
    ],
    all_facts: Annotated[
        bool, typer.Option("--all", help="State every fact, even one that follows from the others.")
    ] = False,
    hide_labels: HideLabels = False,
    image: Image = None,
    time_limit: TimeLimit = 10.0,
    as_json: AsJson = False,
) -> None:
    """Describe a layout or a scene in English, in a few sentences.

    Exit 0 if the text, read again, gives the same facts, and singles out each object of a scene; 1 if not.
    """
    from deixis.workflows.descriptions.tell import holds_facts
    from deixis.workflows.descriptions.tell import tell as run
    from deixis.workflows.layouts.read import load_scene

    given = source if holds_facts(source) else load_scene(source, hide_labels, image)
    if not isinstance(given, str):
        note_unit(given)
    with time_bar("describing", time_limit, source=source):
        telling = run(given, all_facts=all_facts, time_limit=time_limit)
    if as_json:
        print_json(telling.to_dict())
    else:
        print_lines(telling.to_text().splitlines())
    if telling.misread or any(thing.found is False for thing in telling.objects):
        raise typer.Exit(NO)
