"""Links from lessons to the views that they taught, with the category of each, and to what was said in the episodes.

The perceptual store's half is the lesson of each view; the episodes' half is the event of what was said. ``verify``
compares them. A view that a teacher names otherwise, or that is forgotten, no longer belongs to a lesson. Exports of a
semantic memory have no links, as they have no views and no episodes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple
from urllib.parse import unquote

import pyoxigraph as ox

from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.change import Change
from deixis.memory.semantic.rdf.graphs import (
    CATEGORY_OF_VIEW,
    EVENT_OF_LESSON,
    VIEWS,
    lesson_of_views,
    view_node,
    views_graph,
)
from deixis.ontology.rdf.triples import text


class Link(NamedTuple):
    """Link from a lesson to a view of a category."""

    lesson: str
    view: str
    category: str


def linking(lesson: str, views: Mapping[str, str], events: Sequence[str] = ()) -> Change:
    """Return the change that links a lesson to its views, and to what was said.

    Parameters
    ----------
    lesson
        Name of the lesson.
    views
        Categories of the views, by their ids.
    events
        Ids of the events in the episodes that taught it.

    Returns
    -------
    Change
        Change that leaves the canonical graphs as they are.
    """
    triples = [ox.Triple(view_node(view), CATEGORY_OF_VIEW, text(category)) for view, category in views.items()]
    triples += [ox.Triple(ledger.lesson_node(lesson), EVENT_OF_LESSON, text(event)) for event in events]
    return Change(operations=tuple(ledger.insertion(views_graph(lesson), triples)))


def unlinking(lesson: str) -> Change:
    """Return the change that removes the links of a lesson.

    Parameters
    ----------
    lesson
        Name of the lesson.

    Returns
    -------
    Change
        Change that leaves the canonical graphs as they are.
    """
    return Change(operations=(ledger.drop(views_graph(lesson)),))


def relinking(store: ox.Store, categories: Mapping[str, str | None]) -> Change:
    """Return the change that gives linked views other categories.

    Parameters
    ----------
    store
        Store before the change.
    categories
        New categories by the ids of the views; None removes the links of a view. Views without links are ignored.

    Returns
    -------
    Change
        Change that leaves the canonical graphs as they are.
    """
    operations: list[ledger.Operation] = []
    for view, category in categories.items():
        for quad in store.quads_for_pattern(view_node(view), CATEGORY_OF_VIEW, None, None):
            lesson = lesson_of_views(quad.graph_name)
            if lesson is None or getattr(quad.object, "value", None) == category:
                continue
            operations += ledger.deletion(views_graph(lesson), [quad.triple])
            if category is not None:
                triple = ox.Triple(view_node(view), CATEGORY_OF_VIEW, text(category))
                operations += ledger.insertion(views_graph(lesson), [triple])
    return Change(operations=tuple(operations))


def replacing(store: ox.Store, links: Mapping[str, Sequence[Link]]) -> Change:
    """Return the change that replaces all links of some views.

    Parameters
    ----------
    store
        Store before the change.
    links
        New links by the ids of the views; a view without links belongs to no lesson.

    Returns
    -------
    Change
        Change that leaves the canonical graphs as they are.
    """
    operations: list[ledger.Operation] = []
    for view, new in links.items():
        for quad in store.quads_for_pattern(view_node(view), CATEGORY_OF_VIEW, None, None):
            lesson = lesson_of_views(quad.graph_name)
            if lesson is not None:
                operations += ledger.deletion(views_graph(lesson), [quad.triple])
        for link in new:
            triple = ox.Triple(view_node(view), CATEGORY_OF_VIEW, text(link.category))
            operations += ledger.insertion(views_graph(link.lesson), [triple])
    return Change(operations=tuple(operations))


def links_of(store: ox.Store, lesson: str) -> tuple[Link, ...]:
    """Return the links of a lesson, in order.

    Parameters
    ----------
    store
        Store to read.
    lesson
        Name of the lesson.

    Returns
    -------
    tuple of Link
        Links in the order of the views' ids.
    """
    return tuple(sorted(_links(store.quads_for_pattern(None, CATEGORY_OF_VIEW, None, views_graph(lesson)))))


def lessons_with(store: ox.Store, view: str) -> tuple[str, ...]:
    """Return the lessons that taught a view, in order of their ids.

    Parameters
    ----------
    store
        Store to read.
    view
        Id of the view.

    Returns
    -------
    tuple of str
        Names of the lessons; empty for an unknown view.
    """
    found = _links(store.quads_for_pattern(view_node(view), CATEGORY_OF_VIEW, None, None))
    return tuple(sorted({link.lesson for link in found}))


def all_links(store: ox.Store) -> tuple[Link, ...]:
    """Return the links of all lessons, in order, for comparing the two stores.

    Parameters
    ----------
    store
        Store to read.

    Returns
    -------
    tuple of Link
        Links in the order of lessons, then of the views' ids.
    """
    return tuple(sorted(_links(store.quads_for_pattern(None, CATEGORY_OF_VIEW, None, None))))


def events_of_lessons(store: ox.Store) -> dict[str, tuple[str, ...]]:
    """Return the events in the episodes that taught lessons.

    Parameters
    ----------
    store
        Store to read.

    Returns
    -------
    dict
        Ids of the events by the name of the lesson, for lessons of sentences that the episodes have.
    """
    found: dict[str, list[str]] = {}
    for quad in store.quads_for_pattern(None, EVENT_OF_LESSON, None, None):
        lesson = lesson_of_views(quad.graph_name)
        if lesson is not None:
            found.setdefault(lesson, []).append(str(getattr(quad.object, "value", "")))
    return {lesson: tuple(sorted(found[lesson])) for lesson in sorted(found)}


def _links(quads: Iterator[ox.Quad]) -> Iterator[Link]:
    for quad in quads:
        lesson = lesson_of_views(quad.graph_name)
        if lesson is not None and isinstance(quad.subject, ox.NamedNode):
            view = unquote(quad.subject.value.removeprefix(VIEWS + "id/"))
            yield Link(lesson, view, str(getattr(quad.object, "value", "")))
