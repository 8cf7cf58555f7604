"""The fluents in the semantic store, for SPARQL: a copy that follows the log of the blackboard.

The log is authoritative. The graph ``dxg:fluents`` describes all fluents, and ``dxg:now`` has the statements that hold
now as plain triples. A mark says up to which change they follow the log; a query first brings them up to date. After a
crash the changes since the mark are applied again, which gives the same triples.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import pyoxigraph as ox

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Logged
from deixis.memory.episodes.fluents.episode import EpisodicFluent
from deixis.memory.episodes.rdf.observations import EP, RESOURCES, fluent_iri, fluent_triples, statement_triple
from deixis.memory.semantic.rdf.graphs import FLUENTS, NOW
from deixis.reasoning.temporal.fluent import Statement

MARK = ox.NamedNode(FLUENTS.value + "/mark")
"""Graph with the mark of the copy; queries leave it out."""

_UP_TO = ox.NamedNode(EP + "upTo")
_MEMORY, _TIME_ORIGIN = ox.NamedNode(RESOURCES + "memory"), ox.NamedNode(EP + "timeOrigin")
_DATE_TIME = ox.NamedNode("http://www.w3.org/2001/XMLSchema#dateTime")
_PAGE = 20_000  # changes that are applied together


def is_current(board: Blackboard, store: ox.Store) -> bool:
    """Return whether the copy has all changes of the blackboard.

    Parameters
    ----------
    board
        The blackboard.
    store
        The semantic store.

    Returns
    -------
    bool
        True if it has.
    """
    return _mark(store) == (_origin(board), board.sequence)


def follow(board: Blackboard, store: ox.Store) -> None:
    """Bring the copy of the fluents in a store up to date.

    Parameters
    ----------
    board
        The blackboard.
    store
        The semantic store, which is written.
    """
    origin, position = _mark(store)
    if origin != _origin(board) or position > board.sequence:  # of another blackboard
        for graph in (FLUENTS, NOW):
            store.remove_graph(graph)
        position = 0
        store.add(ox.Quad(_MEMORY, _TIME_ORIGIN, ox.Literal(_origin(board), datatype=_DATE_TIME), FLUENTS))
        _set_mark(board, store, 0)
    for page in _pages(board.changes(position)):
        _apply(board, store, page)
        _set_mark(board, store, page[-1].sequence)


def _pages(changes: Iterable[Logged]) -> Iterator[list[Logged]]:
    page: list[Logged] = []
    for change in changes:
        page.append(change)
        if len(page) >= _PAGE:
            yield page
            page = []
    if page:
        yield page


def _apply(board: Blackboard, store: ox.Store, page: list[Logged]) -> None:
    last = {change.id: change.after for change in page}
    gone = [quad for id in last for quad in store.quads_for_pattern(fluent_iri(id), None, None, FLUENTS)]
    statements: set[Statement] = {
        each.statement for change in page for each in (change.before, change.after) if each is not None
    }
    holding = {each.statement for each in board.now()}
    gone += [_quad(statement_triple(statement), NOW) for statement in statements - holding]
    if gone:
        lines = (f"GRAPH {quad.graph_name} {{ {quad.triple} }}" for quad in gone)
        store.update(f"DELETE DATA {{ {' '.join(lines)} }}")
    store.bulk_extend(_quads(last.values(), statements & holding))


def _quads(fluents: Iterable[EpisodicFluent | None], holding: Iterable[Statement]) -> Iterator[ox.Quad]:
    for fluent in fluents:
        if fluent is not None:
            yield from (_quad(triple, FLUENTS) for triple in fluent_triples(fluent))
    yield from (_quad(statement_triple(statement), NOW) for statement in holding)


def _quad(triple: ox.Triple, graph: ox.NamedNode) -> ox.Quad:
    return ox.Quad(triple.subject, triple.predicate, triple.object, graph)


def _origin(board: Blackboard) -> str:
    return board.origin.isoformat()


def _set_mark(board: Blackboard, store: ox.Store, position: int) -> None:
    store.remove_graph(MARK)
    store.add(ox.Quad(FLUENTS, _UP_TO, ox.Literal(f"{_origin(board)} {position}"), MARK))


def _mark(store: ox.Store) -> tuple[str | None, int]:
    for quad in store.quads_for_pattern(FLUENTS, _UP_TO, None, MARK):
        origin, _, position = getattr(quad.object, "value", "").partition(" ")
        return origin, int(position or 0)
    return None, 0
