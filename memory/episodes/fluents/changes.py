"""Changes of the blackboard, and the log entries that record them.

>>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
>>> cup = episodic("f1", ("cup", "on", "table"), start=2.0, source=Source(Origin.SEEN, "tracker"))
>>> str(Finish("f1", 5.0).applied(cup).fluent)
'f1: on(cup, table) from [2, 2] to [5, 5]'
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

from deixis.memory.episodes.fluents.episode import EpisodicFluent, Source, at
from deixis.memory.errors import EpisodeError, UnknownFluentError
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.errors import FluentError
from deixis.reasoning.temporal.fluent import Pattern, Statement


@dataclass(frozen=True, slots=True)
class Add:
    """The addition of a fluent, whose id must be new."""

    fluent: EpisodicFluent

    @property
    def id(self) -> str:
        """Id of the fluent."""
        return self.fluent.id

    def applied(self, before: EpisodicFluent | None) -> EpisodicFluent:
        """Return the fluent after the change.

        Parameters
        ----------
        before
            The fluent with the same id before the change; None if there is none.

        Returns
        -------
        EpisodicFluent
            The added fluent.

        Raises
        ------
        EpisodeError
            If there is a fluent with the id.
        """
        if before is not None:
            raise EpisodeError(f"the fluent '{self.id}' is on the blackboard already; update it, or use a new id")
        return self.fluent


@dataclass(frozen=True, slots=True)
class Finish:
    """The end of a fluent at a time in seconds, or within bounds."""

    id: str
    at: float | Bounds

    def applied(self, before: EpisodicFluent | None) -> EpisodicFluent:
        """Return the fluent after the change.

        Parameters
        ----------
        before
            The fluent before the change.

        Returns
        -------
        EpisodicFluent
            The finished fluent.

        Raises
        ------
        UnknownFluentError
            If there is no such fluent.
        EpisodeError
            If it has finished already, or would finish before it starts.
        """
        known = _known(self.id, before)
        if not known.is_open:
            raise EpisodeError(
                f"the fluent '{self.id}' has finished already, in {known.finish}; update it to correct this"
            )
        return _within(known, known.start, at(self.at))


@dataclass(frozen=True, slots=True)
class Update:
    """New values of a fluent; None leaves a value as it is.

    ``start`` and ``finish`` are seconds or bounds; ``Bounds()`` makes a time unknown again.
    """

    id: str
    statement: Statement | None = None
    start: float | Bounds | None = None
    finish: float | Bounds | None = None
    certainty: float | None = None
    source: Source | None = None

    def applied(self, before: EpisodicFluent | None) -> EpisodicFluent:
        """Return the fluent after the change.

        Parameters
        ----------
        before
            The fluent before the change.

        Returns
        -------
        EpisodicFluent
            The fluent with the new values.

        Raises
        ------
        UnknownFluentError
            If there is no such fluent.
        EpisodeError
            If a new value is not admissible.
        """
        known = _known(self.id, before)
        start = known.start if self.start is None else at(self.start)
        finish = known.finish if self.finish is None else at(self.finish)
        certainty = known.certainty if self.certainty is None else self.certainty
        stated = known if self.statement is None else _stating(known, self.statement)
        return replace(_within(stated, start, finish), certainty=certainty, source=self.source or known.source)


@dataclass(frozen=True, slots=True)
class Delete:
    """The removal of a fluent, as if it had never been stated; the log keeps it."""

    id: str

    def applied(self, before: EpisodicFluent | None) -> None:
        """Check that there is a fluent to remove.

        Parameters
        ----------
        before
            The fluent before the change.

        Raises
        ------
        UnknownFluentError
            If there is no such fluent.
        """
        _known(self.id, before)


Change = Add | Finish | Update | Delete

Kind = Literal["add", "finish", "update", "delete"]

KINDS: dict[type, Kind] = {Add: "add", Finish: "finish", Update: "update", Delete: "delete"}
"""Names of the kinds of change by their classes."""


@dataclass(frozen=True, slots=True)
class Logged:
    """One change in the log.

    Sequence numbers count from 1 without gaps. ``last`` is the sequence number of the last change of the same write,
    and ``written`` the time of the write in seconds since 1970. ``before`` is None if the fluent was added, ``after``
    is None if it was deleted.
    """

    sequence: int
    last: int
    by: str
    written: float
    kind: Kind
    before: EpisodicFluent | None
    after: EpisodicFluent | None

    @property
    def id(self) -> str:
        """Id of the fluent."""
        fluent = self.after if self.after is not None else self.before
        assert fluent is not None
        return fluent.id

    def concerns(self, pattern: Pattern) -> bool:
        """Return whether the fluent matches a pattern before or after the change.

        Parameters
        ----------
        pattern
            Subject, predicate and object; None matches everything.

        Returns
        -------
        bool
            True if subscribers to the pattern get the change.
        """
        return any(fluent is not None and pattern.matches(fluent.statement) for fluent in (self.before, self.after))

    def __str__(self) -> str:
        return f"{self.sequence} {self.kind} by {self.by}: {self.after or self.before}"


def _known(id: str, before: EpisodicFluent | None) -> EpisodicFluent:
    if before is None:
        raise UnknownFluentError(f"no fluent '{id}' is on the blackboard")
    return before


def _stating(fluent: EpisodicFluent, statement: Statement) -> EpisodicFluent:
    return replace(fluent, fluent=replace(fluent.fluent, statement=statement))


def _within(known: EpisodicFluent, start: Bounds, finish: Bounds) -> EpisodicFluent:
    try:
        return replace(known, fluent=replace(known.fluent, start=start, finish=finish))
    except FluentError as error:
        raise EpisodeError(f"{error}; does a clock run backwards?") from None
