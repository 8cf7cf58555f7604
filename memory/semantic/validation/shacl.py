"""Run pyshacl on a few triples in a separate rdflib graph, as it misjudges plain strings in a live view."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import pyoxigraph as ox

from deixis.memory.errors import ShapeResult
from deixis.memory.semantic.rdf.files import short
from deixis.memory.semantic.rdf.package import SHAPES_FILE

if TYPE_CHECKING:
    import rdflib
    import rdflib.term


@lru_cache(maxsize=4)
def shapes_graph(file: Path = SHAPES_FILE) -> rdflib.Graph:
    """Return shapes, parsed once.

    Parameters
    ----------
    file
        Turtle file of the shapes; the packaged shapes by default.

    Returns
    -------
    Graph
        The shapes.
    """
    import rdflib

    return rdflib.Graph().parse(file, format="turtle")


def violations(
    triples: Iterable[ox.Triple], focus: Collection[str] | None = None, file: Path = SHAPES_FILE
) -> list[ShapeResult]:
    """Return the violations of shapes by some focus nodes or by all, sorted and without warnings.

    Parameters
    ----------
    triples
        Triples to check.
    focus
        Texts of the focus nodes; all nodes by default.
    file
        Turtle file of the shapes; the packaged shapes by default.

    Returns
    -------
    list of ShapeResult
        Distinct violations in the order of their text. Values that cannot be compared are reported as one, too.
    """
    triples = list(triples)
    try:
        results = validate(triples, focus, file)
    except (TypeError, ValueError, ArithmeticError, RuntimeError):
        # pyshacl fails for values that cannot be compared, such as a time with a zone and one without
        if focus is None or len(focus) == 1:
            return [_incomparable(*(focus or ()))]
        results = [result for node in focus for result in violations(triples, {node}, file)]
    return sorted({result for result in results if result.severity == "Violation"}, key=str)


def _incomparable(node: str = "somewhere") -> ShapeResult:
    message = "values cannot be compared: give numbers and times in the datatypes that the ontology states"
    return ShapeResult(short(node), None, message, "Violation", "comparable values")


def validate(
    triples: Iterable[ox.Triple], focus: Collection[str] | None = None, file: Path = SHAPES_FILE
) -> list[ShapeResult]:
    """Return all results of validating triples, of any severity, for some focus nodes or for all.

    Parameters
    ----------
    triples
        Triples to check.
    focus
        Texts of the focus nodes; all nodes by default.
    file
        Turtle file of the shapes; the packaged shapes by default.

    Returns
    -------
    list of ShapeResult
        Results in the order of the report.

    Raises
    ------
    RuntimeError
        If pyshacl does not return a report.
    """
    import pyshacl
    import rdflib

    with quiet():
        data = rdflib.Graph()
        data.parse(data=(ox.serialize(triples, format=ox.RdfFormat.N_TRIPLES) or b"").decode("utf-8"), format="nt")
        _, found, _ = pyshacl.validate(
            data,
            shacl_graph=shapes_graph(file),
            advanced=False,
            inference="none",
            do_owl_imports=False,
            meta_shacl=False,
        )
    if not isinstance(found, rdflib.Graph):
        raise RuntimeError(f"pyshacl could not validate: {found}")
    names = shapes_graph(file)
    results = [(found.value(node, rdflib.SH.focusNode), node) for node in _results(found)]
    return [_result(found, node, names) for about, node in results if focus is None or _asked(about, focus)]


def _results(found: rdflib.Graph) -> Iterator[rdflib.term.Node]:
    import rdflib

    return found.subjects(rdflib.RDF.type, rdflib.SH.ValidationResult)


def _asked(about: rdflib.term.Node | None, focus: Collection[str]) -> bool:
    """Return whether a result is about one of some nodes; True for a literal, as rdflib changes its spelling."""
    import rdflib

    return isinstance(about, rdflib.Literal) or str(about) in focus


@contextmanager
def quiet() -> Iterator[None]:
    """Silence rdflib's warnings, and its log of ill-typed literals, which the report has.

    Yields
    ------
    None
        None, once.
    """
    logger = logging.getLogger("rdflib.term")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)
            yield
    finally:
        logger.setLevel(level)


def report_turtle(report: rdflib.Graph) -> str:
    """Return a report as Turtle in an order that depends on its content only.

    rdflib orders blank nodes by their random names; they are renamed in the order of what they say. The canonical
    graph of rdflib would do too, but it takes minutes for a few hundred results.

    Parameters
    ----------
    report
        Validation report of pyshacl.

    Returns
    -------
    str
        The report; equal reports give equal texts.
    """
    import rdflib

    known: dict[rdflib.term.Node, str] = {}

    def content(node: rdflib.term.Node, above: tuple[rdflib.term.Node, ...] = ()) -> str:
        if not isinstance(node, rdflib.BNode):
            return node.n3()
        if node not in known and node not in above:
            inside = (
                (predicate.n3(), content(value, (*above, node))) for predicate, value in report.predicate_objects(node)
            )
            known[node] = str(sorted(inside))
        return known.get(node, "")

    def place(node: rdflib.BNode) -> tuple[str, list[str]]:
        return content(node), sorted(content(subject) for subject in report.subjects(None, node))

    nodes = {node for node in report.all_nodes() if isinstance(node, rdflib.BNode)}
    names: dict[rdflib.term.Node, rdflib.BNode] = {
        node: rdflib.BNode(f"b{number:06}") for number, node in enumerate(sorted(nodes, key=place))
    }
    named = rdflib.Graph(namespace_manager=report.namespace_manager)
    for subject, predicate, value in report:
        named.add((names.get(subject, subject), predicate, names.get(value, value)))
    return named.serialize(format="turtle")


def _result(found: rdflib.Graph, node: rdflib.term.Node, names: rdflib.Graph) -> ShapeResult:
    import rdflib

    sh = rdflib.SH
    shape = found.value(node, sh.sourceShape)
    path, value = found.value(node, sh.resultPath), found.value(node, sh.value)
    return ShapeResult(
        focus=short(str(found.value(node, sh.focusNode))),
        path=short(str(path)) if isinstance(path, rdflib.URIRef) else None,
        message=str(found.value(node, sh.resultMessage)),
        severity=str(found.value(node, sh.resultSeverity)).rsplit("#", 1)[-1],
        shape=str(names.value(shape, sh.name) or names.value(shape, rdflib.RDFS.label) or shape),
        value=None if value is None else short(str(value)) if isinstance(value, rdflib.URIRef) else str(value),
    )
