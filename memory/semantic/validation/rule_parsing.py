"""SHACL rules read from a shapes graph: what they target, under which conditions, and what they conclude.

Source: SHACL Advanced Features (W3C Working Group Note, 8 June 2017), section 8. Known here are ``sh:TripleRule``,
whose subject, predicate and object are ``sh:this``, a term, or an ``sh:path`` of steps forwards and backwards, and
``sh:SPARQLRule``; conditions are shapes of the constraints that :mod:`deixis.memory.semantic.validation.constraints`
knows.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import pyoxigraph as ox

from deixis.errors import OntologyError
from deixis.memory.semantic.queries.results import QueryKind
from deixis.memory.semantic.queries.sparql import check_query
from deixis.memory.semantic.queries.tokens import Kind, Token, tokens
from deixis.memory.semantic.rdf.files import PREFIXES
from deixis.memory.semantic.validation.compiled_shapes import SH, Check, compile_conditions
from deixis.memory.semantic.validation.focus_data import SUB_CLASS_OF, TYPE, Node
from deixis.ontology.vocabulary import W3C

Steps = tuple[tuple[ox.NamedNode, bool], ...]
"""A path: predicates, each with whether it is gone forwards."""

_RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
_CLASSES = {ox.NamedNode(W3C.OWL_CLASS), ox.NamedNode("http://www.w3.org/2000/01/rdf-schema#Class")}


@dataclass(frozen=True)
class Target:
    """What a shape's rules are about."""

    nodes: frozenset[Node]
    classes: frozenset[Node]
    subjects_of: frozenset[ox.NamedNode]
    objects_of: frozenset[ox.NamedNode]


@dataclass(frozen=True)
class TripleRule:
    """Concludes a triple of each of three paths' ends; a part that is a term alone is itself."""

    subject: Node | Steps
    predicate: Node | Steps
    object: Node | Steps

    @property
    def paths(self) -> tuple[Steps, ...]:
        return tuple(part for part in (self.subject, self.predicate, self.object) if isinstance(part, tuple))


@dataclass(frozen=True)
class SparqlRule:
    """Concludes what a CONSTRUCT query makes; ``mentioned`` holds all its predicates, or is None where some vary."""

    construct: str
    mentioned: frozenset[str] | None


@dataclass(frozen=True)
class Rule:
    """One rule of one shape; ``watched`` are the predicates that its conditions look at."""

    target: Target
    order: float
    conditions: tuple[Check, ...]
    watched: frozenset[Node]
    conclusion: TripleRule | SparqlRule


def parse_rules(shapes: Iterable[ox.Triple]) -> tuple[Rule, ...]:
    """The active rules of a shapes graph, by ``sh:order``.

    Raises OntologyError for a rule that is not whole or not known here, QueryError for a query that is refused.
    """
    reader = _Reader(list(shapes))
    return tuple(sorted(reader.rules(), key=lambda rule: rule.order))


