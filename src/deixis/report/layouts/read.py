"""A text in English as it was read: lines for the terminal, and plain data."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.export import claim_to_dict, fact_to_dict
from deixis.report.json_answers import script_to_dict
from deixis.report.marks import doubt

if TYPE_CHECKING:
    from deixis.grammar.reading import Reading, ReadSentence, StatedFact
    from deixis.grammar.script import Script
    from deixis.ontology.graph.facts import Fact
    from deixis.workflows.layouts.read_english import ReadText


def reading_lines(script: Script) -> list[str]:
    """Return each sentence with its facts, a paraphrase, and what was not understood.

    Parameters
    ----------
    script
        Text in English that was read.

    Returns
    -------
    list of str
        Each sentence, with its indented paraphrase, facts and problems; then what the text says is absent, and the
        share of understood words.

    Raises
    ------
    DeixisError
        If the script is a layout script, which has no sentences.
    """
    reading = _reading(script)
    lines: list[str] = []
    facts: dict[int, list[StatedFact]] = {}
    for fact in reading.stated:
        facts.setdefault(fact.sentence, []).append(fact)
    for number, sentence in enumerate(reading.sentences):
        lines.append(sentence.text)
        if sentence.paraphrase:
            lines.append(f"    = {sentence.paraphrase}")
        elif sentence.question:
            lines.append("    a question: it states no fact")
        lines += [f"    {_content(fact)}{_marks(fact)}" for fact in facts.get(number, ())]
        lines += [doubt(f"    {problem.source}: {problem.message}") for problem in sentence.problems]
    if reading.absent:
        lines.append(f"Not there: {', '.join(reading.absent)}.")
    if reading.uncounted:
        lines.append(f"Groups of unknown number: {', '.join(reading.uncounted)}.")
    lines.append(f"Understood: {reading.understood:.0%} of the words.")
    return lines


def _content(fact: StatedFact) -> str:
    """Return a fact or claim; an option of a choice has the weight of its share, and is not something rare."""
    return str(fact.content if fact.alternative is None else replace(fact.content, weight=1.0))


def _marks(fact: StatedFact) -> str:
    content = fact.content
    marks = list(fact.reservations)
    marks += [f"choice {fact.alternative}"] if fact.alternative is not None else []
    marks += ["optional"] if content.optional else []
    marks += [f"weight {content.weight:g}"] if content.weight != 1 else []
    return f"   [{', '.join(marks)}]" if marks else ""


def reading_to_dict(script: Script) -> dict[str, Any]:
    """Return a text as it was read: its objects with their mentions, all facts, and the sentences.

    Parameters
    ----------
    script
        Text in English that was read.

    Returns
    -------
    dict
        Data of :func:`~deixis.report.json_answers.script_to_dict` with the mentions of each object, the sentences, and
        under ``understood`` the share of understood words in [0, 1].

    Raises
    ------
    DeixisError
        If the script is a layout script, which has no sentences.
    """
    reading = _reading(script)
    known = script_to_dict(script)
    for thing in known["objects"]:
        thing["mentions"] = list(reading.mentions.get(thing["id"], ()))
        if thing["id"] in reading.uncounted:
            thing["uncounted"] = True
    return known | {
        "facts": [stated_to_dict(fact, reading) for fact in reading.stated],
        "sentences": [_sentence_to_dict(sentence) for sentence in reading.sentences],
        "surface": reading.surface,
        "absent": list(reading.absent),
        "understood": round(reading.understood, 4),
    }


def read_text_lines(found: ReadText) -> list[str]:
    """Return the lines of :func:`reading_lines`.

    Parameters
    ----------
    found
        Answer of ``deixis read``.

    Returns
    -------
    list of str
        The lines.
    """
    return reading_lines(found.script)


def read_text_to_dict(found: ReadText) -> dict[str, Any]:
    """Return the data of :func:`reading_to_dict`.

    Parameters
    ----------
    found
        Answer of ``deixis read``.

    Returns
    -------
    dict
        Data for JSON.
    """
    return reading_to_dict(found.script)


def read_text_rows(found: ReadText) -> Iterator[dict[str, Any]]:
    """Yield a row for each fact that the text states, asserted or not.

    Parameters
    ----------
    found
        Answer of ``deixis read``.

    Yields
    ------
    dict
        The ``fact``, whether it is ``asserted``, its ``condition`` or None, its ``confidence`` in [0, 1], and the
        number and text of its ``sentence``, counted from 0.
    """
    for fact in found.reading.stated:
        yield {
            "fact": _content(fact),
            "asserted": fact.asserted,
            "condition": fact.condition,
            "confidence": fact.confidence,
            "sentence": fact.sentence,
            "text": found.reading.sentences[fact.sentence].text,
        }


def stated_to_dict(stated: StatedFact, reading: Reading) -> dict[str, Any]:
    """Return a fact of a text with its sentence, its span and what qualifies it.

    Parameters
    ----------
    stated
        Fact or claim with its sentence.
    reading
        Reading of the text; its surface is the object of claims that name none.

    Returns
    -------
    dict
        Data for JSON. ``sentence`` counts from 0; ``span`` is the first and last character in the text, counted from 0,
        the end exclusive.
    """
    return content_to_dict(stated.content, reading.surface) | {
        "status": "stated",
        "asserted": stated.asserted,
        "confidence": round(stated.confidence, 4),
        "sentence": stated.sentence,
        "span": list(stated.span),
        "condition": stated.condition or ("no longer" if stated.past else None),
        "past": stated.past,
        "uncertain": stated.uncertain,
        "alternative": stated.alternative,
        "quantifier": stated.quantifier,
    }


def content_to_dict(content: Fact | Claim, surface: str | None = None) -> dict[str, Any]:
    """Return a fact or a claim as plain data, with the same keys for both.

    Parameters
    ----------
    content
        Fact between two objects, or claim about any number of them.
    surface
        Noun of what everything stands on, which is the object of places that name none; None if unknown.

    Returns
    -------
    dict
        Data for JSON. ``subjects`` is a list; ``arguments``, ``value`` and ``metres`` are empty or None for a fact.
    """
    known = claim_to_dict(content, surface) if isinstance(content, Claim) else fact_to_dict(content)
    if not isinstance(content, Claim):
        known |= {"relation": content.relations[0].name, "arguments": [], "value": None, "metres": None}
    return known | {"subjects": list(content.subjects) if isinstance(content, Claim) else [content.subject]}


def _sentence_to_dict(sentence: ReadSentence) -> dict[str, Any]:
    problems: Iterator[dict[str, Any]] = (
        {"span": list(span), "reason": problem.message.removeprefix("not understood: "), "suggestion": problem.hint}
        for span, problem in zip(sentence.problem_spans, sentence.problems, strict=True)
    )
    return {
        "text": sentence.text,
        "span": list(sentence.span),
        "paraphrase": sentence.paraphrase,
        "understood": round(sentence.understood, 4),
        "question": sentence.question,
        "heading": sentence.heading,
        "not_understood": list(problems),
    }


def _reading(script: Script) -> Reading:
    from deixis.errors import DeixisError

    if script.reading is None:
        raise DeixisError(f"{script.file}: this is a layout script, not a text in English; parse prints its facts")
    return script.reading
