"""Triples as N-Triples text: read into terms, and written back.

A term is its own N-Triples spelling: ``<iri>``, ``_:label`` or a quoted literal.

>>> triple = read_ntriples('<urn:f> <urn:p> "a fork"@en .')[0]
>>> triple.object
'"a fork"@en'
>>> write_ntriples([triple])
'<urn:f> <urn:p> "a fork"@en .\\n'
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from typing import NamedTuple

from deixis.reasoning.errors import TriplesError

_LITERAL = r'"(?:[^"\\\n\r]|\\.)*"(?:@[A-Za-z]+(?:-[A-Za-z0-9]+)*|\^\^<[^<>"{}|^`\\\s]*>)?'
_NODE = r"<[^<>\"{}|^`\s]*>|_:[^\s<>\"]+"
_LINE = re.compile(rf"\s*({_NODE})\s*(<[^<>\"\s]*>)\s*({_NODE}|{_LITERAL})\s*\.\s*(?:#.*)?")
_ESCAPE = re.compile(r"\\u[0-9A-Fa-f]{4}|\\U[0-9A-Fa-f]{8}")
_IRI = re.compile(r"[^<>\"{}|^`\\\s\x00-\x20]*")


class Triple(NamedTuple):
    """A statement; each term in its N-Triples spelling."""

    subject: str
    predicate: str
    object: str

    def __str__(self) -> str:
        return f"{self.subject} {self.predicate} {self.object} ."


def read_ntriples(text: str) -> list[Triple]:
    """The triples of a document, in its order; raises TriplesError, with the line, for what is no N-Triples."""
    triples = []
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        found = _LINE.fullmatch(line.rstrip("\r"))
        if found is None:
            raise TriplesError(f"line {number} is not a triple in N-Triples: {line.strip()[:80]}")
        subject, predicate, object = (_unescaped(part, number) for part in found.groups())
        triples.append(Triple(subject, predicate, object))
    return triples


def _unescaped(term: str, number: int) -> str:
    """An IRI with its escapes read, so that one name has one spelling."""
    if "\\" not in term or is_literal(term):
        return term
    iri = _ESCAPE.sub(lambda found: chr(min(int(found[0][2:], 16), sys.maxunicode)), term[1:-1])
    if not _IRI.fullmatch(iri):
        raise TriplesError(f"line {number} has an IRI with characters that none may have: {term[:80]}")
    return f"<{iri}>"


def write_ntriples(triples: Iterable[Triple]) -> str:
    """A document of these triples, a line each."""
    return "".join(f"{triple}\n" for triple in triples)


def iri_of(term: str) -> str | None:
    """The IRI that a term spells, or None where it is a blank node or a literal."""
    return term[1:-1] if term.startswith("<") else None


def is_literal(term: str) -> bool:
    return term.startswith('"')


def is_blank(term: str) -> bool:
    return term.startswith("_:")
