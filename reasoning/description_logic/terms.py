r"""Terms of RDF, RDFS and OWL 2 in N-Triples spelling, and triples as N-Triples text.

A term is its own N-Triples spelling: ``<iri>``, ``_:label`` or a quoted literal.

>>> triple = read_ntriples('<urn:f> <urn:p> "a fork"@en .')[0]
>>> triple.object
'"a fork"@en'
>>> write_ntriples([triple])
'<urn:f> <urn:p> "a fork"@en .\n'
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from typing import NamedTuple

from deixis.reasoning.errors import TriplesError

PREFIXES = {
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "owl": "http://www.w3.org/2002/07/owl#",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
}


def term(name: str) -> str:
    """Return the term that a prefixed name stands for.

    Parameters
    ----------
    name
        Name with a prefix of ``PREFIXES``.

    Returns
    -------
    str
        IRI in angle brackets.

    Examples
    --------
    >>> term("rdfs:label")
    '<http://www.w3.org/2000/01/rdf-schema#label>'
    """
    prefix, _, local = name.partition(":")
    return f"<{PREFIXES[prefix]}{local}>"


TYPE = term("rdf:type")
FIRST, REST, NIL = term("rdf:first"), term("rdf:rest"), term("rdf:nil")
LABEL = term("rdfs:label")
SUB_CLASS_OF, SUB_PROPERTY_OF = term("rdfs:subClassOf"), term("rdfs:subPropertyOf")
DOMAIN, RANGE = term("rdfs:domain"), term("rdfs:range")
THING, NOTHING, CLASS = term("owl:Thing"), term("owl:Nothing"), term("owl:Class")
EQUIVALENT_CLASS, EQUIVALENT_PROPERTY = term("owl:equivalentClass"), term("owl:equivalentProperty")
DISJOINT_WITH, COMPLEMENT_OF = term("owl:disjointWith"), term("owl:complementOf")
SAME_AS, DIFFERENT_FROM = term("owl:sameAs"), term("owl:differentFrom")
IMPORTS, ONTOLOGY = term("owl:imports"), term("owl:Ontology")
MEMBERS, DISTINCT_MEMBERS = term("owl:members"), term("owl:distinctMembers")
NAMED_INDIVIDUAL, OBJECT_PROPERTY = term("owl:NamedIndividual"), term("owl:ObjectProperty")
DATATYPE_PROPERTY, ANNOTATION_PROPERTY = term("owl:DatatypeProperty"), term("owl:AnnotationProperty")
SOME_VALUES_FROM = term("owl:someValuesFrom")
NEGATIVE_PROPERTY_ASSERTION = term("owl:NegativePropertyAssertion")
SOURCE_INDIVIDUAL, ASSERTION_PROPERTY = term("owl:sourceIndividual"), term("owl:assertionProperty")
TARGET_INDIVIDUAL, TARGET_VALUE = term("owl:targetIndividual"), term("owl:targetValue")


_LITERAL = r'"(?:[^"\\\n\r]|\\.)*"(?:@[A-Za-z]+(?:-[A-Za-z0-9]+)*|\^\^<[^<>"{}|^`\\\s]*>)?'
_NODE = r"<[^<>\"{}|^`\s]*>|_:[^\s<>\"]+"
_LINE = re.compile(rf"\s*({_NODE})\s*(<[^<>\"\s]*>)\s*({_NODE}|{_LITERAL})\s*\.\s*(?:#.*)?")
_ESCAPE = re.compile(r"\\u[0-9A-Fa-f]{4}|\\U[0-9A-Fa-f]{8}")
_IRI = re.compile(r"[^<>\"{}|^`\\\s\x00-\x20]*")


class Triple(NamedTuple):
    """A statement of three terms in N-Triples spelling."""

    subject: str
    predicate: str
    object: str

    def __str__(self) -> str:
        return f"{self.subject} {self.predicate} {self.object} ."


def read_ntriples(text: str) -> list[Triple]:
    """Return the triples of a document, in its order.

    Parameters
    ----------
    text
        The document.

    Returns
    -------
    list of Triple
        Triples, whose terms are in the syntax of N-Triples.

    Raises
    ------
    TriplesError
        A line is not N-Triples; the message has its number.
    """
    triples = []
    for number, line in enumerate(text.split("\n"), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        found = _LINE.fullmatch(line.rstrip("\r"))
        if found is None:
            raise TriplesError(f"line {number} is not a triple in N-Triples: {line.strip()[:80]}")
        subject, predicate, obj = (_unescaped(part, number) for part in found.groups())
        triples.append(Triple(subject, predicate, obj))
    return triples


def _unescaped(term: str, number: int) -> str:
    """Return an IRI with its escapes decoded, so that each IRI has one spelling."""
    if "\\" not in term or is_literal(term):
        return term
    iri = _ESCAPE.sub(lambda found: chr(min(int(found[0][2:], 16), sys.maxunicode)), term[1:-1])
    if not _IRI.fullmatch(iri):
        raise TriplesError(f"line {number} has an IRI with characters that are not allowed: {term[:80]}")
    return f"<{iri}>"


def write_ntriples(triples: Iterable[Triple]) -> str:
    """Return a document of the triples, one line each.

    Parameters
    ----------
    triples
        Triples.

    Returns
    -------
    str
        Document in N-Triples, in the order of the triples.
    """
    return "".join(f"{triple}\n" for triple in triples)


def iri_of(term: str) -> str | None:
    """Return the IRI of a term, or None for a blank node or a literal.

    Parameters
    ----------
    term
        Term in the syntax of N-Triples.

    Returns
    -------
    str or None
        IRI without angle brackets, or None.
    """
    return term[1:-1] if term.startswith("<") else None


def is_literal(term: str) -> bool:
    """Return whether a term is a literal.

    Parameters
    ----------
    term
        Term in the syntax of N-Triples.

    Returns
    -------
    bool
        True for a text in quotes, with or without a language or a datatype.
    """
    return term.startswith('"')


def is_blank(term: str) -> bool:
    """Return whether a term is a blank node.

    Parameters
    ----------
    term
        Term in the syntax of N-Triples.

    Returns
    -------
    bool
        True for a term such as ``_:b0``.
    """
    return term.startswith("_:")
