"""What the package itself contributes to a memory: its ontology and its shapes, and which version they are."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

import pyoxigraph as ox

from deixis.memory.graphs import GraphName
from deixis.ontology.skolem import skolem
from deixis.ontology.tbox import TBOX_FILE

SHAPES_FILE = TBOX_FILE.with_name("shapes.ttl")

_FILES = {GraphName.ONTOLOGY: TBOX_FILE, GraphName.SHAPES: SHAPES_FILE}


@lru_cache(maxsize=1)
def packaged() -> dict[GraphName, tuple[ox.Triple, ...]]:
    """The packaged ontology and shapes as triples, blank nodes as names that stay the same."""
    return {name: tuple(_read(name, file)) for name, file in _FILES.items()}


def package_digest() -> str:
    """A digest of the packaged files, to see whether a memory has them already."""
    return hashlib.sha256(b"".join(file.read_bytes() for file in _FILES.values())).hexdigest()


def _read(name: GraphName, file: Path) -> list[ox.Triple]:
    dataset = ox.Dataset(ox.parse(path=file, format=ox.RdfFormat.TURTLE))
    dataset.canonicalize(ox.CanonicalizationAlgorithm.RDFC_1_0)
    return [ox.Triple(_named(name, quad.subject), quad.predicate, _named(name, quad.object)) for quad in dataset]


_Term = TypeVar("_Term")


def _named(name: GraphName, term: _Term) -> _Term | ox.NamedNode:
    return skolem(f"{name}.{term.value}") if isinstance(term, ox.BlankNode) else term
