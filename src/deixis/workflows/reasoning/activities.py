"""Ground told activities in sequences of fluents, learn them from examples, and recognise them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.deadline import Deadline
from deixis.grammar.activities import read_activities, told_activity, write_activities
from deixis.grammar.formats.fluents import read_fluents
from deixis.reasoning.activities.activity import Activity, StepSequence
from deixis.reasoning.activities.grounding import (
    ActivityGrounding,
    RecognisedActivity,
    ground_activity,
    recognise_activity,
)
from deixis.reasoning.errors import NothingFoundError
from deixis.reasoning.temporal.fluent import Fluent, Statement

if TYPE_CHECKING:
    from deixis.memory.episodes.blackboard import Blackboard


def sequence_of(source: str | Path | StepSequence) -> StepSequence:
    """Return the sequence of a file of fluents.

    Parameters
    ----------
    source
        A sequence, or the name of a file ``.fluents.json``. Relations in the file are not used, bounds are.

    Returns
    -------
    StepSequence
        The sequence.
    """
    return source if isinstance(source, StepSequence) else StepSequence.of(read_fluents(source).fluents)


def sequence_of_episodes(board: Blackboard, start: float | None = None, end: float | None = None) -> StepSequence:
    """Return the sequence in which things came, as a blackboard has it.

    Parameters
    ----------
    board
        The blackboard.
    start, end
        Window in seconds since the origin of the memory; without them, all that is recorded.

    Returns
    -------
    StepSequence
        A fluent for each thing that came, named by its category.
    """
    from deixis.workflows.knowledge.recall import arrivals

    fluents = [
        Fluent(each.id, Statement(name, "placed"), each.start, each.finish)
        for each, name in arrivals(board, start, end)
    ]
    return StepSequence.of(fluents)


def ground(told: str | Activity, source: str | Path | StepSequence, time_limit: float = 10.0) -> ActivityGrounding:
    """Match an activity with the fluents of a sequence.

    Parameters
    ----------
    told
        The activity in words, as in ``first the plate, then the forks``, or a learned one.
    source
        A sequence, or a file of fluents.
    time_limit
        Seconds.

    Returns
    -------
    ActivityGrounding
        Which fluent each step is, what is missing, and what came in another order.
    """
    seen = sequence_of(source)
    activity = told if isinstance(told, Activity) else told_activity(told, seen)
    return ground_activity(activity, seen, Deadline.after(time_limit))


def learn(name: str, sources: Sequence[str | Path | StepSequence], known: str | Path | None = None) -> Activity:
    """Learn an activity from examples, and add it to a file.

    Parameters
    ----------
    name
        Name of the activity.
    sources
        Sequences, or files of fluents.
    known
        File of activities, which is made if it does not exist; examples are added to those of an activity of the name.

    Returns
    -------
    Activity
        The activity with all of its examples.
    """
    activity = Activity.learned(name, [sequence_of(source) for source in sources])
    if known is not None:
        before = read_activities(known) if Path(known).exists() else ()
        same = [each for each in before if each.name == name]
        activity = same[0] + activity if same else activity
        write_activities(known, (*(each for each in before if each.name != name), activity))
    return activity


def recognise(
    source: str | Path | StepSequence, known: str | Path | Sequence[Activity], time_limit: float = 10.0
) -> RecognisedActivity:
    """Recognise which of the known activities a sequence is.

    Parameters
    ----------
    source
        A sequence, or a file of fluents.
    known
        Activities, or the file that has them.
    time_limit
        Seconds.

    Returns
    -------
    RecognisedActivity
        The probability of each activity, and of none of them.

    Raises
    ------
    NothingFoundError
        If no activity is known.
    """
    activities = read_activities(known) if isinstance(known, str | Path) else tuple(known)
    if not activities:
        raise NothingFoundError("no activity is known; 'deixis activity learn' learns one from examples")
    return recognise_activity(activities, sequence_of(source), Deadline.after(time_limit))
