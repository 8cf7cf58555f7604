"""Fluents as the blackboard holds them: with a certainty, and with the source from which they are known.

>>> cup = episodic("f1", ("cup", "on", "table"), start=2.0, source=Source(Origin.SAID, "anna", "sentence 4"))
>>> str(cup)
'f1: on(cup, table) from [2, 2] to (-∞, ∞), certainty 1, said by anna (sentence 4)'
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import datetime
from enum import Enum

from deixis.memory.errors import EpisodeError
from deixis.reasoning.temporal.bounds import UNKNOWN, Bounds
from deixis.reasoning.temporal.fluent import Fluent, Statement

MAX_TEXT = 100_000
"""Maximum length of one text of a fluent, in characters."""


class Origin(Enum):
    """Ways in which a fluent can become known."""

    SEEN = "seen"
    SHOWN = "shown"
    SAID = "said"
    INFERRED = "inferred"


@dataclass(frozen=True, slots=True)
class Source:
    """Where a fluent comes from.

    ``by`` is the module or person that states it, ``event`` the id of the sentence, frame, gesture or lesson. Raises
    EpisodeError if a text is empty or not printable.
    """

    origin: Origin
    by: str
    event: str | None = None

    def __post_init__(self) -> None:
        check_text(self.by, "the person or module of a source")
        if self.event is not None:
            check_text(self.event, "the event of a source")

    def __str__(self) -> str:
        return f"{self.origin.value} by {self.by}" + ("" if self.event is None else f" ({self.event})")


@dataclass(frozen=True, slots=True)
class EpisodicFluent:
    """A fluent with its certainty in (0, 1] and its source.

    Times are in seconds since the origin of the memory. Raises EpisodeError if the certainty is outside (0, 1], or a
    text is empty, too long, or not printable.
    """

    fluent: Fluent
    certainty: float
    source: Source

    def __post_init__(self) -> None:
        if not (isinstance(self.certainty, int | float) and 0 < self.certainty <= 1):
            raise EpisodeError(f"the certainty of '{self.id}' must be above 0 and at most 1, got {self.certainty}")
        statement = self.fluent.statement
        for text, what in ((self.id, "id"), (statement.subject, "subject"), (statement.predicate, "predicate")):
            check_text(text, f"the {what} of a fluent")
        if statement.object is not None:
            check_text(statement.object, f"the object of '{self.id}'")

    @property
    def id(self) -> str:
        """Id of the fluent, unique in one memory."""
        return self.fluent.id

    @property
    def statement(self) -> Statement:
        """Subject, predicate and object."""
        return self.fluent.statement

    @property
    def start(self) -> Bounds:
        """Interval in which the fluent starts to hold, in seconds."""
        return self.fluent.start

    @property
    def finish(self) -> Bounds:
        """Interval in which the fluent ceases to hold, in seconds."""
        return self.fluent.finish

    @property
    def is_open(self) -> bool:
        """True if no upper bound of the finish is known, so that the fluent belongs to the current situation."""
        return math.isinf(self.finish.upper)

    @property
    def started_by(self) -> float:
        """Latest time of the start in seconds; its earliest one where the latest is unknown, else -infinity."""
        return self.start.upper if math.isfinite(self.start.upper) else self.start.lower

    def may_hold(self, start: float, end: float) -> bool:
        """Return whether the fluent may hold at some time of a window.

        Parameters
        ----------
        start, end
            Ends of the window in seconds, which belong to it.

        Returns
        -------
        bool
            True if it may start by ``end`` and finish after ``start``.
        """
        return self.start.lower <= end and self.finish.upper > start

    def must_hold(self, start: float, end: float) -> bool:
        """Return whether the fluent holds at some time of a window, whatever its true start and finish are.

        Parameters
        ----------
        start, end
            Ends of the window in seconds, which belong to it.

        Returns
        -------
        bool
            True if it starts by ``end`` and finishes after ``start`` for each start and finish in its bounds. An open
            fluent is taken not to have finished.
        """
        return self.start.upper <= end and (self.is_open or self.finish.lower > start)

    def __str__(self) -> str:
        return f"{self.fluent}, certainty {self.certainty:g}, {self.source}"


def check_text(text: str, what: str) -> str:
    """Return a text if it may be stored.

    Parameters
    ----------
    text
        The text.
    what
        Its name in the message.

    Returns
    -------
    str
        The text.

    Raises
    ------
    EpisodeError
        If it is not a string, empty, longer than ``MAX_TEXT``, or not printable.
    """
    if not isinstance(text, str):
        raise EpisodeError(f"{what} must be a string, got {type(text).__name__}")
    if not text.strip() or not text.isprintable():
        raise EpisodeError(f"{what} must be one line of printable text that is not blank, got {ascii(text)[:60]}")
    if len(text) > MAX_TEXT:
        raise EpisodeError(f"{what} must have at most {MAX_TEXT} characters, got {len(text)}")
    return text


def at(time: float | Bounds | None) -> Bounds:
    """Return the bounds of a time that is known, known within bounds, or unknown.

    Parameters
    ----------
    time
        Seconds since the origin of the memory, bounds, or None if nothing is known.

    Returns
    -------
    Bounds
        Earliest and latest time.
    """
    if time is None:
        return UNKNOWN
    return time if isinstance(time, Bounds) else Bounds(time, time)


def episodic(
    id: str,
    statement: Statement | tuple[str, str] | tuple[str, str, str | None],
    *,
    start: float | Bounds | None,
    finish: float | Bounds | None = None,
    certainty: float = 1.0,
    source: Source,
) -> EpisodicFluent:
    """Return a fluent for the blackboard.

    Parameters
    ----------
    id
        Id of the fluent, unique in one memory.
    statement
        Subject, predicate and, if it has one, object.
    start, finish
        Times in seconds since the origin of the memory, bounds on them, or None if unknown.
    certainty
        Probability that the statement is true, in (0, 1].
    source
        How it became known, and by whom.

    Returns
    -------
    EpisodicFluent
        The fluent.

    Raises
    ------
    EpisodeError
        If the certainty or a text is not admissible.
    FluentError
        If the bounds leave no start before a finish.
    """
    if isinstance(statement, Statement):
        parsed = statement
    else:
        parsed = Statement(statement[0], statement[1], statement[2] if len(statement) == 3 else None)
    return EpisodicFluent(Fluent(id, parsed, at(start), at(finish)), certainty, source)


EVENT = "event"
"""Key in the metadata of a view: the event in which a person showed its thing (:func:`event_of`)."""


def event_of(origin: datetime, event: str) -> str:
    """Return the name of an event of one blackboard, by which another store can refer to it.

    Parameters
    ----------
    origin
        Origin of the blackboard.
    event
        Id of the event.

    Returns
    -------
    str
        The origin and the id, so that the event of another memory is not taken for one of this memory.

    Examples
    --------
    >>> from datetime import UTC
    >>> event_of(datetime(2026, 5, 1, tzinfo=UTC), "gesture3")
    '2026-05-01T00:00:00+00:00 gesture3'
    """
    return f"{origin.isoformat()} {event}"
