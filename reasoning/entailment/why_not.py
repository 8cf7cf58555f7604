"""Explain why a fact does not follow: the facts exclude it, or they have a picture without it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.errors import GraphError
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.reasoning.entailment.bounds import Order, meaning
from deixis.reasoning.entailment.closed import groups_of, orders_of
from deixis.reasoning.entailment.closing import local_problem, picture_of, picture_of_group
from deixis.reasoning.entailment.conflict import Conflict, compatible, find_conflict
from deixis.reasoning.entailment.demands import demands_of
from deixis.reasoning.entailment.derivations import Derivation
from deixis.reasoning.entailment.implications import Implications


@dataclass(frozen=True, eq=False)
class CounterExample:
    """A picture in which every firm fact holds but the questioned one does not; integers without a unit."""

    objects: tuple[str, ...]
    boxes: NDArray[np.float64]  # (objects, 2, 3): minimum and maximum corner


@dataclass(frozen=True)
class WhyNot:
    """The reason why a fact does not follow, in one of the last four fields, or ``follows`` if it does follow."""

    fact: Fact
    follows: Derivation | None = None
    against: Derivation | None = None  # an implied fact that no boxes satisfy together with it
    conflict: Conflict | None = None  # stated facts with which it is a minimal contradiction
    picture: CounterExample | None = None
    missing: tuple[Order, ...] = ()  # the orders of edges that it needs and that do not follow
    known: tuple[Fact, ...] = ()  # the implied facts about the two objects


def why_not(implied: Implications, fact: Fact) -> WhyNot:
    """Explain why a plain fact does not follow from consistent facts.

    Parameters
    ----------
    implied
        The implications of the facts.
    fact
        One affirmed relation between two different objects.

    Returns
    -------
    WhyNot
        The reason, or a derivation if the fact does follow.

    Raises
    ------
    GraphError
        If the facts are inconsistent, or the fact is not plain or relates an object to itself.
    OutOfTimeError
        At the time limit.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> graph = RelationGraph.from_facts(r, ["a", "b"], [Fact("a", (r["left"],), "b")])
    >>> [str(order) for order in why_not(Implications(graph), Fact("a", (r["top_left"],), "b")).missing]
    ['far edge of b <= near edge of a']
    """
    if not implied.consistent or not fact.plain or fact.subject == fact.object:
        raise GraphError(
            f"'{fact}' cannot be explained: the facts must be consistent, and it must be one relation of two objects"
        )
    relation, s, o = fact.relations[0], fact.subject, fact.object
    found = implied.derive(relation, s, o)
    if found is not None:
        return WhyNot(fact, follows=found)
    for other in implied.vocabulary.values():
        if not compatible(relation, other) and implied.holds(other, s, o):
            return WhyNot(fact, against=implied.derive(other, s, o))
    conflict = find_conflict(Implications(_with(implied.graph, replace(fact, source=None)), implied.time_limit))
    if conflict is not None:
        return WhyNot(fact, conflict=conflict)
    known = tuple(Fact(s, (r,), o) for r in implied.vocabulary.values() if implied.holds(r, s, o))
    return WhyNot(fact, picture=_counter_example(implied, fact), missing=_missing(implied, fact), known=known)


def _missing(implied: Implications, fact: Fact) -> tuple[Order, ...]:
    s, o = implied.graph.index(fact.subject), implied.graph.index(fact.object)
    orders = implied.closed.orders
    assert orders is not None
    return tuple(
        Order(fact.subject, fact.object, bound)
        for part in meaning(fact.relations[0])
        for bound in part
        if not orders.implies(bound, s, o)
    )


def _with(graph: RelationGraph, fact: Fact) -> RelationGraph:
    return RelationGraph.from_facts(graph.vocabulary, graph.nodes, [*graph.facts(), fact])


def _counter_example(implied: Implications, fact: Fact) -> CounterExample:
    """Return the objects that facts connect with the two, in a picture without the fact."""
    graph = _with(implied.graph, replace(fact, positive=False))
    demands = demands_of(graph)
    groups = groups_of(graph.subjects[demands.firm], graph.objects[demands.firm], len(graph.nodes))
    group = int(groups.label[graph.index(fact.subject)])
    nodes = groups.members(group)
    names = tuple(graph.nodes[k] for k in nodes)
    choices = [choice for choice in demands.choices if groups.label[choice.subject] == group]
    if not choices:
        orders = orders_of(demands.bounds, groups)
        assert orders is not None, "a fact that does not follow has a picture without it"
        return CounterExample(names, picture_of_group(orders, group))
    picture = local_problem(demands, nodes, choices).picture(Deadline.after(implied.time_limit))
    assert picture is not None, "a fact that does not follow has a picture without it"
    return CounterExample(names, picture_of(picture))
