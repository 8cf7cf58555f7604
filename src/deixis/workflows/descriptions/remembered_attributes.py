"""Keep sentences that teach adjectives on the blackboard of a memory, and read the attributes back.

A sentence becomes one fluent for each thing that is an example of its adjective: subject is the thing, predicate
``calledAs`` or ``notCalledAs``, object the word with the measures of the thing, all with the id of the sentence as the
event of their source. Attributes are computed from these fluents alone, so that after a sentence is removed, the memory
is as if the sentence had never been said.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Delete
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.ontology.rdf.triples import content_key
from deixis.ontology.strict_json import parse_json
from deixis.perception.scene import Scene
from deixis.reasoning.attributes.attribute import MEASURES, Attribute, Example
from deixis.reasoning.errors import DescriptionError
from deixis.reasoning.temporal.fluent import Pattern
from deixis.workflows.descriptions.attributes import examples_of, new_adjectives

CALLED, NOT_CALLED = "calledAs", "notCalledAs"
"""Predicates of things that a word was used of, and of those that it was not used of."""

LARGEST = 1e30
"""Bound of a measure; a larger one was not written by :func:`remember_sentence`."""


def remember_sentence(board: Blackboard, text: str, scene: Scene, target: str, by: str = "user") -> str:
    """Keep what a sentence teaches about its new adjectives.

    Parameters
    ----------
    board
        The blackboard.
    text
        Sentence such as *the blick one*.
    scene
        The scene that it was said about.
    target
        Id of the thing that was meant.
    by
        Name of the speaker.

    Returns
    -------
    str
        Id of the sentence; a sentence that is known already is not kept twice.

    Raises
    ------
    DescriptionError
        If the sentence has no new adjective, or the scene has no such thing.
    EpisodeError
        If the blackboard refuses the fluents.
    """
    phrase = new_adjectives(text)
    if phrase is None:
        raise DescriptionError(f"'{text}' has no adjective to learn; write, say, 'the shiny one'")
    examples = examples_of(phrase, scene, target)
    rows = [[None if np.isnan(v) else round(float(v), 4) for v in one.measures] for one in examples]
    sentence = f"sentence-{content_key(json.dumps([text, scene.file, target, by, rows]))[:16]}"
    if any(True for _ in _ids_of(board, sentence)):
        return sentence
    source, now = Source(Origin.SAID, by, sentence), board.seconds()
    changes: list[Add] = []
    for word in phrase.words:
        for one, row in zip(examples, rows, strict=True):
            entry = json.dumps({"word": word, "label": one.label, "measures": row, "text": text})
            predicate = CALLED if one.positive else NOT_CALLED
            id = board.new_id("attribute")
            changes.append(
                Add(episodic(id, (f"{sentence}-{len(changes)}", predicate, entry), start=now, source=source))
            )
    board.write(*changes, by=by)
    return sentence


def remembered_attributes(board: Blackboard) -> dict[str, Attribute]:
    """Return the attributes that the sentences on a blackboard teach.

    Parameters
    ----------
    board
        The blackboard.

    Returns
    -------
    dict
        Attributes by word.
    """
    found: dict[str, list[Example]] = {}
    for predicate, positive in ((CALLED, True), (NOT_CALLED, False)):
        for fluent in board.now(Pattern(predicate=predicate)):
            entry = entry_of(fluent.statement.object)
            if entry is not None:
                measures = [np.nan if value is None else value for value in entry["measures"]]
                example = Example(np.array(measures, dtype=np.float64), entry["label"], positive)
                found.setdefault(entry["word"], []).append(example)
    return {word: Attribute(word, tuple(examples)) for word, examples in found.items()}


def entry_of(text: str | None) -> dict[str, Any] | None:
    """Return what an object of ``calledAs`` or ``notCalledAs`` says.

    Anyone may write to the blackboard, so a text may be anything.

    Parameters
    ----------
    text
        The object.

    Returns
    -------
    dict or None
        The keys ``word``, ``label``, ``measures`` and ``text``; None for a text that is not such an entry.

    Examples
    --------
    >>> entry_of("shiny") is None
    True
    """
    try:
        entry = parse_json(text or "", "", DescriptionError, "is not a measure")
    except DescriptionError:
        return None
    if not isinstance(entry, dict) or not isinstance(entry.get("measures"), list):
        return None
    measures = [value for value in entry["measures"] if value is not None]
    fits = len(entry["measures"]) == len(MEASURES) and all(
        isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < LARGEST for value in measures
    )
    label = entry.get("label")
    texts = isinstance(entry.get("word"), str) and isinstance(entry.get("text"), str)
    return entry if fits and texts and (label is None or isinstance(label, str)) else None


def forget_sentence(board: Blackboard, sentence: str, by: str = "user") -> None:
    """Remove what one sentence taught about adjectives.

    Parameters
    ----------
    board
        The blackboard.
    sentence
        Id of the sentence.
    by
        Name of who removes it.

    Raises
    ------
    DescriptionError
        If no such sentence is kept.
    """
    ids = list(_ids_of(board, sentence))
    if not ids:
        raise DescriptionError(f"no sentence '{sentence}' taught an adjective in this memory")
    board.write(*(Delete(id) for id in ids), by=by)


def _ids_of(board: Blackboard, sentence: str) -> Iterator[str]:
    for predicate in (CALLED, NOT_CALLED):
        for fluent in board.now(Pattern(predicate=predicate)):
            if fluent.source.event == sentence:
                yield fluent.id
