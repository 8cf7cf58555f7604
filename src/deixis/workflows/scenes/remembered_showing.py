"""Keep what was said, pointed at and taught as fluents on the blackboard of a memory."""

from __future__ import annotations

from collections.abc import Iterator

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.workflows.scenes.point import Shown

MIN_CERTAINTY = 1e-6
"""Minimum certainty of a fluent, which must be above 0."""


def remember_showing(board: Blackboard, shown: Shown, since: float = 0.0, by: str = "pointing") -> int:
    """Write utterances, gestures and taught names to a blackboard, all of them or none.

    An utterance becomes ``said(speaker, text)``, a decided gesture ``pointedAt(person, thing)``, and a taught name
    ``isA(thing, name)`` from the moment on at which it was said. The source of a name has the id of its utterance.

    Parameters
    ----------
    board
        The blackboard.
    shown
        Gestures and names (:func:`deixis.point`).
    since
        Time of the recording's clock zero, in seconds since the origin of the memory.
    by
        Name of the module that writes.

    Returns
    -------
    int
        Number of the last change.

    Raises
    ------
    EpisodeError
        If the blackboard refuses the fluents.
    """
    return board.write(*(Add(fluent) for fluent in _fluents(board, shown, since, by)), by=by)


def _fluents(board: Blackboard, shown: Shown, since: float, by: str) -> Iterator[EpisodicFluent]:
    for pointing in shown.pointings:
        gesture, event = pointing.gesture, board.new_id("gesture")
        if pointing.decided is not None:
            yield episodic(
                event,
                (gesture.person, "pointedAt", pointing.decided),
                start=since + gesture.start,
                finish=since + gesture.finish,
                certainty=pointing.probabilities[pointing.decided],
                source=Source(Origin.SEEN, by, event),
            )
    for label in shown.labels:
        utterance, event = label.utterance, board.new_id("utterance")
        yield episodic(
            event,
            (utterance.speaker, "said", utterance.text),
            start=since + utterance.at,
            finish=since + utterance.end if utterance.end > utterance.at else None,
            certainty=max(utterance.confidence, MIN_CERTAINTY),
            source=Source(Origin.SAID, utterance.speaker, event),
        )
        if label.target is not None and label.refused is None and label.positive and label.name is not None:
            yield episodic(
                board.new_id("name"),
                (label.target, "isA", label.name),
                start=since + utterance.at,
                certainty=max(label.probability, MIN_CERTAINTY),
                source=Source(Origin.SHOWN, utterance.speaker, event),
            )
