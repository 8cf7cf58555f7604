"""A store as it will be after a change that is not written yet, one canonical graph at a time."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

import pyoxigraph as ox

from deixis.memory.semantic.rdf.change import Change
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri

DATA = tuple(name for name in GraphName if name is not GraphName.SHAPES)
"""Graphs with statements about the world, unlike those of shapes."""

Node = ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple


class After:
    """Look-ups in the canonical graphs of a store after a change; the cost of each is proportional to its results."""

    def __init__(self, store: ox.Store, change: Change | None = None) -> None:
        self.store, self.change = store, change or Change()
        self._graphs = {name: graph_iri(name) for name in GraphName}
        self._data: dict[object, GraphName] = {graph_iri(name): name for name in DATA}
        self._indexes: dict[tuple[GraphName, str], dict[object, list[ox.Triple]]] = {}

    def holds(self, name: GraphName, triple: ox.Triple) -> bool:
        """Return whether a graph has a triple after the change.

        Parameters
        ----------
        name
            Canonical graph.
        triple
            Triple to look up.

        Returns
        -------
        bool
            True also if the change adds the triple.
        """
        if triple in self.change.added.get(name, ()):
            return True
        gone = triple in self.change.removed.get(name, ())
        return not gone and ox.Quad(triple.subject, triple.predicate, triple.object, self._graphs[name]) in self.store

    def triples(
        self,
        name: GraphName,
        subject: Node | None = None,
        predicate: ox.NamedNode | None = None,
        obj: Node | None = None,
    ) -> Iterator[ox.Triple]:
        """Yield the triples of a graph with a subject, predicate and object.

        Parameters
        ----------
        name
            Canonical graph.
        subject, predicate, obj
            Terms of the triples; None matches all.

        Yields
        ------
        Triple
            Triples after the change. Those that it adds come last.
        """
        gone = self.change.removed.get(name)
        for quad in self.store.quads_for_pattern(subject, predicate, obj, self._graphs[name]):  # type: ignore[arg-type]
            triple = quad.triple
            if not gone or triple not in gone:
                yield triple
        if subject is not None:
            yield from (triple for triple in self.coming(name, subject, predicate) if obj in (None, triple.object))
        elif obj is not None:
            yield from self.arriving(name, predicate, obj)
        elif predicate is not None:
            yield from self._index(name, "predicate").get(predicate, ())
        else:
            yield from self.change.added.get(name, ())

    def coming(self, name: GraphName, subject: Node, predicate: ox.NamedNode | None = None) -> Iterator[ox.Triple]:
        """Yield the triples that the change adds about a subject.

        Parameters
        ----------
        name
            Canonical graph.
        subject
            Subject of the triples.
        predicate
            Their predicate; None matches all.

        Yields
        ------
        Triple
            Added triples of the graph.
        """
        triples = self._index(name, "subject").get(subject, ())
        return (triple for triple in triples if predicate in (None, triple.predicate))

    def arriving(self, name: GraphName, predicate: ox.NamedNode | None, obj: Node) -> Iterator[ox.Triple]:
        """Yield the triples that the change adds with an object.

        Parameters
        ----------
        name
            Canonical graph.
        predicate
            Predicate of the triples; None matches all.
        obj
            Their object.

        Yields
        ------
        Triple
            Added triples of the graph.
        """
        triples = self._index(name, "object").get(obj, ())
        return (triple for triple in triples if predicate in (None, triple.predicate))

    def _index(self, name: GraphName, by: str) -> dict[object, list[ox.Triple]]:
        """Return the triples that the change adds to a graph, by subject, predicate or object; cache them."""
        found = self._indexes.get((name, by))
        if found is None:
            found = self._indexes[name, by] = defaultdict(list)
            for triple in self.change.added.get(name, ()):
                found[getattr(triple, by)].append(triple)
        return found

    def says(self, subject: Node, predicate: ox.NamedNode) -> bool:
        """Return whether a subject can have a predicate in any graph; if not, no graph has to be read.

        Parameters
        ----------
        subject
            Subject of the triples.
        predicate
            Their predicate.

        Returns
        -------
        bool
            True also for triples that the change removes.
        """
        stored = self.store.quads_for_pattern(subject, predicate, None, None)  # type: ignore[arg-type]
        return any(True for _ in stored) or any(True for name in DATA for _ in self.coming(name, subject, predicate))

    def of_data(self, quads: Iterable[ox.Quad]) -> Iterator[ox.Triple]:
        """Yield the triples of stored quads that are in a data graph and stay there.

        Parameters
        ----------
        quads
            Quads of the store.

        Yields
        ------
        Triple
            Triples that the change does not remove.
        """
        for quad in quads:
            name = self._data.get(quad.graph_name)
            if name is not None:
                gone = self.change.removed.get(name)
                if not gone or quad.triple not in gone:
                    yield quad.triple
