"""Count the content of a semantic memory."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pyoxigraph as ox

from deixis.memory.folder import VERSION, size
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.ontology.rdf.vocabulary import DX, W3C


@dataclass(frozen=True)
class MemoryStats:
    """Size of a memory: triples by graph, what they describe, bytes on disk, and the version of the format."""

    triples: dict[GraphName, int]
    lessons: int
    layouts: int
    categories: int
    scenes: int
    relation_models: int
    size_models: int
    bytes: int
    version: int


def count(store: ox.Store, folder: Path, lessons: int) -> MemoryStats:
    """Return the counts of a store's content.

    Parameters
    ----------
    store
        Store of the memory.
    folder
        The folder of the memory.
    lessons
        Number of lessons.

    Returns
    -------
    MemoryStats
        Numbers of lessons, triples and things, and the size on the disk.
    """
    learned, asserted = graph_iri(GraphName.LEARNED), graph_iri(GraphName.ASSERTED)
    return MemoryStats(
        triples={name: _number(store, f"{{ GRAPH {graph_iri(name)} {{ ?x ?p ?o }} }}", "*") for name in GraphName},
        lessons=lessons,
        layouts=_number(store, f"{{ GRAPH {learned} {{ ?x <{W3C.RDFS_SUB_CLASS_OF}> <{DX.LAYOUT}> }} }}"),
        categories=_number(
            store,
            f"{{ GRAPH {learned} {{ ?x <{DX.LEARNED_IN}> ?lesson }} "
            f"FILTER NOT EXISTS {{ GRAPH {learned} {{ ?x <{W3C.RDFS_SUB_CLASS_OF}> <{DX.LAYOUT}> }} }} }}",
        ),
        scenes=_number(store, f"{{ GRAPH {asserted} {{ ?x a <{DX.SCENE}> }} }}"),
        relation_models=_number(store, f"{{ GRAPH {learned} {{ ?x a <{DX.RELATION_MODEL}> }} }}"),
        size_models=_number(store, f"{{ GRAPH {learned} {{ ?x a <{DX.SIZE_MODEL}> }} }}"),
        bytes=size(folder),
        version=VERSION,
    )


def _number(store: ox.Store, where: str, what: str = "DISTINCT ?x") -> int:
    solutions = store.query(f"SELECT (COUNT({what}) AS ?n) WHERE {where}")
    assert isinstance(solutions, ox.QuerySolutions)
    return int(next(solutions)["n"].value)
