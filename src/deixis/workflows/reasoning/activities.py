"""Ground described activities in sequences of fluents, learn them from examples, and recognise them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.deadline import Deadline
from deixis.grammar.activities import read_activities, told_activity, write_activities
from deixis.grammar.formats.fluents import read_fluents
from deixis.reasoning.activities.activity import Activity, Laying, StepSequence, box_of
from deixis.reasoning.activities.grounding import (
    ActivityGrounding,
    RecognisedActivity,
    ground_activity,
    recognise_activity,
)
from deixis.reasoning.activities.prediction import LayingModel, Prediction
from deixis.reasoning.errors import NothingFoundError, SettingError
from deixis.reasoning.temporal.fluent import Fluent, Statement
from deixis.text_files import changing

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
    """Return the sequence in which things came, as recorded on a blackboard.

    Parameters
    ----------
    board
        The blackboard.
    start, end
        Window in seconds since the origin of the memory; without them, all that is recorded.

    Returns
    -------
    StepSequence
        A fluent for each thing that came, named by its category, with its box.
    """
    from deixis.workflows.knowledge.recall import arrivals

    fluents = [
        Fluent(
            each.id,
            Statement(name, "placed") if box_of(each.statement) is None else replace(each.statement, subject=name),
            each.start,
            each.finish,
        )
        for each, name in arrivals(board, start, end)
    ]
    return StepSequence.of(fluents)


def sequences_of_experiences(board: Blackboard, names: Sequence[str] = ()) -> tuple[StepSequence, ...]:
    """Return the sequences in which things came in experiences.

    Parameters
    ----------
    board
        The blackboard.
    names
        Names of experiences; by default all whose recording has finished.

    Returns
    -------
    tuple of StepSequence
        A sequence for each experience, in the given order or in that of their starts.

    Raises
    ------
    EpisodeError
        If there is no experience of a name.
    NothingFoundError
        If no experience has finished, or nothing came in one of them.
    """
    from deixis.memory.episodes.experiences import experience_named, experiences

    chosen = [experience_named(board, name) for name in names]
    chosen = chosen or [each for each in experiences(board) if each.finish is not None]
    if not chosen:
        raise NothingFoundError(
            "the memory has no finished experience; record one with 'deixis robot run --experience'"
        )
    sequences = []
    for each in chosen:
        sequences.append(sequence_of_episodes(board, each.start, each.finish))
        if not sequences[-1].steps:
            raise NothingFoundError(f"nothing came to the table in the experience '{each.name}'; leave it out")
    return tuple(sequences)


def ground(
    activity_text: str | Activity, source: str | Path | StepSequence, time_limit: float = 10.0
) -> ActivityGrounding:
    """Match an activity with the fluents of a sequence.

    Parameters
    ----------
    activity_text
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
    activity = activity_text if isinstance(activity_text, Activity) else told_activity(activity_text, seen)
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

    Raises
    ------
    SettingError
        If the name is blank.
    ActivityTextError
        If the file of activities cannot be read or written.
    """
    if not name.strip():
        raise SettingError("the name of an activity must have at least one word, got none")
    activity = Activity.learned(name, [sequence_of(source) for source in sources])
    if known is None:
        return activity
    with changing(known):
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
    activities = _known(known)
    if not activities:
        raise NothingFoundError("no activity is known; 'deixis activity learn' learns one from examples")
    return recognise_activity(activities, sequence_of(source), Deadline.after(time_limit))


def predict(
    source: str | Path | StepSequence | None,
    known: str | Path | Sequence[Activity] = (),
    name: str | None = None,
    told: str | None = None,
) -> Prediction:
    """Predict what is laid next, and where.

    Parameters
    ----------
    source
        What was laid so far: a sequence, a file of fluents, or None for nothing. Places are those of statements of the
        predicate ``at``, whose object is a box.
    known
        Learned activities, or the file that has them.
    name
        Name of the learned activity; it is needed if there are several.
    told
        Order that a person stated, such as ``first the plate, then the forks``.

    Returns
    -------
    Prediction
        Kinds with probabilities and places.

    Raises
    ------
    NothingFoundError
        If there is no learned activity of the name, and no stated order.
    SettingError
        If there are several learned activities, and no name.

    Examples
    --------
    >>> predict(None, told="first the plate, then the fork, finally the cup").things[0].kind
    'plate'
    """
    activities = _known(known)
    if name is not None:
        activities = tuple(each for each in activities if each.name == name)
    if len(activities) > 1:
        raise SettingError(f"name one of the activities: {', '.join(sorted(each.name for each in activities))}")
    if not activities and (told is None or name is not None):
        raise NothingFoundError(
            f"no activity {'' if name is None else repr(name) + ' '}is known; 'deixis activity learn' learns one"
        )
    layings = [laying for each in activities for laying in each.layings]
    largest = StepSequence.of(
        Fluent(f"{kind}_{number}", Statement(kind, "placed"))
        for kind, count in _max_counts(layings).items()
        for number in range(count)
    )
    laid = () if source is None else sequence_of(source).laying
    order = None if told is None else told_activity(told, largest)
    return LayingModel(layings, order, name or (activities[0].name if activities else "told")).predict(laid)


def _known(known: str | Path | Sequence[Activity]) -> tuple[Activity, ...]:
    return read_activities(known) if isinstance(known, str | Path) else tuple(known)


def _max_counts(layings: Sequence[Laying]) -> Counter[str]:
    """Return the largest number of things of each kind in one laying."""
    most: Counter[str] = Counter()
    for laying in layings:
        most |= Counter(thing.kind for thing in laying)
    return most
