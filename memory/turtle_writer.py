"""Turtle and TriG that are the same bytes for the same content: sorted, grouped by subject, with stable labels.

>>> import pyoxigraph as ox
>>> print(turtle([ox.Triple(ox.NamedNode("urn:a"), ox.NamedNode("urn:p"), ox.Literal("x"))]).splitlines()[-2:])
['<urn:a>', '    <urn:p> "x" .']
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from itertools import groupby

import pyoxigraph as ox

from deixis.memory.prefixes import PREFIXES, turtle_name
from deixis.ontology.skolem import with_blank
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
    subject, predicate, term = cache(_subject), cache(_predicate), cache(_term)  # most terms stand in many triples
    rows = sorted({(subject(t.subject), predicate(t.predicate), term(t.object)) for t in triples})
    for (_, name), about in groupby(rows, key=lambda row: row[0]):
        said = [f"{verb} {object}" for _, (_, verb), object in about]
        yield indent + name
        for line in said[:-1]:
            yield f"{indent}    {line} ;"
        yield f"{indent}    {said[-1]} ."


def _subject(term: ox.NamedNode | ox.BlankNode) -> tuple[bool, str]:
    """Named subjects first."""
    return isinstance(with_blank(term), ox.BlankNode), _term(term)


def _predicate(term: ox.NamedNode) -> tuple[bool, str]:
    """The type first."""
    return (False, "a") if term.value == W3C.RDF_TYPE else (True, turtle_name(term.value))


def _term(term: ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple) -> str:
    term = with_blank(term)
    if isinstance(term, ox.NamedNode):
        return turtle_name(term.value)
    if isinstance(term, ox.Literal) and term.datatype.value not in _STRINGS:
        return f"{ox.Literal(term.value)}^^{turtle_name(term.datatype.value)}"
    return str(term)
