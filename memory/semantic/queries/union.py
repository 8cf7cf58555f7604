"""Union of the ontology and the asserted, inferred and learned graphs, as queries read it: each triple once.

A query over several graphs gets a triple that is in two of them twice from Oxigraph, contrary to SPARQL. So as soon as
the three graphs overlap, their union is stored as a graph of its own that queries read; as long as they do not, as
after loading in bulk, nothing is stored twice.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

import pyoxigraph as ox

from deixis.memory.semantic.rdf.graphs import MERGED, UNION, GraphName, graph_iri
from deixis.memory.semantic.rdf.ledger import Operation, Triples, deletion, insertion, quad_of

BUILD = (
    f"INSERT {{ GRAPH {MERGED} {{ ?s ?p ?o }} }} WHERE {{ VALUES ?g {{ "
    f"{' '.join(str(graph_iri(name)) for name in UNION)} }} GRAPH ?g {{ ?s ?p ?o }} }}"
)


def default_graph(store: ox.Store) -> list[ox.NamedNode]:
    """Return the non-empty graphs that a query without GRAPH reads; none of them share a triple.

    Parameters
    ----------
    store
        The memory.

    Returns
    -------
    list of ox.NamedNode
        Names of the graphs.
    """
    if store.contains_named_graph(MERGED):
        return [MERGED]
    graphs = [graph_iri(name) for name in UNION]
    return [graph for graph in graphs if any(store.quads_for_pattern(None, None, None, graph))] or graphs


def merging(store: ox.Store, added: Triples, removed: Triples) -> Iterator[Operation]:
    """Yield the operations that update the union for a change; they are run after those of the change.

    Parameters
    ----------
    store
        The memory before the change.
    added, removed
        Triples of the change by graph.

    Yields
    ------
    Operation
        An operation.
    """
    if store.contains_named_graph(MERGED):
        gone = {triple for name in UNION for triple in removed.get(name, ())}
        yield from deletion(MERGED, [t for t in gone if not any(_after(store, n, t, added, removed) for n in UNION)])
        yield from insertion(MERGED, {triple for name in UNION for triple in added.get(name, ())})


def building(store: ox.Store, added: Triples, removed: Triples) -> Iterator[str]:
    """Yield the SPARQL operation that builds the union, if it does not exist and a change makes the graphs overlap.

    Parameters
    ----------
    store
        The memory before the change.
    added, removed
        Triples of the change by graph.

    Yields
    ------
    str
        The operation; nothing if it is not needed.
    """
    if not store.contains_named_graph(MERGED) and overlapping(store, added, removed):
        yield BUILD


def overlapping(store: ox.Store, added: Triples, removed: Triples) -> bool:
    """Return whether a change adds a triple to a graph that another graph has after it.

    Parameters
    ----------
    store
        The memory before the change.
    added, removed
        Triples of the change by graph.

    Returns
    -------
    bool
        True if it does.
    """
    by_subject: dict[GraphName, dict[object, list[ox.Triple]]] = {name: defaultdict(list) for name in UNION}
    for name in UNION:
        for triple in added.get(name, ()):
            by_subject[name][triple.subject].append(triple)
    for name in UNION:
        for other in UNION:
            graph = graph_iri(other)
            for subject, triples in by_subject[name].items() if other is not name else ():
                spoken_of = subject in by_subject[other] or any(store.quads_for_pattern(subject, None, None, graph))  # type: ignore[arg-type]
                if spoken_of and any(_after(store, other, triple, added, removed) for triple in triples):
                    return True
    return False


def _after(store: ox.Store, name: GraphName, triple: ox.Triple, added: Triples, removed: Triples) -> bool:
    """Return whether a graph has a triple after the change."""
    if triple in added.get(name, ()):
        return True
    return triple not in removed.get(name, ()) and quad_of(triple, graph_iri(name)) in store


def merge_if_overlapping(store: ox.Store) -> None:
    """Build the union in a store that was filled in bulk, if the three graphs overlap.

    Parameters
    ----------
    store
        The memory, which is changed.
    """
    if store.contains_named_graph(MERGED):
        return
    by_size = sorted(UNION, key=lambda name: _size(store, name))
    for position, small in enumerate(by_size[:-1]):
        for quad in store.quads_for_pattern(None, None, None, graph_iri(small)):
            if any(quad_of(quad.triple, graph_iri(large)) in store for large in by_size[position + 1 :]):
                store.update(BUILD)
                return


def _size(store: ox.Store, name: GraphName) -> int:
    solutions = store.query("SELECT (COUNT(*) AS ?n) { ?s ?p ?o }", default_graph=graph_iri(name))
    assert isinstance(solutions, ox.QuerySolutions)
    return int(next(solutions)["n"].value)
