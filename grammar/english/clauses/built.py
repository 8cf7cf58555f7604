"""Hold the pieces of a clause while the parser runs: nouns, verbs and their predicates."""

from __future__ import annotations

from contextvars import ContextVar
from dataclasses import dataclass

from deixis.grammar.english.chunking.chunk import VerbGroup
from deixis.grammar.english.tree import (
    Misunderstood,
    NounPhrase,
    Predicate,
    Span,
)

notes: ContextVar[list[Misunderstood]] = ContextVar("notes")
"""Phrases of the sentence being built that have no meaning here."""

ALONG_WITH = "along with"
"""Adverb of what shares the place of another thing: *on the shelf, along with the goggles*; not *too* of a degree."""


@dataclass(frozen=True, slots=True)
class Noun:
    """A noun phrase, and the phrases after it that belong to what stands above it: *to the left of it, on the tray*."""

    phrase: NounPhrase
    extra: tuple[Predicate, ...] = ()


@dataclass(frozen=True, slots=True)
class Predication:
    """Predicates with their joint: ``choice`` is True after *or*, ``contrast`` after *but*."""

    predicates: tuple[Predicate, ...]
    choice: bool = False
    contrast: bool = False


@dataclass(frozen=True, slots=True)
class Verb:
    """A verb group with what it says."""

    group: VerbGroup
    predications: tuple[Predication, ...]
    span: Span
    nominal: Noun | None = None
    thing: Noun | None = None  # object of the verb


@dataclass(frozen=True, slots=True)
class Built:
    """A clause as it is parsed: ``shape`` is the name of its rule."""

    shape: str
    subject: Noun | None
    verbs: tuple[Verb, ...]
    predications: tuple[Predication, ...] = ()


def union(first: Span, last: Span) -> Span:
    """Return the span from the start of one to the end of another.

    Parameters
    ----------
    first, last
        Spans in the same text, in any order.

    Returns
    -------
    Span
        Smallest span that contains both.
    """
    return min(first[0], last[0]), max(first[1], last[1])


def misunderstood(span: Span, reason: str, suggestion: str | None = None) -> None:
    """Note a phrase that has no meaning.

    Parameters
    ----------
    span
        Place of the phrase in the text.
    reason
        Why it has no meaning, for the message.
    suggestion
        Advice or a wording that would be understood, or None.
    """
    notes.get().append(Misunderstood(span, reason, suggestion))
