"""Who contributed what: reading the copies in a store, and the one update that a lesson's coming or going takes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import UTC, datetime
from itertools import islice

import pyoxigraph as ox

from deixis.memory.semantic.rdf.graphs import (
    CONTRIBUTED,
    COUNTED,
    KEPT_UP,
    GraphName,
    copied_graph,
    graph_iri,
    lesson_graph,
    lesson_of_graph,
    loaded_graph,
    package_graph,
)
from deixis.ontology.triples import learned_iri
from deixis.ontology.vocabulary import PROV

Contributions = Mapping[GraphName, Sequence[ox.Triple]]

Triples = Mapping[GraphName, frozenset[ox.Triple]]

_STARTED = ox.NamedNode(PROV.STARTED_AT_TIME)

NEVER = datetime.min.replace(tzinfo=UTC)
"""When a lesson started that does not say so: before all others."""


def lessons(store: ox.Store) -> tuple[str, ...]:
    """The lessons that a store holds, in the order learned: by when they started, then by id."""
    found = {known[0] for graph in store.named_graphs() if (known := lesson_of_graph(graph.value))}
    return tuple(sorted(found, key=lambda lesson: (started(store, lesson), lesson)))


def knows(store: ox.Store, lesson: str) -> bool:
    """Whether a store holds a lesson."""
    return any(store.contains_named_graph(lesson_graph(lesson, name)) for name in CONTRIBUTED)


def started(store: ox.Store, lesson: str) -> datetime:
    """When a lesson started; as text, times do not sort, since the store drops zeros at the end of a fraction."""
    node, episodes = ox.NamedNode(learned_iri("lesson", lesson)), graph_iri(GraphName.EPISODES)
    times = (getattr(quad.object, "value", "") for quad in store.quads_for_pattern(node, _STARTED, None, episodes))
    return min((time for text in times if (time := _time(text)) is not None), default=NEVER)


def _time(text: str) -> datetime | None:
    try:
        time = datetime.fromisoformat(text)
    except ValueError:
        return None
    return time if time.tzinfo is not None else time.replace(tzinfo=UTC)


def triples_in(store: ox.Store, graph: ox.NamedNode) -> Iterator[ox.Triple]:
    """The triples of one graph."""
    for quad in store.quads_for_pattern(None, None, None, graph):
        yield quad.triple


def quad_of(triple: ox.Triple, graph: ox.NamedNode) -> ox.Quad:
    """The triple in a graph."""
    return ox.Quad(triple.subject, triple.predicate, triple.object, graph)


def quads_of(store: ox.Store, triple: ox.Triple) -> Iterator[ox.Quad]:
    """The triple in every graph that holds it."""
    return store.quads_for_pattern(triple.subject, triple.predicate, triple.object, None)


def copies(store: ox.Store, lesson: str) -> dict[GraphName, list[ox.Triple]]:
    """What one lesson contributed, by graph."""
    found = {name: list(triples_in(store, lesson_graph(lesson, name))) for name in CONTRIBUTED}
    return {name: triples for name, triples in found.items() if triples}


def only_of(store: ox.Store, copy: ox.NamedNode, name: GraphName, triples: Iterable[ox.Triple]) -> list[ox.Triple]:
    """Those of the triples that no copy but this one contributes to the graph of that name."""
    return [triple for triple in triples if not _held_elsewhere(store, copy, name, triple)]


def _held_elsewhere(store: ox.Store, copy: ox.NamedNode, name: GraphName, triple: ox.Triple) -> bool:
    quads = quads_of(store, triple)
    return any(quad.graph_name != copy and _copies(quad.graph_name, name) for quad in quads)


def arrival(store: ox.Store, lesson: str, contributions: Contributions) -> Iterator[str]:
    """The operations that write a lesson: its contributions, and the copies of them."""
    for name, triples in contributions.items():
        yield from insertion(loaded_graph(name), _unowned(store, name, triples))
        yield from insertion(graph_iri(name), triples)
        yield from insertion(lesson_graph(lesson, name), triples)


def _unowned(store: ox.Store, name: GraphName, triples: Iterable[ox.Triple]) -> Iterator[ox.Triple]:
    """Those that were loaded in bulk: the canonical graph has them, and no copy does."""
    for triple in triples:
        if quad_of(triple, graph_iri(name)) in store and not any(
            _copies(quad.graph_name, name) for quad in quads_of(store, triple)
        ):
            yield triple


def _copies(graph: ox.NamedNode | ox.BlankNode | ox.DefaultGraph, name: GraphName) -> bool:
    return isinstance(graph, ox.NamedNode) and copied_graph(graph.value) is name


def package_update(store: ox.Store, packaged: Contributions) -> Iterator[str]:
    """The operations that bring the packaged ontology and shapes up to date; none where they are."""
    for name, triples in packaged.items():
        copy = package_graph(name)
        gone, come = difference(store, copy, triples)
        yield from replacement(store, copy, name, gone, come)


def difference(
    store: ox.Store, graph: ox.NamedNode, triples: Iterable[ox.Triple]
) -> tuple[list[ox.Triple], list[ox.Triple]]:
    """What must go from a graph, and what must come, so that it holds just these triples."""
    old, new = set(triples_in(store, graph)), set(as_stored(triples))
    return sorted(old - new, key=str), sorted(new - old, key=str)


def replacement(
    store: ox.Store, copy: ox.NamedNode, name: GraphName, gone: Sequence[ox.Triple], come: Sequence[ox.Triple]
) -> Iterator[str]:
    """The operations that exchange triples of a copy and of the canonical graph that it contributes to."""
    yield from deletion(graph_iri(name), only_of(store, copy, name, gone))
    yield from deletion(copy, gone)
    yield from insertion(graph_iri(name), come)
    yield from insertion(copy, come)


def as_stored(triples: Iterable[ox.Triple]) -> list[ox.Triple]:
    """The triples as a store gives them back: numbers, times and language tags in one spelling, sorted."""
    store = ox.Store()
    store.extend(ox.Quad(t.subject, t.predicate, t.object) for t in triples)
    return sorted((quad.triple for quad in store), key=str)


def kept_up(store: ox.Store) -> str | None:
    """The rules by which a store's inferred graph and statistics are right, None where they are to be made anew."""
    found = list(store.quads_for_pattern(COUNTED, KEPT_UP, None, COUNTED))
    return found[0].object.value if len(found) == 1 and isinstance(found[0].object, ox.Literal) else None


