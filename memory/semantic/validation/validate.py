"""Check each change by SHACL before it is written.

Only the nodes whose conformance can change are checked: compiled checks accept nodes that are certainly well formed,
and pyshacl decides about the others, on a copy of those nodes and of what their shapes reach.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import pyoxigraph as ox

from deixis.answers import count
from deixis.memory.errors import RejectedWriteError, ShapeResult
from deixis.memory.semantic.rdf.after import DATA, Node
from deixis.memory.semantic.rdf.change import Change
from deixis.memory.semantic.validation.compiled_shapes import Shapes, packaged_shapes
from deixis.memory.semantic.validation.focus_data import SUB_CLASS_OF, TYPE, FocusData

BATCH = 200
"""Number of doubtful nodes per run of pyshacl; the first run with violations ends the search."""


def check_change(store: ox.Store, change: Change) -> None:
    """Raise RejectedWriteError if the store would break the shapes after a change.

    Parameters
    ----------
    store
        Store before the change.
    change
        Change that is not written yet.

    Raises
    ------
    RejectedWriteError
        If a node that the change may alter does not conform; the error has the violations.
    """
    shapes, view = packaged_shapes(), FocusData(store, change)
    _check(shapes, view, touched(shapes, view, change))


def check_store(store: ox.Store) -> None:
    """Raise RejectedWriteError if the store breaks the shapes.

    Parameters
    ----------
    store
        Store to check as a whole.

    Raises
    ------
    RejectedWriteError
        If a node does not conform; the error has the violations.
    """
    shapes, view = packaged_shapes(), FocusData(store)
    _decide(shapes, view, {node for shape in shapes.shapes for node in shape.focus(view) if not shape.sure(view, node)})


def touched(shapes: Shapes, view: FocusData, change: Change) -> set[Node]:
    """Return the nodes whose conformance a change may alter.

    Parameters
    ----------
    shapes
        Compiled shapes.
    view
        Data after the change.
    change
        Change that is not written yet.

    Returns
    -------
    set of Node
        Nodes to check; all others conform if they did before.
    """
    found: set[Node] = set()
    for side in (change.added, change.removed):
        for name in DATA:
            for triple in side.get(name, ()):
                found.add(triple.subject)
                if triple.predicate in shapes.objects_of:
                    found.add(triple.object)
                if triple.predicate == TYPE:
                    found |= _leading_to(shapes, view, triple.subject)
                elif triple.predicate == SUB_CLASS_OF and view.broader(triple.object) & shapes.classes:
                    for node in set(view.instances(triple.subject)):
                        found |= {node, *_leading_to(shapes, view, node)}
    return found


def _leading_to(shapes: Shapes, view: FocusData, node: Node) -> set[Node]:
    """Return the subjects of a node for predicates whose objects a shape requires to be of a class."""
    return {triple.subject for triple in view.leading(node) if triple.predicate in shapes.paths_to_classes}


def _check(shapes: Shapes, view: FocusData, nodes: Iterable[Node]) -> None:
    _decide(shapes, view, {node for node in nodes if not shapes.sure(view, node)})


def _decide(shapes: Shapes, view: FocusData, nodes: set[Node]) -> None:
    """Run pyshacl on the doubtful nodes."""
    doubtful = sorted(nodes, key=str)
    for position, batch in enumerate(_batches(doubtful)):
        results = report(_copy(shapes, view, batch), batch)
        if results:
            left = len(doubtful) - (position + 1) * BATCH
            more = f"; {left} more nodes may be wrong too" if left > 0 else ""
            raise RejectedWriteError(
                f"nothing was written: it breaks the shapes in {count(len(results), 'place')}{more}", results
            )


def _batches(nodes: list[Node]) -> Iterator[list[Node]]:
    for start in range(0, len(nodes), BATCH):
        yield nodes[start : start + BATCH]


def _copy(shapes: Shapes, view: FocusData, nodes: Iterable[Node]) -> set[ox.Triple]:
    """Return the triples that the shapes reach from some nodes: their statements, and the classes of their objects."""
    copied: set[ox.Triple] = set()
    for node in nodes:
        copied.update(_about(view, node))
        copied.update(_classes(view, node))
        for predicate in shapes.objects_of:
            copied.update(_triple(other, predicate, node) for other in view.subjects(predicate, node))
    return copied


def _about(view: FocusData, node: Node) -> Iterator[ox.Triple]:
    for predicate, values in view.about(node).items():
        for value in values:
            yield _triple(node, predicate, value)
            yield from _classes(view, value)


def _classes(view: FocusData, node: Node) -> Iterator[ox.Triple]:
    for kind in view.values(node, TYPE):
        yield _triple(node, TYPE, kind)
        for narrow in view.broader(kind):
            for broad in view.values(narrow, SUB_CLASS_OF):
                yield _triple(narrow, SUB_CLASS_OF, broad)


def _triple(subject: Node, predicate: ox.NamedNode, obj: Node) -> ox.Triple:
    assert not isinstance(subject, ox.Literal)
    return ox.Triple(subject, predicate, obj)


def report(triples: Iterable[ox.Triple], nodes: Iterable[Node] | None = None) -> list[ShapeResult]:
    """Return the violations that pyshacl finds among some triples, for some focus nodes or for all.

    Parameters
    ----------
    triples
        Triples to check.
    nodes
        Focus nodes; all nodes by default.

    Returns
    -------
    list of ShapeResult
        Violations in the order of their text.
    """
    from deixis.memory.semantic.validation.shacl import violations

    return violations(triples, None if nodes is None else {str(getattr(node, "value", "")) for node in nodes})
