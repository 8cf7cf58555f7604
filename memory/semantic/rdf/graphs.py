"""Named graphs of a memory, and the copies that record which lesson contributed what.

The six canonical graphs are the content. For each lesson and graph there is also a copy of what the lesson contributed,
and likewise for the packaged ontology and shapes: a triple is removed when no copy has it. Triples loaded in
bulk belong to no lesson and are in the canonical graph only; if a lesson contributes such a triple too, a copy under
``loaded`` keeps it when the lesson is removed. Learned models, which all lessons teach together, have copies of their
own under ``models``, and are replaced as a whole. The counts that they are learned from are under ``statistics``: once
for all lessons, and a share for each. They follow from the lessons: queries and exports leave them out. The same holds
for ``views``, which has the views that each lesson taught (see :mod:`deixis.memory.semantic.rdf.links`), and ``order``,
which numbers the lessons as they are learned (see :mod:`deixis.memory.semantic.rdf.ledger`).
"""

from __future__ import annotations

from enum import StrEnum
from urllib.parse import unquote

import pyoxigraph as ox

from deixis.ontology.rdf.triples import iri_part

GRAPHS = "https://w3id.org/deixis/graph/"
LESSONS = GRAPHS + "lesson/"
PACKAGE = GRAPHS + "package/"
LOADED = GRAPHS + "loaded/"
MODELS = GRAPHS + "models/"
STATISTICS = GRAPHS + "statistics/"
VIEWS = GRAPHS + "views/"


class GraphName(StrEnum):
    """The six canonical graphs.

    >>> graph_iri(GraphName.LEARNED)
    <NamedNode value=https://w3id.org/deixis/graph/learned>
    """

    ONTOLOGY = "ontology"
    SHAPES = "shapes"
    ASSERTED = "asserted"
    INFERRED = "inferred"
    LEARNED = "learned"
    EPISODES = "episodes"


class ModelSet(StrEnum):
    """Models that all lessons teach together: the meaning of relation words, and the sizes of kinds of things."""

    WORDS = "words"
    SIZES = "sizes"


CONTRIBUTED = tuple(name for name in GraphName if name is not GraphName.INFERRED)
"""Graphs that lessons contribute to; the inferred graph is always replaced as a whole."""

UNION = (GraphName.ONTOLOGY, GraphName.ASSERTED, GraphName.INFERRED, GraphName.LEARNED)
"""Graphs that a query without GRAPH reads: what is known, and the vocabulary that it is stated in."""

MERGED = ox.NamedNode(GRAPHS + "merged")
"""Union of these graphs, stored as a graph where they overlap: see :mod:`deixis.memory.semantic.queries.union`."""


def graph_iri(name: GraphName) -> ox.NamedNode:
    """Return the IRI of a canonical graph.

    Parameters
    ----------
    name
        Canonical graph.

    Returns
    -------
    NamedNode
        IRI of the graph.
    """
    return ox.NamedNode(GRAPHS + name)


CANONICAL = {graph_iri(name): name for name in GraphName}
"""Canonical graph by IRI."""


def lesson_graph(lesson: str, name: GraphName) -> ox.NamedNode:
    """Return the graph with the contributions of one lesson to a canonical graph.

    Parameters
    ----------
    lesson
        Name of the lesson, in any characters.
    name
        Canonical graph that the lesson contributes to.

    Returns
    -------
    NamedNode
        IRI of the copy.

    Examples
    --------
    >>> lesson_graph("set 1", GraphName.LEARNED).value
    'https://w3id.org/deixis/graph/lesson/set%201/learned'
    """
    return ox.NamedNode(f"{LESSONS}{iri_part(lesson)}/{name}")


def package_graph(name: GraphName) -> ox.NamedNode:
    """Return the graph with the contributions of the package: the ontology and the shapes.

    Parameters
    ----------
    name
        Canonical graph that the package contributes to.

    Returns
    -------
    NamedNode
        IRI of the copy.
    """
    return ox.NamedNode(PACKAGE + name)


def loaded_graph(name: GraphName) -> ox.NamedNode:
    """Return the graph of the triples that were loaded in bulk and also come from a lesson.

    Parameters
    ----------
    name
        Canonical graph that the triples are in.

    Returns
    -------
    NamedNode
        IRI of the copy.
    """
    return ox.NamedNode(LOADED + name)


def models_graph(models: ModelSet) -> ox.NamedNode:
    """Return the graph with the copy of a set of models in the learned graph.

    Parameters
    ----------
    models
        Set of models.

    Returns
    -------
    NamedNode
        IRI of the copy.

    Examples
    --------
    >>> models_graph(ModelSet.SIZES).value
    'https://w3id.org/deixis/graph/models/sizes'
    """
    return ox.NamedNode(MODELS + models)


