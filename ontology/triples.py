"""RDF terms and triples: IRIs of learned things, literals, a look-up over a set of triples, and Skolem IRIs for blank
nodes.

An OWL class expression needs blank nodes; a store that must take back exactly what one lesson said needs names. So the
memory holds skolem IRIs, and they become blank nodes on the way out.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from datetime import datetime
from decimal import Decimal
from functools import lru_cache
from typing import TypeVar
from urllib.parse import quote, unquote

import pyoxigraph as ox

LEARNED = "https://w3id.org/deixis/learned/"


def learned_iri(*parts: str | int) -> str:
    """An IRI under :data:`LEARNED`; every part is percent-encoded, so that no name can reach out of its place.

    >>> learned_iri("category", "fish knife>")
    'https://w3id.org/deixis/learned/category/fish%20knife%3E'
    """
    return LEARNED + "/".join(map(_encoded, map(str, parts)))


@lru_cache(maxsize=4096)
def _encoded(part: str) -> str:
    return quote(part, safe="")


def category_iri(name: str) -> str:
    """The class of things that go by a name, as it was learned."""
    return learned_iri("category", name)


def content_key(content: str) -> str:
    """A short name for a text, in the letters that a blank node's label may have."""
    return hashlib.sha256(content.encode("utf-8")).hexdigest()[:16]


def last_part(iri: str) -> str:
    """The name that the last part of a learned IRI was made from.

    >>> last_part(learned_iri("category", "fish knife>"))
    'fish knife>'
    """
    return unquote(iri.rsplit("/", 1)[-1])


XSD = "http://www.w3.org/2001/XMLSchema#"


def iri(value: str) -> ox.NamedNode:
    """A named node; ``value`` may be a member of the closed vocabulary."""
    return ox.NamedNode(str(value))


def text(value: str) -> ox.Literal:
    return ox.Literal(value)


def typed(value: bool | int | float | datetime) -> ox.Literal:
    """A boolean, integer or dateTime as such (HermiT reads no finer than milliseconds); a float as xsd:double."""
    if isinstance(value, bool):
        return ox.Literal(str(value).lower(), datatype=iri(XSD + "boolean"))
    if isinstance(value, datetime):
        return ox.Literal(value.isoformat(timespec="milliseconds"), datatype=iri(XSD + "dateTime"))
    name = "integer" if isinstance(value, int) else "double"
    return ox.Literal(repr(value), datatype=iri(XSD + name))


def decimal(value: float) -> ox.Literal:
    """A number as xsd:decimal, which has no exponent."""
    return ox.Literal(format(Decimal(repr(float(value))), "f"), datatype=iri(XSD + "decimal"))


class Description:
    """Triples about one subject, in the order in which they are said.

    >>> about = Description("urn:fork")
    >>> about.say("urn:p", text("x"), text("y"))
    >>> len(list(about))
    2
    """

    def __init__(self, subject: str) -> None:
        self.subject = iri(subject)
        self._triples: list[ox.Triple] = []

    def say(self, predicate: str, *objects: ox.NamedNode | ox.Literal) -> None:
        self._triples += [ox.Triple(self.subject, iri(predicate), value) for value in objects]

    def __iter__(self) -> Iterator[ox.Triple]:
        return iter(self._triples)


GENID = "https://w3id.org/deixis/.well-known/genid/"


def skolem(key: str) -> ox.NamedNode:
    """The IRI that stands for a blank node; ``key`` is letters, digits, ``-``, ``_`` and ``.`` only."""
    return ox.NamedNode(GENID + key)


def with_blank_nodes(triples: Iterable[ox.Triple]) -> Iterator[ox.Triple]:
    """The triples with skolem IRIs as blank nodes.

    >>> list(with_blank_nodes([ox.Triple(skolem("x"), ox.NamedNode("urn:p"), ox.Literal("1"))]))[0].subject
    <BlankNode value=x>
    """
    for triple in triples:
        yield ox.Triple(with_blank(triple.subject), triple.predicate, with_blank(triple.object))


def with_names(triples: Iterable[ox.Triple]) -> Iterator[ox.Triple]:
    """The triples with blank nodes as skolem IRIs, by their labels."""
    for triple in triples:
        yield ox.Triple(_named(triple.subject), triple.predicate, _named(triple.object))


_Term = TypeVar("_Term")


def with_blank(term: _Term) -> _Term | ox.BlankNode:
    """A term, as a blank node where it is a skolem IRI."""
    if isinstance(term, ox.NamedNode) and term.value.startswith(GENID):
        return ox.BlankNode(term.value.removeprefix(GENID))
    return term


def _named(term: _Term) -> _Term | ox.NamedNode:
    return skolem(term.value) if isinstance(term, ox.BlankNode) else term
