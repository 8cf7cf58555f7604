"""Validation of RDF files, or of everything remembered, by SHACL shapes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pyoxigraph as ox

from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.memory.semantic.rdf.files import read_quads
from deixis.memory.semantic.rdf.graphs import UNION, GraphName
from deixis.memory.semantic.rdf.package import SHAPES_FILE
from deixis.memory.semantic.store import SemanticMemory
from deixis.memory.semantic.validation.by_shapes import ShapesReport, validate_by_shapes


def validate_files(files: Sequence[Path], shapes: Sequence[Path] = (), time_limit: float = 60.0) -> ShapesReport:
    """Validate the triples of some files, taken together, by SHACL shapes.

    Parameters
    ----------
    files
        Files of data.
    shapes
        Files of shapes; default: those of Deixis.
    time_limit
        Seconds until the report.

    Returns
    -------
    ShapesReport
        All results, violations first.

    Raises
    ------
    ImportFormatError
        If a file cannot be read; the message names the place.
    ShapesError
        If the shapes are malformed.
    LimitError
        If the time limit is reached.
    """
    deadline = Deadline.after(time_limit)
    return validate_by_shapes(_triples(files), _shapes(shapes), deadline)


def validate_memory(memory: SemanticMemory, shapes: Sequence[Path] = (), time_limit: float = 60.0) -> ShapesReport:
    """Validate everything remembered, with the ontology and what was inferred, by SHACL shapes.

    Parameters
    ----------
    memory
        The open memory.
    shapes
        Files of shapes; default: those of Deixis.
    time_limit
        Seconds until the report.

    Returns
    -------
    ShapesReport
        All results, violations first.

    Raises
    ------
    ShapesError
        If the shapes are malformed.
    LimitError
        If the time limit is reached.
    """
    deadline = Deadline.after(time_limit)
    data = [triple for name in (GraphName.ONTOLOGY, GraphName.EPISODES, *UNION) for triple in memory.triples(name)]
    return validate_by_shapes(dict.fromkeys(data), _shapes(shapes), deadline)


def _triples(files: Sequence[Path]) -> list[ox.Triple]:
    return list(dict.fromkeys(quad.triple for file in files for quad in read_quads(file)))


def _shapes(files: Sequence[Path]) -> list[ox.Triple]:
    found = _triples(files or [SHAPES_FILE])
    if not any(triple.predicate.value.startswith("http://www.w3.org/ns/shacl#") for triple in found):
        raise DeixisError(f"{', '.join(map(str, files))}: there is no SHACL shape in it")
    return found
