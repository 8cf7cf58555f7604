"""Contributions of the package to a memory: its ontology and its shapes, with their version."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from typing import TypeVar

import pyoxigraph as ox

from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri, package_graph
from deixis.ontology.rdf.triples import skolem
from deixis.ontology.tbox import TBOX_FILES, tbox_turtle

SHAPES_FILE = TBOX_FILES[0].with_name("shapes.ttl")


@lru_cache(maxsize=1)
def packaged() -> dict[GraphName, tuple[ox.Triple, ...]]:
    """Return the packaged ontology and shapes as triples, with stable names instead of blank nodes."""
    return {name: tuple(_read(name, turtle)) for name, turtle in _texts().items()}


@lru_cache(maxsize=1)
def packaged_quads() -> tuple[ox.Quad, ...]:
    """Return the packaged ontology and shapes as quads: in their canonical graphs, and in the package's copies."""
    return tuple(
        ox.Quad(triple.subject, triple.predicate, triple.object, graph)
        for name, triples in packaged().items()
        for graph in (graph_iri(name), package_graph(name))
        for triple in triples
    )


def package_digest() -> str:
    """Return a digest of the packaged texts, by which a memory knows whether it has them.

    Returns
    -------
    str
        SHA-256 in hexadecimal digits.
    """
    return hashlib.sha256("".join(_texts().values()).encode()).hexdigest()


def _texts() -> dict[GraphName, str]:
    return {GraphName.ONTOLOGY: tbox_turtle(), GraphName.SHAPES: SHAPES_FILE.read_text(encoding="utf-8")}


def _read(name: GraphName, turtle: str) -> list[ox.Triple]:
    dataset = ox.Dataset(ox.parse(turtle, format=ox.RdfFormat.TURTLE))
    dataset.canonicalize(ox.CanonicalizationAlgorithm.RDFC_1_0)
    return [ox.Triple(_named(name, quad.subject), quad.predicate, _named(name, quad.object)) for quad in dataset]


_Term = TypeVar("_Term")


def _named(name: GraphName, term: _Term) -> _Term | ox.NamedNode:
    return skolem(f"{name}.{term.value}") if isinstance(term, ox.BlankNode) else term
