"""pyshacl, asked about a few triples in a graph of rdflib's own: over a live view it takes strings for something else."""

from __future__ import annotations

import logging
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import TYPE_CHECKING

import pyoxigraph as ox

from deixis.memory.errors import ShapeResult
from deixis.memory.package import SHAPES_FILE
from deixis.memory.prefixes import short

if TYPE_CHECKING:
    import rdflib


@lru_cache(maxsize=1)
def shapes_graph() -> rdflib.Graph:
    """The packaged shapes, parsed once."""
    import rdflib

    return rdflib.Graph().parse(SHAPES_FILE, format="turtle")


def violations(triples: Iterable[ox.Triple], focus: Collection[str] | None = None) -> list[ShapeResult]:
    """What breaks the packaged shapes, of these focus nodes or of all; warnings left out, sorted."""
    results = [result for result in validate(triples, focus) if result.severity == "Violation"]
    return sorted(results, key=str)


def validate(triples: Iterable[ox.Triple], focus: Collection[str] | None = None) -> list[ShapeResult]:
    """Every result of validating these triples, of whatever severity; about some focus nodes or about all."""
    import pyshacl
    import rdflib

    with _quiet():
        data = rdflib.Graph()
        data.parse(data=(ox.serialize(triples, format=ox.RdfFormat.N_TRIPLES) or b"").decode("utf-8"), format="nt")
        _, found, _ = pyshacl.validate(
            data,
            shacl_graph=shapes_graph(),
            advanced=False,
            inference="none",
            do_owl_imports=False,
            meta_shacl=False,
        )
    if not isinstance(found, rdflib.Graph):
        raise RuntimeError(f"pyshacl could not validate: {found}")
    return [
        _result(found, node)
        for node in found.subjects(rdflib.RDF.type, rdflib.SH.ValidationResult)
        if focus is None or str(found.value(node, rdflib.SH.focusNode)) in focus
    ]


@contextmanager
def _quiet() -> Iterator[None]:
    """Without rdflib's log of each literal that is ill-typed: the report names it."""
    logger = logging.getLogger("rdflib.term")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(level)


def _result(found: rdflib.Graph, node: rdflib.term.Node) -> ShapeResult:
    import rdflib

    sh = rdflib.SH
    shape = found.value(node, sh.sourceShape)
    path, value = found.value(node, sh.resultPath), found.value(node, sh.value)
    names = shapes_graph()
    return ShapeResult(
        focus=short(str(found.value(node, sh.focusNode))),
        path=short(str(path)) if isinstance(path, rdflib.URIRef) else None,
        message=str(found.value(node, sh.resultMessage)),
        severity=str(found.value(node, sh.resultSeverity)).rsplit("#", 1)[-1],
        shape=str(names.value(shape, sh.name) or names.value(shape, rdflib.RDFS.label) or shape),
        value=None if value is None else short(str(value)) if isinstance(value, rdflib.URIRef) else str(value),
    )
