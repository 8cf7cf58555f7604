"""The command ``deixis show``: print a learned layout as a script, as SHACL shapes, or as an OWL class."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import Annotated

import typer

from deixis.cli.common import AsJson, MemoryDir, print_json
from deixis.cli.completion import complete_layouts


class LayoutFormat(StrEnum):
    """Formats of ``deixis show``."""

    SCRIPT = "script"
    SHACL = "shacl"
    OWL = "owl"


def show(
    layout: Annotated[
        str,
        typer.Argument(
            metavar="LAYOUT", help="A learned layout's name, or a lesson's id.", autocompletion=complete_layouts
        ),
    ],
    format: Annotated[
        LayoutFormat, typer.Option("--format", help="Script, or Turtle with the SHACL shapes or the OWL class.")
    ] = LayoutFormat.SCRIPT,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Print a learned layout: what its tables have in common, and on how many of them.

    A name stands for all tables of the layout: stated facts that did not hold on all of them are hedged by their share,
    and what held on all of them is added. The id of a lesson stands for that lesson.
    """
    from deixis.report.knowledge.concept import concept_to_dict
    from deixis.session import Session

    with Session(memory) as session:
        if format is LayoutFormat.SCRIPT and not as_json:
            sys.stdout.write(session.show(layout))
            return
        found, text = session.concept(layout), session.show(layout)
        relations = session.ontology.relations
    if as_json:
        print_json(concept_to_dict(found, text))
    else:
        from deixis.ontology.rdf.triples import turtle

        sys.stdout.write(turtle(found.shapes() if format is LayoutFormat.SHACL else found.owl(relations)))
