"""What a relation graph implies, and why: inverses, sub-properties and transitivity, as the TBox declares them.

Only firm facts are premises: affirmed, not optional, of weight 1, one relation each. Everything implied of a pair has
a derivation down to stated facts, and the shortest one is given: a relation's facts, their inverses and what they are
sub-properties of make a directed graph, in which a transitive conclusion is a path and its shortest derivation a
shortest path.

This is the seam for a full calculus: callers use :class:`Implications` and do not know how it closes the graph.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np

from deixis.ontology.errors import GraphError
from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Relation, Relations
from deixis.reasoning.closure import FAR, Component, base_edges, components, firm_edges


class Rule(StrEnum):
    """Why a fact holds."""

    STATED = "stated"
    INVERSE = "inverse"  # owl:inverseOf
    SUB_PROPERTY = "sub-property"  # rdfs:subPropertyOf
    TRANSITIVITY = "transitivity"  # owl:TransitiveProperty


@dataclass(frozen=True)
class Derivation:
    """A fact, the rule that gives it, and the derivations of what the rule needs."""

    fact: Fact
    rule: Rule
    premises: tuple[Derivation, ...] = ()

    def stated(self) -> tuple[Fact, ...]:
        """The stated facts that it rests on, without repetition, in the order of use."""
        if self.rule is Rule.STATED:
            return (self.fact,)
        return tuple(dict.fromkeys(fact for premise in self.premises for fact in premise.stated()))

    def lines(self, indent: str = "") -> Iterator[str]:
        """The derivation as indented text, conclusion first."""
        place = f"   [{self.fact.source}]" if self.rule is Rule.STATED and self.fact.source else ""
        yield f"{indent}{self.fact}   by {self.rule}{place}"
        for premise in self.premises:
            yield from premise.lines(indent + "    ")


class Implications:
    """Everything that follows from a relation graph; built at once, explained on demand.

    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> facts = [Fact("a", (r["left"],), "b"), Fact("c", (r["right"],), "b")]
    >>> implied = Implications(RelationGraph.from_facts(r, ["a", "b", "c"], facts))
    >>> print(*implied.derive(r["left"], "a", "c").lines(), sep="\\n")
    left(a, c)   by transitivity
        left(a, b)   by stated
        left(b, c)   by inverse
            right(c, b)   by stated

    Raises LimitError where facts connect more than ``MAX_CONNECTED`` objects to one another.
    """

    def __init__(self, graph: RelationGraph, sub_properties: bool = True) -> None:
        self.graph = graph
        self.vocabulary: Relations = graph.vocabulary
        self._base = base_edges(graph, sub_properties)
        self._explained: dict[tuple[int, int, int], Derivation] = {}
        self._place, self._components = components(graph, self._base)

    def holds(self, relation: Relation, subject: str, object: str) -> bool:
        """Whether the fact is stated or implied."""
        part, s, o = self._locate(subject, object)
        return part is not None and s != o and part.distance(relation)[s, o] < FAR

    def derive(self, relation: Relation, subject: str, object: str) -> Derivation | None:
        """The shortest derivation of a fact, or None where it does not follow."""
        part, s, o = self._locate(subject, object)
        if part is None or s == o or part.distance(relation)[s, o] >= FAR:
            return None
        path = part.path(relation, s, o)
        steps = [self._explain_edge(relation, int(part.nodes[u]), int(part.nodes[v])) for u, v in pairwise(path)]
        if len(steps) == 1:
            return steps[0]
        return Derivation(Fact(subject, (relation,), object), Rule.TRANSITIVITY, tuple(steps))

    def triples(self) -> Iterator[tuple[Relation, str, str]]:
        """Every fact that is stated or implied, by relation, subject and object in node order."""
        for relation in self.vocabulary.values():
            rows: list[tuple[int, int]] = []
            for part in (part for part in self._components if part.has(relation)):
                s, o = np.nonzero((part.distance(relation) < FAR) & ~np.eye(len(part.nodes), dtype=bool))
                rows += zip(part.nodes[s].tolist(), part.nodes[o].tolist(), strict=True)
            for u, v in sorted(rows):
                yield relation, self.graph.nodes[u], self.graph.nodes[v]

    def inferred(self) -> Iterator[Derivation]:
        """Every implied fact that is not stated itself, with its shortest derivation."""
        for fact in self.implied():
            derivation = self.derive(fact.relations[0], fact.subject, fact.object)
            assert derivation is not None
            yield derivation

    def implied(self) -> Iterator[Fact]:
        """Every implied fact that is not stated itself, without its derivation: cheap, however long that may be."""
        stated = {
            (self.graph.subjects[edge], self.graph.objects[edge], self.graph.relation_sets[edge])
            for edge in firm_edges(self.graph)
        }
        for relation, subject, object in self.triples():
            if (self.graph.index(subject), self.graph.index(object), relation.bit) not in stated:
                yield Fact(subject, (relation,), object)

    def steps(self, fact: Fact) -> int:
        """How many stated facts the shortest derivation of an implied fact takes; 0 where it does not follow."""
        part, s, o = self._locate(fact.subject, fact.object)
        distance = FAR if part is None or s == o else int(part.distance(fact.relations[0])[s, o])
        return 0 if distance >= FAR else distance

    def support(self, fact: Fact) -> tuple[Rule, tuple[int, ...]]:
        """By what rule an implied fact follows last, and the edges of the graph that its shortest derivation rests on.

        The same as :meth:`derive` says, without the derivation. Raises GraphError where the fact does not follow.
        """
        part, s, o = self._locate(fact.subject, fact.object)
        relation = fact.relations[0]
        if part is None or s == o or part.distance(relation)[s, o] >= FAR:
            raise GraphError(f"{fact} does not follow")
        path = part.nodes[part.path(relation, s, o)].tolist()
        if len(path) == 2:
            return self._explain_edge(relation, path[0], path[1]).rule, (self._base[relation.index][path[0], path[1]],)
        base = self._base[relation.index]
        return Rule.TRANSITIVITY, tuple(dict.fromkeys(base[pair] for pair in pairwise(path)))

    def count(self) -> int:
        """How many facts are stated or implied."""
        distances = (part.distance(r) for part in self._components for r in self.vocabulary.values() if part.has(r))
        return sum(int(np.count_nonzero(d < FAR)) - int(np.count_nonzero(d.diagonal() < FAR)) for d in distances)

    def completed(self) -> RelationGraph:
        """The graph with the implied facts as further edges, after the stated ones."""
        return RelationGraph.from_facts(
            self.vocabulary,
            self.graph.nodes,
            [*self.graph.facts(), *self.implied()],
            kinds=self.graph.kinds,
            boxes=self.graph.boxes,
        )

    def parts(self) -> Sequence[Component]:
        """The connected parts of the graph, each with its closed relations."""
        return self._components

    def _locate(self, subject: str, object: str) -> tuple[Component | None, int, int]:
        s, o = self.graph.index(subject), self.graph.index(object)
        if self._place[s, 0] != self._place[o, 0]:
            return None, 0, 0
        return self._components[self._place[s, 0]], int(self._place[s, 1]), int(self._place[o, 1])

    def _explain_edge(self, relation: Relation, subject: int, object: int) -> Derivation:
        """One edge of a relation's graph: stated, an inverse, a sub-property, or the last two in turn."""
        key = (relation.index, subject, object)
        if key not in self._explained:
            self._explained[key] = self._derive_edge(relation, subject, object)
        return self._explained[key]

    def _derive_edge(self, relation: Relation, subject: int, object: int) -> Derivation:
        stated = self.graph.fact(self._base[relation.index][subject, object])
        derivation = Derivation(stated, Rule.STATED)
        current = stated.relations[0]
        s, o = self.graph.nodes[subject], self.graph.nodes[object]
        if (stated.subject, stated.object) != (s, o):
            current = self.vocabulary[current.inverse]
            derivation = Derivation(Fact(s, (current,), o), Rule.INVERSE, (derivation,))
        if current != relation:
            derivation = Derivation(Fact(s, (relation,), o), Rule.SUB_PROPERTY, (derivation,))
        return derivation