def models_of_graph(iri: str) -> ModelSet | None:
    """Return the set of models that the IRI of a copy names, or None for another IRI.

    Parameters
    ----------
    iri
        IRI of any graph.

    Returns
    -------
    ModelSet or None
        The set of models.
    """
    name = iri.removeprefix(MODELS)
    return ModelSet(name) if iri.startswith(MODELS) and name in list(ModelSet) else None


def lesson_of_graph(iri: str) -> tuple[str, GraphName] | None:
    """Return the lesson and the graph that the IRI of a copy names, or None for another IRI.

    Parameters
    ----------
    iri
        IRI of any graph.

    Returns
    -------
    tuple or None
        Name of the lesson, and the canonical graph that it contributes to.

    Examples
    --------
    >>> lesson_of_graph("https://w3id.org/deixis/graph/lesson/set%201/learned")
    ('set 1', <GraphName.LEARNED: 'learned'>)
    >>> lesson_of_graph("https://w3id.org/deixis/graph/lesson/set 1/learned/x") is None
    True
    """
    if not iri.startswith(LESSONS):
        return None
    lesson, slash, name = iri.removeprefix(LESSONS).partition("/")
    if not lesson or not slash or name not in CONTRIBUTED:
        return None
    return unquote(lesson), GraphName(name)


FLUENTS, NOW = ox.NamedNode(GRAPHS + "fluents"), ox.NamedNode(GRAPHS + "now")
"""Graphs of the blackboard: descriptions of all fluents, and the statements that hold now; copies of its log."""

READABLE = (*CANONICAL, FLUENTS, NOW)
"""Graphs that a query can name."""

COUNTED = ox.NamedNode(STATISTICS + "counted")
"""Graph of the counts of all lessons together."""

KEPT_UP = ox.NamedNode(STATISTICS + "kept-up")
"""Predicate for the rules by which the statistics and the inferred graph are up to date, said about :data:`COUNTED`."""


def share_graph(lesson: str) -> ox.NamedNode:
    """Return the graph with the share of one lesson in the statistics.

    Parameters
    ----------
    lesson
        Name of the lesson, in any characters.

    Returns
    -------
    NamedNode
        IRI of the graph.
    """
    return ox.NamedNode(f"{STATISTICS}lesson/{iri_part(lesson)}")


ORDER = ox.NamedNode(GRAPHS + "order")
"""Graph that numbers the lessons in the order in which they were learned, independent of the clock."""

NUMBER, NEXT = ox.NamedNode(GRAPHS + "order/number"), ox.NamedNode(GRAPHS + "order/next")
"""Predicate for the number of a lesson; for :data:`ORDER` itself, the number of the next lesson."""


CATEGORY_OF_VIEW = ox.NamedNode(VIEWS + "category")
"""Predicate for the category of a view, in the graph of a lesson that taught it."""

EVENT_OF_LESSON = ox.NamedNode(VIEWS + "event")
"""Predicate for the event in the episodes that taught a lesson, in the graph of its views."""


def views_graph(lesson: str) -> ox.NamedNode:
    """Return the graph of the views that a lesson taught, and of the event that taught it.

    Parameters
    ----------
    lesson
        Name of the lesson, in any characters.

    Returns
    -------
    NamedNode
        IRI of the graph.
    """
    return ox.NamedNode(f"{VIEWS}lesson/{iri_part(lesson)}")


def lesson_of_views(graph: object) -> str | None:
    """Return the lesson whose views a graph has, or None for another graph.

    Parameters
    ----------
    graph
        Name of any graph; the default graph is another one.

    Returns
    -------
    str or None
        Name of the lesson.

    Examples
    --------
    >>> lesson_of_views(views_graph("set 1"))
    'set 1'
    """
    name = graph.value if isinstance(graph, ox.NamedNode) else ""
    return unquote(name.removeprefix(f"{VIEWS}lesson/")) if name.startswith(f"{VIEWS}lesson/") else None


def view_node(id: str) -> ox.NamedNode:
    """Return the IRI of a view of the perceptual store.

    Parameters
    ----------
    id
        Id of the view, in any characters.

    Returns
    -------
    NamedNode
        IRI of the view.
    """
    return ox.NamedNode(f"{VIEWS}id/{iri_part(id)}")


def copied_graph(iri: str) -> GraphName | None:
    """Return the canonical graph that a copy contributes to, or None for another graph.

    A copy is that of a lesson, of models, of the package, or of loaded triples.

    Parameters
    ----------
    iri
        IRI of any graph.

    Returns
    -------
    GraphName or None
        The canonical graph.
    """
    found = lesson_of_graph(iri)
    if found:
        return found[1]
    if models_of_graph(iri):
        return GraphName.LEARNED
    for base in (PACKAGE, LOADED):
        name = iri.removeprefix(base)
        if iri.startswith(base) and name in CONTRIBUTED:
            return GraphName(name)
    return None
