"""Sentences of the text of a lesson: the lesson that the other sentences teach.

Each statement of a script remembers the sentence that it came from. Without a sentence, the rest of the text is read
again. If that gives other facts than those of the other sentences, because a pronoun or *the other fork* refers to the
sentence that goes, the facts stay as they were read.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate
from typing import TYPE_CHECKING

from deixis.errors import DeixisError
from deixis.grammar.english.reader import read_english
from deixis.grammar.errors import ScriptError
from deixis.grammar.layout.format import format_script
from deixis.grammar.layout.parser import parse_script
from deixis.grammar.reading import Reading
from deixis.grammar.script import Script, Statement
from deixis.learning.lessons.lesson import Occasion, lesson_of
from deixis.perception.formats.scene_json import read_scene
from deixis.version import VERSION
from deixis.workflows.grounding.ground import GroundingRequest, answer

if TYPE_CHECKING:
    from deixis.ontology.lessons.read import Provenance
    from deixis.ontology.lessons.types import LayoutConcept, Lesson
    from deixis.ontology.tbox import Ontology
    from deixis.reasoning.grounding.evidence.words.meaning import Meaning


def plain(text: str) -> str:
    """Return a sentence in lower case, without line ends and without punctuation at its end.

    Parameters
    ----------
    text
        The sentence.

    Returns
    -------
    str
        A text by which two ways of writing one sentence are equal.

    Examples
    --------
    >>> plain("The fork  is left of the plate.")
    'the fork is left of the plate'
    """
    return " ".join(text.lower().split()).rstrip(" .!;")


def without_sentence(text: str, sentence: str, ontology: Ontology) -> str | None:
    """Return an English text without a sentence.

    Parameters
    ----------
    text
        The text.
    sentence
        The sentence, in any case and spacing.
    ontology
        Words of the language.

    Returns
    -------
    str or None
        The other sentences; None if the text has no such sentence, or no other.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> text = "The fork is left of the plate. The knife is right of it."
    >>> without_sentence(text, "the knife is right of it", default_ontology())
    'The fork is left of the plate.'
    """
    try:
        read = read_english(text, ontology=ontology).reading
    except ScriptError:
        return None
    sentences = [] if read is None else [each.text.strip() for each in read.sentences]
    kept = [each for each in sentences if plain(each) != plain(sentence)]
    return " ".join(kept) if kept and len(kept) < len(sentences) else None


def script_without(record: Provenance, layout: LayoutConcept, sentence: str, ontology: Ontology) -> Script | None:
    """Return the script of a lesson without a sentence of its text.

    Parameters
    ----------
    record
        What is known about the lesson.
    layout
        The layout that it taught.
    sentence
        A sentence, or a statement of the layout language.
    ontology
        Words of the language.

    Returns
    -------
    Script or None
        The script that the other sentences state, which may be empty; None if the text has no such sentence.
    """
    try:
        if record.told_text is None:
            return _layout_without(record, layout, sentence, ontology)
        described = read_english(record.told_text, record.script_file, ontology)
    except ScriptError:
        return None
    reading = described.reading
    if reading is None or plain(sentence) not in {plain(each.text) for each in reading.sentences}:
        return None
    kept = [each for each in described.statements if plain(_sentence_of(each, reading)) != plain(sentence)]
    rest = without_sentence(record.told_text, sentence, ontology) or ""
    script = replace(described, statements=tuple(kept), reading=replace(reading, text=rest))
    try:
        again = read_english(rest, record.script_file, ontology)
        if _stated(again) == _stated(script):
            script = again
    except ScriptError:  # it refers to the sentence that goes
        pass
    return replace(script, name=layout.name, title=layout.title)


def _layout_without(record: Provenance, layout: LayoutConcept, sentence: str, ontology: Ontology) -> Script | None:
    """Return a layout script without a statement."""
    script = parse_script(record.script_text, record.script_file, ontology)
    try:
        wanted = {plain(format_script(parse_script(sentence, ontology=ontology)))}
    except ScriptError:
        wanted = set()
    wanted.add(plain(sentence))
    lines, gone = record.script_text.splitlines(), set[int]()
    for each in script.statements:
        own = range(each.source.line - 1, each.source.end_line)
        if plain("\n".join(lines[place] for place in own)) in wanted:
            gone |= set(own)
    if not gone:
        return None
    text = "\n".join(line for place, line in enumerate(lines) if place not in gone)
    try:
        rest = parse_script(text, record.script_file, ontology)
    except ScriptError:  # nothing is left
        rest = replace(script, statements=())
    return replace(rest, name=layout.name, title=layout.title)


def _sentence_of(statement: Statement, reading: Reading) -> str:
    """Return the sentence of an English text that a statement came from."""
    starts = [0, *accumulate(len(line) for line in reading.text.splitlines(keepends=True))]
    place = starts[statement.source.line - 1] + statement.source.column - 1
    spans = ((each.text, *each.span) for each in reading.sentences)
    return next((text for text, first, last in spans if first <= place < last), "")


def _stated(script: Script) -> set[str]:
    return {str(each) for each in script.stated}


def lesson_of_script(
    script: Script, record: Provenance, engine: str, events: Sequence[str], meaning: Meaning
) -> Lesson | None:
    """Return the lesson that a script teaches from the table of an earlier lesson, in its place.

    Parameters
    ----------
    script
        The script.
    record
        What is known about the earlier lesson.
    engine
        Engine that grounded it.
    events
        Ids in the episodes of what the teacher said.
    meaning
        Words and sizes as they were before the lesson.

    Returns
    -------
    Lesson or None
        The lesson with the same id and time; None if the script teaches nothing.
    """
    if not script.objects:
        return None
    scene = replace(read_scene(json.loads(record.scene_text)), file=record.scene_file)
    try:
        found = answer(GroundingRequest(script, scene, engine, meaning=meaning))
    except DeixisError:
        return None
    if not found.object_matches:
        return None
    occasion = Occasion(
        record.started, record.ended or record.started, record.version or VERSION, record.teacher, tuple(events)
    )
    return lesson_of(script, scene, found, record.lesson, occasion)
