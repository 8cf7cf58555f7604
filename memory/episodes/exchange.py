"""Export the fluents of a blackboard as text, and import such a text.

>>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
>>> with Blackboard.transient() as first, Blackboard.transient(first.origin) as second:
...     _ = first.add(episodic("f1", ("cup", "on", "table"), start=2.0, source=Source(Origin.SAID, "anna")), by="anna")
...     text = export_episodes(first)
...     import_episodes(second, text, "a.episodes.json"), export_episodes(second) == text, second.new_id("f")
(1, True, 'f2')
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from deixis.memory.episodes.blackboard import Blackboard, has_episodes
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.errors import EpisodeError, ImportFormatError, RejectedWriteError
from deixis.memory.folder import EPISODES, size
from deixis.ontology.strict_json import json_type, parse_json
from deixis.printable import shortened
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.errors import FluentError
from deixis.reasoning.temporal.fluent import Statement
from deixis.text_files import read_text

ENDING = ".episodes.json"
"""Ending of the exported files."""

FORMAT, VERSION = "deixis-episodes", 1

MAX_FILE_CHARACTERS = 2**30
"""Maximum number of characters of an export that is imported."""

IMPORT = "import"
"""Name under which the log of the blackboard records what was imported."""


@dataclass(frozen=True, slots=True)
class EpisodeStats:
    """Numbers of fluents, of those that have not finished, and of the changes in the log; and bytes on disk."""

    fluents: int
    open: int
    changes: int
    bytes: int


def export_episodes(board: Blackboard) -> str:
    """Return the fluents of a blackboard as JSON, the same text for the same content.

    Parameters
    ----------
    board
        The blackboard.

    Returns
    -------
    str
        The origin of times, and a line for each fluent in the order of ids; the log is not part of it.
    """
    fluents = sorted(board.holding(), key=lambda each: each.id)
    lines = [json.dumps(_to_list(each), ensure_ascii=False) for each in fluents]
    head = json.dumps({"format": FORMAT, "version": VERSION, "origin": board.origin.isoformat()})
    return head[:-1] + ', "fluents": [' + "".join(f"\n{line}," for line in lines).rstrip(",") + "\n]}\n"


def import_episodes(board: Blackboard, text: str, file: str) -> int:
    """Add exported fluents to a blackboard: all of them or, if one is refused, none.

    Times are moved to the origin of the blackboard. Ids of the file are never reused.

    Parameters
    ----------
    board
        The blackboard.
    text
        An export.
    file
        Its name in messages.

    Returns
    -------
    int
        Number of the fluents that were added; equal ones that are there already are not counted.

    Raises
    ------
    ImportFormatError
        If the text is not an export.
    RejectedWriteError
        If the blackboard has another fluent with an id of the file, or a shape is violated.
    """
    origin, fluents = read_episodes(text, file)
    shift = (origin - board.origin).total_seconds()
    new = []
    for each in (_shifted(one, shift) for one in fluents):
        known = board.fluent(each.id)
        if known is None:
            new.append(each)
        elif not _same(known, each):
            raise RejectedWriteError(
                f"{file}: its fluent '{each.id}' differs from the one of this memory; import into another memory"
            )
    if new:
        board.write(*map(Add, new), by=IMPORT)
    statements = [each.statement for each in fluents]
    names = [each.id for each in fluents]
    names += [name or "" for statement in statements for name in (statement.subject, statement.object)]
    board.reserve([*names, *(each.source.event or "" for each in fluents)])
    return len(new)


def import_file(memory: Path, file: Path) -> int:
    """Add the fluents of a file to the blackboard of a memory; a new one gets the origin of the file.

    Parameters
    ----------
    memory
        Folder of the memory.
    file
        The file.

    Returns
    -------
    int
        Number of the fluents that were added.

    Raises
    ------
    ImportFormatError
        If the file cannot be read, or is not an export.
    RejectedWriteError
        If the blackboard refuses a fluent; nothing is changed then.
    """
    text = read_text(file, ImportFormatError, MAX_FILE_CHARACTERS)
    origin, _ = read_episodes(text, str(file))
    with Blackboard.open(memory, create=True, origin=origin) as board:
        return import_episodes(board, text, str(file))


def stats_of(memory: Path) -> EpisodeStats | None:
    """Return how much the blackboard of a memory holds.

    Parameters
    ----------
    memory
        Folder of the memory.

    Returns
    -------
    EpisodeStats or None
        The numbers; None if it has no blackboard.
    """
    if not has_episodes(memory):
        return None
    with Blackboard.open(memory) as board:
        return EpisodeStats(len(board.holding()), len(board.now()), board.sequence, size(memory / EPISODES))


def read_episodes(text: str, file: str) -> tuple[datetime, tuple[EpisodicFluent, ...]]:
    """Read an export.

    Parameters
    ----------
    text
        The text.
    file
        Its name in messages.

    Returns
    -------
    origin : datetime
        Time from which the fluents count seconds.
    fluents : tuple of EpisodicFluent
        The fluents.

    Raises
    ------
    ImportFormatError
        If the text is not an export.
    """
    data = parse_json(text, file, ImportFormatError, "is not a time; write null for an unknown bound")
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise ImportFormatError(f"{file}: an export of episodes must state the format {FORMAT!r}")
    if data.get("version") != VERSION:
        raise ImportFormatError(f"{file}: the version of the format must be {VERSION}, got {_shown(data, 'version')}")
    try:
        origin = datetime.fromisoformat(data["origin"])
    except (KeyError, TypeError, ValueError):
        raise ImportFormatError(
            f"{file}: 'origin' must be a time as in 2026-11-23T12:30:00+00:00, got {_shown(data, 'origin')}"
        ) from None
    if origin.tzinfo is None:
        raise ImportFormatError(f"{file}: the origin of times must have a time zone")
    if not isinstance(data.get("fluents"), list):
        raise ImportFormatError(f"{file}: 'fluents' must be a list, got {_shown(data, 'fluents')}")
    fluents = []
    for number, entry in enumerate(data["fluents"], 1):
        try:
            fluents.append(_of_list(entry))
        except (ImportFormatError, EpisodeError, FluentError, SettingError) as error:
            raise ImportFormatError(f"{file}: fluent {number} of the list: {error}") from error
    return origin, tuple(fluents)


def _shown(data: dict[str, Any], key: str) -> str:
    """Return the value of a key for messages; 'nothing' if it is missing."""
    return shortened(json.dumps(data[key], ensure_ascii=False), 60) if key in data else "nothing"


def has_ending(file: Path) -> bool:
    """Return whether a file has the ending of an export of episodes.

    Parameters
    ----------
    file
        The file.

    Returns
    -------
    bool
        True if it has.
    """
    return file.name.endswith(ENDING)


def _to_list(fluent: EpisodicFluent) -> list[Any]:
    statement, source = fluent.statement, fluent.source
    ends = [*_finite(fluent.start), *_finite(fluent.finish)]
    terms = [statement.subject, statement.predicate, statement.object]
    return [fluent.id, terms, ends, fluent.certainty, [source.origin.value, source.by, source.event]]


def _finite(bounds: Bounds) -> list[float | None]:
    return [time if math.isfinite(time) else None for time in (bounds.lower, bounds.upper)]


def _of_list(data: Any) -> EpisodicFluent:
    """Return the fluent in parsed JSON; raise ImportFormatError if it has another form."""
    form = "[id, [subject, predicate, object], [4 times or null], certainty, [origin, by, event]]"
    if not isinstance(data, list) or len(data) != 5:
        raise ImportFormatError(f"it must be {form}, got {json_type(data)}")
    id, statement, ends, certainty, source = data
    for name, value, length in (("statement", statement, 3), ("list of times", ends, 4), ("source", source, 3)):
        if not isinstance(value, list) or len(value) != length:
            raise ImportFormatError(f"its {name} must be a list of {length} parts, as in {form}")
    for number in (*(end for end in ends if end is not None), certainty):
        if json_type(number) != "a number":
            raise ImportFormatError(f"its times and certainty must be numbers, as in {form}, got {json_type(number)}")
    (subject, predicate, thing), (origin, by, event) = statement, source
    texts = {
        "id": id,
        "subject": subject,
        "predicate": predicate,
        "object": thing,
        "person or module": by,
        "event": event,
    }
    for name, value in texts.items():
        if not isinstance(value, str) and not (value is None and name in ("object", "event")):
            raise ImportFormatError(f"its {name} must be a string, got {json_type(value)}")
    origins = [each.value for each in Origin]
    if origin not in origins:
        raise ImportFormatError(f"its origin must be one of {', '.join(origins)}, got {json.dumps(origin):.60}")
    unknown = (-math.inf, math.inf, -math.inf, math.inf)
    first, last, earliest, latest = (u if end is None else float(end) for end, u in zip(ends, unknown, strict=True))
    return episodic(
        id,
        Statement(subject, predicate, thing),
        start=Bounds(first, last),
        finish=Bounds(earliest, latest),
        certainty=certainty,
        source=Source(Origin(origin), by, event),
    )


def _shifted(fluent: EpisodicFluent, shift: float) -> EpisodicFluent:
    if shift == 0:
        return fluent
    start, finish = (Bounds(each.lower + shift, each.upper + shift) for each in (fluent.start, fluent.finish))
    return episodic(
        fluent.id, fluent.statement, start=start, finish=finish, certainty=fluent.certainty, source=fluent.source
    )


def _same(first: EpisodicFluent, second: EpisodicFluent) -> bool:
    """Return whether two fluents are equal up to the rounding of moved times."""
    times = [(each.start.lower, each.start.upper, each.finish.lower, each.finish.upper) for each in (first, second)]
    near = all(one == other or abs(one - other) < 1e-4 for one, other in zip(*times, strict=True))
    rest = [(each.statement, each.certainty, each.source) for each in (first, second)]
    return near and rest[0] == rest[1]
