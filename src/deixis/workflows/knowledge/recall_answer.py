"""Answers to questions about then and now: the fluents that answer them, with the names and places of their things."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import datetime, timedelta

from deixis.answers import Answer
from deixis.arguments import checks_arguments
from deixis.grammar.recall.questions import RecallQuestion
from deixis.memory.episodes.fluents.episode import EpisodicFluent
from deixis.memory.episodes.search import FluentSearch
from deixis.workflows.knowledge.recall_places import RelatedPlace


@dataclass(frozen=True, slots=True)
class Recalled:
    """One fluent of an answer, with the names of its things then."""

    fluent: EpisodicFluent
    name: str
    other: str | None
    place: RelatedPlace | None = None  # what the box of the thing says about its place, with the name of the other one

    @property
    def certainly(self) -> bool:
        """True if both ends are known exactly, or the fluent has not finished and its start is known exactly."""
        start, finish = self.fluent.start, self.fluent.finish
        return start.lower == start.upper and (self.fluent.is_open or finish.lower == finish.upper)


@dataclass(frozen=True, repr=False)
class Recall(Answer):
    """Answer to a question about then and now.

    ``facts`` are the fluents that answer it, in order of time. ``known`` is False if nothing recorded answers it, and
    ``reason`` then says why. ``answer`` is a sentence, ``search`` finds the facts, ``asked`` is the time of asking, and
    ``origin`` the time from which fluents count seconds.

    Examples
    --------
    >>> from datetime import UTC
    >>> from deixis.memory.episodes.blackboard import Blackboard
    >>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
    >>> from deixis.workflows.knowledge.recall import recall
    >>> board, seen = Blackboard.transient(datetime(2026, 5, 1, 12, tzinfo=UTC)), Source(Origin.SEEN, "tracker")
    >>> facts = (("t1", "isA", "fork"), ("t2", "isA", "plate"), ("t1", "left", "t2"))
    >>> for fact in facts:
    ...     number = board.add(episodic(board.new_id("f"), fact, start=60.0, source=seen), by="tracker")
    >>> found = recall("where is the fork?", board, 3600.0)
    >>> found.known, [str(fact.fluent.statement) for fact in found.facts]
    (True, ['left(t1, t2)'])
    >>> found.moment(60.0) == datetime(2026, 5, 1, 12, 1, tzinfo=UTC)
    True
    >>> board.close()
    """

    question: RecallQuestion
    facts: tuple[Recalled, ...]
    search: FluentSearch | None
    answer: str
    reason: str | None
    asked: float
    origin: datetime

    @property
    def known(self) -> bool:
        """True if something recorded answers the question."""
        return self.reason is None

    def summary(self) -> str:
        """Return the answer in a sentence."""
        return self.answer

    @checks_arguments
    def moment(self, seconds: float) -> datetime | None:
        """Return seconds since the origin as local time.

        Parameters
        ----------
        seconds
            Seconds since the origin of the memory.

        Returns
        -------
        datetime or None
            The moment; None for an infinite number, which stands for an unknown time.
        """
        return None if math.isinf(seconds) else (self.origin + timedelta(seconds=seconds)).astimezone()
