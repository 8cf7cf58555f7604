"""Encode fluents, changes and log entries, and decode them.

>>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
>>> cup = episodic("f1", ("cup", "on", "table"), start=2.0, source=Source(Origin.SEEN, "tracker"))
>>> decode_fluent(encode_fluent(cup)) == cup
True
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from deixis.memory.episodes.fluents.changes import Add, Change, Delete, Finish, Kind, Logged, Update
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, at
from deixis.reasoning.temporal.bounds import UNKNOWN, Bounds
from deixis.reasoning.temporal.fluent import Fluent, Pattern, Statement

_write = json.JSONEncoder(ensure_ascii=False, separators=(",", ":"), check_circular=False).encode
_ORIGINS = {origin.value: origin for origin in Origin}


def encode_fluent(fluent: EpisodicFluent) -> bytes:
    """Return a fluent as bytes.

    Parameters
    ----------
    fluent
        The fluent.

    Returns
    -------
    bytes
        A JSON array.
    """
    return _write(_values(fluent)).encode()


def decode_fluent(data: bytes) -> EpisodicFluent:
    """Return the fluent that bytes stand for.

    Parameters
    ----------
    data
        Bytes that :func:`encode_fluent` returned.

    Returns
    -------
    EpisodicFluent
        The fluent.
    """
    return _fluent(json.loads(data))


def decode_if_matching(data: bytes, pattern: Pattern) -> EpisodicFluent | None:
    """Return the fluent that bytes stand for if its statement matches a pattern.

    Parameters
    ----------
    data
        Bytes that :func:`encode_fluent` returned.
    pattern
        Subject, predicate and object; None matches everything.

    Returns
    -------
    EpisodicFluent or None
        The fluent; None if it does not match, which takes a fraction of the time.
    """
    values = json.loads(data)
    wanted = (pattern.subject, pattern.predicate, pattern.object)
    if any(part is not None and part != value for part, value in zip(wanted, values[1:4], strict=True)):
        return None
    return _fluent(values)


def encode_logged(last: int, by: str, written: float, kind: Kind, before: bytes | None, after: bytes | None) -> bytes:
    """Return a log entry as bytes; its sequence number is its key.

    Parameters
    ----------
    last
        Sequence number of the last change of the same write.
    by
        Name of the writer.
    written
        Time of the write in seconds since 1970.
    kind
        Kind of the change.
    before, after
        The encoded fluent before and after the change.

    Returns
    -------
    bytes
        A JSON array.
    """
    head = _write([last, by, written, kind]).encode()
    return b"%b,%b,%b]" % (head[:-1], before or b"null", after or b"null")


def logged_bytes(change: Logged) -> bytes:
    """Return a log entry as bytes, as :func:`encode_logged` does.

    Parameters
    ----------
    change
        The log entry.

    Returns
    -------
    bytes
        A JSON array, without the sequence number.
    """
    before, after = (None if each is None else encode_fluent(each) for each in (change.before, change.after))
    return encode_logged(change.last, change.by, change.written, change.kind, before, after)


def decode_logged(sequence: int, data: bytes) -> Logged:
    """Return the log entry that bytes stand for.

    Parameters
    ----------
    sequence
        Sequence number of the change.
    data
        Bytes that :func:`encode_logged` returned.

    Returns
    -------
    Logged
        The log entry.
    """
    last, by, written, kind, before, after = json.loads(data)
    fluents = (None if each is None else _fluent(each) for each in (before, after))
    return Logged(sequence, last, by, written, kind, *fluents)


def change_to_list(change: Change) -> list[Any]:
    """Return a change as plain data, which JSON can hold.

    Parameters
    ----------
    change
        The change.

    Returns
    -------
    list
        Its kind and its values.

    Examples
    --------
    >>> change_to_list(Finish("f1", 5.0))
    ['finish', 'f1', 5.0]
    """
    match change:
        case Add():
            return ["add", _values(change.fluent)]
        case Finish():
            return ["finish", change.id, _bounds(at(change.at))]
        case Delete():
            return ["delete", change.id]
        case Update():
            statement, source = change.statement, change.source
            return [
                "update",
                change.id,
                None if statement is None else [statement.subject, statement.predicate, statement.object],
                None if change.start is None else [_bounds(at(change.start))],
                None if change.finish is None else [_bounds(at(change.finish))],
                change.certainty,
                None if source is None else [source.origin.value, source.by, source.event],
            ]


def change_of_list(data: Sequence[Any]) -> Change:
    """Return the change that plain data stands for.

    Parameters
    ----------
    data
        Data that :func:`change_to_list` returned.

    Returns
    -------
    Change
        The change.

    Raises
    ------
    ValueError
        If it is of an unknown kind.
    """
    match data:
        case ["add", values]:
            return Add(_fluent(values))
        case ["finish", id, end]:
            return Finish(id, _read(end))
        case ["delete", id]:
            return Delete(id)
        case ["update", id, terms, start, finish, certainty, source]:
            return Update(
                id,
                None if terms is None else Statement(*terms),
                None if start is None else _read(start[0]),
                None if finish is None else _read(finish[0]),
                certainty,
                None if source is None else Source(_ORIGINS[source[0]], *source[1:]),
            )
    raise ValueError("a change of an unknown kind")


def _values(fluent: EpisodicFluent) -> list[Any]:
    statement, source = fluent.fluent.statement, fluent.source
    ends = [_bounds(fluent.fluent.start), _bounds(fluent.fluent.finish)]
    where = [source.origin.value, source.by, source.event]
    terms = [statement.subject, statement.predicate, statement.object]
    return [fluent.fluent.id, *terms, *ends, fluent.certainty, *where]


def _fluent(values: list[Any]) -> EpisodicFluent:
    id, subject, predicate, object, start, finish, certainty, origin, by, event = values
    fluent = Fluent(id, Statement(subject, predicate, object), _read(start), _read(finish))
    return EpisodicFluent(fluent, certainty, Source(_ORIGINS[origin], by, event))


def _bounds(bounds: Bounds) -> list[Any] | float | None:
    """Return null for an unknown time, a number for a known one, or else both bounds and what is open."""
    if bounds.lower == bounds.upper:
        return bounds.lower
    if bounds == UNKNOWN:
        return None
    return [bounds.lower, bounds.upper, bounds.lower_open, bounds.upper_open]


def _read(values: Any) -> Bounds:
    if values is None:
        return UNKNOWN
    return Bounds(*values) if isinstance(values, list) else Bounds(values, values)
