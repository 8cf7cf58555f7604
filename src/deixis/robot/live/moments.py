"""Key moments of a live run, read from its episodes: what was seen, known and said at each of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.episode import EpisodicFluent
from deixis.memory.episodes.predicates import AT, CALLED, FAULT, IS_A, LAYOUT, NOT_CALLED, POINTED_AT, SAID, SAYS
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.live.senses import NOTICED, TABLE, VIEW_ENDING
from deixis.workflows.scenes.point import SAME_MOMENT

SITUATION_DELAY = 0.01
"""Seconds after the beginning of a moment at which its situation is read."""


@dataclass(frozen=True)
class Moment:
    """One key moment.

    Attributes
    ----------
    at
        Seconds since the story began.
    view
        File with the camera's image of the last look at the table; None before the first one.
    things
        Category of each thing that is on the table, by its id; None for one that is unknown.
    new
        Ids of the things that came since the moment before.
    pointed
        Ids of the things that a person points at or names.
    said
        What was said and noticed, in order, as pairs of the speaker and the words.
    layout
        Name of the layout of the table, or None.
    faults
        What is wrong with the table.
    """

    at: float
    view: Path | None
    things: Mapping[str, str | None]
    new: frozenset[str]
    pointed: frozenset[str]
    said: tuple[tuple[str, str], ...]
    layout: str | None
    faults: tuple[str, ...]


def key_moments(board: Blackboard, began: float) -> tuple[Moment, ...]:
    """Return the key moments of a run: each time that a person spoke, and each look at a table that had changed.

    Parameters
    ----------
    board
        The blackboard.
    began
        Time at which the story began, in seconds since the origin of the memory.

    Returns
    -------
    tuple of Moment
        The moments in the order of time.
    """
    fluents = [each for each in board.holding(start=began) if each.start.lower >= began - SITUATION_DELAY]
    times = sorted({each.start.lower for each in fluents if each.statement.predicate in (SAID, TABLE)})
    found: list[Moment] = []
    for at in times:
        before = found[-1].things if found else {}
        moment = _moment(board, fluents, at, began, before)
        if moment.said or moment.things != before:
            found.append(moment)
    return tuple(found)


def _moment(
    board: Blackboard, fluents: Sequence[EpisodicFluent], at: float, began: float, before: Mapping[str, str | None]
) -> Moment:
    def holding(predicate: str) -> list[EpisodicFluent]:
        found = board.holding(Pattern(predicate=predicate), at + SITUATION_DELAY, at + SITUATION_DELAY)
        return [each for each in found if each.start.lower >= began - SITUATION_DELAY]

    names = {each.statement.subject: each.statement.object for each in holding(IS_A)}
    things = {each.statement.subject: names.get(each.statement.subject) for each in holding(AT)}
    looks = [each for each in fluents if each.statement.predicate == TABLE and each.start.lower <= at + SITUATION_DELAY]
    spoken = [each for each in fluents if each.statement.predicate in (SAID, SAYS, NOTICED) and each.start.lower == at]
    words = [each for each in spoken if each.statement.predicate == SAID]
    end = max((each.finish.upper for each in words), default=at)
    aims = board.holding(Pattern(predicate=POINTED_AT), at - SAME_MOMENT, end + SAME_MOMENT) if words else ()
    named = frozenset(
        each.statement.subject
        for each in fluents
        if each.statement.predicate in (CALLED, NOT_CALLED) and each.start.lower == at
    )
    speakers = {SAYS: "robot", NOTICED: "note"}
    return Moment(
        at - began,
        Path(str(looks[-1].statement.object)).with_suffix("").with_suffix(VIEW_ENDING) if looks else None,
        things,
        frozenset(things) - frozenset(before),
        frozenset(str(each.statement.object) for each in aims) | named,
        tuple(
            (speakers.get(each.statement.predicate, each.statement.subject), str(each.statement.object))
            for each in spoken
        ),
        next((each.statement.object for each in holding(LAYOUT)), None),
        tuple(str(each.statement.object) for each in holding(FAULT)),
    )
