"""A layout or a scene in English: lines for the terminal, and plain data."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.report.layouts.read import content_to_dict
from deixis.report.marks import doubt

if TYPE_CHECKING:
    from deixis.grammar.reading import StatedFact
    from deixis.workflows.descriptions.telling import Telling, ToldObject

WIDTH = 100
"""Columns of the text."""


def telling_lines(telling: Telling) -> list[str]:
    """Return the text, filled to the width of the terminal, the ids of numbered things, and what it could not say.

    Parameters
    ----------
    telling
        Answer of ``deixis tell``.

    Returns
    -------
    list of str
        Lines of at most :data:`WIDTH` characters unless a word is longer; then the warnings, marked as doubt.
    """
    lines = textwrap.wrap(telling.text, WIDTH, break_long_words=False, break_on_hyphens=False) or ["Nothing is stated."]
    numbered = [f"{thing.words} is {thing.id}" for thing in telling.objects if _is_numbered(thing)]
    lines += textwrap.wrap(f"In the scene, {', '.join(numbered)}.", WIDTH) if numbered else []
    lines += [doubt(f"Not read as it is meant: {content}") for content in telling.misread]
    lost = [thing.id for thing in telling.objects if thing.found is False]
    if lost:
        lines.append(doubt(f"Not singled out: {', '.join(lost)}."))
    return lines + [doubt(f"Note: {note}") for note in telling.notes]


def _is_numbered(thing: ToldObject) -> bool:
    """Return whether the text names a thing of a scene by its number, as *the second cup*."""
    return thing.found is not None and thing.words.rpartition(" ")[2].isdecimal()


def telling_to_dict(telling: Telling) -> dict[str, Any]:
    """Return the text, its sentences with the facts that they state, and the words for each object.

    Parameters
    ----------
    telling
        Answer of ``deixis tell``.

    Returns
    -------
    dict
        Data for JSON with the keys ``file``, ``text``, ``sentences``, ``objects``, ``left_out``, ``misread`` and
        ``notes``. ``found`` of an object is False where its words do not single it out.
    """
    return {
        "file": telling.file,
        "text": telling.text,
        "sentences": [
            {"text": sentence.text, "facts": [_stated_to_dict(telling.facts[i]) for i in sentence.facts]}
            for sentence in telling.sentences
        ],
        "objects": [
            {"id": thing.id, "words": thing.words, "description": thing.description, "found": thing.found}
            for thing in telling.objects
        ],
        "left_out": [content_to_dict(fact) for fact in telling.left_out],
        "misread": [content_to_dict(content) for content in telling.misread],
        "notes": list(telling.notes),
    }


def _stated_to_dict(stated: StatedFact) -> dict[str, Any]:
    marks = {"condition": stated.condition, "past": stated.past, "uncertain": stated.uncertain}
    return content_to_dict(stated.content) | marks


def telling_rows(telling: Telling) -> Iterator[dict[str, Any]]:
    """Yield a row for each sentence.

    Parameters
    ----------
    telling
        Answer of ``deixis tell``.

    Yields
    ------
    dict
        ``sentence``, and the ``facts`` that it states, as text.
    """
    for sentence in telling.sentences:
        facts = "; ".join(str(telling.facts[i].content) for i in sentence.facts)
        yield {"sentence": sentence.text, "facts": facts}
