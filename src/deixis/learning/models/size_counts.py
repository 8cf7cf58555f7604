"""Counts of sizes in the store: those of all lessons, and the share of each lesson, as triples.

A row of counts is a subject, and its keys are predicates. The share of a lesson is a graph with the views that it has
of each place, so that they can be taken out of the counts again.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from urllib.parse import quote, unquote

import pyoxigraph as ox

from deixis.learning.lessons.recollection import Recollection, Remembered
from deixis.learning.models.sizes import Counts, Row, SizeStatistics, SizeView, size_views
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.change import Change, modelling, remodelling, together
from deixis.memory.semantic.rdf.graphs import COUNTED, STATISTICS, ModelSet, models_graph, share_graph
from deixis.ontology.models.sizes import SIZE_PROPERTIES, size_iri, size_triples
from deixis.ontology.rdf.triples import iri, text
from deixis.ontology.rdf.vocabulary import PROV
from deixis.ontology.tbox import Ontology

SEEN = iri(STATISTICS + "seen")
"""Predicate from a place in the counts to the view that a lesson has of it."""


def recounted(store: ox.Store, ontology: Ontology, come: Sequence[Remembered], gone: Sequence[str]) -> Change:
    """Return the change of the statistics and models of sizes when lessons are added and removed.

    Parameters
    ----------
    store
        The store before the change.
    ontology
        The ontology.
    come
        Lessons that are added.
    gone
        Ids of the lessons that are removed.

    Returns
    -------
    Change
        The change, whose cost depends on these lessons only.
    """
    counts = Counts(lambda row, key: _value(store, row, key), lambda row: _row(store, row))
    statistics = SizeStatistics(counts, ontology.sizes)
    operations: list[ledger.Operation] = []
    for lesson in gone:
        share = share_graph(lesson)
        for quad in list(store.quads_for_pattern(None, SEEN, None, share)):
            same_box = store.quads_for_pattern(quad.subject, SEEN, None, None)
            others = (_view(other) for other in same_box if other.graph_name != share)
            statistics.remove(_view(quad), others)
        operations.append(ledger.drop(share))
    operations += _shares(statistics, come, ontology)
    statistics.settle()
    copy = models_graph(ModelSet.SIZES)
    old: list[ox.Triple] = []
    new: list[ox.Triple] = []
    for kind, (model, scenes_gone, scenes_come) in statistics.models().items():
        node, derived = iri(size_iri(kind)), iri(PROV.WAS_DERIVED_FROM)
        old += [q.triple for p in SIZE_PROPERTIES for q in store.quads_for_pattern(node, iri(p), None, copy)]
        old += [ox.Triple(node, derived, iri(scene)) for scene in sorted(scenes_gone)]
        if model is not None:
            new += size_triples(kind, model, sorted(scenes_come))
    come_now = [triple for triple in ledger.as_stored(new) if ledger.quad_of(triple, copy) not in store]
    stay = set(ledger.as_stored(new))
    left = [triple for triple in old if triple not in stay]
    return together(remodelling(store, copy, left, come_now), Change(operations=(*operations, *_rows(counts))))


def recounted_from_scratch(store: ox.Store, ontology: Ontology, recollection: Recollection) -> Change:
    """Return the change that recomputes the statistics and models of sizes from all lessons.

    Parameters
    ----------
    store
        The store before the change.
    ontology
        The ontology.
    recollection
        All lessons.

    Returns
    -------
    Change
        The change.
    """
    counts, shares, triples = counted(recollection, ontology)
    operations = [ledger.drop(graph) for graph in _share_graphs(store)]
    operations += ledger.deletion(COUNTED, sorted(stored_rows(store), key=str))
    models = modelling(store, {ModelSet.SIZES: triples})
    return together(models, Change(operations=(*operations, *shares, *_rows(counts))))


def counted(recollection: Recollection, ontology: Ontology) -> tuple[Counts, list[ledger.Operation], list[ox.Triple]]:
    """Return the counts of all lessons, the operations that write the share of each, and the size models as triples.

    Parameters
    ----------
    recollection
        All lessons.
    ontology
        The ontology.

    Returns
    -------
    tuple
        Counts, operations and triples.
    """
    counts = Counts()
    statistics = SizeStatistics(counts, ontology.sizes)
    shares = _shares(statistics, recollection.lessons, ontology)
    statistics.settle()
    triples: list[ox.Triple] = []
    for kind, (model, _, scenes) in statistics.models().items():
        triples += size_triples(kind, model, sorted(scenes)) if model is not None else ()
    return counts, shares, triples


def _share_graphs(store: ox.Store) -> list[ox.NamedNode]:
    graphs = (graph for graph in store.named_graphs() if isinstance(graph, ox.NamedNode))
    return [graph for graph in graphs if graph.value.startswith(f"{STATISTICS}lesson/")]


def stored_shares(store: ox.Store) -> set[ox.Quad]:
    """Return the stored shares of all lessons.

    Parameters
    ----------
    store
        The store.

    Returns
    -------
    set of ox.Quad
        A quad for each view of a place, in the graph of its lesson.
    """
    return {quad for graph in _share_graphs(store) for quad in store.quads_for_pattern(None, None, None, graph)}


def stored_rows(store: ox.Store) -> set[ox.Triple]:
    """Return the stored counts, without what the graph says about itself.

    Parameters
    ----------
    store
        The store.

    Returns
    -------
    set of ox.Triple
        A triple for each key of each row.
    """
    return {quad.triple for quad in store.quads_for_pattern(None, None, None, COUNTED) if quad.subject != COUNTED}


def _shares(statistics: SizeStatistics, lessons: Iterable[Remembered], ontology: Ontology) -> list[ledger.Operation]:
    """Add what lessons show to the statistics; return the operations that write their shares."""
    operations: list[ledger.Operation] = []
    for lesson in lessons:
        views = size_views(lesson, ontology.kinds)
        for view in views:
            statistics.add(view)
        seen = {ox.Triple(_node(view.place), SEEN, text(view.written())) for view in views}
        operations += ledger.insertion(share_graph(lesson.lesson), sorted(seen, key=str))
    return operations


def _view(quad: ox.Quad) -> SizeView:
    return SizeView.read(str(getattr(quad.object, "value", "")))


@lru_cache(maxsize=4096)
def _node(name: str) -> ox.NamedNode:
    return iri(STATISTICS + quote(name, safe="/"))


def _value(store: ox.Store, row: str, key: str) -> str | None:
    found = next(store.quads_for_pattern(_node(row), _node(key), None, COUNTED), None)
    return None if found is None else str(getattr(found.object, "value", ""))


def _row(store: ox.Store, row: str) -> Row:
    quads = store.quads_for_pattern(_node(row), None, None, COUNTED)
    return {unquote(q.predicate.value.removeprefix(STATISTICS)): str(getattr(q.object, "value", "")) for q in quads}


def new_rows(counts: Counts) -> set[ox.Triple]:
    """Return the rows that counts add to what they were read from, as the store keeps them.

    Parameters
    ----------
    counts
        The counts.

    Returns
    -------
    set of ox.Triple
        A triple for each key of each row.
    """
    return set(_row_triples(counts.difference()[1]))


def _row_triples(rows: Iterable[tuple[str, str, str]]) -> list[ox.Triple]:
    return [ox.Triple(_node(row), _node(key), text(value)) for row, key, value in rows]


def _rows(counts: Counts) -> list[ledger.Operation]:
    """Return the operations that update the stored rows."""
    gone, come = (_row_triples(side) for side in counts.difference())
    return [*ledger.deletion(COUNTED, gone), *ledger.insertion(COUNTED, come)]
