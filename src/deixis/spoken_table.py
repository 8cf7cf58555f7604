"""The table that a script speaks of, and what is on it though the script does not say so."""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from typing import TYPE_CHECKING

from deixis.imagination import Sized
from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Relation

if TYPE_CHECKING:
    from deixis.ontology.tbox import Ontology


def is_table(thing: Sized, ontology: Ontology) -> bool:
    """Whether a thing is of a kind of table."""
    table = ontology.kinds.of_word("table")
    return thing.kind is not None and table is not None and ontology.kinds.is_a(thing.kind, table)


def all_on_it(graph: RelationGraph, tables: Sequence[bool]) -> tuple[RelationGraph, ...]:
    """The graph with everything said to be on the one table that it speaks of, if it speaks of one: but for what it has
    beside the table, or on what is there."""
    if sum(tables) != 1:
        return ()
    on, table, facts = graph.vocabulary["on"], graph.nodes[tables.index(True)], list(graph.facts())
    beside = {table}
    while True:
        more = {name for fact in facts for name in _elsewhere(fact, on, table, beside)} - beside
        if not more:
            break
        beside |= more
    facts += [Fact(name, (on,), table) for name in graph.nodes if name not in beside]
    return (RelationGraph.from_facts(graph.vocabulary, graph.nodes, facts, graph.kinds, graph.boxes, graph.colours),)


def _elsewhere(fact: Fact, on: Relation, table: str, beside: Set[str]) -> Iterator[str]:
    """What a fact has beside the table, or on what is beside it."""
    if not fact.positive:
        return
    if on in fact.relations:
        if fact.object != table and fact.object in beside:
            yield fact.subject
    elif table in (fact.subject, fact.object):
        yield fact.object if fact.subject == table else fact.subject
