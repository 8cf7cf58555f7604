"""Read and write files of fluents, ``.fluents.json``; errors name the place in the file.

A file holds the origin from which times are counted, fluents with bounds on their starts and finishes, and relations
between them: Allen's, or bounds on the time from one point to another. ``docs/reference/time.md`` describes the format.
"""

from __future__ import annotations

import json
import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from deixis.errors import DeixisError
from deixis.grammar.errors import shortened
from deixis.grammar.files import read_text
from deixis.ontology.relations.allen import SYMBOLS, Allen, allen_mask, members
from deixis.ontology.strict_json import json_type, parse_json
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.bounds import MAX_SECONDS, UNKNOWN, Bounds
from deixis.reasoning.temporal.fluent import (
    ORIGIN,
    AllenStatement,
    EndDifference,
    Fluent,
    Statement,
    TemporalRelation,
)
from deixis.spelling import nearest
from deixis.text_files import is_folder

UNITS = {"s": 1.0, "ms": 0.001, "min": 60.0, "h": 3600.0}
"""Lengths of the accepted units, in seconds."""

_ALLEN = {relation.name.lower(): relation for relation in Allen} | dict(zip(SYMBOLS, Allen, strict=True))
_BOUNDS_KEYS = ("lower", "upper", "lower_open", "upper_open")


class FluentFileError(DeixisError, ValueError):
    """A file of fluents with an error; the message names the file and the place in it."""


@dataclass(frozen=True)
class FluentFile:
    """Fluents and relations between them, with times in seconds since ``origin``, a description in words."""

    origin: str
    fluents: tuple[Fluent, ...]
    relations: tuple[TemporalRelation, ...] = ()
    file: str = field(default="<fluents>", compare=False)


def read_fluents(path: str | Path) -> FluentFile:
    """Read a file of fluents.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    FluentFile
        The fluents and their relations.

    Raises
    ------
    FluentFileError
        If the file has an error; the message names the place.
    ScriptFileError
        If the file cannot be read.
    """
    if is_folder(path):
        raise FluentFileError(f"{path}: this is a folder, not a file of fluents")
    return parse_fluents(read_text(Path(path), str(path)), str(path))


def parse_fluents(text: str, file: str = "<fluents>") -> FluentFile:
    """Read the text of a file of fluents.

    Parameters
    ----------
    text
        The text, in JSON.
    file
        Its name in messages and explanations.

    Returns
    -------
    FluentFile
        The fluents and their relations.

    Raises
    ------
    FluentFileError
        If the text has an error; the message names the line and column, or the path to the place.

    Examples
    --------
    >>> cup = '{"id": "f", "statement": ["cup", "full"], "start": [0, 2]}'
    >>> parsed = parse_fluents(f'{{"origin": "noon", "fluents": [{cup}]}}')
    >>> str(parsed.fluents[0])
    'f: full(cup) from [0, 2] to (-∞, ∞)'

    Raises FluentFileError: with line and column if the text is not JSON, or else with the path to the place.
    """
    parsed = parse_json(text, file, FluentFileError, "is not a time; write null for an unknown bound")
    if not isinstance(parsed, dict):
        raise FluentFileError(f"{file}: the content must be an object {{…}}, got {json_type(parsed)}")
    data = _object(parsed, file, ("origin", "unit", "fluents", "relations"), ("origin", "fluents"))
    origin = _text(data["origin"], f"{file}: origin")
    unit = _text(data.get("unit", "s"), f"{file}: unit")
    if unit not in UNITS:
        raise FluentFileError(f"{file}: unit must be one of {', '.join(UNITS)}, got '{shortened(unit)}'")
    fluents: dict[str, Fluent] = {}
    for position, entry in enumerate(_list(data["fluents"], f"{file}: fluents")):
        fluent = _fluent(entry, f"{file}: fluents[{position}]", UNITS[unit])
        if fluent.id in fluents:
            raise FluentFileError(
                f"{fluent.source}.id: '{shortened(fluent.id)}' is used twice; give each fluent its own id"
            )
        fluents[fluent.id] = fluent
    points = dict.fromkeys([ORIGIN, *(point for fluent in fluents.values() for point in fluent.points)])
    relations = tuple(
        _relation(entry, f"{file}: relations[{position}]", UNITS[unit], fluents, points)
        for position, entry in enumerate(_list(data.get("relations", []), f"{file}: relations"))
    )
    return FluentFile(origin, tuple(fluents.values()), relations, file)


