"""SHACL shapes compiled to fast checks that accept well-formed data, which is nearly all data.

A check returns True only where it is certain; all doubtful nodes go to pyshacl, which decides and writes the report.
The constraints that ``ontology/shapes.ttl`` uses are supported, on paths of one step. A shape with any other part is an
error. Shapes that only warn are left out, as they reject nothing. Compiling takes 2.9 times as long from a
``pyoxigraph.Store`` as from the dictionary of nodes that is used here.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import pyoxigraph as ox

from deixis.errors import OntologyError
from deixis.memory.semantic.rdf.after import Node
from deixis.memory.semantic.rdf.package import SHAPES_FILE
from deixis.memory.semantic.validation.constraints import CONSTRAINTS, Values
from deixis.memory.semantic.validation.focus_data import TYPE, FocusData

SH = "http://www.w3.org/ns/shacl#"
_FIRST = ox.NamedNode("http://www.w3.org/1999/02/22-rdf-syntax-ns#first")
_REST = ox.NamedNode("http://www.w3.org/1999/02/22-rdf-syntax-ns#rest")

Check = Callable[[FocusData, Node], bool]
Properties = dict[ox.NamedNode, list[Node]]


def _sh(name: str) -> ox.NamedNode:
    return ox.NamedNode(SH + name)


_NO_CONSTRAINT = {
    TYPE, _sh("path"), _sh("name"), _sh("message"), _sh("severity"), _sh("property"), _sh("targetClass"),
    _sh("targetSubjectsOf"), _sh("targetObjectsOf"), ox.NamedNode("http://www.w3.org/2000/01/rdf-schema#label"),
}  # fmt: skip


_TARGETS = tuple(_sh(name) for name in ("targetClass", "targetSubjectsOf", "targetObjectsOf"))
_CLASSES = {
    ox.NamedNode("http://www.w3.org/2000/01/rdf-schema#Class"), ox.NamedNode("http://www.w3.org/2002/07/owl#Class"),
}  # fmt: skip


@dataclass(frozen=True)
class Shape:
    """A node shape: its targets, and the checks of a focus node."""

    classes: tuple[Node, ...]
    subjects_of: tuple[ox.NamedNode, ...]
    objects_of: tuple[ox.NamedNode, ...]
    checks: tuple[Check, ...]

    def targets(self, view: FocusData, node: Node) -> bool:
        """Return whether a node is a focus node of the shape.

        Parameters
        ----------
        view
            Data after a change.
        node
            Node of the data.

        Returns
        -------
        bool
            True if a class or a predicate of the node is a target.
        """
        return (
            not view.classes(node).isdisjoint(self.classes)
            or any(view.some(node, predicate, 1) for predicate in self.subjects_of)
            or any(view.leads_here(predicate, node) for predicate in self.objects_of)
        )

    def sure(self, view: FocusData, node: Node) -> bool:
        """Return True if a focus node certainly conforms.

        Parameters
        ----------
        view
            Data after a change.
        node
            Focus node of the shape.

        Returns
        -------
        bool
            False if the node is doubtful, so that it must be checked in full.
        """
        return all(check(view, node) for check in self.checks)

    def focus(self, view: FocusData) -> set[Node]:
        """Return all focus nodes of the shape.

        Parameters
        ----------
        view
            Data after a change.

        Returns
        -------
        set of Node
            Nodes that the shape targets.
        """
        found = {node for kind in self.classes for node in view.instances(kind)}
        for predicate in self.subjects_of:
            found |= view.subjects_of(predicate)
        for predicate in self.objects_of:
            found |= view.objects_of(predicate)
        return found


@dataclass(frozen=True)
class Shapes:
    """Compiled shapes, with the classes and paths by which a change can affect them."""

    shapes: tuple[Shape, ...]
    classes: frozenset[Node]
    paths_to_classes: frozenset[ox.NamedNode]

    @property
    def objects_of(self) -> frozenset[ox.NamedNode]:
        """Predicates whose objects a shape targets."""
        return frozenset(predicate for shape in self.shapes for predicate in shape.objects_of)

    def sure(self, view: FocusData, node: Node) -> bool:
        """Return True if a node certainly conforms to every shape that targets it.

        For a node with many statements only the change is checked; a shape that did not target it before counts as
        doubtful.

        Parameters
        ----------
        view
            Data after a change.
        node
            Node of the data.

        Returns
        -------
        bool
            False if the node is doubtful for one of the shapes.
        """
        return all(
            shape.sure(view, node) and not (view.says_much(node) and not shape.targets(view.before, node))
            for shape in self.shapes
            if shape.targets(view, node)
        )


@lru_cache(maxsize=1)
def packaged_shapes() -> Shapes:
    """Return the packaged shapes, compiled once."""
    return compile_shapes(SHAPES_FILE)


def compile_shapes(file: Path) -> Shapes:
    """Compile a Turtle file of shapes.

    Parameters
    ----------
    file
        File of shapes.

    Returns
    -------
    Shapes
        Shapes with the classes and paths that they use.

    Raises
    ------
    OntologyError
        If the file has an unsupported constraint.
    """
    compiler = _Compiler(ox.parse(path=file, format=ox.RdfFormat.TURTLE))
    shapes = tuple(compiler.node_shape(node) for node in compiler.node_shapes())
    compiler.require_all_read()
    targets = {kind for shape in shapes for kind in shape.classes}
    return Shapes(shapes, frozenset(targets | compiler.classes), frozenset(compiler.paths_to_classes))


class _Compiler:
    def __init__(self, quads: Iterable[ox.Quad]) -> None:
        self._properties: dict[Node, Properties] = defaultdict(lambda: defaultdict(list))
        for quad in quads:
            self._properties[quad.subject][quad.predicate].append(quad.object)
        self._read: set[Node] = set()
        self.classes: set[Node] = set()
        self.paths_to_classes: set[ox.NamedNode] = set()

    def node_shapes(self) -> list[Node]:
        return [node for node, properties in self._properties.items() if _sh("NodeShape") in properties[TYPE]]

    def require_all_read(self) -> None:
        """Raise OntologyError where a triple with a SHACL term was not compiled."""
        for node, properties in self._properties.items():
            words = [
                predicate.value for predicate in properties if predicate.value.startswith(SH) and properties[predicate]
            ]
            if words and node not in self._read:
                raise OntologyError(f"the shape {node}, with <{words[0]}>, is of an unsupported form")

    def _properties_of(self, node: Node) -> Properties:
        self._read.add(node)
        return self._properties[node]

    def node_shape(self, node: Node) -> Shape:
        properties = self._properties_of(node)
        if not _CLASSES.isdisjoint(properties[TYPE]):
            raise OntologyError(f"the shape {node} must not be a class: use sh:targetClass instead")
        if properties[_sh("path")]:
            raise OntologyError(f"the shape {node} must be a node shape, without a path")
        checks = []
        for part in properties[_sh("property")]:
            inner = self._properties_of(part)
            if inner[_sh("property")] or any(inner[target] for target in _TARGETS):
                raise OntologyError(f"the property shape {part} must not have a target or a property shape")
            checks += self._shape(inner)
        return Shape(
            classes=tuple(properties[_sh("targetClass")]),
            subjects_of=_names(properties[_sh("targetSubjectsOf")]),
            objects_of=_names(properties[_sh("targetObjectsOf")]),
            checks=(*self._shape(properties), *checks),
        )

    def _shape(self, properties: Properties) -> list[Check]:
        """Return the checks of a node shape or a property shape; none for a shape that rejects nothing."""
        if properties[_sh("severity")] not in ([], [_sh("Violation")]):
            self._leave_out(properties)
            return []
        path = properties[_sh("path")]
        values = self._path(path[0]) if path else _ITSELF
        return [
            self._constraint(predicate, properties, values)
            for predicate in list(properties)
            if predicate not in _NO_CONSTRAINT
        ]

    def _leave_out(self, properties: Properties) -> None:
        """Mark all triples of a shape as read."""
        parts = [
            part
            for values in properties.values()
            for part in values
            if part in self._properties and part not in self._read
        ]
        for part in parts:
            self._leave_out(self._properties_of(part))

    def _path(self, path: Node) -> Values:
        inverse = self._properties_of(path)[_sh("inversePath")] if isinstance(path, ox.BlankNode) else []
        if _names(inverse):
            return _Backwards(_names(inverse)[0])
        if not isinstance(path, ox.NamedNode):
            raise OntologyError("the path of a shape must be one step, forwards or sh:inversePath")
        return _Forwards(path)

    def _constraint(self, predicate: ox.NamedNode, properties: Properties, values: Values) -> Check:
        name, arguments = predicate.value.removeprefix(SH), properties[predicate]
        if name == "or":
            return _all_of([self._or(head, values, properties) for head in arguments])
        if name == "in":
            arguments = [item for head in arguments for item in self._list(head)]
        if name == "class":
            self.classes.update(arguments)
            self.paths_to_classes.update(_names(properties[_sh("path")]))
        make = CONSTRAINTS.get(name)
        if make is None:
            raise OntologyError(
                f"the constraint <{predicate.value}> is not known to memory/semantic/validation/constraints.py"
            )
        return make(values, arguments)

    def _or(self, head: Node, values: Values, outer: Properties) -> Check:
        outer_path = outer[_sh("path")]
        cases = [self._case(self._properties_of(item), outer_path) for item in self._list(head)]
        if outer_path:  # an alternative for each value of the outer path
            return lambda view, node: all(any(case(view, value) for case in cases) for value in values(view, node))
        return lambda view, node: any(case(view, node) for case in cases)

    def _case(self, properties: Properties, outer_path: list[Node]) -> Check:
        """Return one alternative of sh:or, checked for one value; a class in it applies to values of the outer path."""
        if properties[_sh("property")] or any(properties[target] for target in _TARGETS):
            raise OntologyError("an alternative of sh:or must not have a target or a property shape")
        if properties[_sh("path")] or not outer_path:
            return _all_of(self._shape(properties))
        placed: Properties = defaultdict(list, {**properties, _sh("path"): outer_path})
        return _all_of([self._constraint(p, placed, _ITSELF) for p in list(properties) if p not in _NO_CONSTRAINT])

    def _list(self, head: Node) -> list[Node]:
        items = []
        while first := self._properties[head][_FIRST]:
            items.append(first[0])
            head = self._properties[head][_REST][0]
        return items


def _names(nodes: Iterable[Node]) -> tuple[ox.NamedNode, ...]:
    return tuple(node for node in nodes if isinstance(node, ox.NamedNode))


class _Itself:
    """The path of no steps: the node itself."""

    def __call__(self, view: FocusData, node: Node) -> Iterable[Node]:
        return (node,)

    def some(self, view: FocusData, node: Node, number: int) -> Iterable[Node]:
        return (node,)[:number]

    fresh = __call__


@dataclass(frozen=True)
class _Forwards:
    """The path to the objects of a predicate."""

    predicate: ox.NamedNode

    def __call__(self, view: FocusData, node: Node) -> Iterable[Node]:
        return view.values(node, self.predicate)

    def some(self, view: FocusData, node: Node, number: int) -> Iterable[Node]:
        return view.some(node, self.predicate, number)

    def fresh(self, view: FocusData, node: Node) -> Iterable[Node]:
        return view.fresh(node, self.predicate)


@dataclass(frozen=True)
class _Backwards:
    """The path to the subjects of a predicate."""

    predicate: ox.NamedNode

    def __call__(self, view: FocusData, node: Node) -> Iterable[Node]:
        return view.subjects(self.predicate, node)

    def some(self, view: FocusData, node: Node, number: int) -> Iterable[Node]:
        return list(view.subjects(self.predicate, node))[:number]

    fresh = __call__


_ITSELF = _Itself()


def _all_of(checks: Sequence[Check]) -> Check:
    return lambda view, node: all(check(view, node) for check in checks)
