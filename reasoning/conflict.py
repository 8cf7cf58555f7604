"""Contradictions in a relation graph: the smallest one found, made minimal by deletion.

A contradiction is a pair of which two relations are implied that no two boxes can bear at once, a relation that is
implied and denied, or a choice of which nothing is left.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Relation, Relations
from deixis.reasoning.closure import FAR
from deixis.reasoning.implications import Implications


@dataclass(frozen=True)
class Conflict:
    """Stated facts that cannot all hold, none of them dispensable, and in words why."""

    facts: tuple[Fact, ...]
    reason: str


def compatible(a: Relation, b: Relation) -> bool:
    """Whether some two boxes bear both: their atoms meet on every axis.

    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> compatible(r["left"], r["top"]), compatible(r["left"], r["right"]), compatible(r["on"], r["under"])
    (True, False, False)
    """
    height = not (a.z_atoms and b.z_atoms) or bool(a.z_atoms & b.z_atoms)
    return bool(a.x_atoms & b.x_atoms) and bool(a.y_atoms & b.y_atoms) and height


def find_conflict(implied: Implications) -> Conflict | None:
    """The contradiction that rests on the fewest stated facts, made minimal; None where the facts are consistent.

    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> facts = [Fact("a", (r["left"],), "b"), Fact("b", (r["left"],), "a"), Fact("c", (r["on"],), "b")]
    >>> found = find_conflict(Implications(RelationGraph.from_facts(r, ["a", "b", "c"], facts)))
    >>> [str(fact) for fact in found.facts], found.reason
    (['left(a, b)', 'left(b, a)'], "'a' cannot be both left of and right of 'b'")
    """
    best: tuple[tuple[Fact, ...], str] | None = None
    for facts, reason in _candidates(implied):
        if best is None or len(facts) < len(best[0]):
            best = facts, reason
        if len(best[0]) == 1:
            break
    return None if best is None else _minimised(best[0], best[1], implied.graph)


def _candidates(implied: Implications) -> Iterator[tuple[tuple[Fact, ...], str]]:
    yield from _self_relations(implied.graph)
    yield from _clashes(implied)
    yield from _denials(implied)
    yield from _exhausted(implied)


def _self_relations(graph: RelationGraph) -> Iterator[tuple[tuple[Fact, ...], str]]:
    firm = graph.positive & ~graph.optional & (graph.weights >= 1.0)
    for edge in np.flatnonzero((graph.subjects == graph.objects) & firm):
        fact = graph.fact(int(edge))
        yield (fact,), f"nothing can be related to itself, and '{fact.subject}' is"


def _clashes(implied: Implications) -> Iterator[tuple[tuple[Fact, ...], str]]:
    """For every two relations that no boxes bear at once: the pair for which both are implied by fewest steps."""
    relations = list(implied.vocabulary.values())
    for part in implied.parts():
        stated = [r for r in relations if part.has(r)]
        for i, a in enumerate(stated):
            for b in stated[i + 1 :]:
                if not compatible(a, b):
                    pair = _closest(part.distance(a), part.distance(b))
                    if pair is not None:
                        s, o = (implied.graph.nodes[part.nodes[k]] for k in pair)
                        yield _both(implied, a, b, s, o)


def _closest(a: NDArray[np.int32], b: NDArray[np.int32]) -> tuple[int, int] | None:
    steps = a + b
    np.fill_diagonal(steps, np.iinfo(np.int32).max)
    found = np.unravel_index(int(steps.argmin()), steps.shape)
    both = a[found] < FAR and b[found] < FAR and found[0] != found[1]
    return (int(found[0]), int(found[1])) if both else None


def _both(implied: Implications, a: Relation, b: Relation, s: str, o: str) -> tuple[tuple[Fact, ...], str]:
    facts = _stated(implied, [(a, s, o), (b, s, o)])
    return facts, f"'{s}' cannot be both {a.phrase} and {b.phrase} '{o}'"


def _stated(implied: Implications, goals: Sequence[tuple[Relation, str, str]]) -> tuple[Fact, ...]:
    used: dict[Fact, None] = {}
    for goal in goals:
        derivation = implied.derive(*goal)
        assert derivation is not None
        used.update(dict.fromkeys(derivation.stated()))
    return tuple(used)


def _denials(implied: Implications) -> Iterator[tuple[tuple[Fact, ...], str]]:
    for fact in _firm(implied.graph, positive=False):
        for relation in fact.relations:
            if implied.holds(relation, fact.subject, fact.object):
                facts = _stated(implied, [(relation, fact.subject, fact.object)])
                yield (
                    (*facts, fact),
                    f"'{fact.subject}' is {relation.phrase} '{fact.object}', and that is denied",
                )


def _exhausted(implied: Implications) -> Iterator[tuple[tuple[Fact, ...], str]]:
    """Disjunctions none of whose alternatives is left."""
    denied: dict[tuple[str, str, int], Fact] = {}
    for fact in _firm(implied.graph, positive=False):
        for relation in _with_narrower(fact.relations, implied.vocabulary):
            inverse = implied.vocabulary[relation.inverse]
            denied.setdefault((fact.subject, fact.object, relation.index), fact)
            denied.setdefault((fact.object, fact.subject, inverse.index), fact)
    for fact in _firm(implied.graph, positive=True):
        if len(fact.relations) < 2:
            continue
        against = [_against(implied, relation, fact, denied) for relation in fact.relations]
        if all(facts is not None for facts in against):
            used = dict.fromkeys(f for facts in against if facts for f in facts)
            names = " nor ".join(relation.phrase for relation in fact.relations)
            yield (*used, fact), f"'{fact.subject}' can be neither {names} '{fact.object}'"


def _with_narrower(relations: Sequence[Relation], vocabulary: Relations) -> list[Relation]:
    """The relations and all that imply one of them: what is denied when they are."""
    names = {relation.name for relation in relations}
    return [other for other in vocabulary.values() if other.name in names or other.broader & names]


def _against(
    implied: Implications, relation: Relation, fact: Fact, denied: dict[tuple[str, str, int], Fact]
) -> tuple[Fact, ...] | None:
    """Stated facts that exclude one alternative of a disjunction, or None."""
    key = (fact.subject, fact.object, relation.index)
    if key in denied:
        return (denied[key],)
    for other in implied.vocabulary.values():
        if not compatible(relation, other) and implied.holds(other, fact.subject, fact.object):
            return _stated(implied, [(other, fact.subject, fact.object)])
    return None


def _firm(graph: RelationGraph, positive: bool) -> Iterator[Fact]:
    chosen = (graph.positive == positive) & ~graph.optional & (graph.weights >= 1.0)
    return (graph.fact(int(edge)) for edge in np.flatnonzero(chosen))


def _minimised(facts: tuple[Fact, ...], reason: str, graph: RelationGraph) -> Conflict:
    """Drops every fact without which the rest is still contradictory."""
    kept = list(facts)
    for fact in facts:
        rest = [other for other in kept if other is not fact]
        again = _first(rest, graph.vocabulary)
        if again is not None:
            kept, reason = rest, again
    if graph.sources:
        kept.sort(key=lambda fact: (fact.source is None, fact.source))
    return Conflict(tuple(kept), reason)


def _first(facts: Sequence[Fact], vocabulary: Relations) -> str | None:
    names = tuple(dict.fromkeys(name for fact in facts for name in (fact.subject, fact.object)))
    found = next(_candidates(Implications(RelationGraph.from_facts(vocabulary, names, facts))), None)
    return None if found is None else found[1]
