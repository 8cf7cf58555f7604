"""Errors and warnings of a document: those of the parser and those of ``deixis lint``."""

from __future__ import annotations

from dataclasses import dataclass

from deixis.grammar.errors import MAX_PROBLEMS_SHOWN
from deixis.lsp.document import READ_TIME_LIMIT, Document
from deixis.ontology.graph.facts import Source

LINT_TIME_LIMIT = 1.0
"""Time limit in seconds for the warnings of a document that is being typed."""
MAX_WARNINGS = 500
"""Maximum number of warnings that are shown in an editor."""


@dataclass(frozen=True, slots=True)
class Problem:
    """An error or a warning at a place; ``code`` is None for an error, ``replacement`` a text to put there instead."""

    source: Source
    message: str
    code: str | None = None
    replacement: str | None = None

    @property
    def is_error(self) -> bool:
        """True for an error, which hides its statement from every command."""
        return self.code is None


def errors(document: Document) -> list[Problem]:
    """Return the errors of a document, at most :data:`MAX_PROBLEMS_SHOWN` of them.

    Parameters
    ----------
    document
        Script that may have errors.

    Returns
    -------
    list of Problem
        Errors without a code. An additional one reports those that are not shown, or a script too long to be read in
        :data:`~deixis.lsp.document.READ_TIME_LIMIT` seconds.
    """
    found = document.reading.problems
    shown = [
        Problem(one.source, f"{one.message}; {one.hint}" if one.hint else one.message, None, one.replacement)
        for one in found[:MAX_PROBLEMS_SHOWN]
    ]
    top = Source(document.file, 1, 1, 1, 2)
    if len(found) > MAX_PROBLEMS_SHOWN:
        shown.append(Problem(top, f"{len(found) - MAX_PROBLEMS_SHOWN} more errors are not shown"))
    if not document.reading.complete:
        message = f"the script is too long to be checked while it is edited ({READ_TIME_LIMIT:g} s)"
        shown.append(Problem(top, f"{message}; run `deixis parse`"))
    return shown


def warnings(document: Document, time_limit: float = LINT_TIME_LIMIT) -> list[Problem]:
    """Return the warnings about the statements that have no errors.

    Where some statements have errors, the warnings that need all statements are left out: a name without facts
    (N002), groups without connection (F004), and a missing viewpoint (L001).

    Parameters
    ----------
    document
        Script that may have errors.
    time_limit
        Time limit in seconds for the search for warnings.

    Returns
    -------
    list of Problem
        At most :data:`MAX_WARNINGS` warnings of ``deixis lint``, without those about included files.
    """
    from deixis.workflows.layouts.lint import lint

    ignored = ("N002", "F004", "L001") if document.reading.problems else ()
    found = lint(document.script, ignore=ignored, time_limit=time_limit).findings
    return [
        Problem(one.source, f"{one.message}; {one.hint}" if one.hint else one.message, one.code, one.replacement)
        for one in found
        if one.source.file == document.file
    ][:MAX_WARNINGS]