def _fluent(data: Any, where: str, scale: float) -> Fluent:
    entry = _object(data, where, ("id", "statement", "start", "finish"), ("id", "statement"))
    name = _text(entry["id"], f"{where}.id")
    words = _list(entry["statement"], f"{where}.statement")
    if len(words) not in (2, 3):
        raise FluentFileError(
            f"{where}.statement must be a subject, a predicate and optionally an object, got {len(words)} words"
        )
    statement = Statement(*(_text(word, f"{where}.statement[{position}]") for position, word in enumerate(words)))
    start = _bounds(entry.get("start"), f"{where}.start", scale)
    finish = _bounds(entry.get("finish"), f"{where}.finish", scale)
    return Fluent(name, statement, start, finish, where)


def _relation(
    data: Any, where: str, scale: float, fluents: Collection[str], points: Collection[str]
) -> TemporalRelation:
    if isinstance(data, dict) and data.keys() & {"a", "allen", "b"}:
        entry = _object(data, where, ("a", "allen", "b"), ("a", "allen", "b"))
        a, b = (_known(entry[end], f"{where}.{end}", fluents, "fluent") for end in "ab")
        names = _list(entry["allen"], f"{where}.allen")
        if not names:
            raise FluentFileError(
                f'{where}.allen must have at least one relation, got none; write one, such as "before"'
            )
        relations = [_ALLEN[_known(n, f"{where}.allen[{k}]", _ALLEN, "relation")] for k, n in enumerate(names)]
        return AllenStatement(a, allen_mask(relations), b, where)
    entry = _object(data, where, ("from", "to", "bounds"), ("from", "to", "bounds"))
    tail, head = (_known(entry[end], f"{where}.{end}", points, "point") for end in ("from", "to"))
    return EndDifference(tail, head, _bounds(entry["bounds"], f"{where}.bounds", scale), where)


def _bounds(data: Any, where: str, scale: float) -> Bounds:
    """Return the bounds in ``[lower, upper]``, or in an object that also says which ends are open; null is unknown."""
    if data is None:
        return UNKNOWN
    flags = (False, False)
    if isinstance(data, dict):
        entry = _object(data, where, _BOUNDS_KEYS, ("lower", "upper"))
        flags = (_flag(entry, "lower_open", where), _flag(entry, "upper_open", where))
        data = [entry["lower"], entry["upper"]]
    ends = _list(data, where)
    if len(ends) != 2:
        raise FluentFileError(f"{where} must be two bounds, [lower, upper], each of which may be null, got {len(ends)}")
    lower = -math.inf if ends[0] is None else _number(ends[0], f"{where}[0]", scale)
    upper = math.inf if ends[1] is None else _number(ends[1], f"{where}[1]", scale)
    try:
        return Bounds(lower, upper, *flags)
    except SettingError as error:
        raise FluentFileError(f"{where}: {error}") from None


def _flag(entry: dict[str, Any], key: str, where: str) -> bool:
    if not isinstance(entry.get(key, False), bool):
        raise FluentFileError(f"{where}.{key} must be true or false, got {json_type(entry[key])}")
    return bool(entry.get(key, False))


def _number(data: Any, where: str, scale: float) -> float:
    if isinstance(data, bool) or not isinstance(data, int | float):
        raise FluentFileError(f"{where} must be a number or null, got {json_type(data)}")
    if not abs(data) <= MAX_SECONDS / scale:
        raise FluentFileError(
            f"{where} must be at most {MAX_SECONDS:g} s from zero, got {data * scale:g} s; check the unit"
        )
    return data * scale


