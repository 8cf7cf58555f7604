"""One change of a memory, worked out before it is written: what comes, what goes, and the update that does it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain

import pyoxigraph as ox

from deixis.memory import ledger
from deixis.memory.errors import RejectedWriteError
from deixis.memory.graphs import GraphName, graph_iri, lesson_graph
from deixis.ontology.iris import content_key
from deixis.ontology.skolem import skolem


@dataclass(frozen=True)
class Change:
    """What a write adds to and removes from the canonical graphs, and the operations of its one update."""

    added: ledger.Triples = field(default_factory=dict)
    removed: ledger.Triples = field(default_factory=dict)
    statements: tuple[str, ...] = ()


def arriving(
    store: ox.Store, lesson: str, said: Mapping[GraphName, Sequence[ox.Triple]], inferred: Iterable[ox.Triple]
) -> Change:
    """The change that a new lesson makes."""
    come, gone = _inferred(store, inferred)
    return Change(
        added={**{name: frozenset(triples) for name, triples in said.items()}, GraphName.INFERRED: frozenset(come)},
        removed={GraphName.INFERRED: frozenset(gone)},
        statements=tuple(chain(ledger.arrival(store, lesson, said), _replacing(come, gone))),
    )


def departing(store: ox.Store, lesson: str, inferred: Iterable[ox.Triple] | None) -> Change:
    """The change that forgetting a lesson makes; with None the inferred graph stays as it is."""
    come, gone = ([], []) if inferred is None else _inferred(store, inferred)
    removed, statements = {GraphName.INFERRED: frozenset(gone)}, []
    for name, triples in ledger.copies(store, lesson).items():
        copy = lesson_graph(lesson, name)
        only = ledger.only_of(store, copy, name, triples)
        removed[name] = frozenset(only)
        statements += [*ledger.deletion(graph_iri(name), only), f"DROP SILENT GRAPH {copy}"]
    return Change({GraphName.INFERRED: frozenset(come)}, removed, (*statements, *_replacing(come, gone)))


def concluding(store: ox.Store, inferred: Iterable[ox.Triple]) -> Change:
    """The change that only replaces the inferred graph."""
    come, gone = _inferred(store, inferred)
    removed = {GraphName.INFERRED: frozenset(gone)}
    return Change({GraphName.INFERRED: frozenset(come)}, removed, tuple(_replacing(come, gone)))


def _inferred(store: ox.Store, triples: Iterable[ox.Triple]) -> tuple[list[ox.Triple], list[ox.Triple]]:
    """What comes to the inferred graph and what goes, so that it holds just these triples."""
    old = set(ledger.triples_in(store, graph_iri(GraphName.INFERRED)))
    new = set(ledger.as_stored(named("inferred", triples)))
    return sorted(new - old, key=str), sorted(old - new, key=str)


def _replacing(come: Iterable[ox.Triple], gone: Iterable[ox.Triple]) -> Iterable[str]:
    graph = graph_iri(GraphName.INFERRED)
    return chain(ledger.deletion(graph, gone), ledger.insertion(graph, come))


def incoming(lesson: str, contributions: Mapping[GraphName, Iterable[ox.Triple]]) -> dict[GraphName, list[ox.Triple]]:
    """Contributions as they will be stored. Raises RejectedWriteError for what no lesson may say."""
    if not lesson.strip():
        raise RejectedWriteError("a lesson needs a name")
    if GraphName.INFERRED in contributions:
        raise RejectedWriteError(f"lesson '{lesson}' cannot say what is inferred: pass it as the inferred triples")
    key = content_key(lesson)
    return {GraphName(name): ledger.as_stored(named(key, triples)) for name, triples in contributions.items()}


def named(key: str, triples: Iterable[ox.Triple]) -> Iterable[ox.Triple]:
    """Triples whose blank nodes have become names under ``key``; raises RejectedWriteError for triples in triples."""
    for triple in triples:
        subject, object = triple.subject, triple.object
        if isinstance(subject, ox.NamedNode) and isinstance(object, ox.NamedNode | ox.Literal):
            yield triple
        else:
            named_subject = _name(key, subject)
            assert not isinstance(named_subject, ox.Literal)
            yield ox.Triple(named_subject, triple.predicate, _name(key, object))


def _name(key: str, term: ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple) -> ox.NamedNode | ox.Literal:
    if isinstance(term, ox.BlankNode):
        return skolem(f"{key}.{term.value}")
    if isinstance(term, ox.Triple):
        raise RejectedWriteError(f"a triple inside a triple cannot be kept: {term}")
    return term
