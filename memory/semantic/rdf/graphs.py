"""The named graphs of a memory, and the copies that say which lesson contributed what.

The six canonical graphs are what is known. Beside them stands, for every lesson and graph, a copy of what that lesson
contributed, and for the packaged ontology and shapes likewise: a triple may go when nobody's copy holds it any more.
What was loaded in bulk belongs to no lesson and stands in the canonical graph alone; of a triple that a lesson
contributes too, a copy under ``loaded`` says that it stays when the lesson goes. Learned models, which all lessons
teach together, have copies of their own under ``models``, and are replaced as a whole. What they are learned from,
counted, stands under ``statistics``: once for all lessons, and a share for each. It follows from the lessons: no query
looks at it, and no export has it. Nor do they have ``views``, which says what views each lesson taught (see
:mod:`deixis.memory.semantic.rdf.links`), and ``order``, in which the lessons are numbered as they come (see
:mod:`deixis.memory.semantic.rdf.ledger`).
"""

from __future__ import annotations

from enum import StrEnum
from urllib.parse import quote, unquote

import pyoxigraph as ox

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
    """What all lessons together teach: the meaning of relation words, and the sizes of kinds of things."""

    WORDS = "words"
    SIZES = "sizes"


CONTRIBUTED = tuple(name for name in GraphName if name is not GraphName.INFERRED)
"""The graphs that lessons contribute to; the inferred one is always replaced as a whole."""

UNION = (GraphName.ONTOLOGY, GraphName.ASSERTED, GraphName.INFERRED, GraphName.LEARNED)
"""The graphs that a query without GRAPH looks at: what is known, and the terms in which it is said."""

MERGED = ox.NamedNode(GRAPHS + "merged")
"""Their union as a graph of its own, kept where they overlap: see :mod:`deixis.memory.semantic.queries.union`."""


def graph_iri(name: GraphName) -> ox.NamedNode:
    """Return the IRI of a canonical graph."""
    return ox.NamedNode(GRAPHS + name)


CANONICAL = {graph_iri(name): name for name in GraphName}
"""From IRI to canonical graph."""


def lesson_graph(lesson: str, name: GraphName) -> ox.NamedNode:
    """Return the graph that holds what one lesson contributed to a canonical one.

    >>> lesson_graph("set 1", GraphName.LEARNED).value
    'https://w3id.org/deixis/graph/lesson/set%201/learned'
    """
    return ox.NamedNode(f"{LESSONS}{quote(lesson, safe='')}/{name}")


def package_graph(name: GraphName) -> ox.NamedNode:
    """Return the graph that holds what the package itself contributes: the ontology and the shapes."""
    return ox.NamedNode(PACKAGE + name)


def loaded_graph(name: GraphName) -> ox.NamedNode:
    """Return the graph of the triples that were loaded in bulk and that a lesson contributes too."""
    return ox.NamedNode(LOADED + name)


def models_graph(models: ModelSet) -> ox.NamedNode:
    """Return the graph that holds a set of models as the learned graph has it.

    >>> models_graph(ModelSet.SIZES).value
    'https://w3id.org/deixis/graph/models/sizes'
    """
    return ox.NamedNode(MODELS + models)


def models_of_graph(iri: str) -> ModelSet | None:
    """Return the set of models that a copy's IRI names, or None where it names none."""
    name = iri.removeprefix(MODELS)
    return ModelSet(name) if iri.startswith(MODELS) and name in list(ModelSet) else None


def lesson_of_graph(iri: str) -> tuple[str, GraphName] | None:
    """Return the lesson and the graph that a copy's IRI names, or None where it names none.

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


COUNTED = ox.NamedNode(STATISTICS + "counted")
"""The graph of what all lessons come to."""

KEPT_UP = ox.NamedNode(STATISTICS + "kept-up")
"""What the statistics and the inferred graph are right for is said under this, in :data:`COUNTED` about itself."""


def share_graph(lesson: str) -> ox.NamedNode:
    """Return the graph that holds what one lesson adds to the statistics."""
    return ox.NamedNode(f"{STATISTICS}lesson/{quote(lesson, safe='')}")


ORDER = ox.NamedNode(GRAPHS + "order")
"""The graph that numbers the lessons in the order in which they came, whatever the clock said."""

NUMBER, NEXT = ox.NamedNode(GRAPHS + "order/number"), ox.NamedNode(GRAPHS + "order/next")
"""The number of a lesson; and that of the next one, which is said of :data:`ORDER` itself."""


CATEGORY_OF_VIEW = ox.NamedNode(VIEWS + "category")
"""Says of a view, in the graph of a lesson that taught it, of which category it is."""


def views_graph(lesson: str) -> ox.NamedNode:
    """Return the graph of the views that a lesson taught."""
    return ox.NamedNode(f"{VIEWS}lesson/{quote(lesson, safe='')}")


def lesson_of_views(graph: object) -> str | None:
    """Return the lesson whose views a graph holds, or None for another graph.

    >>> lesson_of_views(views_graph("set 1"))
    'set 1'
    """
    name = graph.value if isinstance(graph, ox.NamedNode) else ""
    return unquote(name.removeprefix(f"{VIEWS}lesson/")) if name.startswith(f"{VIEWS}lesson/") else None


def view_node(id: str) -> ox.NamedNode:
    """Return the name of a view of the perceptual store."""
    return ox.NamedNode(f"{VIEWS}id/{quote(id, safe='')}")


def copied_graph(iri: str) -> GraphName | None:
    """Return the canonical graph that a copy, of a lesson, models, the package or loaded, contributes to; None for
    no copy."""
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
