"""Contradictions in a relation graph: minimal sets of facts that have no common picture.

Facts without choices are contradictory if the orders of edges that they demand form a cycle; the cycle with the fewest
facts is reported. Facts with choices are contradictory if no combination of the choices has a picture. Facts of graded
words may contradict each other too (:mod:`deixis.reasoning.entailment.word_conflicts`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Relation, Relations
from deixis.reasoning.constraints.minimal import minimal_subset
from deixis.reasoning.entailment.closed import order_graph
from deixis.reasoning.entailment.closing import consistent
from deixis.reasoning.entailment.demands import Demands, demands_of_facts
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.entailment.word_conflicts import conflicting_edges


@dataclass(frozen=True)
class Conflict:
    """Stated facts that cannot all hold, and the reason in words.

    ``minimal`` is True if all of them are needed, and False if the time limit was reached before that was proved.
    """

    facts: tuple[Fact, ...]
    reason: str
    minimal: bool = True


def compatible(a: Relation, b: Relation) -> bool:
    """Return whether two boxes can have both of two relations.

    Their atoms must intersect on every axis, and a strict order excludes its inverse.

    Parameters
    ----------
    a, b
        The relations.

    Returns
    -------
    bool
        True if they can.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> compatible(r["left"], r["top"]), compatible(r["left"], r["right"]), compatible(r["on"], r["under"])
    (True, False, False)
    """
    if a.is_strict_order and a.inverse == b.name:
        return False
    height = not (a.z_atoms and b.z_atoms) or bool(a.z_atoms & b.z_atoms)
    return bool(a.x_atoms & b.x_atoms) and bool(a.y_atoms & b.y_atoms) and height


def find_conflict(implied: Implications, deadline: Deadline | None = None) -> Conflict | None:
    """Find a minimal contradiction.

    Parameters
    ----------
    implied
        The implications of the facts.
    deadline
        Time limit of the searches; default: after the time limit of ``implied``.

    Returns
    -------
    Conflict or None
        The contradiction, or None if the facts are consistent or the time limit left that open. If the deadline passes
        before a contradiction with choices is minimal, it has the facts left so far, and ``minimal`` is False.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> facts = [Fact("a", (r["left"],), "b"), Fact("b", (r["left"],), "a"), Fact("c", (r["on"],), "b")]
    >>> found = find_conflict(Implications(RelationGraph.from_facts(r, ["a", "b", "c"], facts)))
    >>> [str(fact) for fact in found.facts], found.reason
    (['left(a, b)', 'left(b, a)'], "'a' cannot be both left of and right of 'b'")
    """
    if implied.consistent:
        return None
    until = Deadline.after(implied.time_limit) if deadline is None else deadline
    demands = implied.demands
    graph = implied.graph
    cycle = order_graph(demands.bounds, len(graph.nodes)).shortest_cycle()
    of_words = None
    if cycle is None and implied.closed.contradictory < 0:
        of_words = conflicting_edges(graph, demands.firm)
    edges = sorted(cycle or of_words or _group_edges(implied))
    facts, minimal = [graph.fact(edge) for edge in edges], True
    if of_words is None and (cycle is None or not _is_single_cycle(demands, edges)):
        found = minimal_subset(facts, lambda chosen: _inconsistent(chosen, graph.vocabulary, until))
        facts, minimal = list(found.items), found.proved
    if graph.sources:
        facts.sort(key=lambda fact: (fact.source is None, fact.source))
    reason = _reason(facts, graph.vocabulary) if minimal else "the facts below, some of which leave a choice"
    return Conflict(tuple(facts), reason, minimal)


def _group_edges(implied: Implications) -> list[int]:
    """Return the firm facts of the group that has no picture."""
    graph, firm = implied.graph, implied.demands.firm
    inside = implied.closed.groups.label[graph.subjects[firm]] == implied.closed.contradictory
    edges: list[int] = firm[inside].tolist()
    return edges


def _is_single_cycle(demands: Demands, edges: Sequence[int]) -> bool:
    """Return whether the bounds of the facts form a single cycle, so that every fact is needed."""
    few = demands.restricted(edges)
    return not few.choices and order_graph(few.bounds, len(demands.graph.nodes)).is_single_cycle


def _inconsistent(facts: list[Fact], vocabulary: Relations, deadline: Deadline) -> list[Fact] | None:
    return None if consistent(demands_of_facts(vocabulary, facts), deadline) else facts


def _reason(facts: Sequence[Fact], vocabulary: Relations) -> str:
    """Return the reason why one of the facts cannot hold with the others: a choice, else a denial, else the first."""
    fact = next((f for f in facts if f.positive and len(f.relations) > 1), None)
    fact = fact or next((f for f in facts if not f.positive), facts[0])
    s, o = fact.subject, fact.object
    phrases = [relation.phrase for relation in fact.relations]
    if s == o:
        return f"no object can be related to itself, but '{s}' is"
    if len(fact.relations) > 1 and fact.positive:
        return f"'{s}' can be neither {' nor '.join(phrases)} '{o}'"
    others = _implications([other for other in facts if other is not fact], (s, o), vocabulary)
    if not fact.positive:
        held = [relation.phrase for relation in fact.relations if others.holds(relation, s, o)]
        return f"'{s}' is {' or '.join(held[:1] or phrases)} '{o}', but that is denied"
    for other in vocabulary.values():
        if not compatible(other, fact.relations[0]) and others.holds(other, s, o):
            return f"'{s}' cannot be both {phrases[0]} and {other.phrase} '{o}'"
    return f"'{s}' cannot be {phrases[0]} '{o}' if the other facts hold"


def _implications(facts: Sequence[Fact], ends: tuple[str, str], vocabulary: Relations) -> Implications:
    named = [name for fact in facts for name in (fact.subject, fact.object)]
    return Implications(RelationGraph.from_facts(vocabulary, tuple(dict.fromkeys([*ends, *named])), facts))
