"""Find what people point at, and which thing each spoken name is taught to.

A name counts only if a gesture falls in the same moment: at most ``SAME_MOMENT`` seconds lie between the words and the
hold. People begin to point before they name, and hold on until they have named (Levelt and others 1985).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.grammar.utterances import Utterance, read_utterances
from deixis.perception.errors import PointingError
from deixis.perception.formats.skeletons import read_skeletons
from deixis.perception.pointing.aim import SURE, Pointing, pointed_at
from deixis.perception.pointing.gesture import Gesture, arms_seen, gestures
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.scene import Scene
from deixis.workflows.layouts.read import as_scene

SAME_MOMENT = 1.0
"""Maximum time between a name and the hold of a gesture in the same moment, in seconds."""

MIN_CONFIDENCE = 0.5
"""Minimum confidence of a recogniser in words that are taught."""

MIN_LEAD = 0.25
"""Time by which a gesture must overlap the words more than others that point at something else, in seconds."""

MIN_SIZE_FIT = 0.02
"""Minimum weight of a thing whose size is unusual for what a name means."""


@dataclass(frozen=True, slots=True)
class SpokenName:
    """Name that a sentence gives to what is pointed at: *this is a fork*.

    ``positive`` is False for *this is not a fork*, and ``corrects`` is True for *no, that is a fork*.
    """

    name: str
    positive: bool = True
    corrects: bool = False


@dataclass(frozen=True, eq=False)
class PointedLabel:
    """A name that was said, and the thing that it is taught to, or why it is not.

    Parameters
    ----------
    utterance
        What was said.
    name
        The name in it; None if it names nothing.
    positive
        False if the sentence says that the thing is not called so.
    target
        Id of the thing that the name is taught to, or None.
    probability
        Probability that the name is meant for the thing: that of the gesture times the confidence of the words.
    pointing
        Gesture of the same moment, read together with the name; None without one.
    refused
        Reason why nothing is taught, or None.
    question
        Question that would settle it, or None.
    """

    utterance: Utterance
    name: str | None
    positive: bool = True
    target: str | None = None
    probability: float = 0.0
    pointing: Pointing | None = None
    refused: str | None = None
    question: str | None = None


@dataclass(frozen=True, repr=False)
class Shown(Answer):
    """Gestures with what they point at, and names with the things that they are taught to.

    Examples
    --------
    >>> import deixis
    >>> from deixis.examples_data import example
    >>> shown = deixis.point(example("showing.skeleton.jsonl"), example("showing.scene.json"))
    >>> shown
    <Shown 4 gestures, 0 names taught>
    >>> shown.taught
    ()
    """

    pointings: tuple[Pointing, ...]
    labels: tuple[PointedLabel, ...]
    contradictions: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def taught(self) -> tuple[PointedLabel, ...]:
        """Names that are taught to a thing."""
        return tuple(label for label in self.labels if label.target is not None and label.refused is None)

    def summary(self) -> str:
        """Return the numbers of gestures and of taught names."""
        return f"{count(len(self.pointings), 'gesture')}, {count(len(self.taught), 'name')} taught"


@checks_arguments
def point(
    skeletons: Iterable[Skeleton] | str | Path,
    scene: Scene | str | Path | Mapping[str, Any],
    said: Iterable[Utterance] | str | Path = (),
    *,
    sure: float = SURE,
) -> Shown:
    """Find what people point at in a scene, and which thing each spoken name is taught to.

    Parameters
    ----------
    skeletons
        Skeletons in order of time, or a file of them (``.skeleton.jsonl``).
    scene
        Things in metres with heights, or its file or parsed JSON, in the frame of the skeletons.
    said
        Utterances, or a file of them (``.said.jsonl``), on the clock of the skeletons.
    sure
        Minimum probability of a decided thing.

    Returns
    -------
    Shown
        The gestures with the probabilities of the things, and the names.

    Raises
    ------
    PointingError
        If a file cannot be read, the scene has no heights, or ``sure`` is not in (0.5, 1).
    UtteranceError
        If an utterance is invalid.

    Notes
    -----
    A name is evidence too: things of another size than the lexicon gives for it are less probable. The gesture is
    detected by :func:`deixis.perception.pointing.gesture.gestures` and compared with the things by
    :func:`deixis.perception.pointing.aim.pointed_at`.

    Examples
    --------
    >>> import deixis
    >>> from deixis.examples_data import example
    >>> skeletons, scene = example("showing.skeleton.jsonl"), example("showing.scene.json")
    >>> found = deixis.point(skeletons, scene, example("showing.said.jsonl"))
    >>> [(label.utterance.text, label.target) for label in found.taught]
    [('this is a plate', 'o1'), ('that one is called a fork', 'o2')]
    """
    notes: tuple[str, ...] = ()
    if isinstance(skeletons, str | Path):
        source = read_skeletons(skeletons)
        frames, notes = source.skeletons, source.notes
    else:
        frames = tuple(skeletons)
    seen = as_scene(scene)
    utterances = read_utterances(said) if isinstance(said, str | Path) else tuple(sorted(said, key=lambda one: one.at))
    if frames and not arms_seen(frames):
        names = sorted({name for one in frames for name in one.joints})
        raise PointingError(
            "no frame has a shoulder, an elbow and a wrist of one arm, such as 'right_shoulder', 'right_elbow' and"
            f" 'right_wrist'; the joints are: {', '.join(names)[:200] or 'none'}"
        )
    pointings = tuple(pointed_at(gesture, seen, sure=sure) for gesture in gestures(frames))
    labels, contradictions = taught_labels([pointed_label(one, pointings, seen, sure) for one in utterances], seen)
    return Shown(pointings, labels, contradictions, notes)


def spoken_name(text: str) -> SpokenName | None:
    """Return the name that a sentence gives to what is pointed at.

    Parameters
    ----------
    text
        English: *this is a fork*, *that one is called a ladle*, *the salad plate*, *no, that is a spoon*.

    Returns
    -------
    SpokenName or None
        The name in the singular; None for a question, a command, or a sentence about anything else. A bare noun is a
        name only if nothing else is said: *layout tea; teacup on saucer* is a script.

    Examples
    --------
    >>> spoken_name("This is not a soup spoon.")
    SpokenName(name='soup spoon', positive=False, corrects=False)
    >>> spoken_name("Where is the fork?") is None
    True
    """
    from deixis.grammar.english.parse import parse_english
    from deixis.grammar.english.tree import Mood

    plain = re.sub(r"\b(is|are|'s) (?:called|named|known as)\b", r"\1", text)
    plain, corrects = without_correction(plain)
    if not plain.strip():
        return None
    sentences = parse_english(plain)
    for sentence in sentences:
        for clause in sentence.clauses:
            for predicate in clause.predicates:
                demonstrated = clause.subject is not None and not clause.subject.head
                if predicate.relation == "kind" and demonstrated and clause.mood is Mood.STATEMENT:
                    noun = predicate.arguments[0].head
                    if noun:
                        return SpokenName(noun, predicate.positive and clause.positive, corrects)
        phrase = sentence.fragment if len(sentences) == 1 and not sentence.clauses else None
        if phrase is not None and phrase.head and not phrase.predicates and sentence.words == sentence.words_understood:
            return SpokenName(phrase.head, not phrase.negated, corrects)
    return None


def without_correction(text: str) -> tuple[str, bool]:
    """Return a sentence without the word that corrects an earlier one, and whether it had one.

    Parameters
    ----------
    text
        English.

    Returns
    -------
    tuple
        The rest of the sentence, and True if it begins with *no*, *wrong* or *sorry*.

    Examples
    --------
    >>> without_correction("No, that is a spoon.")
    ('that is a spoon.', True)
    """
    found = re.match(r"\s*(?:no|wrong|sorry)\b[\s,:;.!-]*", text, re.IGNORECASE)
    return (text, False) if found is None else (text[found.end() :], True)


def pointed_label(
    utterance: Utterance, pointings: Sequence[Pointing], scene: Scene, sure: float = SURE
) -> PointedLabel:
    """Return what an utterance names, before it is compared with the other labels.

    Parameters
    ----------
    utterance
        The words.
    pointings
        Gestures with what they point at.
    scene
        The things.
    sure
        Minimum probability of a decided thing.

    Returns
    -------
    PointedLabel
        The name and the thing, or why nothing is taught.
    """
    naming = spoken_name(utterance.text)
    if naming is None:
        return PointedLabel(utterance, None, refused="names nothing that could be pointed at")
    label = PointedLabel(utterance, naming.name, naming.positive)
    if utterance.confidence < MIN_CONFIDENCE:
        return replace(label, refused=f"recognised with a confidence of {utterance.confidence:.2f} only")
    near = [one for one in pointings if overlap(utterance, one.gesture) >= -SAME_MOMENT]
    if not near:
        return replace(label, refused=f"no gesture within {SAME_MOMENT:g} s of the words")
    weights = size_weights(naming.name, scene) if naming.positive else None
    read = [pointed_at(one.gesture, scene, prior=weights, sure=sure) for one in near]
    useful = [one for one in read if one.none < 0.5] or read
    most = max(overlap(utterance, one.gesture) for one in useful)
    together = [one for one in useful if overlap(utterance, one.gesture) >= most - MIN_LEAD]
    chosen = max(together, key=lambda one: overlap(utterance, one.gesture))
    if len({one.decided for one in together}) > 1:
        return replace(label, pointing=chosen, refused="two gestures of the same moment point at different things")
    best = max(chosen.probabilities.values(), default=0.0)
    return replace(
        label,
        target=chosen.decided,
        probability=best * utterance.confidence,
        pointing=chosen,
        refused=chosen.refused,
        question=chosen.question,
    )


def overlap(utterance: Utterance, gesture: Gesture) -> float:
    """Return how long words and a hold overlap in time.

    Parameters
    ----------
    utterance
        The words.
    gesture
        The gesture.

    Returns
    -------
    float
        Seconds; the time between them, negative, if they do not overlap.
    """
    return min(gesture.finish, utterance.end) - max(gesture.start, utterance.at)


def size_weights(name: str, scene: Scene) -> dict[str, float]:
    """Return how well the size of each thing fits what a name usually measures.

    Parameters
    ----------
    name
        A noun.
    scene
        Things in metres with heights.

    Returns
    -------
    dict
        Weights in (0, 1] by id, all 1 for a noun that the lexicon does not know.
    """
    from deixis.ontology.tbox import default_ontology

    lexicon = default_ontology().lexicon
    if not lexicon.knows(name) or not scene.objects or scene.boxes.shape[2] != 3:
        return dict.fromkeys(scene.ids, 1.0)
    extents = scene.boxes[:, 1] - scene.boxes[:, 0]
    turned = {i: thing.oriented.extents for i, thing in enumerate(scene.objects) if thing.oriented is not None}
    for i, sides in turned.items():
        extents[i] = sides
    plane = np.sort(extents[:, :2], axis=1)
    measured = np.log(np.maximum(np.column_stack([plane[:, 1], plane[:, 0], extents[:, 2]]), 0.005))
    usual = lexicon.size_of(name)
    ends = [
        [max(getattr(one, end), 0.005) for one in (usual.length, usual.width, usual.height)]
        for end in ("least", "greatest")
    ]
    least, greatest = np.log(ends)
    off = np.maximum(least - measured, 0.0) + np.maximum(measured - greatest, 0.0)
    fits = np.maximum(np.exp(-3.0 * off.sum(axis=1)), MIN_SIZE_FIT)
    return dict(zip(scene.ids, fits.tolist(), strict=True))


def taught_labels(labels: Sequence[PointedLabel], scene: Scene) -> tuple[tuple[PointedLabel, ...], tuple[str, ...]]:
    """Return labels with those refused that contradict an earlier one of the same thing, and the contradictions.

    Two names of one thing contradict each other unless the lexicon knows one as a synonym or a kind of the other. A
    correction (*no, that is a spoon*) takes back what was said before.

    Parameters
    ----------
    labels
        Labels in order of time.
    scene
        The things.

    Returns
    -------
    labels : tuple of PointedLabel
        The labels, in the same order.
    contradictions : tuple of str
        A sentence for each contradiction.
    """
    from deixis.ontology.lexicon.lexicon import Relatedness
    from deixis.ontology.tbox import default_ontology

    lexicon = default_ontology().lexicon
    agree = {Relatedness.SAME, Relatedness.SYNONYM, Relatedness.BROADER, Relatedness.NARROWER}
    result = list(labels)
    found: list[str] = []
    for place, label in enumerate(labels):
        if label.target is None or label.refused is not None or label.name is None:
            continue
        corrects = without_correction(label.utterance.text)[1]
        for earlier in range(place):
            other = result[earlier]
            if other.target != label.target or other.refused is not None or other.name is None:
                continue
            agreeing = lexicon.relation(label.name, other.name) in agree
            if (label.positive and other.positive and not agreeing) or (label.positive != other.positive and agreeing):
                if corrects:
                    result[earlier] = replace(other, refused=f"taken back at {label.utterance.at:g} s")
                    continue
                who = "" if label.utterance.speaker == other.utterance.speaker else f" by {other.utterance.speaker}"
                claims = [f"{'' if one.positive else 'not '}{one.name}" for one in (other, label)]
                found.append(
                    f"{label.utterance.speaker} calls {label.target} '{claims[1]}' at {label.utterance.at:g} s;"
                    f" it was called '{claims[0]}' at {other.utterance.at:g} s{who}"
                )
                question = f"Is {label.target} {claims[0]} or {claims[1]}?"
                result[place] = replace(
                    label, refused=f"contradicts '{claims[0]}' of {other.utterance.at:g} s", question=question
                )
    return tuple(result), tuple(found)