def keeping_up(store: ox.Store, rules: str | None) -> Iterator[str]:
    """The operations that say by which rules they are right from now on; None: by none."""
    old = {quad.triple for quad in store.quads_for_pattern(COUNTED, KEPT_UP, None, COUNTED)}
    new = {ox.Triple(COUNTED, KEPT_UP, ox.Literal(rules))} if rules is not None else set()
    yield from deletion(COUNTED, old - new)
    yield from insertion(COUNTED, new - old)


def insertion(graph: ox.NamedNode, triples: Iterable[ox.Triple]) -> Iterator[str]:
    """INSERT DATA for these triples, none where there are none."""
    yield from _data("INSERT", graph, triples)


def deletion(graph: ox.NamedNode, triples: Iterable[ox.Triple]) -> Iterator[str]:
    """DELETE DATA for these triples, none where there are none."""
    yield from _data("DELETE", graph, triples)


def _data(verb: str, graph: ox.NamedNode, triples: Iterable[ox.Triple]) -> Iterator[str]:
    """Terms write themselves as N-Triples, escapes and all; an IRI that could break out of ``<>`` cannot be made."""
    rest = iter(triples)
    while chunk := list(islice(rest, 10_000)):
        yield f"{verb} DATA {{ GRAPH {graph} {{ {' '.join(f'{triple} .' for triple in chunk)} }} }}"
