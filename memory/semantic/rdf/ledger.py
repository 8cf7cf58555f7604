"""Contributions of lessons: read the copies in a store, and make the update for a lesson that is added or removed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import islice
from typing import Literal

import pyoxigraph as ox

from deixis.memory.journal import MARKS, JointWrite, marked
from deixis.memory.semantic.rdf.graphs import (
    CONTRIBUTED,
    COUNTED,
    KEPT_UP,
    NEXT,
    NUMBER,
    ORDER,
    GraphName,
    copied_graph,
    graph_iri,
    lesson_graph,
    lesson_of_graph,
    loaded_graph,
    package_graph,
)
from deixis.ontology.rdf.triples import learned_iri
from deixis.ontology.rdf.vocabulary import PROV

Contributions = Mapping[GraphName, Sequence[ox.Triple]]

Triples = Mapping[GraphName, frozenset[ox.Triple]]


@dataclass(frozen=True, slots=True)
class Operation:
    """One operation of an update: insert triples into a graph, delete them from it, or drop the graph."""

    verb: Literal["INSERT", "DELETE", "DROP"]
    graph: ox.NamedNode
    triples: tuple[ox.Triple, ...] = ()

    def texts(self) -> Iterator[str]:
        """Yield the operation in SPARQL.

        Terms are written as N-Triples with escapes; an IRI that could end its ``<>`` early cannot be created.

        Yields
        ------
        str
            Updates of at most 10,000 triples each.
        """
        if self.verb == "DROP":
            yield f"DROP SILENT GRAPH {self.graph}"
        rest = iter(self.triples)
        while chunk := list(islice(rest, 10_000)):
            yield f"{self.verb} DATA {{ GRAPH {self.graph} {{ {' '.join(f'{triple} .' for triple in chunk)} }} }}"


STARTED = ox.NamedNode(PROV.STARTED_AT_TIME)

NEVER = datetime.min.replace(tzinfo=UTC)
"""Starting time of a lesson that states none: before all others."""


def lessons(store: ox.Store) -> tuple[str, ...]:
    """Return the lessons of a store, in the order learned: see :func:`place`.

    Parameters
    ----------
    store
        Store to read.

    Returns
    -------
    tuple of str
        Names of the lessons.
    """
    found = {known[0] for graph in store.named_graphs() if (known := lesson_of_graph(graph.value))}
    return tuple(sorted(found, key=lambda lesson: place(store, lesson)))


def place(store: ox.Store, lesson: str) -> tuple[int, datetime, str]:
    """Return the sort key of a lesson: the number that it got when it was learned, whatever the clock said.

    Lessons from before there were numbers come first, by their starting time, then by id.

    Parameters
    ----------
    store
        Store with the lesson.
    lesson
        Name of the lesson.

    Returns
    -------
    tuple
        Number, starting time and name.
    """
    numbers = store.quads_for_pattern(lesson_node(lesson), NUMBER, None, ORDER)
    number = next((int(getattr(quad.object, "value", "0")) for quad in numbers), 0)
    return number, NEVER if number else started(store, lesson), lesson


def lesson_node(lesson: str) -> ox.NamedNode:
    """Return the IRI of a lesson.

    Parameters
    ----------
    lesson
        Name of the lesson.

    Returns
    -------
    NamedNode
        IRI of the individual.
    """
    return ox.NamedNode(learned_iri("lesson", lesson))


def numbering(store: ox.Store, come: Sequence[str]) -> Iterator[Operation]:
    """Yield the operations that number new lessons in their order, from 1 on; a number is never reused.

    Parameters
    ----------
    store
        Store before the lessons.
    come
        Names of the new lessons.

    Yields
    ------
    Operation
        No operations without lessons.
    """
    kept = [quad.triple for quad in store.quads_for_pattern(ORDER, NEXT, None, ORDER)]
    first = max((int(getattr(triple.object, "value", "1")) for triple in kept), default=1)
    numbers = [
        ox.Triple(lesson_node(lesson), NUMBER, ox.Literal(str(number))) for number, lesson in enumerate(come, first)
    ]
    if numbers:
        yield from deletion(ORDER, kept)
        yield from insertion(ORDER, [*numbers, ox.Triple(ORDER, NEXT, ox.Literal(str(first + len(numbers))))])


def unnumbering(store: ox.Store, lesson: str) -> Iterator[Operation]:
    """Yield the operation that removes the number of a lesson.

    Parameters
    ----------
    store
        Store with the lesson.
    lesson
        Name of the lesson.

    Yields
    ------
    Operation
        No operation for a lesson without a number.
    """
    numbers = store.quads_for_pattern(lesson_node(lesson), NUMBER, None, ORDER)
    yield from deletion(ORDER, [quad.triple for quad in numbers])


def renumbering(store: ox.Store, lesson: str, number: int) -> Iterator[Operation]:
    """Yield the operations that give a lesson the place of an earlier one in the order.

    Parameters
    ----------
    store
        Store with the lesson.
    lesson
        Name of the lesson.
    number
        Its number; 0 for none.

    Yields
    ------
    Operation
        The operations.
    """
    yield from unnumbering(store, lesson)
    if number:
        yield from insertion(ORDER, [ox.Triple(lesson_node(lesson), NUMBER, ox.Literal(str(number)))])


def knows(store: ox.Store, lesson: str) -> bool:
    """Return whether a store has a lesson.

    Parameters
    ----------
    store
        Store to read.
    lesson
        Name of the lesson.

    Returns
    -------
    bool
        True if a graph holds contributions of the lesson.
    """
    return any(store.contains_named_graph(lesson_graph(lesson, name)) for name in CONTRIBUTED)


def started(store: ox.Store, lesson: str) -> datetime:
    """Return the starting time of a lesson.

    Times cannot be sorted as text, since the store drops zeros at the end of a fraction.

    Parameters
    ----------
    store
        Store with the lesson.
    lesson
        Name of the lesson.

    Returns
    -------
    datetime
        Earliest starting time; ``NEVER`` without one.
    """
    node, episodes = lesson_node(lesson), graph_iri(GraphName.EPISODES)
    return earliest(quad.triple for quad in store.quads_for_pattern(node, STARTED, None, episodes))


def earliest(triples: Iterable[ox.Triple]) -> datetime:
    """Return the earliest starting time in some triples.

    Parameters
    ----------
    triples
        Triples whose objects are times; objects that are not times are ignored.

    Returns
    -------
    datetime
        Earliest time; ``NEVER`` without one.
    """
    times = (getattr(triple.object, "value", "") for triple in triples)
    return min((time for text in times if (time := _time(text)) is not None), default=NEVER)


def _time(text: str) -> datetime | None:
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        return None
    return time if time.tzinfo is not None else time.replace(tzinfo=UTC)


def triples_in(store: ox.Store, graph: ox.NamedNode) -> Iterator[ox.Triple]:
    """Yield the triples of one graph.

    Parameters
    ----------
    store
        Store to read.
    graph
        Graph of the store; an unknown one has no triples.

    Yields
    ------
    Triple
        Triples in the order of the store.
    """
    for quad in store.quads_for_pattern(None, None, None, graph):
        yield quad.triple


def quad_of(triple: ox.Triple, graph: ox.NamedNode) -> ox.Quad:
    """Return a triple as a quad in a graph.

    Parameters
    ----------
    triple
        Triple of the graph.
    graph
        Graph of the quad.

    Returns
    -------
    Quad
        Quad with the terms of the triple.
    """
    return ox.Quad(triple.subject, triple.predicate, triple.object, graph)


def quads_of(store: ox.Store, triple: ox.Triple) -> Iterator[ox.Quad]:
    """Yield the quads of a triple, one for each graph that has it.

    Parameters
    ----------
    store
        Store to read.
    triple
        Triple to look up.

    Yields
    ------
    Quad
        Quads of canonical graphs and of copies.
    """
    return store.quads_for_pattern(triple.subject, triple.predicate, triple.object, None)


def copies(store: ox.Store, lesson: str) -> dict[GraphName, list[ox.Triple]]:
    """Return the contributions of one lesson, by graph.

    Parameters
    ----------
    store
        Store to read.
    lesson
        Name of the lesson.

    Returns
    -------
    dict
        Triples by canonical graph; graphs without any are left out.
    """
    found = {name: list(triples_in(store, lesson_graph(lesson, name))) for name in CONTRIBUTED}
    return {name: triples for name, triples in found.items() if triples}


def only_of(store: ox.Store, copy: ox.NamedNode, name: GraphName, triples: Iterable[ox.Triple]) -> list[ox.Triple]:
    """Return those of the triples that only this copy contributes to the graph with that name.

    Parameters
    ----------
    store
        Store to read.
    copy
        Graph of the copy.
    name
        Canonical graph that the copy contributes to.
    triples
        Triples of the copy.

    Returns
    -------
    list of Triple
        Triples that leave the canonical graph with the copy.
    """
    return [triple for triple in triples if not _held_elsewhere(store, copy, name, triple)]


def _held_elsewhere(store: ox.Store, copy: ox.NamedNode, name: GraphName, triple: ox.Triple) -> bool:
    quads = quads_of(store, triple)
    return any(quad.graph_name != copy and _copies(quad.graph_name, name) for quad in quads)


def stored_triples(store: ox.Store, graph: ox.NamedNode, triples: Iterable[ox.Triple]) -> list[ox.Triple]:
    """Return those of the triples that a graph has.

    Parameters
    ----------
    store
        Store to read.
    graph
        Graph of the store.
    triples
        Triples to look up.

    Returns
    -------
    list of Triple
        Triples in the given order.
    """
    return [triple for triple in triples if quad_of(triple, graph) in store]


def arrival(store: ox.Store, lesson: str, contributions: Contributions, known: Contributions) -> Iterator[Operation]:
    """Yield the operations that write a lesson: its contributions, and the copies of them.

    Parameters
    ----------
    store
        Store before the lesson.
    lesson
        Name of the lesson.
    contributions
        Triples by canonical graph.
    known
        Those that the canonical graphs have already.

    Yields
    ------
    Operation
        Insertions.
    """
    for name, triples in contributions.items():
        yield from insertion(loaded_graph(name), _unowned(store, name, known[name]))
        yield from insertion(graph_iri(name), triples)
        yield from insertion(lesson_graph(lesson, name), triples)


def _unowned(store: ox.Store, name: GraphName, triples: Iterable[ox.Triple]) -> Iterator[ox.Triple]:
    """Yield those of some triples of a canonical graph that were loaded in bulk, so that no copy has them."""
    for triple in triples:
        if not any(_copies(quad.graph_name, name) for quad in quads_of(store, triple)):
            yield triple


def _copies(graph: ox.NamedNode | ox.BlankNode | ox.DefaultGraph, name: GraphName) -> bool:
    return isinstance(graph, ox.NamedNode) and copied_graph(graph.value) is name


def package_update(store: ox.Store, packaged: Contributions) -> Iterator[Operation]:
    """Yield the operations that update the packaged ontology and shapes, if they differ.

    Parameters
    ----------
    store
        Store to update.
    packaged
        Triples of the package by canonical graph.

    Yields
    ------
    Operation
        No operations if nothing differs.
    """
    for name, triples in packaged.items():
        copy = package_graph(name)
        gone, come = difference(store, copy, triples)
        yield from replacement(store, copy, name, gone, come)


def difference(
    store: ox.Store, graph: ox.NamedNode, triples: Iterable[ox.Triple]
) -> tuple[list[ox.Triple], list[ox.Triple]]:
    """Return the triples to remove from a graph and those to add, so that it has just the given triples.

    Parameters
    ----------
    store
        Store to read.
    graph
        Graph of the store.
    triples
        Triples that the graph should have.

    Returns
    -------
    tuple
        Triples to remove and triples to add, both sorted.
    """
    old, new = set(triples_in(store, graph)), set(as_stored(triples))
    return sorted(old - new, key=str), sorted(new - old, key=str)


def replacement(
    store: ox.Store, copy: ox.NamedNode, name: GraphName, gone: Sequence[ox.Triple], come: Sequence[ox.Triple]
) -> Iterator[Operation]:
    """Yield the operations that replace triples in a copy and in the canonical graph that it contributes to.

    Parameters
    ----------
    store
        Store before the change.
    copy
        Graph of the copy.
    name
        Canonical graph that the copy contributes to.
    gone
        Triples to remove. The canonical graph keeps those that also come from elsewhere.
    come
        Triples to add.

    Yields
    ------
    Operation
        Deletions, then insertions.
    """
    yield from deletion(graph_iri(name), only_of(store, copy, name, gone))
    yield from deletion(copy, gone)
    yield from insertion(graph_iri(name), come)
    yield from insertion(copy, come)


def as_stored(triples: Iterable[ox.Triple]) -> list[ox.Triple]:
    """Return triples as a store returns them: numbers, times and language tags in one spelling, sorted.

    Parameters
    ----------
    triples
        Triples in any order; repeated ones are stored once.

    Returns
    -------
    list of Triple
        Triples in the order of their text.
    """
    store = ox.Store()
    store.extend(ox.Quad(t.subject, t.predicate, t.object) for t in triples)
    return sorted((quad.triple for quad in store), key=str)


def kept_up(store: ox.Store) -> str | None:
    """Return the rules by which the inferred graph and the statistics of a store are up to date.

    Parameters
    ----------
    store
        Store to read.

    Returns
    -------
    str or None
        Name of the rules; None if both must be recomputed.
    """
    found = list(store.quads_for_pattern(COUNTED, KEPT_UP, None, COUNTED))
    return found[0].object.value if len(found) == 1 and isinstance(found[0].object, ox.Literal) else None


def keeping_up(store: ox.Store, rules: str | None) -> Iterator[Operation]:
    """Yield the operations that record the rules by which a store is up to date.

    Parameters
    ----------
    store
        Store to update.
    rules
        Name of the rules; None removes the record.

    Yields
    ------
    Operation
        No operations if the record is the given one.
    """
    old = {quad.triple for quad in store.quads_for_pattern(COUNTED, KEPT_UP, None, COUNTED)}
    new = {ox.Triple(COUNTED, KEPT_UP, ox.Literal(rules))} if rules is not None else set()
    yield from deletion(COUNTED, old - new)
    yield from insertion(COUNTED, new - old)


def marking(store: ox.Store, write: JointWrite | None) -> Iterator[Operation]:
    """Yield the operations that record the write over several stores that this commit decides, if any.

    See :mod:`deixis.memory.journal`.

    Parameters
    ----------
    store
        Store to update.
    write
        The write; None if the commit decides no such write.

    Yields
    ------
    Operation
        No operations without a write.
    """
    new = {} if write is None else marked(write)
    yield from deletion(MARKS, [q.triple for each in new for q in store.quads_for_pattern(MARKS, each, None, MARKS)])
    yield from insertion(MARKS, [ox.Triple(MARKS, predicate, id) for predicate, id in new.items()])


def insertion(graph: ox.NamedNode, triples: Iterable[ox.Triple]) -> Iterator[Operation]:
    """Yield the operation that inserts triples into a graph, if there are any triples.

    Parameters
    ----------
    graph
        Graph that gets the triples.
    triples
        Triples to insert.

    Yields
    ------
    Operation
        At most one operation.
    """
    if some := tuple(triples):
        yield Operation("INSERT", graph, some)


def deletion(graph: ox.NamedNode, triples: Iterable[ox.Triple]) -> Iterator[Operation]:
    """Yield the operation that deletes triples from a graph, if there are any triples.

    Parameters
    ----------
    graph
        Graph that loses the triples.
    triples
        Triples to delete.

    Yields
    ------
    Operation
        At most one operation.
    """
    if some := tuple(triples):
        yield Operation("DELETE", graph, some)


def drop(graph: ox.NamedNode) -> Operation:
    """Return the operation that drops a graph, if it exists.

    Parameters
    ----------
    graph
        Graph to drop, which may be missing.

    Returns
    -------
    Operation
        One operation.
    """
    return Operation("DROP", graph)


def update(store: ox.Store, operations: Iterable[Operation], last: Iterable[str] = ()) -> None:
    """Run operations, and then some SPARQL updates, in one step.

    Parameters
    ----------
    store
        Store to update.
    operations
        Operations in order.
    last
        Updates in SPARQL that follow.
    """
    texts = [*(text for operation in operations for text in operation.texts()), *last]
    if texts:
        store.update(" ;\n".join(texts))


def update_in_bulk(store: ox.Store, operations: Iterable[Operation]) -> None:
    """Run operations fast but not atomically, on a store that is discarded if this fails.

    Deletions are run before insertions.

    Parameters
    ----------
    store
        Store to update.
    operations
        Operations, whose deletions are run first.
    """
    come = []
    for operation in operations:
        if operation.verb == "INSERT":
            come.append(operation)
        elif operation.verb == "DROP":
            store.remove_graph(operation.graph)
        for triple in operation.triples if operation.verb == "DELETE" else ():
            store.remove(quad_of(triple, operation.graph))
    store.bulk_extend(quad_of(triple, operation.graph) for operation in come for triple in operation.triples)
