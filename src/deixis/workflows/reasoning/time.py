"""Compute when fluents held, from what is stated about them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from deixis.arguments import checks_arguments
from deixis.grammar.formats.fluents import FluentFile, parse_fluents, read_fluents
from deixis.reasoning.errors import require_time_limit
from deixis.reasoning.qualitative.networks.closure.state import Progress
from deixis.reasoning.temporal.chronology import Chronology
from deixis.reasoning.temporal.timeline import Timeline
from deixis.text_files import require_path_or_text


@checks_arguments
def chronology(fluents: str | Path | None = None, *, text: str | None = None, time_limit: float = 10.0) -> Chronology:
    """Return the implied bounds of when fluents held, and the possible relations of every pair.

    Parameters
    ----------
    fluents
        File of the fluents (``.fluents.json``).
    text
        The content of such a file, instead of a file.
    time_limit
        Seconds for the search over disjunctions.

    Returns
    -------
    Chronology
        The bounds and relations.

    Raises
    ------
    FluentFileError
        If the file has an error; the message names the place.
    TemporalConflictError
        If the statements contradict each other.
    TypeError
        Unless exactly one of ``fluents`` and ``text`` is given.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.chronology("examples/serving.fluents.json")
    >>> found
    <Chronology 5 fluents: consistent>
    >>> sorted(found.to_dict())
    ['exact', 'file', 'fluents', 'origin', 'verdict']
    """
    require_path_or_text("chronology", fluents, text)
    require_time_limit(time_limit)
    content = read_fluents(fluents) if fluents is not None else parse_fluents(text or "")
    return chronology_of(content, timeline_of(content, time_limit), time_limit)


def timeline_of(content: FluentFile, time_limit: float, progress: Progress | None = None) -> Timeline:
    """Return the timeline with all statements of a file.

    Parameters
    ----------
    content
        The fluents and their relations.
    time_limit
        Seconds for each statement.
    progress
        Called with the number of statements added, and of all.

    Returns
    -------
    Timeline
        The timeline.

    Raises
    ------
    TemporalConflictError
        If the statements contradict each other.
    """
    timeline, items = Timeline(), (*content.fluents, *content.relations)
    for number, item in enumerate(items):
        if progress is not None:
            progress(number, len(items))
        timeline.add(item, time_limit)
    return timeline


def chronology_of(content: FluentFile, timeline: Timeline, time_limit: float) -> Chronology:
    """Return the chronology of a file's timeline, with the origin of its times.

    Parameters
    ----------
    content
        The fluents and their relations.
    timeline
        Timeline of its statements.
    time_limit
        Seconds for the search over disjunctions.

    Returns
    -------
    Chronology
        The bounds and relations.
    """
    return replace(timeline.chronology(time_limit), origin=content.origin, file=content.file)
