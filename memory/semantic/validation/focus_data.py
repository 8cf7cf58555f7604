"""Data that shapes are checked on: a store after a change, read node by node."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import cached_property
from itertools import islice

import pyoxigraph as ox

from deixis.memory.semantic.rdf.after import DATA, After, Node
from deixis.memory.semantic.rdf.change import Change
from deixis.ontology.rdf.vocabulary import W3C

TYPE = ox.NamedNode(W3C.RDF_TYPE)
SUB_CLASS_OF = ox.NamedNode(W3C.RDFS_SUB_CLASS_OF)

MAX_READ_AT_ONCE = 48
"""Maximum number of statements about a node, lessons' copies included, that are read at once.

More are read predicate by predicate. A category that a thousand lessons taught, or the size of a kind from a thousand
scenes, leads to all of them, and a check must not read all of these for one more lesson.
"""


class FocusData:
    """Union of the data graphs of a store after a change that is not written yet."""

    def __init__(self, store: ox.Store, change: Change | None = None) -> None:
        self._store, self._after, self._whole = store, After(store, change), change is None
        self._about: dict[Node, dict[ox.NamedNode, set[Node]] | None] = {}
        self._values: dict[tuple[Node, ox.NamedNode], set[Node]] = {}
        self._broader: dict[Node, frozenset[Node]] = {}
        self._classes: dict[Node, frozenset[Node]] = {}

    @cached_property
    def before(self) -> FocusData:
        """The data before the change."""
        return FocusData(self._store)

    def says_much(self, node: Node) -> bool:
        """Return whether a node has too many statements to be read at once, so that it is read predicate by predicate.

        Parameters
        ----------
        node
            Subject of the statements.

        Returns
        -------
        bool
            False for a node whose statements are all read at once.
        """
        return self._read_at_once(node) is None

    def about(self, node: Node) -> dict[ox.NamedNode, set[Node]]:
        """Return the objects of a node, by predicate.

        Parameters
        ----------
        node
            Subject of the statements.

        Returns
        -------
        dict
            Objects by predicate, after the change.
        """
        found = self._read_at_once(node)
        if found is None:
            found = defaultdict(set)
            for name in DATA:
                for triple in self._after.triples(name, node):
                    found[triple.predicate].add(triple.object)
        return found

    def _read_at_once(self, node: Node) -> dict[ox.NamedNode, set[Node]] | None:
        """Return the objects of a node, by predicate; None where there are many."""
        if node not in self._about:
            self._about[node] = self._read(node)
        return self._about[node]

    def _read(self, node: Node) -> dict[ox.NamedNode, set[Node]] | None:
        found: dict[ox.NamedNode, set[Node]] = defaultdict(set)
        if isinstance(node, ox.NamedNode | ox.BlankNode):
            quads = list(islice(self._store.quads_for_pattern(node, None, None, None), MAX_READ_AT_ONCE + 1))
            if len(quads) > MAX_READ_AT_ONCE:
                return None
            for triple in self._after.of_data(quads):
                found[triple.predicate].add(triple.object)
            for name in DATA:
                for triple in self._after.coming(name, node):
                    found[triple.predicate].add(triple.object)
        return found

    def values(self, node: Node, predicate: ox.NamedNode) -> Iterable[Node]:
        """Return the objects of a node for a predicate.

        Parameters
        ----------
        node
            Subject of the statements.
        predicate
            Their predicate.

        Returns
        -------
        Iterable[Node]
            Distinct objects.
        """
        objects = self._read_at_once(node)
        if objects is not None:
            return objects.get(predicate, ())
        known = self._values.get((node, predicate))
        if known is None:
            known = set(self._objects(node, predicate))
            self._values[node, predicate] = known
        return known

    def some(self, node: Node, predicate: ox.NamedNode, number: int) -> Iterable[Node]:
        """Return at most ``number`` objects of a node for a predicate.

        Parameters
        ----------
        node
            Subject of the statements.
        predicate
            Their predicate.
        number
            Maximum number of objects.

        Returns
        -------
        Iterable[Node]
            Distinct objects; as few as possible are read.
        """
        objects = self._read_at_once(node)
        if objects is not None:
            return list(objects.get(predicate, ()))[:number]
        each = self._objects(node, predicate)
        found: set[Node] = set()
        while len(found) < number and (value := next(each, None)) is not None:
            found.add(value)
        return found

    def _objects(self, node: Node, predicate: ox.NamedNode) -> Iterator[Node]:
        """Yield the objects of a node with many statements, graph by graph; some may occur twice."""
        if self._after.says(node, predicate):
            for name in DATA:
                for triple in self._after.triples(name, node, predicate):
                    yield triple.object

    def fresh(self, node: Node, predicate: ox.NamedNode) -> Iterable[Node]:
        """Return the new objects of a node for a predicate, and those whose class the change may have altered.

        Where there are few objects, and where there is no change, return all of them.

        Parameters
        ----------
        node
            Subject of the statements.
        predicate
            Their predicate.

        Returns
        -------
        Iterable[Node]
            Objects that must be checked again.
        """
        if self._whole or not self.says_much(node):
            return self.values(node, predicate)
        new = {triple.object for name in DATA for triple in self._after.coming(name, node, predicate)}
        return new | self._to_untyped.get((node, predicate), set())

    @cached_property
    def _to_untyped(self) -> dict[tuple[Node, ox.NamedNode], set[Node]]:
        """Nodes that lose a class, or whose class loses a broader one, by their subject and predicate."""
        removed = [triple for name in DATA for triple in self._after.change.removed.get(name, ())]
        untyped: set[Node] = {triple.subject for triple in removed if triple.predicate == TYPE}
        for kind in {triple.subject for triple in removed if triple.predicate == SUB_CLASS_OF}:
            untyped.update(self.before.instances(kind))
        found: dict[tuple[Node, ox.NamedNode], set[Node]] = defaultdict(set)
        for node in untyped:
            for triple in self.leading(node):
                found[triple.subject, triple.predicate].add(node)
        return found

    def subjects(self, predicate: ox.NamedNode, node: Node) -> set[Node]:
        """Return the subjects of a predicate with this node as object.

        Parameters
        ----------
        predicate
            Predicate of the statements.
        node
            Their object.

        Returns
        -------
        set of Node
            Distinct subjects.
        """
        return {triple.subject for triple in self.leading(node, predicate)}

    def leads_here(self, predicate: ox.NamedNode, node: Node) -> bool:
        """Return whether this node is an object of a predicate.

        Parameters
        ----------
        predicate
            Predicate of the statements.
        node
            Their object.

        Returns
        -------
        bool
            False if there is no such statement.
        """
        return any(True for _ in self.leading(node, predicate))

    def leading(self, node: Node, predicate: ox.NamedNode | None = None) -> Iterator[ox.Triple]:
        """Yield the triples with a node as object, for one predicate or all; a triple may occur twice.

        Parameters
        ----------
        node
            Object of the triples.
        predicate
            Their predicate; None matches all.

        Yields
        ------
        Triple
            Triples of all data graphs.
        """
        if isinstance(node, ox.NamedNode | ox.Literal | ox.BlankNode):
            yield from self._after.of_data(self._store.quads_for_pattern(None, predicate, node, None))
            for name in DATA:
                yield from self._after.arriving(name, predicate, node)

    def is_a(self, node: Node, kind: Node) -> bool:
        """Return whether a node is an instance of a class or of a sub-class of it.

        Parameters
        ----------
        node
            Node of the data.
        kind
            Class.

        Returns
        -------
        bool
            False for a node without a class.
        """
        return kind in self.classes(node)

    def classes(self, node: Node) -> frozenset[Node]:
        """Return the classes of a node, with all their super-classes.

        Parameters
        ----------
        node
            Node of the data.

        Returns
        -------
        frozenset of Node
            Classes; empty for a node without a class.
        """
        known = self._classes.get(node)
        if known is None:
            known = self._classes[node] = frozenset[Node]().union(*map(self.broader, self.values(node, TYPE)))
        return known

    def broader(self, kind: Node) -> frozenset[Node]:
        """Return a class and all of its super-classes.

        Parameters
        ----------
        kind
            Class.

        Returns
        -------
        frozenset of Node
            Classes, with ``kind``.
        """
        known = self._broader.get(kind)
        if known is None:
            known = self._broader[kind] = frozenset(self._closure(kind, upwards=True))
        return known

    def narrower(self, kind: Node) -> frozenset[Node]:
        """Return a class and all of its sub-classes.

        Parameters
        ----------
        kind
            Class.

        Returns
        -------
        frozenset of Node
            Classes, with ``kind``.
        """
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
        """Yield the instances of a class and of its sub-classes.

        Parameters
        ----------
        kind
            Class.

        Yields
        ------
        Node
            Instances; one of several classes occurs repeatedly.
        """
        for narrower in self.narrower(kind):
            yield from self.subjects(TYPE, narrower)

    def subjects_of(self, predicate: ox.NamedNode) -> set[Node]:
        """Return all subjects of a predicate.

        Parameters
        ----------
        predicate
            Predicate of the statements.

        Returns
        -------
        set of Node
            Subjects in all data graphs.
        """
        return {triple.subject for name in DATA for triple in self._after.triples(name, None, predicate)}

    def objects_of(self, predicate: ox.NamedNode) -> set[Node]:
        """Return all objects of a predicate.

        Parameters
        ----------
        predicate
            Predicate of the statements.

        Returns
        -------
        set of Node
            Objects in all data graphs.
        """
        return {triple.object for name in DATA for triple in self._after.triples(name, None, predicate)}
