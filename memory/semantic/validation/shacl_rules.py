"""SHACL rules applied to triples until nothing new follows, and again where triples are added.

Source: SHACL Advanced Features (W3C Working Group Note, 8 June 2017), section 8: rules run by ``sh:order``, over the
focus nodes of their shape that meet their conditions; here they are iterated to the fixpoint. A triple that is added
makes a rule look again at those focus nodes alone that it can reach: by the rule's paths; at all of them where a
condition or a CONSTRUCT query names its predicate.

Rules are taken to be monotone: a conclusion stays, even where a triple that comes later breaks a condition such as
``sh:maxCount``, or ``sh:class`` of all values. Where facts go, start anew.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import product

import pyoxigraph as ox

from deixis.errors import OntologyError
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.memory.semantic.validation.focus_data import SUB_CLASS_OF, Node, View
from deixis.memory.semantic.validation.rule_parsing import Rule, SparqlRule, Steps, TripleRule, parse_rules
from deixis.reasoning.errors import LimitError

MAX_ROUNDS = 1000
"""Rounds after which a set of rules is taken to make ever new triples."""

_GRAPH = graph_iri(GraphName.ASSERTED)
_THIS = ox.Variable("this")


class RuleInference:
    """Triples, and what some SHACL rules make of them.

    >>> rule = '''@prefix sh: <http://www.w3.org/ns/shacl#> . @prefix : <urn:> .
    ... :S sh:targetSubjectsOf :on ; sh:rule [ a sh:TripleRule ;
    ...     sh:subject [ sh:path :on ] ; sh:predicate :under ; sh:object sh:this ] .'''
    >>> known = RuleInference([quad.triple for quad in ox.parse(rule, format=ox.RdfFormat.TURTLE)])
    >>> a, on, b = (ox.NamedNode(f"urn:{name}") for name in ("a", "on", "b"))
    >>> [str(triple) for triple in known.add([ox.Triple(a, on, b)])]
    ['<urn:b> <urn:under> <urn:a>']
    """

    def __init__(self, shapes: Iterable[ox.Triple], triples: Iterable[ox.Triple] = ()) -> None:
        self._rules = parse_rules(shapes)
        self._store = ox.Store()
        self._view = View(self._store)
        self._inferred: dict[ox.Triple, None] = {}
        self.focus_nodes_looked_at = 0
        self.add(triples)

    @property
    def inferred(self) -> tuple[ox.Triple, ...]:
        """The triples that follow and were not stated, in the order found."""
        return tuple(self._inferred)

    def add(self, triples: Iterable[ox.Triple]) -> tuple[ox.Triple, ...]:
        """Adds triples; gives those that follow now and did not before.

        Raises LimitError where the rules make ever new triples, OntologyError where one makes a blank node or what is
        no triple.
        """
        stated = list(triples)
        for triple in stated:
            self._inferred.pop(triple, None)
        fresh = self._keep(stated)
        pending: list[set[Node]] = [set() for _ in self._rules]
        found: list[ox.Triple] = []
        self._notice(fresh, pending)
        for _ in range(MAX_ROUNDS * max(1, len(self._rules))):
            due = next((number for number, nodes in enumerate(pending) if nodes), None)
            if due is None:
                return tuple(found)
            nodes, pending[due] = pending[due], set()
            concluded = dict.fromkeys(self._concluded(self._rules[due], nodes))
            fresh = self._keep(concluded)
            self._inferred.update(dict.fromkeys(fresh))
            found += fresh
            self._notice(fresh, pending)
        raise LimitError(f"the rules make ever new triples: {len(found)} so far; see which rule feeds itself")

    def _keep(self, triples: Iterable[ox.Triple]) -> list[ox.Triple]:
        """Those triples that are new, now stored."""
        fresh = [triple for triple in dict.fromkeys(triples) if _quad(triple) not in self._store]
        self._store.extend(_quad(triple) for triple in fresh)
        if fresh:
            self._view = View(self._store)
        return fresh

    # ---- which focus nodes to look at

    def _notice(self, fresh: Sequence[ox.Triple], pending: list[set[Node]]) -> None:
        for rule, nodes in zip(self._rules, pending, strict=True):
            near: set[Node] = set()
            everywhere = any(self._concerns_all(rule, triple) for triple in fresh)
            if not everywhere:
                near = {node for triple in fresh for node in self._reached(rule, triple)}
            nodes |= self._targets(rule) if everywhere else {node for node in near if self._is_target(rule, node)}

    def _concerns_all(self, rule: Rule, triple: ox.Triple) -> bool:
        """Whether a triple may matter to every focus node of a rule."""
        if triple.predicate in rule.watched or (triple.predicate == SUB_CLASS_OF and bool(rule.target.classes)):
            return True
        if isinstance(rule.conclusion, SparqlRule):
            mentioned = rule.conclusion.mentioned
            return mentioned is None or triple.predicate.value in mentioned
        return False

    def _reached(self, rule: Rule, triple: ox.Triple) -> Iterator[Node]:
        """The nodes that a triple may have made focus nodes, or from which a path of the rule leads through it."""
        yield triple.subject
        yield triple.object
        if isinstance(rule.conclusion, TripleRule):
            for path in rule.conclusion.paths:
                for place, (predicate, forwards) in enumerate(path):
                    if predicate == triple.predicate:
                        start = triple.subject if forwards else triple.object
                        back = tuple((step, not ahead) for step, ahead in reversed(path[:place]))
                        yield from self._ends(start, back)

    def _targets(self, rule: Rule) -> set[Node]:
        target = rule.target
        found = {node for kind in target.classes for node in self._view.instances(kind)} | target.nodes
        found |= {node for predicate in target.subjects_of for node in self._view.subjects_of(predicate)}
        return found | {node for predicate in target.objects_of for node in self._view.objects_of(predicate)}

    def _is_target(self, rule: Rule, node: Node) -> bool:
        target = rule.target
        return (
            node in target.nodes
            or any(self._view.is_a(node, kind) for kind in target.classes)
            or any(self._view.values(node, predicate) for predicate in target.subjects_of)
            or any(self._view.subjects(predicate, node) for predicate in target.objects_of)
        )

    # ---- what a rule concludes

    def _concluded(self, rule: Rule, nodes: Iterable[Node]) -> Iterator[ox.Triple]:
        for node in sorted(nodes, key=str):
            self.focus_nodes_looked_at += 1
            if all(check(self._view, node) for check in rule.conditions):
                if isinstance(rule.conclusion, SparqlRule):
                    yield from self._constructed(rule.conclusion, node)
                else:
                    yield from self._combined(rule.conclusion, node)

    def _combined(self, rule: TripleRule, node: Node) -> Iterator[ox.Triple]:
        parts = (self._values(part, node) for part in (rule.subject, rule.predicate, rule.object))
        for subject, predicate, object in product(*parts):
            if isinstance(subject, ox.Literal | ox.Triple) or not isinstance(predicate, ox.NamedNode):
                raise OntologyError(f"a rule concludes what is no triple: {subject} {predicate} {object}")
            yield ox.Triple(subject, predicate, object)

    def _values(self, part: Node | Steps, node: Node) -> list[Node]:
        return sorted(self._ends(node, part), key=str) if isinstance(part, tuple) else [part]

    def _ends(self, node: Node, path: Steps) -> set[Node]:
        """The nodes at the ends of a path."""
        here = {node}
        for predicate, forwards in path:
            follow = self._view.values if forwards else lambda n, p: self._view.subjects(p, n)
            here = {end for start in here for end in follow(start, predicate)}
        return here

    def _constructed(self, rule: SparqlRule, node: Node) -> Iterator[ox.Triple]:
        found = self._store.query(
            rule.construct,
            default_graph=_GRAPH,
            substitutions={_THIS: node},
        )
        assert isinstance(found, ox.QueryTriples)
        for triple in found:
            if not all(self._is_known(part) for part in (triple.subject, triple.object)):
                raise OntologyError("a rule makes a blank node, so that there would be no end: give it a name")
            yield triple

    def _is_known(self, node: Node) -> bool:
        """Whether a node has a name, or was there before."""
        if not isinstance(node, ox.BlankNode):
            return True
        forwards = self._store.quads_for_pattern(node, None, None, _GRAPH)
        return any(forwards) or any(self._store.quads_for_pattern(None, None, node, _GRAPH))


def _quad(triple: ox.Triple) -> ox.Quad:
    return ox.Quad(triple.subject, triple.predicate, triple.object, _GRAPH)
