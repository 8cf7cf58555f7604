"""RDF terms and triples: IRIs of learned resources, literals, and Skolem IRIs for blank nodes.

OWL class expressions need blank nodes. The memory needs names instead, so that it can remove exactly the triples of one
lesson. It therefore stores Skolem IRIs, and exports them as blank nodes.
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
    """Return an IRI under :data:`LEARNED`, each part percent-encoded so that no part can add a path segment.

    Parameters
    ----------
    parts
        Parts of the path.

    Returns
    -------
    str
        The IRI.

    Examples
    --------
    >>> learned_iri("category", "fish knife>")
    'https://w3id.org/deixis/learned/category/fish%20knife%3E'
    """
    return LEARNED + "/".join(map(iri_part, map(str, parts)))


@lru_cache(maxsize=4096)
def iri_part(name: str) -> str:
    """Return a name as one part of the path of an IRI.

    Parameters
    ----------
    name
        The name, which may have lone surrogates.

    Returns
    -------
    str
        The name, with all characters except letters, digits and ``_.-~`` percent-encoded.

    Examples
    --------
    >>> iri_part("fish knife>")
    'fish%20knife%3E'
    """
    return quote(name, safe="", errors="surrogatepass")


def category_iri(name: str) -> str:
    """Return the IRI of the learned class of the objects called ``name``.

    Parameters
    ----------
    name
        Name of the category.

    Returns
    -------
    str
        The IRI.
    """
    return learned_iri("category", name)


def content_key(content: str) -> str:
    """Return a hash of a text: 16 hexadecimal digits of SHA-256, valid in the label of a blank node.

    Parameters
    ----------
    content
        The text.

    Returns
    -------
    str
        The hash.
    """
    return hashlib.sha256(content.encode("utf-8")).hexdigest()[:16]


def last_part(iri: str) -> str:
    """Return the last part of a learned IRI, decoded.

    Parameters
    ----------
    iri
        The IRI.

    Returns
    -------
    str
        The part.

    Examples
    --------
    >>> last_part(learned_iri("category", "fish knife>"))
    'fish knife>'
    """
    return unquote(iri.rsplit("/", 1)[-1])


XSD = "http://www.w3.org/2001/XMLSchema#"


def iri(value: str) -> ox.NamedNode:
    """Return a named node.

    Parameters
    ----------
    value
        An IRI, which may be a member of the closed vocabulary.

    Returns
    -------
    ox.NamedNode
        The node.
    """
    return ox.NamedNode(str(value))


def text(value: str) -> ox.Literal:
    """Return a plain string literal.

    Parameters
    ----------
    value
        The text.

    Returns
    -------
    ox.Literal
        The literal.
    """
    return ox.Literal(value)


def typed(value: bool | int | float | datetime) -> ox.Literal:
    """Return a typed literal.

    A boolean, integer or datetime keeps its type; a datetime has milliseconds, the finest unit that HermiT reads. A
    float becomes an xsd:double.

    Parameters
    ----------
    value
        The value.

    Returns
    -------
    ox.Literal
        The literal.
    """
    if isinstance(value, bool):
        return ox.Literal(str(value).lower(), datatype=iri(XSD + "boolean"))
    if isinstance(value, datetime):
        return ox.Literal(value.isoformat(timespec="milliseconds"), datatype=iri(XSD + "dateTime"))
    name = "integer" if isinstance(value, int) else "double"
    return ox.Literal(repr(value), datatype=iri(XSD + name))


def decimal(value: float) -> ox.Literal:
    """Return a number as xsd:decimal, which is written without an exponent.

    Parameters
    ----------
    value
        The number.

    Returns
    -------
    ox.Literal
        The literal.
    """
    return ox.Literal(format(Decimal(repr(float(value))), "f"), datatype=iri(XSD + "decimal"))


class Description:
    """Triples about one subject, in the order in which they were added.

    >>> about = Description("urn:fork")
    >>> about.say("urn:p", text("x"), text("y"))
    >>> len(list(about))
    2
    """

    def __init__(self, subject: str) -> None:
        self.subject = iri(subject)
        self._triples: list[ox.Triple] = []

    def say(self, predicate: str, *objects: ox.NamedNode | ox.Literal) -> None:
        """Add one triple per object.

        Parameters
        ----------
        predicate
            IRI of the predicate.
        objects
            The objects, each of which gives a triple.
        """
        self._triples += [ox.Triple(self.subject, iri(predicate), value) for value in objects]

    def __iter__(self) -> Iterator[ox.Triple]:
        return iter(self._triples)


GENID = "https://w3id.org/deixis/.well-known/genid/"


def skolem(key: str) -> ox.NamedNode:
    """Return the IRI that stands for a blank node.

    Parameters
    ----------
    key
        Label of the blank node: letters, digits, ``-``, ``_`` and ``.``.

    Returns
    -------
    ox.NamedNode
        The IRI.
    """
    return ox.NamedNode(GENID + key)


def with_blank_nodes(triples: Iterable[ox.Triple]) -> Iterator[ox.Triple]:
    """Yield the triples with Skolem IRIs replaced by blank nodes.

    Parameters
    ----------
    triples
        The triples.

    Yields
    ------
    ox.Triple
        A triple.

    Examples
    --------
    >>> list(with_blank_nodes([ox.Triple(skolem("x"), ox.NamedNode("urn:p"), ox.Literal("1"))]))[0].subject
    <BlankNode value=x>
    """
    for triple in triples:
        yield ox.Triple(with_blank(triple.subject), triple.predicate, with_blank(triple.object))


def with_names(triples: Iterable[ox.Triple]) -> Iterator[ox.Triple]:
    """Yield the triples with blank nodes replaced by Skolem IRIs, made from their labels.

    Parameters
    ----------
    triples
        The triples.

    Yields
    ------
    ox.Triple
        A triple.
    """
    for triple in triples:
        yield ox.Triple(_named(triple.subject), triple.predicate, _named(triple.object))


_Term = TypeVar("_Term")


def with_blank(term: _Term) -> _Term | ox.BlankNode:
    """Return the blank node that a Skolem IRI stands for, or any other term unchanged.

    Parameters
    ----------
    term
        The term.

    Returns
    -------
    _Term or ox.BlankNode
        The blank node, or the term itself.
    """
    if isinstance(term, ox.NamedNode) and term.value.startswith(GENID):
        return ox.BlankNode(term.value.removeprefix(GENID))
    return term


def _named(term: _Term) -> _Term | ox.NamedNode:
    return skolem(term.value) if isinstance(term, ox.BlankNode) else term


def turtle(triples: Iterable[ox.Triple]) -> str:
    """Return triples as Turtle, with blank nodes for Skolem IRIs.

    Parameters
    ----------
    triples
        The triples.

    Returns
    -------
    str
        The text.
    """
    prefixes = {
        "dx": "https://w3id.org/deixis/onto#",
        "owl": "http://www.w3.org/2002/07/owl#",
        "prov": "http://www.w3.org/ns/prov#",
        "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
        "sh": "http://www.w3.org/ns/shacl#",
        "xsd": "http://www.w3.org/2001/XMLSchema#",
    }
    plain = list(dict.fromkeys(with_blank_nodes(triples)))
    return (ox.serialize(plain, format=ox.RdfFormat.TURTLE, prefixes=prefixes) or b"").decode("utf-8")
