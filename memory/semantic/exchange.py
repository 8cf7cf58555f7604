"""Export a memory as text, and import such a text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import pyoxigraph as ox

from deixis.memory.errors import ImportFormatError, RejectedWriteError
from deixis.memory.folder import FolderState, inspect, reading
from deixis.memory.semantic.dump import Dump, read_dump
from deixis.memory.semantic.opening import open_memory
from deixis.memory.semantic.queries.union import merge_if_overlapping
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.change import Change, modelling, together
from deixis.memory.semantic.rdf.files import PREFIXES, trig, turtle
from deixis.memory.semantic.rdf.graphs import (
    CANONICAL,
    CONTRIBUTED,
    GraphName,
    copied_graph,
    graph_iri,
    loaded_graph,
)
from deixis.memory.semantic.rdf.package import packaged
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.rdf.triples import with_blank
from deixis.ontology.rdf.vocabulary import W3C

TYPE, NAMED_INDIVIDUAL = ox.NamedNode(W3C.RDF_TYPE), ox.NamedNode(PREFIXES["owl"] + "NamedIndividual")

TURTLE_GRAPHS = (GraphName.ONTOLOGY, GraphName.ASSERTED, GraphName.INFERRED, GraphName.LEARNED, GraphName.EPISODES)
"""Graphs that an export in Turtle merges."""


def export_memory(memory: SemanticMemory, format: str = "trig") -> str:
    """Return the content of a memory as text, the same text for the same content.

    Parameters
    ----------
    memory
        Open memory.
    format
        ``trig`` is exact: it has every graph, and which lesson contributed what. ``turtle`` merges the ontology with
        the asserted, inferred and learned graphs and the episodes into one graph, for tools such as Protégé and
        owlready2. It declares each individual as an ``owl:NamedIndividual``.

    Returns
    -------
    str
        Document in TriG or Turtle.

    Raises
    ------
    ImportFormatError
        The format is another one.
    """
    with reading(memory.path):
        if format == "turtle":
            return turtle(with_named_individuals([t for name in TURTLE_GRAPHS for t in memory.triples(name)]))
        if format != "trig":
            raise ImportFormatError(f"the export format must be trig or turtle, got '{format}'")
        graphs = [graph for graph in memory.store.named_graphs() if isinstance(graph, ox.NamedNode)]
        copies = sorted((graph for graph in graphs if copied_graph(graph.value)), key=lambda graph: graph.value)
        return trig((graph, ledger.triples_in(memory.store, graph)) for graph in [*CANONICAL, *copies])


def with_named_individuals(triples: Sequence[ox.Triple]) -> Iterator[ox.Triple]:
    """Yield triples, and the declaration of each individual with an IRI as an ``owl:NamedIndividual``.

    An individual has a type outside the vocabularies of RDF, RDFS and OWL, and none in that of OWL: neither a class nor
    a property is declared. Tools such as owlready2 list declared individuals only.

    Parameters
    ----------
    triples
        Triples of the document.

    Yields
    ------
    ox.Triple
        The given triples, with the declarations.
    """
    yield from triples
    typed = [(t.subject, t.object) for t in triples if t.predicate == TYPE and isinstance(t.object, ox.NamedNode)]
    schema = {one for one, of in typed if of.value.startswith(PREFIXES["owl"]) and of != NAMED_INDIVIDUAL}
    built_in = tuple(PREFIXES[name] for name in ("rdf", "rdfs", "owl"))
    for subject in {one for one, of in typed if not of.value.startswith(built_in)} - schema:
        if not isinstance(with_blank(subject), ox.BlankNode):
            yield ox.Triple(subject, TYPE, NAMED_INDIVIDUAL)


def import_dump(file: str | Path, target: str | Path) -> None:
    """Import a file into a memory, all of it or nothing.

    A TriG or N-Quads file that an export wrote gives the same graphs back. It is merged into a memory with content
    lesson by lesson; learned models are imported where the memory has none. Plain triples (Turtle, N-Triples, RDF/XML)
    become a lesson that is named after the file.

    Parameters
    ----------
    file
        File in TriG, N-Quads, Turtle, N-Triples or RDF/XML; its ending names the format.
    target
        Path of the memory.

    Raises
    ------
    ImportFormatError
        The file cannot be read.
    RejectedWriteError
        The file breaks the shapes, or has a known lesson with other content.
    """
    file, target = Path(file), Path(target)
    dump = read_dump(file)
    if inspect(target) in (FolderState.ABSENT, FolderState.EMPTY):
        open_memory(target, create=True, fill=lambda store: _fill(store, dump)).close()
        return
    with SemanticMemory.open(target) as memory:
        change = _merged(memory, dump, file)
        if change.operations:
            memory.commit(change)


def merging_dump(memory: SemanticMemory, file: Path) -> Change:
    """Return the change that imports a file into an open memory, to be committed with what follows from both.

    The inferred graph of the file is left out.

    Parameters
    ----------
    memory
        The open memory.
    file
        File in TriG, N-Quads, Turtle, N-Triples or RDF/XML; its ending names the format.

    Returns
    -------
    Change
        Triples to add.

    Raises
    ------
    ImportFormatError
        If the file cannot be read.
    RejectedWriteError
        If the file breaks the shapes, or has a known lesson with other content.
    """
    dump = read_dump(file)
    dump.canonical[GraphName.INFERRED].clear()
    return _merged(memory, dump, file)


def _fill(store: ox.Store, dump: Dump) -> None:
    from deixis.memory.semantic.validation.validate import check_store

    store.bulk_extend(dump.quads())
    ledger.update(store, ledger.package_update(store, packaged()))
    ledger.update(store, ledger.numbering(store, dump.in_order()))
    merge_if_overlapping(store)
    check_store(store)


def _merged(memory: SemanticMemory, dump: Dump, file: Path) -> Change:
    """Return the change that merges a dump into a memory."""
    store, known = memory.store, set(memory.lessons())
    added: dict[GraphName, set[ox.Triple]] = {name: set() for name in GraphName}
    operations: list[ledger.Operation] = []
    new_lessons: list[str] = []
    for lesson in dump.in_order():
        contributions = {name: sorted(triples, key=str) for name, triples in dump.lessons[lesson].items() if triples}
        if lesson in known:
            if {name: set(triples) for name, triples in memory.contributions(lesson).items()} != {
                name: set(triples) for name, triples in contributions.items()
            }:
                raise RejectedWriteError(
                    f"{file}: its lesson '{lesson}' differs from the one in the memory at {memory.path}; forget that "
                    "one first, or import into another memory"
                )
            continue
        new_lessons.append(lesson)
        held = {name: ledger.stored_triples(store, graph_iri(name), triples) for name, triples in contributions.items()}
        operations += ledger.arrival(store, lesson, contributions, held)
        for name, triples in contributions.items():
            added[name].update(triples)
    operations += ledger.numbering(store, new_lessons)
    for name, graph, loose in _without_lesson(store, dump):
        operations += ledger.insertion(graph, sorted(loose, key=str))
        added[name].update(loose)
    new_ones = {
        name: {triple for triple in triples if ledger.quad_of(triple, graph_iri(name)) not in store}
        for name, triples in added.items()
    }
    lessons = Change({name: frozenset(triples) for name, triples in new_ones.items()}, {}, tuple(operations))
    new = {which: sorted(triples, key=str) for which, triples in dump.models.items() if not memory.models(which)}
    return together(lessons, modelling(store, new))


def _without_lesson(store: ox.Store, dump: Dump) -> Iterator[tuple[GraphName, ox.NamedNode, set[ox.Triple]]]:
    """Yield the triples that belong to no lesson, by graph; those that a lesson has too are marked as loaded."""
    for name in CONTRIBUTED:
        loose = dump.loose(name)
        also = {triple for triple in loose if any(ledger.quads_of(store, triple))} | dump.loaded[name]
        also |= {triple for triple in loose for graphs in dump.lessons.values() if triple in graphs[name]}
        yield name, graph_iri(name), loose
        yield name, loaded_graph(name), also
    inferred = graph_iri(GraphName.INFERRED)
    yield GraphName.INFERRED, inferred, dump.canonical[GraphName.INFERRED]
