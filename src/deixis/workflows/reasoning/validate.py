"""Validation of RDF files, or of everything remembered, by SHACL shapes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pyoxigraph as ox

from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.memory.semantic.rdf.files import read_quads
from deixis.memory.semantic.rdf.graphs import UNION, GraphName
from deixis.memory.semantic.rdf.package import SHAPES_FILE
from deixis.memory.semantic.store import SemanticMemory
from deixis.memory.semantic.validation.by_shapes import ShapesReport, validate_by_shapes
from deixis.reasoning.errors import require_time_limit
from deixis.workflows.reasoning.reason import paths


@checks_arguments
def validate(
    data: SemanticMemory | str | Path | Sequence[str | Path],
    shapes: str | Path | Sequence[str | Path] = SHAPES_FILE,
    time_limit: float = 60.0,
) -> ShapesReport:
    """Validate the triples of files, taken together, or of a memory, by SHACL shapes.

    Parameters
    ----------
    data
        File of data, several files, or the memory of a session: then everything remembered, with the ontology and what
        was inferred.
    shapes
        File of shapes, or several; default: those of Deixis.
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

    Examples
    --------
    >>> import deixis
    >>> deixis.validate("ontology/deixis.ttl", shapes="ontology/shapes.ttl").conforms
    True
    """
    require_time_limit(time_limit)
    deadline = Deadline.after(time_limit)
    if isinstance(data, SemanticMemory):
        names = (GraphName.ONTOLOGY, GraphName.EPISODES, *UNION)
        triples = list(dict.fromkeys(triple for name in names for triple in data.triples(name)))
    else:
        triples = _triples(paths(data, "data"))
    return validate_by_shapes(triples, _shapes(paths(shapes, "shapes")), deadline)


def _triples(files: Sequence[Path]) -> list[ox.Triple]:
    return list(dict.fromkeys(quad.triple for file in files for quad in read_quads(file)))


def _shapes(files: Sequence[Path]) -> list[ox.Triple]:
    found = _triples(files)
    if not any(triple.predicate.value.startswith("http://www.w3.org/ns/shacl#") for triple in found):
        raise DeixisError(f"{', '.join(map(str, files))}: there is no SHACL shape in it")
    return found
