"""Keep sentences that teach adjectives on the blackboard of a memory, and read the attributes back.

A sentence becomes one fluent for each thing that is an example of its adjective: subject is the thing, predicate
``calledAs`` or ``notCalledAs``, object the word with the measures of the thing, all with the id of the sentence as the
event of their source. Attributes are computed from these fluents alone, so that a memory without a sentence is what it
would be had that sentence never been said.
"""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Delete
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.ontology.rdf.triples import content_key
from deixis.perception.scene import Scene
from deixis.reasoning.attributes.attribute import MEASURES, Attribute, Example
from deixis.reasoning.errors import DescriptionError
from deixis.reasoning.temporal.fluent import Pattern
from deixis.workflows.descriptions.attributes import examples_of, new_adjectives

CALLED, NOT_CALLED = "calledAs", "notCalledAs"
"""Predicates of things that a word was used of, and of those that it was not used of."""


def remember_sentence(board: Blackboard, text: str, scene: Scene, target: str, by: str = "user") -> str:
    """Keep what a sentence teaches about its new adjectives.

    Parameters
    ----------
    board
        The blackboard.
    text
        Sentence such as *the blick one*.
    scene
        The scene that it was said of.
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
            entry = json.loads(fluent.statement.object or "{}")
            measures = np.array([np.nan if value is None else value for value in entry["measures"]], dtype=np.float64)
            if len(measures) == len(MEASURES):
                found.setdefault(entry["word"], []).append(Example(measures, entry["label"], positive))
    return {word: Attribute(word, tuple(examples)) for word, examples in found.items()}


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
