"""What a TBox in Turtle says, term by term, as strings: what the ontology's page is made from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from deixis.errors import OntologyError
from deixis.ontology.vocabulary import DX, W3C

OWL = "http://www.w3.org/2002/07/owl#"
RDFS = "http://www.w3.org/2000/01/rdf-schema#"
RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"
DCTERMS = "http://purl.org/dc/terms/"


@dataclass(frozen=True, slots=True)
class Term:
    """What the TBox says of one subject: values by predicate, both as strings, in the order of the file."""

    iri: str
    said: Mapping[str, tuple[str, ...]]

    def values(self, predicate: str) -> tuple[str, ...]:
        return self.said.get(predicate, ())

    def value(self, predicate: str) -> str:
        """The first value, or an empty text."""
        return next(iter(self.values(predicate)), "")

    def is_a(self, kind: str) -> bool:
        return kind in self.values(W3C.RDF_TYPE)

    @property
    def words(self) -> tuple[str, ...]:
        """Label, phrase and synonyms, each once."""
        given = (self.value(W3C.RDFS_LABEL), self.value(DX.PHRASE), *self.values(W3C.SKOS_ALT_LABEL))
        return tuple(word for word in dict.fromkeys(given) if word)

    @property
    def definition(self) -> str:
        return self.value(W3C.SKOS_DEFINITION)


Terms = Mapping[str, Term]


def read_terms(turtle: str) -> Terms:
    """Every subject of the text; raises OntologyError where it is no Turtle."""
    import pyoxigraph as ox

    said: dict[str, dict[str, list[str]]] = {}
    try:
        for quad in ox.parse(turtle, format=ox.RdfFormat.TURTLE):
            subject, value = (getattr(node, "value", str(node)) for node in (quad.subject, quad.object))
            said.setdefault(subject, {}).setdefault(quad.predicate.value, []).append(value)
    except SyntaxError as error:
        raise OntologyError(f"the ontology is no valid Turtle: {error}") from error
    return {iri: Term(iri, {p: tuple(values) for p, values in about.items()}) for iri, about in said.items()}


def union(value: str, terms: Terms) -> list[str]:
    """The members where ``value`` is the name of a union, else ``value`` alone."""
    if value not in terms or not terms[value].values(OWL + "unionOf"):
        return [value]
    members, node = [], terms[value].value(OWL + "unionOf")
    while node in terms:
        members.append(terms[node].value(RDF + "first"))
        node = terms[node].value(RDF + "rest")
    return members
