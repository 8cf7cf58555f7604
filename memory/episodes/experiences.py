"""Experiences: named stretches of time that were recorded, and what held in them.

>>> from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
>>> with Blackboard.transient() as board:
...     start_recording(board, "first table", 1.0, by="robot")
...     source = Source(Origin.SEEN, "tracker")
...     _ = board.add(episodic("f1", ("t1", "on", "table"), start=2.0, source=source), by="tracker")
...     finish_recording(board, "first table", 3.0, by="robot")
...     [str(each.statement) for each in episode(board, "first table")]
'e1'
['on(t1, table)']
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Protocol

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Change, Update
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.errors import EpisodeError
from deixis.reasoning.temporal.fluent import ANYTHING, Pattern, Statement

RECORDED = "recorded"
"""Predicate of the fluent that an experience with the subject's name is recorded."""

CONSOLIDATED = "consolidated"
"""Predicate of the fluent that an experience was consolidated; its object is the id of the lesson."""

_MARKERS = {RECORDED, CONSOLIDATED}


class Holding(Protocol):
    """A blackboard, or a part of one, of which one can ask what held when."""

    def holding(
        self, pattern: Pattern = ANYTHING, start: float | None = None, end: float | None = None
    ) -> tuple[EpisodicFluent, ...]:
        """Return what may have held in a window of time.

        Parameters
        ----------
        pattern
            Subject, predicate and object; None matches everything.
        start, end
            Ends of the window in seconds; by default it has no end on that side.

        Returns
        -------
        tuple of EpisodicFluent
            The fluents in the order of their earliest starts.
        """
        ...


@dataclass(frozen=True, slots=True)
class Experience:
    """A recorded stretch of time, in seconds; ``finish`` is None while it is recorded."""

    name: str
    id: str
    start: float
    finish: float | None

    def __str__(self) -> str:
        until = "still recorded" if self.finish is None else f"to {self.finish:g} s"
        return f"{self.name}: from {self.start:g} {until}"


def start_recording(board: Blackboard, name: str, at: float, by: str) -> str:
    """Start to record an experience.

    Parameters
    ----------
    board
        The blackboard.
    name
        Name of the experience, which no other may have.
    at
        Time in seconds.
    by
        Name of the writer.

    Returns
    -------
    str
        Id of the fluent that stands for the experience.

    Raises
    ------
    EpisodeError
        If the name is blank, or there is an experience of this name.
    """
    _require_new(board, name)
    id = board.new_id("e")
    board.add(episodic(id, (name, RECORDED), start=at, source=Source(Origin.INFERRED, by)), by=by)
    return id


def finish_recording(board: Blackboard, name: str, at: float, by: str) -> None:
    """Finish the recording of an experience.

    Parameters
    ----------
    board
        The blackboard.
    name
        Name of the experience.
    at
        Time in seconds.
    by
        Name of the writer.

    Raises
    ------
    EpisodeError
        If there is no such experience, or it has finished.
    """
    board.finish(experience_named(board, name).id, at, by=by)


def experiences(board: Holding) -> tuple[Experience, ...]:
    """Return all experiences.

    Parameters
    ----------
    board
        The blackboard.

    Returns
    -------
    tuple of Experience
        The experiences in the order of their starts.
    """
    return tuple(_read(each) for each in board.holding(Pattern(predicate=RECORDED)))


def episode(board: Holding, name: str) -> tuple[EpisodicFluent, ...]:
    """Return what held in an experience.

    Parameters
    ----------
    board
        The blackboard.
    name
        Name of the experience.

    Returns
    -------
    tuple of EpisodicFluent
        The fluents that held at some time of it, without those that stand for experiences.

    Raises
    ------
    EpisodeError
        If there is no such experience.
    """
    found = experience_named(board, name)
    held = board.holding(start=found.start, end=found.finish)
    return tuple(each for each in held if each.statement.predicate not in _MARKERS)


def put_episode(
    board: Blackboard, name: str, fluents: Sequence[EpisodicFluent], start: float, finish: float, by: str
) -> int:
    """Write an experience with its fluents as one: all of them or, if one is refused, nothing.

    Parameters
    ----------
    board
        The blackboard.
    name
        Name of the experience, which no other may have.
    fluents
        Fluents with new ids.
    start, finish
        Times of the experience in seconds.
    by
        Name of the writer.

    Returns
    -------
    int
        Sequence number of the last change.

    Raises
    ------
    EpisodeError
        If the name is blank, there is an experience of this name, or a fluent cannot be written.
    """
    _require_new(board, name)
    source = Source(Origin.INFERRED, by)
    marker = episodic(board.new_id("e"), (name, RECORDED), start=start, finish=finish, source=source)
    return board.write(Add(marker), *map(Add, fluents), by=by)


def _require_new(board: Blackboard, name: str) -> None:
    """Check the name of a new experience; raise EpisodeError if it is not a name, or is in use."""
    if not name.strip() or not name.isprintable():
        raise EpisodeError(f"the name of an experience must be printable text that is not blank, got {name!r:.60}")
    if board.holding(Pattern(name, RECORDED)):
        raise EpisodeError(f"there is an experience '{name}' already; choose another name")


def without_lessons(board: Holding, lessons: Collection[str]) -> tuple[Change, ...]:
    """Return the changes after which experiences do not name lessons that go; they stay consolidated.

    Parameters
    ----------
    board
        The blackboard.
    lessons
        Ids of the lessons.

    Returns
    -------
    tuple of Change
        A change for each experience that taught one of the lessons.
    """
    marks = board.holding(Pattern(predicate=CONSOLIDATED))
    return tuple(
        Update(each.id, statement=Statement(each.statement.subject, CONSOLIDATED))
        for each in marks
        if each.statement.object in lessons
    )


def experience_named(board: Holding, name: str) -> Experience:
    """Return the experience of a name.

    Parameters
    ----------
    board
        The blackboard.
    name
        Its name.

    Returns
    -------
    Experience
        The experience.

    Raises
    ------
    EpisodeError
        If there is none of this name; the message has the last ones.
    """
    found = board.holding(Pattern(name, RECORDED))
    if not found:
        known = ", ".join(each.name for each in experiences(board)[-5:])
        raise EpisodeError(f"there is no experience '{name}'; the blackboard has {known or 'no experiences'}")
    return _read(found[0])


def _read(fluent: EpisodicFluent) -> Experience:
    finish = None if fluent.is_open else fluent.finish.upper
    return Experience(fluent.statement.subject, fluent.id, fluent.start.lower, finish)