class _Reader:
    def __init__(self, shapes: list[ox.Triple]) -> None:
        self._shapes = shapes
        self._said: dict[Node, dict[ox.NamedNode, list[Node]]] = defaultdict(lambda: defaultdict(list))
        for triple in shapes:
            self._said[triple.subject][triple.predicate].append(triple.object)

    def rules(self) -> Iterator[Rule]:
        for shape in list(self._said):
            for rule in self._all(shape, "rule"):
                if not (self._is_off(shape) or self._is_off(rule)):
                    yield self._rule(shape, rule)

    def _rule(self, shape: Node, rule: Node) -> Rule:
        shapes = [condition for condition in self._all(rule, "condition") if not self._is_off(condition)]
        checks = compile_conditions((ox.Quad(*_parts(triple)) for triple in self._shapes), shapes)
        order = self._all(rule, "order")
        return Rule(
            target=self._target(shape),
            order=float(getattr(order[0], "value", 0)) if order else 0.0,
            conditions=tuple(checks.values()),
            watched=frozenset(self._predicates(shapes)),
            conclusion=self._conclusion(rule),
        )

    def _conclusion(self, rule: Node) -> TripleRule | SparqlRule:
        kinds = self._said[rule][TYPE]
        if ox.NamedNode(SH + "SPARQLRule") in kinds:
            return self._sparql(rule)
        if ox.NamedNode(SH + "TripleRule") in kinds:
            return TripleRule(*(self._expression(self._one(rule, part)) for part in ("subject", "predicate", "object")))
        raise OntologyError(f"{rule}: a rule is an sh:TripleRule or an sh:SPARQLRule: say which by rdf:type")

    def _sparql(self, rule: Node) -> SparqlRule:
        prefixes = dict(PREFIXES)
        for ontology in self._all(rule, "prefixes"):
            for declaration in self._all(ontology, "declare"):
                prefix, base = self._one(declaration, "prefix"), self._one(declaration, "namespace")
                prefixes[str(getattr(prefix, "value", ""))] = str(getattr(base, "value", ""))
        text = str(getattr(self._one(rule, "construct"), "value", ""))
        checked = check_query(text, prefixes)
        if checked.kind is not QueryKind.CONSTRUCT:
            raise OntologyError(f"{rule}: sh:construct must be a CONSTRUCT query, not {checked.kind.upper()}")
        head = "".join(f"PREFIX {prefix}: <{base}>\n" for prefix, base in checked.prefixes.items())
        return SparqlRule(head + text, mentioned_predicates(text, prefixes))

    def _expression(self, node: Node) -> Node | Steps:
        if node == ox.NamedNode(SH + "this"):
            return ()
        if not isinstance(node, ox.BlankNode):
            return node
        path = self._one(node, "path")
        return tuple(self._step(part) for part in (self._list(path) or [path]))

    def _step(self, node: Node) -> tuple[ox.NamedNode, bool]:
        backwards = self._all(node, "inversePath")
        step = backwards[0] if backwards else node
        if not isinstance(step, ox.NamedNode):
            raise OntologyError(f"{node}: a rule's sh:path is a predicate or an sh:inversePath, or a list of these")
        return step, not backwards

    def _target(self, shape: Node) -> Target:
        implicit = {shape} if _CLASSES & set(self._said[shape][TYPE]) else set()
        return Target(
            nodes=frozenset(self._all(shape, "targetNode")),
            classes=frozenset({*self._all(shape, "targetClass"), *implicit}),
            subjects_of=frozenset(_names(self._all(shape, "targetSubjectsOf"))),
            objects_of=frozenset(_names(self._all(shape, "targetObjectsOf"))),
        )

    def _predicates(self, shapes: Iterable[Node]) -> Iterator[Node]:
        """Whatever the shapes may look at: every IRI in them, and the types and classes of things."""
        todo, seen = list(shapes), set(shapes)
        if todo:
            yield from (TYPE, SUB_CLASS_OF)
        while todo:
            for values in self._said[todo.pop()].values():
                yield from _names(values)
                new = [value for value in values if value not in seen and value in self._said]
                seen.update(new)
                todo += new

    def _is_off(self, node: Node) -> bool:
        return any(getattr(value, "value", "") in ("true", "1") for value in self._all(node, "deactivated"))

    def _all(self, node: Node, name: str) -> list[Node]:
        return self._said[node][ox.NamedNode(SH + name)] if node in self._said else []

    def _one(self, node: Node, name: str) -> Node:
        found = self._all(node, name)
        if len(found) != 1:
            raise OntologyError(f"{node}: sh:{name} must be given once, not {len(found)} times")
        return found[0]

    def _list(self, head: Node) -> list[Node]:
        items: list[Node] = []
        while first := self._said[head][ox.NamedNode(_RDF + "first")] if head in self._said else []:
            items.append(first[0])
            head = self._said[head][ox.NamedNode(_RDF + "rest")][0]
        return items


def _names(nodes: Iterable[Node]) -> Iterator[ox.NamedNode]:
    return (node for node in nodes if isinstance(node, ox.NamedNode))


def _parts(triple: ox.Triple) -> tuple[ox.NamedNode | ox.BlankNode, ox.NamedNode, Node]:
    assert not isinstance(triple.subject, ox.Triple)
    return triple.subject, triple.predicate, triple.object


def mentioned_predicates(query: str, prefixes: dict[str, str]) -> frozenset[str] | None:
    """The IRIs of every name in a query, all its predicates among them; None where a predicate may be any.

    >>> sorted(mentioned_predicates("CONSTRUCT { ?x dx:on ?y } WHERE { ?x a dx:Fork }", {"dx": "urn:"}))[0]
    'http://www.w3.org/1999/02/22-rdf-syntax-ns#type'
    """
    found = [token for token in tokens(query) if token.kind is not Kind.COMMENT]
    known = dict(prefixes)
    names: set[str] = set()
    for before, token, after in zip([None, *found], found, [*found[1:], None], strict=False):
        if token.text == "!" or "\\" in token.text or (before and after and _is_predicate(before, token, after)):
            return None
        if token.kind is Kind.WORD and token.text == "a":
            names.add(W3C.RDF_TYPE.value)
        elif token.kind is Kind.IRI:
            names.add(token.text[1:-1])
            if before and before.text.endswith(":"):
                known[before.text[:-1]] = token.text[1:-1]
        elif token.kind is Kind.NAME:
            prefix, _, local = token.text.partition(":")
            names.add(known.get(prefix, "") + local)
    return frozenset(names)


_TERMS = {Kind.VARIABLE, Kind.NAME, Kind.IRI, Kind.STRING, Kind.NUMBER}


def _is_predicate(before: Token, token: Token, after: Token) -> bool:
    """Whether a token may be a variable in the place of a predicate."""
    follows = before.kind in _TERMS or before.text in ("]", ";", ")")
    return token.kind is Kind.VARIABLE and follows and (after.kind in _TERMS or after.text in ("[", "("))
