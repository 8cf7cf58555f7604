"""The data that shapes are checked on: a store as it would be after a change, read node by node."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

import pyoxigraph as ox

from deixis.memory.semantic.rdf.change import Change
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.ontology.vocabulary import W3C

Node = ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple

DATA = tuple(name for name in GraphName if name is not GraphName.SHAPES)
"""The graphs whose union is checked."""

TYPE = ox.NamedNode(W3C.RDF_TYPE)
SUB_CLASS_OF = ox.NamedNode(W3C.RDFS_SUB_CLASS_OF)


class View:
    """The union of the data graphs of a store after a change that is not written yet."""

    def __init__(self, store: ox.Store, change: Change | None = None) -> None:
        self._store = store
        self._names: dict[object, GraphName] = {graph_iri(name): name for name in DATA}
        self._removed = change.removed if change else {}
        self._added = ox.Store()
        for name in DATA:
            coming = change.added.get(name, ()) if change else ()
            self._added.bulk_extend(ox.Quad(triple.subject, triple.predicate, triple.object) for triple in coming)
        self._about: dict[Node, dict[ox.NamedNode, set[Node]]] = {}
        self._broader: dict[Node, frozenset[Node]] = {}

    def about(self, node: Node) -> dict[ox.NamedNode, set[Node]]:
        """What is said of a node, by predicate."""
        known = self._about.get(node)
        if known is None:
            known = self._about[node] = defaultdict(set)
            if isinstance(node, ox.NamedNode):
                for quad in self._store.quads_for_pattern(node, None, None, None):
                    if self._stays(quad):
                        known[quad.predicate].add(quad.object)
            if isinstance(node, ox.NamedNode | ox.BlankNode):
                for quad in self._added.quads_for_pattern(node, None, None):
                    known[quad.predicate].add(quad.object)
        return known

    def values(self, node: Node, predicate: ox.NamedNode) -> Iterable[Node]:
        """The objects of a node under a predicate."""
        return self.about(node).get(predicate, ())

    def subjects(self, predicate: ox.NamedNode, node: Node) -> set[Node]:
        """The nodes that lead to this one under a predicate."""
        found: set[Node] = {quad.subject for quad in self._added.quads_for_pattern(None, predicate, node)}
        if isinstance(node, ox.NamedNode | ox.Literal):
            quads = self._store.quads_for_pattern(None, predicate, node, None)
            found.update(quad.subject for quad in quads if self._stays(quad))
        return found

    def _stays(self, quad: ox.Quad) -> bool:
        name = self._names.get(quad.graph_name)
        return name is not None and not (self._removed.get(name) and quad.triple in self._removed[name])

    def is_a(self, node: Node, kind: Node) -> bool:
        """Whether a node is an instance of a class, or of a narrower one."""
        return any(kind in self.broader(type) for type in self.values(node, TYPE))

    def broader(self, kind: Node) -> frozenset[Node]:
        """A class and all that it is a sub-class of."""
        known = self._broader.get(kind)
        if known is None:
            known = self._broader[kind] = frozenset(self._closure(kind, upwards=True))
        return known

    def narrower(self, kind: Node) -> frozenset[Node]:
        """A class and all of its sub-classes."""
        return frozenset(self._closure(kind, upwards=False))

    def _closure(self, kind: Node, upwards: bool) -> set[Node]:
        seen, todo = {kind}, [kind]
        while todo:
            node = todo.pop()
            near = self.values(node, SUB_CLASS_OF) if upwards else self.subjects(SUB_CLASS_OF, node)
            new = set(near) - seen
            seen |= new
            todo += new
        return seen

    def instances(self, kind: Node) -> Iterator[Node]:
        """The instances of a class and of its sub-classes."""
        for narrower in self.narrower(kind):
            yield from self.subjects(TYPE, narrower)

    def subjects_of(self, predicate: ox.NamedNode) -> set[Node]:
        """The nodes of which a predicate is used, in the store alone."""
        return {
            quad.subject for quad in self._store.quads_for_pattern(None, predicate, None, None) if self._stays(quad)
        }

    def objects_of(self, predicate: ox.NamedNode) -> set[Node]:
        """The nodes that a predicate leads to, in the store alone."""
        return {quad.object for quad in self._store.quads_for_pattern(None, predicate, None, None) if self._stays(quad)}