def _object(data: Any, where: str, known: Sequence[str], needed: Sequence[str]) -> dict[str, Any]:
    if not isinstance(data, dict):
        raise FluentFileError(f"{where} must be an object {{…}}, got {json_type(data)}")
    for key in data:
        if key not in known:
            hint = _suggestion(key, known)
            raise FluentFileError(f"{where}: unknown key '{shortened(key)}'; {hint}the keys are {', '.join(known)}")
    for key in needed:
        if key not in data:
            raise FluentFileError(f"{where}: '{key}' is missing")
    return data


def _list(data: Any, where: str) -> list[Any]:
    if not isinstance(data, list):
        raise FluentFileError(f"{where} must be a list, got {json_type(data)}")
    return data


def _text(data: Any, where: str) -> str:
    if not isinstance(data, str):
        raise FluentFileError(f"{where} must be a string, got {json_type(data)}")
    if not data.strip() or not data.isprintable():
        raise FluentFileError(
            f"{where} must be one line of printable text that is not blank, got {shortened(ascii(data))}"
        )
    return data


def _known(data: Any, where: str, names: Collection[str], kind: str) -> str:
    """Return the name in ``data``; raise FluentFileError if it is not among ``names``."""
    name = _text(data, where)
    if name not in names:
        hint = _suggestion(name, names).removesuffix("; ")
        raise FluentFileError(f"{where}: there is no {kind} '{shortened(name)}'{'; ' if hint else ''}{hint}")
    return name


def _suggestion(name: str, names: Collection[str]) -> str:
    near = nearest(name, names)
    if near is not None:
        return f"did you mean '{shortened(near)}'?; "
    stem = name.rpartition(".")[0]
    points = [other for other in names if stem and other.rpartition(".")[0] == stem]
    return f"there are {' and '.join(map(shortened, points))}; " if points else ""


def format_fluents(content: FluentFile) -> str:
    """Return the text of a file of fluents, one fluent or relation per line.

    Parameters
    ----------
    content
        The fluents and their relations.

    Returns
    -------
    str
        The text; reading it gives the same content.
    """
    head = f'{{\n  "origin": {_json(content.origin)},\n  "unit": "s",\n'
    fluents = _lines([_fluent_to_dict(fluent) for fluent in content.fluents])
    relations = _lines([_relation_to_dict(relation) for relation in content.relations])
    return f'{head}  "fluents": {fluents},\n  "relations": {relations}\n}}\n'


def bounds_to_json(bounds: Bounds) -> Any:
    """Return bounds as a file writes them.

    Parameters
    ----------
    bounds
        Lower and upper bound in seconds.

    Returns
    -------
    list or dict
        ``[lower, upper]``, or an object if an end is open.

    Examples
    --------
    >>> bounds_to_json(Bounds(0, 5)), bounds_to_json(Bounds(2.5))
    ([0, 5], [2.5, None])
    """
    ends = [None if math.isinf(bound) else bound for bound in (bounds.lower, bounds.upper)]
    if not (bounds.lower_open or bounds.upper_open):
        return ends
    return dict(zip(_BOUNDS_KEYS, (*ends, bounds.lower_open, bounds.upper_open), strict=True))


def _fluent_to_dict(fluent: Fluent) -> dict[str, Any]:
    statement = fluent.statement
    words = [statement.subject, statement.predicate, *([] if statement.object is None else [statement.object])]
    ends = {"start": bounds_to_json(fluent.start), "finish": bounds_to_json(fluent.finish)}
    return {"id": fluent.id, "statement": words, **ends}


def _relation_to_dict(relation: TemporalRelation) -> dict[str, Any]:
    if isinstance(relation, AllenStatement):
        names = [found.name.lower() for found in members(relation.relations)]
        return {"a": relation.a, "allen": names, "b": relation.b}
    return {"from": relation.tail, "to": relation.head, "bounds": bounds_to_json(relation.bounds)}


def _lines(entries: Sequence[dict[str, Any]]) -> str:
    return "[" + ",".join(f"\n    {_json(entry)}" for entry in entries) + ("\n  ]" if entries else "]")


def _json(data: Any) -> str:
    return json.dumps(data, ensure_ascii=False)
