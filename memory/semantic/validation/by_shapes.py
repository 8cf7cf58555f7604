"""Validate any data by any SHACL shapes, with pyshacl in a process of its own that can be stopped.

pyshacl has no time limit, and shapes may have SPARQL: so the process that runs it is stopped when its time is up, and
has a memory limit. Nothing is fetched: ``owl:imports`` is ignored, and a SPARQL constraint that queries another
endpoint (``SERVICE``) is refused.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pyoxigraph as ox

from deixis.answers import Answer, count
from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.memory.errors import ShapeResult, ShapesError
from deixis.memory.semantic.rdf.files import short
from deixis.reasoning.errors import LimitError
from deixis.scratch import scratch_folder, tied_to_parent

if TYPE_CHECKING:
    import rdflib
    import rdflib.term

MEMORY_LIMIT = 4 << 30
"""Memory limit of the process, in bytes."""

_SPARQL = {ox.NamedNode(f"http://www.w3.org/ns/shacl#{name}") for name in ("select", "ask", "construct", "update")}
_ESCAPE = re.compile(r"\\u([0-9A-Fa-f]{4})|\\U([0-9A-Fa-f]{8})")


@dataclass(frozen=True, repr=False)
class ShapesReport(Answer):
    """Result of a validation: conformance, every result (violations first), and the standard report as Turtle.

    Examples
    --------
    >>> import deixis
    >>> deixis.validate("ontology/deixis.ttl")
    <ShapesReport 0 results: conforms>
    """

    conforms: bool
    results: tuple[ShapeResult, ...]
    turtle: str

    def summary(self) -> str:
        """Return whether the data conforms, and the number of results."""
        verdict = "conforms" if self.conforms else "does not conform"
        return f"{count(len(self.results), 'result')}: {verdict}"


def validate_by_shapes(
    data: Iterable[ox.Triple], shapes: Iterable[ox.Triple], deadline: Deadline = Deadline.never()
) -> ShapesReport:
    """Return the report of SHACL core and SPARQL constraints over some triples.

    Warnings and informations are results too; ``conforms`` is False for them, as the standard says.

    Parameters
    ----------
    data
        Triples to check.
    shapes
        Shapes as triples. They must not query another endpoint (``SERVICE``).
    deadline
        Time limit of the check, which runs in another process.

    Returns
    -------
    ShapesReport
        Results of all severities, and the report in Turtle.

    Raises
    ------
    LimitError
        The deadline passed, or the memory limit was reached.
    ShapesError
        The shapes are malformed.
    """
    shapes = list(shapes)
    for triple in shapes:
        if triple.predicate in _SPARQL and "service" in _unescaped(str(getattr(triple.object, "value", ""))).lower():
            raise ShapesError("the shapes query another endpoint (SERVICE), which is refused; copy its data to a file")
    with scratch_folder() as folder:
        for name, triples in (("data", data), ("shapes", shapes)):
            (folder / f"{name}.nt").write_bytes(ox.serialize(triples, format=ox.RdfFormat.N_TRIPLES) or b"")
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        command = [sys.executable, "-m", __name__, str(folder)]
        limit = None if deadline.left == float("inf") else max(deadline.left, 0.0)
        try:
            done = subprocess.run(
                command,
                env=environment,
                capture_output=True,
                timeout=limit,
                check=False,
                stdin=subprocess.DEVNULL,
                preexec_fn=tied_to_parent(),
            )
        except subprocess.TimeoutExpired:
            raise LimitError("undecided: time limit reached before the shapes were checked; allow more time") from None
        if not (folder / "report.json").exists():
            messages = done.stderr.decode("utf-8", "replace").strip().splitlines() or ["it ended without a message"]
            if "MemoryError" in messages[-1]:
                raise LimitError(f"undecided: the shapes take more than {MEMORY_LIMIT >> 30} GB of memory to check")
            raise ShapesError(f"pyshacl cannot check these shapes: {messages[-1][:300]}")
        found = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    results = tuple(ShapeResult(**result) for result in found["results"])
    return ShapesReport(found["conforms"], results, found["turtle"])


def _unescaped(sparql: str) -> str:
    return _ESCAPE.sub(lambda found: chr(min(int(found[1] or found[2], 16), sys.maxunicode)), sparql)


# ---- code that runs in the process


def _check(folder: Path) -> None:
    import pyshacl
    import rdflib
    from pyshacl.errors import ConstraintLoadError, ReportableRuntimeError, ShapeLoadError

    from deixis.memory.semantic.validation.shacl import quiet, report_turtle

    data, shapes = (rdflib.Graph().parse(folder / f"{name}.nt", format="nt") for name in ("data", "shapes"))
    with quiet():
        try:
            _, report, text = pyshacl.validate(
                data, shacl_graph=shapes, advanced=False, inference="none", do_owl_imports=False, meta_shacl=False
            )
        except (ShapeLoadError, ConstraintLoadError, ReportableRuntimeError) as error:
            raise SystemExit(" ".join(str(error).split())) from None
    if not isinstance(report, rdflib.Graph):
        raise SystemExit(" ".join(str(getattr(report, "message", text)).split()))
    sh = rdflib.SH
    results = [_result(report, shapes, node) for node in report.subjects(rdflib.RDF.type, sh.ValidationResult)]
    order = ["Violation", "Warning", "Info"]
    results.sort(key=lambda result: (order.index(result.severity) if result.severity in order else 3, str(result)))
    conforms = not results
    answer = {
        "conforms": conforms,
        "results": [asdict(result) for result in results],
        "turtle": report_turtle(report),
    }
    (folder / "report.json").write_text(json.dumps(answer, ensure_ascii=False), encoding="utf-8")


def _result(report: rdflib.Graph, shapes: rdflib.Graph, node: rdflib.term.Node) -> ShapeResult:
    import rdflib

    sh = rdflib.SH

    def readable(about: rdflib.term.Node | None) -> str:
        return short(str(about)) if isinstance(about, rdflib.URIRef) else str(about)

    shape, path, value = (report.value(node, part) for part in (sh.sourceShape, sh.resultPath, sh.value))
    name = shapes.value(shape, sh.name) or shapes.value(shape, rdflib.RDFS.label)
    component = readable(report.value(node, sh.sourceConstraintComponent))
    return ShapeResult(
        focus=readable(report.value(node, sh.focusNode)),
        path=readable(path) if isinstance(path, rdflib.URIRef) else None,
        message=" ".join(str(report.value(node, sh.resultMessage) or component).split()),
        severity=str(report.value(node, sh.resultSeverity)).rsplit("#", 1)[-1],
        shape=str(name) if name else readable(shape) if isinstance(shape, rdflib.URIRef) else component,
        value=None if value is None else readable(value),
    )


def _limit_memory() -> None:
    with suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))


if __name__ == "__main__":
    _limit_memory()
    try:
        _check(Path(sys.argv[1]))
    except DeixisError as error:
        raise SystemExit(str(error)) from None
