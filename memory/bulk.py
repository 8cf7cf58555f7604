"""Much at once: loaded into a copy of the store, checked there, and swapped in."""

from __future__ import annotations

import shutil
from collections.abc import Iterable, Iterator, Mapping

import pyoxigraph as ox

from deixis.memory import folder as files
from deixis.memory.change import named
from deixis.memory.errors import RejectedWriteError
from deixis.memory.graphs import MERGED, UNION, GraphName, graph_iri, loaded_graph
from deixis.memory.merged import merge_if_overlapping
from deixis.memory.opening import Opened
from deixis.memory.writing import committed


def load_aside(opened: Opened, contributions: Mapping[GraphName, Iterable[ox.Triple]]) -> None:
    """See :meth:`deixis.memory.semantic.SemanticMemory.load`."""
    from deixis.memory.validation import check_store

    if GraphName.INFERRED in contributions:
        raise RejectedWriteError("what is inferred cannot be loaded: it follows from the rest")
    aside = opened.folder / files.NEW
    with committed(opened.folder):
        shutil.rmtree(aside, ignore_errors=True)
        opened.store.flush()
        opened.store.backup(aside)
        try:
            store = ox.Store(aside)
            for name, triples in contributions.items():
                store.bulk_extend(_quads(opened.store, GraphName(name), triples))
            merge_if_overlapping(store)
            check_store(store)
            store.flush()
            del store
        except BaseException:
            shutil.rmtree(aside, ignore_errors=True)
            raise
        opened.shut()
        try:
            files.swap(opened.folder, files.read_mark(opened.folder))
        finally:
            opened.reopen()


def _quads(store: ox.Store, name: GraphName, triples: Iterable[ox.Triple]) -> Iterator[ox.Quad]:
    """The quads to write: where the graph has content, a triple that is there already is marked as loaded too."""
    graph, mark = graph_iri(name), loaded_graph(name)
    merged = name in UNION and store.contains_named_graph(MERGED)
    held = any(store.quads_for_pattern(None, None, None, graph))
    for triple in named(f"loaded.{name}", triples):
        quad = ox.Quad(triple.subject, triple.predicate, triple.object, graph)
        if held and quad in store:
            yield ox.Quad(triple.subject, triple.predicate, triple.object, mark)
        if merged:
            yield ox.Quad(triple.subject, triple.predicate, triple.object, MERGED)
        yield quad
