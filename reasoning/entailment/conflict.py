"""Contradictions in a relation graph: facts that no picture bears out together, none of which can be spared.

Facts that leave no choice contradict each other where the orders between edges that they demand go round in a circle,
and the circle of the fewest facts is reported. Where there are choices, no combination of them has a picture.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deixis.deadline import Deadline
from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Relation, Relations
from deixis.reasoning.constraints.minimal import minimal_subset
from deixis.reasoning.entailment.closed import order_graph
from deixis.reasoning.entailment.closing import consistent
from deixis.reasoning.entailment.demands import Demands, demands_of_facts
from deixis.reasoning.entailment.implications import Implications


@dataclass(frozen=True)
class Conflict:
    """Stated facts that cannot all hold, and in words why.

    None of them is dispensable, unless ``minimal`` is False: then the time was up before that was seen.
    """

    facts: tuple[Fact, ...]
    reason: str
    minimal: bool = True


def compatible(a: Relation, b: Relation) -> bool:
    """Return whether some two boxes bear both: their atoms meet on every axis.

    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> compatible(r["left"], r["top"]), compatible(r["left"], r["right"]), compatible(r["on"], r["under"])
    (True, False, False)
    """
    height = not (a.z_atoms and b.z_atoms) or bool(a.z_atoms & b.z_atoms)
    return bool(a.x_atoms & b.x_atoms) and bool(a.y_atoms & b.y_atoms) and height


def find_conflict(implied: Implications, deadline: Deadline | None = None) -> Conflict | None:
    """Return a minimal contradiction; None where the facts are consistent, or where the time limit left that open.

    Searches end at ``deadline`` (without one, after the time limit of ``implied``); where it passes before a
    contradiction among choices is minimal, the one that was left then is returned, and says so.

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
    circle = order_graph(demands.bounds, len(graph.nodes)).shortest_cycle()
    edges = _group_edges(implied) if circle is None else sorted(circle)
    facts, minimal = [graph.fact(edge) for edge in edges], True
    if circle is None or not _minimal_circle(demands, edges):
        found = minimal_subset(facts, lambda chosen: _inconsistent(chosen, graph.vocabulary, until))
        facts, minimal = list(found.items), found.proved
    if graph.sources:
        facts.sort(key=lambda fact: (fact.source is None, fact.source))
    reason = _reason(facts, graph.vocabulary) if minimal else "the facts below, among which some leave a choice"
    return Conflict(tuple(facts), reason, minimal)


def _group_edges(implied: Implications) -> list[int]:
    """Return the firm facts of the group that has no picture."""
    graph, firm = implied.graph, implied.demands.firm
    inside = implied.closed.groups.label[graph.subjects[firm]] == implied.closed.contradictory
    edges: list[int] = firm[inside].tolist()
    return edges


def _minimal_circle(demands: Demands, edges: Sequence[int]) -> bool:
    """Return whether nothing but one circle is in the facts' bounds, so that every fact is needed to close it."""
    few = demands.restricted(edges)
    return not few.choices and order_graph(few.bounds, len(demands.graph.nodes)).is_single_cycle


def _inconsistent(facts: list[Fact], vocabulary: Relations, deadline: Deadline) -> list[Fact] | None:
    return None if consistent(demands_of_facts(vocabulary, facts), deadline) else facts


def _reason(facts: Sequence[Fact], vocabulary: Relations) -> str:
    """Return why one of the facts cannot hold beside the others: a choice, else a denial, else the first."""
    fact = next((f for f in facts if f.positive and len(f.relations) > 1), None)
    fact = fact or next((f for f in facts if not f.positive), facts[0])
    s, o = fact.subject, fact.object
    phrases = [relation.phrase for relation in fact.relations]
    if s == o:
        return f"nothing can be related to itself, and '{s}' is"
    if len(fact.relations) > 1 and fact.positive:
        return f"'{s}' can be neither {' nor '.join(phrases)} '{o}'"
    others = _implications([other for other in facts if other is not fact], (s, o), vocabulary)
    if not fact.positive:
        held = [relation.phrase for relation in fact.relations if others.holds(relation, s, o)]
        return f"'{s}' is {' or '.join(held[:1] or phrases)} '{o}', and that is denied"
    for other in vocabulary.values():
        if not compatible(other, fact.relations[0]) and others.holds(other, s, o):
            return f"'{s}' cannot be both {phrases[0]} and {other.phrase} '{o}'"
    return f"'{s}' cannot be {phrases[0]} '{o}' where the other facts hold"


def _implications(facts: Sequence[Fact], ends: tuple[str, str], vocabulary: Relations) -> Implications:
    named = [name for fact in facts for name in (fact.subject, fact.object)]
    return Implications(RelationGraph.from_facts(vocabulary, tuple(dict.fromkeys([*ends, *named])), facts))
