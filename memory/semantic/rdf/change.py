"""A change of a memory, computed before it is written: added and removed triples, and the update that writes it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain

import pyoxigraph as ox

from deixis.memory.errors import RejectedWriteError
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.graphs import GraphName, ModelSet, graph_iri, lesson_graph, models_graph
from deixis.ontology.rdf.triples import content_key, skolem

Models = Mapping[ModelSet, Sequence[ox.Triple]]
"""Sets of learned models, each replacing the stored one; sets that are left out stay."""


@dataclass(frozen=True)
class Change:
    """Triples that a write adds to the canonical graphs and removes from them, and the operations of its one update.

    Added triples were not stored before, and removed ones were: a lesson with only known triples changes nothing.
    """

    added: ledger.Triples = field(default_factory=dict)
    removed: ledger.Triples = field(default_factory=dict)
    operations: tuple[ledger.Operation, ...] = ()


def together(*changes: Change) -> Change:
    """Return one change that makes several changes in one step, in their order.

    Parameters
    ----------
    changes
        Changes in the order in which their operations run.

    Returns
    -------
    Change
        Change with the operations of all changes.
    """
    added: dict[GraphName, frozenset[ox.Triple]] = {}
    removed: dict[GraphName, frozenset[ox.Triple]] = {}
    for change in changes:
        for name, triples in change.added.items():
            added[name] = added.get(name, frozenset()) | triples
        for name, triples in change.removed.items():
            removed[name] = removed.get(name, frozenset()) | triples
    return Change(added, removed, tuple(chain.from_iterable(change.operations for change in changes)))


def arriving(store: ox.Store, lesson: str, contributions: Mapping[GraphName, Sequence[ox.Triple]]) -> Change:
    """Return the change that a new lesson makes, without what follows from it.

    Parameters
    ----------
    store
        Store before the change.
    lesson
        Name of the lesson.
    contributions
        Contributions of the lesson by canonical graph, as :func:`incoming` returns them.

    Returns
    -------
    Change
        Change that adds the triples which the canonical graphs lack.
    """
    held = {name: ledger.stored_triples(store, graph_iri(name), triples) for name, triples in contributions.items()}
    added = {name: frozenset(triples).difference(held[name]) for name, triples in contributions.items()}
    return Change(added=added, operations=tuple(ledger.arrival(store, lesson, contributions, held)))


def departing(store: ox.Store, lesson: str) -> Change:
    """Return the change that forgetting a lesson makes, without what followed from it.

    Parameters
    ----------
    store
        Store before the change.
    lesson
        Name of the lesson.

    Returns
    -------
    Change
        Change that removes the triples which only this lesson contributes.
    """
    removed: dict[GraphName, frozenset[ox.Triple]] = {}
    operations: list[ledger.Operation] = []
    for name, triples in ledger.copies(store, lesson).items():
        copy = lesson_graph(lesson, name)
        only = ledger.only_of(store, copy, name, triples)
        removed[name] = frozenset(only)
        operations += [*ledger.deletion(graph_iri(name), only), ledger.drop(copy)]
    return Change({}, removed, tuple(operations))


def concluding(store: ox.Store, inferred: Iterable[ox.Triple]) -> Change:
    """Return the change that replaces the inferred graph.

    Parameters
    ----------
    store
        Store before the change.
    inferred
        All triples of the new inferred graph.

    Returns
    -------
    Change
        Change with the difference between the old graph and the new one.
    """
    graph = graph_iri(GraphName.INFERRED)
    gone, come = ledger.difference(store, graph, named("inferred", inferred))
    operations = (*ledger.deletion(graph, gone), *ledger.insertion(graph, come))
    return Change({GraphName.INFERRED: frozenset(come)}, {GraphName.INFERRED: frozenset(gone)}, operations)


def modelling(store: ox.Store, models: Models) -> Change:
    """Return the change that replaces sets of learned models.

    Parameters
    ----------
    store
        Store before the change.
    models
        Sets of learned models; sets that are left out stay.

    Returns
    -------
    Change
        Change of the learned graph, and of the copies of the sets.
    """
    copies = {models_graph(which): triples for which, triples in models.items()}
    return together(
        *(remodelling(store, copy, *ledger.difference(store, copy, triples)) for copy, triples in copies.items())
    )


def remodelling(store: ox.Store, copy: ox.NamedNode, gone: Sequence[ox.Triple], come: Sequence[ox.Triple]) -> Change:
    """Return the change that replaces triples in a copy of learned models.

    Parameters
    ----------
    store
        Store before the change.
    copy
        Graph of the copy.
    gone
        Triples to remove from the copy. The learned graph keeps those that also come from elsewhere.
    come
        Triples to add.

    Returns
    -------
    Change
        Change of the learned graph, and of the copy.
    """
    only = ledger.only_of(store, copy, GraphName.LEARNED, gone)
    return Change(
        {
            GraphName.LEARNED: frozenset(come).difference(
                ledger.stored_triples(store, graph_iri(GraphName.LEARNED), come)
            )
        },
        {GraphName.LEARNED: frozenset(only)},
        tuple(ledger.replacement(store, copy, GraphName.LEARNED, gone, come)),
    )


def reconcluding(gone: Iterable[ox.Triple], come: Iterable[ox.Triple]) -> Change:
    """Return the change that replaces triples in the inferred graph; only existing triples are removed.

    Parameters
    ----------
    gone
        Triples to remove, all of which are in the inferred graph.
    come
        Triples to add.

    Returns
    -------
    Change
        Change of the inferred graph.
    """
    graph, gone, come = graph_iri(GraphName.INFERRED), frozenset(gone), frozenset(come)
    operations = (*ledger.deletion(graph, sorted(gone, key=str)), *ledger.insertion(graph, sorted(come, key=str)))
    return Change({GraphName.INFERRED: come}, {GraphName.INFERRED: gone}, operations)


def incoming(lesson: str, contributions: Mapping[GraphName, Iterable[ox.Triple]]) -> dict[GraphName, list[ox.Triple]]:
    """Return contributions as they will be stored.

    Parameters
    ----------
    lesson
        Name of the lesson.
    contributions
        Triples by canonical graph.

    Returns
    -------
    dict
        Triples by canonical graph, in the spelling of the store. Their blank nodes are named after the lesson.

    Raises
    ------
    RejectedWriteError
        If the name is empty, or a triple is nested or in the inferred graph.
    """
    if not lesson.strip():
        raise RejectedWriteError("the name of a lesson must not be empty")
    if GraphName.INFERRED in contributions:
        raise RejectedWriteError(
            f"lesson '{lesson}' must not contribute to the inferred graph: pass such triples as `inferred`"
        )
    key = content_key(lesson)
    return {GraphName(name): ledger.as_stored(named(key, triples)) for name, triples in contributions.items()}


def named(key: str, triples: Iterable[ox.Triple]) -> Iterable[ox.Triple]:
    """Yield triples whose blank nodes are named.

    Parameters
    ----------
    key
        Key under which blank nodes are named, so that equal ones of other sources stay apart.
    triples
        Triples with or without blank nodes.

    Yields
    ------
    Triple
        Triples without blank nodes.

    Raises
    ------
    RejectedWriteError
        If a triple is nested in another one.
    """
    for triple in triples:
        subject, obj = triple.subject, triple.object
        if isinstance(subject, ox.NamedNode) and isinstance(obj, ox.NamedNode | ox.Literal):
            yield triple
        else:
            named_subject = _name(key, subject)
            assert not isinstance(named_subject, ox.Literal)
            yield ox.Triple(named_subject, triple.predicate, _name(key, obj))


def _name(key: str, term: ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple) -> ox.NamedNode | ox.Literal:
    if isinstance(term, ox.BlankNode):
        return skolem(f"{key}.{term.value}")
    if isinstance(term, ox.Triple):
        raise RejectedWriteError(f"a triple inside a triple cannot be stored: {term}")
    return term
