"""Write parsed sentences in a short notation, for documentation, tests and error reports."""

from __future__ import annotations

from collections.abc import Iterator

from deixis.grammar.english.tree import Clause, Degree, Mood, NounPhrase, Predicate, Sentence, Viewpoint
from deixis.grammar.english.vocabulary.tables import LITERAL

_DEGREES = {Degree.PLAIN: "", Degree.COMPARATIVE: "+", Degree.SUPERLATIVE: "++"}
_MOODS = {Mood.STATEMENT: "", Mood.COMMAND: "!", Mood.QUESTION: "?"}


def outline(sentence: Sentence) -> str:
    """Return the viewpoint, the clauses, the fragment and the misunderstood phrases of a sentence, a line for each.

    ``+`` stands for a comparative, ``++`` for a superlative, ``~`` for a reversed predicate, ``!`` for a command, ``?``
    for a question; restrictions of a noun phrase are in brackets.

    Parameters
    ----------
    sentence
        Parsed sentence.

    Returns
    -------
    str
        Outline in a form that tests can compare; its parts have a line each.

    Examples
    --------
    >>> from deixis.grammar.english.parse import parse_english
    >>> print(outline(parse_english("Facing the bed, choose the taller lamp that isn't next to the door.")[0]))
    from facing the bed
    the tall+ lamp [not next_to(the door)]
    """
    lines = [] if sentence.viewpoint is None else [f"from {_viewpoint(sentence.viewpoint)}"]
    lines += [clause_outline(clause) for clause in sentence.clauses]
    if sentence.fragment is not None:
        lines.append(noun_outline(sentence.fragment))
    first = sentence.span[0]
    lines += [f"-- {sentence.text[m.span[0] - first : m.span[1] - first]}: {m.reason}" for m in sentence.misunderstood]
    return "\n".join(lines)


def clause_outline(clause: Clause) -> str:
    """Return the subject, the predicates and the modality of a clause.

    The marks after the predicates are ``or`` and a choice, ``modal``, ``past`` and a condition.

    Parameters
    ----------
    clause
        Clause of a sentence; an absent subject is written ``...``.

    Returns
    -------
    str
        One line.
    """
    subject = "..." if clause.subject is None else noun_outline(clause.subject)
    parts = [f"{subject}{_MOODS[clause.mood]}: " + ", ".join(predicate_outline(p) for p in clause.predicates)]
    parts += ["or " + ", ".join(predicate_outline(p) for p in choice) for choice in clause.choices]
    if clause.modal is not None:
        parts.append(f"({clause.modal})")
    parts += [f"({hedge})" for hedge in clause.hedges]
    if clause.past:
        parts.append("(past)")
    if clause.condition is not None:
        parts.append(f"({clause.condition})")
    return " ".join(part.rstrip() for part in parts)


def predicate_outline(predicate: Predicate) -> str:
    """Return a predicate as its relation and what stands with it, in parentheses.

    Parameters
    ----------
    predicate
        Predicate of a clause, or restriction of a noun phrase.

    Returns
    -------
    str
        Text such as ``not next_to(the door)``.
    """
    return "".join(
        (
            "" if predicate.positive else "not ",
            predicate.relation,
            "~" if predicate.reversed else "",
            _DEGREES[predicate.degree],
            "(" + ", ".join(_arguments(predicate)) + ")",
        )
    )


def _arguments(predicate: Predicate) -> Iterator[str]:
    if predicate.subject_part is not None:
        yield noun_outline(predicate.subject_part)
    yield from (noun_outline(argument) for argument in predicate.arguments)
    if predicate.than is not None:
        yield f"than {noun_outline(predicate.than)}"
    value = predicate.value
    if value is not None and value.rank is not None:
        yield f"{value.rank}"
    elif value is not None and predicate.degree is Degree.PLAIN:
        yield value.word
    if predicate.part is not None:
        yield predicate.part
    if predicate.measure is not None:
        yield f"{predicate.measure.metres:g} m"
    if predicate.viewpoint is not None:
        yield f"of {_viewpoint(predicate.viewpoint)}"


def noun_outline(phrase: NounPhrase) -> str:
    """Return a noun phrase with its restrictions in brackets.

    Parameters
    ----------
    phrase
        Noun phrase; the parts of a coordination stand in parentheses.

    Returns
    -------
    str
        Text such as ``the tall+ lamp [not next_to(the door)]``.
    """
    ending = " [" + ", ".join(predicate_outline(p) for p in phrase.predicates) + "]" if phrase.predicates else ""
    negation = "not " if phrase.negated else ""
    if phrase.members:
        return (
            f"({negation}"
            + f" {phrase.joined_by} ".join(noun_outline(member) for member in phrase.members)
            + f"){ending}"
        )
    words = [] if phrase.owner is None else [f"{noun_outline(phrase.owner)}'s"]
    words += [phrase.determiner] if phrase.determiner is not None else []
    words += [] if phrase.count is None else [str(phrase.count)]
    words += [f"{adjective.word}{_DEGREES[adjective.degree]}" for adjective in phrase.adjectives]
    words += [word.replace(LITERAL, "") for word in (phrase.head, phrase.pronoun) if word]
    if phrase.of is not None:
        words.append(f"of {noun_outline(phrase.of)}")
    return negation + " ".join(words) + ending


def _viewpoint(view: Viewpoint) -> str:
    parts = [
        ("entering" if view.entering else "at", view.at),
        ("facing", view.facing),
        ("back to", view.back),
        ("own", view.own),
    ]
    return ", ".join(f"{word} {noun_outline(phrase)}" for word, phrase in parts if phrase is not None)
