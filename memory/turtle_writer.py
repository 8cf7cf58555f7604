"""Turtle and TriG that are the same bytes for the same content: sorted, grouped by subject, with stable labels.

>>> import pyoxigraph as ox
>>> print(turtle([ox.Triple(ox.NamedNode("urn:a"), ox.NamedNode("urn:p"), ox.Literal("x"))]).splitlines()[-2:])
['<urn:a>', '    <urn:p> "x" .']
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby

import pyoxigraph as ox

from deixis.memory.prefixes import PREFIXES, turtle_name
from deixis.ontology.skolem import with_blank_nodes
from deixis.ontology.vocabulary import W3C

_STRINGS = {PREFIXES["xsd"] + "string", PREFIXES["rdf"] + "langString", PREFIXES["rdf"] + "dirLangString"}


def turtle(triples: Iterable[ox.Triple]) -> str:
    """A Turtle document; names that stand for blank nodes become blank nodes."""
    return "\n".join([*_prefixes(), "", *_statements(triples, "")]) + "\n"


def trig(graphs: Iterable[tuple[ox.NamedNode, Iterable[ox.Triple]]]) -> str:
    """A TriG document of named graphs, in the order given; empty ones are left out."""
    lines = [*_prefixes()]
    for graph, triples in graphs:
        statements = list(_statements(triples, "    "))
        if statements:
            lines += ["", f"{turtle_name(graph.value)} {{", *statements, "}"]
    return "\n".join(lines) + "\n"


def _prefixes() -> Iterator[str]:
    for prefix, base in PREFIXES.items():
        yield f"@prefix {prefix}: <{base}> ."


def _statements(triples: Iterable[ox.Triple], indent: str) -> Iterator[str]:
    rows = sorted({(_subject(t), _predicate(t), _term(t.object)) for t in with_blank_nodes(triples)})
    for (_, subject), about in groupby(rows, key=lambda row: row[0]):
        said = [f"{predicate} {object}" for _, (_, predicate), object in about]
        yield indent + subject
        for line in said[:-1]:
            yield f"{indent}    {line} ;"
        yield f"{indent}    {said[-1]} ."


def _subject(triple: ox.Triple) -> tuple[bool, str]:
    """Named subjects first."""
    return isinstance(triple.subject, ox.BlankNode), _term(triple.subject)


def _predicate(triple: ox.Triple) -> tuple[bool, str]:
    """The type first."""
    iri = triple.predicate.value
    return iri != W3C.RDF_TYPE, "a" if iri == W3C.RDF_TYPE else turtle_name(iri)


def _term(term: ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple) -> str:
    if isinstance(term, ox.NamedNode):
        return turtle_name(term.value)
    if isinstance(term, ox.Literal) and term.datatype.value not in _STRINGS:
        return f"{ox.Literal(term.value)}^^{turtle_name(term.datatype.value)}"
    return str(term)
