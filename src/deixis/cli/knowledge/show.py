"""The command ``deixis show``: print a learned layout as a script, as SHACL shapes, or as an OWL class."""

from __future__ import annotations

import sys
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated, Any

import typer

from deixis.cli.common import (
    AsJson,
    MemoryDir,
    print_json,
)
from deixis.cli.completion import complete_layouts

if TYPE_CHECKING:
    from deixis.learning.layouts.concept import CountedConcept


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
    """Print a learned layout, with what its tables have in common and counts.

    A name stands for all tables of the layout: told facts that did not hold on all of them are hedged by their share,
    and what held on all of them is added. The id of a lesson stands for that lesson.
    """
    from deixis.session import Session

    with Session(memory) as session:
        if format is LayoutFormat.SCRIPT and not as_json:
            sys.stdout.write(session.show(layout))
            return
        found, text = session.concept(layout), session.show(layout)
        relations = session.ontology.relations
    if as_json:
        print_json(_to_json(found, text))
    else:
        from deixis.ontology.rdf.triples import turtle

        sys.stdout.write(turtle(found.shapes() if format is LayoutFormat.SHACL else found.owl(relations)))


def _to_json(found: CountedConcept, text: str) -> dict[str, Any]:
    from deixis.ontology.graph.export import fact_to_dict
    from deixis.ontology.graph.facts import Fact

    concept = found.layout
    counts = [
        {
            "statement": str(each.statement),
            "claim": not isinstance(each.statement, Fact),
            "told": each.told,
            "held": each.tally.held,
            "of": each.tally.of,
        }
        for each in found.statements
    ]
    return {
        "name": concept.name,
        "title": concept.title,
        "viewpoint": concept.viewpoint,
        "lesson": concept.lesson,
        "lessons": list(found.lessons),
        "facts": [fact_to_dict(fact) for fact in concept.facts],
        "counts": counts,
        "roles": [{"role": role, "present": tally.held, "of": tally.of} for role, tally in found.filled.items()],
        "text": text,
    }
