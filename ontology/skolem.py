"""Blank nodes as IRIs and back (RDF 1.1, section 3.5): what is stored has a name, what is exchanged need not.

An OWL class expression needs blank nodes; a store that must take back exactly what one lesson said needs names. So the
memory holds skolem IRIs, and they become blank nodes on the way out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TypeVar

import pyoxigraph as ox

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
