"""Learned layouts as plain data, lines of text and rows of a table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.grammar.layout.format import layout_script
from deixis.ontology.graph.export import fact_to_dict
from deixis.ontology.graph.facts import Fact
from deixis.ontology.tbox import default_ontology
from deixis.report.knowledge.rows import Row, facts_rows

if TYPE_CHECKING:
    from deixis.learning.layouts.concept import CountedConcept
    from deixis.ontology.lessons.types import LayoutConcept


def concept_to_dict(found: CountedConcept, text: str | None = None) -> dict[str, Any]:
    """Return a layout with the counts of its tables as plain data.

    Parameters
    ----------
    found
        The layout over all its tables.
    text
        The layout as a script; None makes it with the words of the shipped ontology.

    Returns
    -------
    dict
        Data for JSON, as ``deixis show --json`` prints it.
    """
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
        "text": found.script(default_ontology()) if text is None else text,
    }


def concept_lines(found: CountedConcept) -> list[str]:
    """Return the script of a layout, with comments on the counts of its tables.

    Parameters
    ----------
    found
        The layout over all its tables.

    Returns
    -------
    list of str
        The lines of the script, in the words of the shipped ontology.
    """
    return found.script(default_ontology()).splitlines()


def concept_rows(found: CountedConcept) -> Iterator[Row]:
    """Yield a row for each statement of a layout.

    Parameters
    ----------
    found
        The layout over all its tables.

    Yields
    ------
    dict
        ``statement``, ``told`` (False if it was only seen), and the number of tables on which it ``held``, ``of``
        those on which it could be compared.
    """
    for each in found.statements:
        yield {"statement": str(each.statement), "told": each.told, "held": each.tally.held, "of": each.tally.of}


def layout_to_dict(layout: LayoutConcept) -> dict[str, Any]:
    """Return the layout of one lesson as plain data.

    Parameters
    ----------
    layout
        The layout.

    Returns
    -------
    dict
        The data of :func:`concept_to_dict`, without counts.
    """
    from deixis.learning.layouts.concept import CountedConcept

    return concept_to_dict(CountedConcept(layout, (layout.lesson,), (), {}))


def layout_lines(layout: LayoutConcept) -> list[str]:
    """Return the script of the layout of one lesson.

    Parameters
    ----------
    layout
        The layout.

    Returns
    -------
    list of str
        The lines of the script, in the words of the shipped ontology.
    """
    return layout_script(layout, default_ontology()).splitlines()


def layout_rows(layout: LayoutConcept) -> Iterator[Row]:
    """Yield a row for each fact of the layout of one lesson.

    Parameters
    ----------
    layout
        The layout.

    Yields
    ------
    dict
        The fact, and its ``line`` in the script that taught it, counted from 1.
    """
    return facts_rows(layout.facts)
