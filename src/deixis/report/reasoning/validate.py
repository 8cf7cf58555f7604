"""Reports of SHACL validations as lines of text and as plain data for JSON."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from deixis.answers import count
from deixis.report.marks import violation

if TYPE_CHECKING:
    from deixis.memory.semantic.validation.by_shapes import ShapesReport


def shapes_lines(report: ShapesReport) -> list[str]:
    """Return a line for each result, then the verdict.

    Parameters
    ----------
    report
        Answer of ``deixis validate``.

    Returns
    -------
    list of str
        The results with their severities, marked as violations, and whether the data conforms.
    """
    lines = [violation(f"{result.severity}: {result}") for result in report.results]
    verdict = "conforms" if report.conforms else f"{count(len(report.results), 'result')}: does not conform"
    return [*lines, verdict]


def shapes_to_dict(report: ShapesReport) -> dict[str, Any]:
    """Return a report as plain data for JSON.

    Parameters
    ----------
    report
        Answer of ``deixis validate``.

    Returns
    -------
    dict
        Data for JSON with the keys ``conforms`` and ``results``.
    """
    return {"conforms": report.conforms, "results": list(shapes_rows(report))}


def shapes_rows(report: ShapesReport) -> Iterator[dict[str, Any]]:
    """Yield a row for each result.

    Parameters
    ----------
    report
        Answer of ``deixis validate``.

    Yields
    ------
    dict
        The fields of :class:`~deixis.memory.errors.ShapeResult`.
    """
    yield from map(asdict, report.results)
