"""A store as it would be after a change that is not written yet, one canonical graph at a time."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

import pyoxigraph as ox

from deixis.memory.semantic.rdf.change import Change
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri

DATA = tuple(name for name in GraphName if name is not GraphName.SHAPES)
"""The graphs that say something of the world; those of shapes do not."""

Node = ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple


class After:
    """Look-ups in the canonical graphs of a store as a change leaves them; each costs what it finds."""

    def __init__(self, store: ox.Store, change: Change | None = None) -> None:
        self.store, self.change = store, change or Change()
        self._graphs = {name: graph_iri(name) for name in GraphName}
        self._data: dict[object, GraphName] = {graph_iri(name): name for name in DATA}
        self._of: dict[tuple[GraphName, Node], list[ox.Triple]] = defaultdict(list)
        self._to: dict[tuple[GraphName, Node], list[ox.Triple]] = defaultdict(list)
        for name, triples in self.change.added.items():
            for triple in triples:
                self._of[name, triple.subject].append(triple)
                self._to[name, triple.object].append(triple)

    def holds(self, name: GraphName, triple: ox.Triple) -> bool:
        """Return whether a graph holds a triple after the change."""
        if triple in self.change.added.get(name, ()):
            return True
        gone = triple in self.change.removed.get(name, ())
        return not gone and ox.Quad(triple.subject, triple.predicate, triple.object, self._graphs[name]) in self.store

    def triples(
        self,
        name: GraphName,
        subject: Node | None = None,
        predicate: ox.NamedNode | None = None,
        object: Node | None = None,
    ) -> Iterator[ox.Triple]:
        """Yield the triples of a graph with that subject, predicate and object; one of the three must be given.

        What the change adds comes last.
        """
        gone = self.change.removed.get(name)
        for quad in self.store.quads_for_pattern(subject, predicate, object, self._graphs[name]):  # type: ignore[arg-type]
            triple = quad.triple
            if not gone or triple not in gone:
                yield triple
        if subject is not None:
            yield from (triple for triple in self.coming(name, subject, predicate) if object in (None, triple.object))
        elif object is not None:
            yield from self.arriving(name, predicate, object)
        else:
            come = self.change.added.get(name, ())
            yield from (triple for triple in come if predicate in (None, triple.predicate))

    def coming(self, name: GraphName, subject: Node, predicate: ox.NamedNode | None = None) -> Iterator[ox.Triple]:
        """Yield what the change adds about a subject."""
        triples = self._of.get((name, subject), ())
        return (triple for triple in triples if predicate in (None, triple.predicate))

    def arriving(self, name: GraphName, predicate: ox.NamedNode | None, object: Node) -> Iterator[ox.Triple]:
        """Yield what the change adds that leads to an object."""
        return (triple for triple in self._to.get((name, object), ()) if predicate in (None, triple.predicate))

    def of_data(self, quads: Iterable[ox.Quad]) -> Iterator[ox.Triple]:
        """Yield the triples of those stored quads that are in a graph of data and stay there."""
        for quad in quads:
            name = self._data.get(quad.graph_name)
            if name is not None:
                gone = self.change.removed.get(name)
                if not gone or quad.triple not in gone:
                    yield quad.triple
