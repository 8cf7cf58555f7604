"""Warnings about a script as lines of text and as plain data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.answers import count
from deixis.report.marks import doubt

if TYPE_CHECKING:
    from deixis.workflows.layouts.lint import Lint


def lint_lines(found: Lint) -> Iterator[str]:
    """Yield a line for each warning, as ``file:line:column: CODE message``, and their number.

    Parameters
    ----------
    found
        Answer of ``deixis lint``.

    Yields
    ------
    str
        The warnings, marked as doubt; then their number; then a notice if the time limit was reached.
    """
    for finding in found.findings:
        hint = f"; {finding.hint}" if finding.hint else ""
        yield doubt(f"{finding.source}: {finding.code} {finding.message}{hint}")
    yield f"{count(len(found.findings), 'warning')}." if found.findings else "No warnings."
    if not found.complete:
        yield doubt("Time limit reached: there may be more warnings.")


def lint_to_dict(found: Lint) -> dict[str, Any]:
    """Return the warnings with their places, codes, hints and replacements.

    Parameters
    ----------
    found
        Answer of ``deixis lint``.

    Returns
    -------
    dict
        Data for JSON with the keys ``file``, ``warnings`` and ``complete``. Lines and columns count from 1.
    """
    warnings = [
        {
            "code": finding.code,
            "message": finding.message,
            "hint": finding.hint,
            "replacement": finding.replacement,
            "file": finding.source.file,
            "line": finding.source.line,
            "column": finding.source.column,
            "end_line": finding.source.end_line,
            "end_column": finding.source.end_column,
        }
        for finding in found.findings
    ]
    return {"file": found.file, "warnings": warnings, "complete": found.complete}


def lint_rows(found: Lint) -> Iterator[dict[str, Any]]:
    """Yield a row for each warning.

    Parameters
    ----------
    found
        Answer of ``deixis lint``.

    Yields
    ------
    dict
        The warning with the keys of its JSON: ``code``, ``message``, ``hint``, ``replacement``, ``file``, ``line``, ….
    """
    yield from lint_to_dict(found)["warnings"]
