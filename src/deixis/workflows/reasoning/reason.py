"""Triples to reason over: out of RDF files, or out of a memory."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import pyoxigraph as ox

from deixis.memory.semantic.rdf.files import PREFIXES, read_quads
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.rdf.triples import with_blank_nodes
from deixis.reasoning.description_logic.terms import Triple, read_ntriples

_PREFIX = re.compile(r"^\s*@?prefix\s+([\w.-]*):\s*<([^<>\s]*)>", re.IGNORECASE | re.MULTILINE)

_STATED = (GraphName.ONTOLOGY, GraphName.LEARNED, GraphName.ASSERTED, GraphName.EPISODES)


def read_ontology(files: Sequence[Path]) -> tuple[list[Triple], dict[str, str]]:
    """Read files as one ontology.

    Parameters
    ----------
    files
        Files of triples.

    Returns
    -------
    tuple
        The triples, and the usual prefixes with those that the files declare.

    Raises
    ------
    ImportFormatError
        If a file cannot be read; the message names the place.
    """
    found = [triple for number, file in enumerate(files) for triple in _with_own_blank_nodes(number, read_quads(file))]
    prefixes = dict(PREFIXES)
    for file in files:
        if file.suffix.lower() in (".ttl", ".trig"):
            prefixes.update(_PREFIX.findall(file.read_text(encoding="utf-8", errors="replace")))
    return _as_triples(found), prefixes


def _with_own_blank_nodes(number: int, quads: Iterable[ox.Quad]) -> Iterator[ox.Triple]:
    """Yield the triples of one file, with blank nodes renamed so that they differ from those of other files."""

    def own(node: object) -> object:
        return ox.BlankNode(f"f{number}x{node.value}") if isinstance(node, ox.BlankNode) else node

    for quad in quads:
        yield ox.Triple(own(quad.subject), quad.predicate, own(quad.object))  # type: ignore[arg-type]


def read_remembered(memory: SemanticMemory) -> tuple[list[Triple], dict[str, str]]:
    """Return the stated triples of a memory, without inferred ones.

    Parameters
    ----------
    memory
        The open memory.

    Returns
    -------
    tuple
        The triples, and the usual prefixes.
    """
    found = [triple for name in _STATED for triple in memory.triples(name)]
    return _as_triples(list(with_blank_nodes(found))), dict(PREFIXES)


def _as_triples(found: list[ox.Triple]) -> list[Triple]:
    text = ox.serialize(found, format=ox.RdfFormat.N_TRIPLES) or b""
    return list(dict.fromkeys(read_ntriples(text.decode("utf-8"))))
