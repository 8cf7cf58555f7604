"""Edits of a document: quick fixes, renaming an object, and the canonical form."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deixis.errors import DeixisError
from deixis.grammar.layout.format import format_script
from deixis.grammar.layout.names import MAX_NAME, key_of, unquote
from deixis.grammar.script import Header, Include, RelationStatement
from deixis.lsp.diagnostics import Problem
from deixis.lsp.document import Document
from deixis.ontology.graph.facts import Source

VIEWPOINT = " seen from chair"  # end of the header that a quick fix adds


class RenameError(DeixisError, ValueError):
    """A new name that cannot be given to an object, or a position without a name."""


@dataclass(frozen=True, slots=True)
class Edit:
    """A text that replaces a span of the document; an empty span for an insertion."""

    source: Source
    text: str


@dataclass(frozen=True, slots=True)
class Fix:
    """A quick fix of a problem: a title and its edits."""

    title: str
    problem: Problem
    edits: tuple[Edit, ...]


def fixes(document: Document, problems: Iterable[Problem]) -> Iterator[Fix]:
    """Yield the quick fixes of problems: insert the suggested word, remove a needless statement, add a viewpoint.

    Parameters
    ----------
    document
        Script with the problems.
    problems
        Errors and warnings of the script.

    Yields
    ------
    Fix
        One fix for each problem that has one.
    """
    for problem in problems:
        if problem.replacement is not None:
            title = f"Replace with '{problem.replacement}'"
            yield Fix(title, problem, (Edit(problem.source, problem.replacement),))
        elif problem.code in ("F001", "F002"):
            span = _removable(document, problem.source)
            if span is not None:
                yield Fix("Remove this statement", problem, (Edit(span, ""),))
        elif problem.code == "L001":
            yield Fix("Add 'seen from chair'", problem, (_header(document),))


def _removable(document: Document, source: Source) -> Source | None:
    """Return the span to remove with a statement that states one fact: its whole line if nothing else is there."""
    found = next((one for one in document.script.statements if one.source == source), None)
    if not isinstance(found, RelationStatement) or sum(1 for _ in found.facts()) != 1:
        return None
    if source.line != source.end_line:
        return None
    line = document.lines[source.line - 1]
    before, after = line[: source.column - 1], line[source.end_column - 1 :]
    if not before.strip() and not after.strip(" \t;.") and source.line < len(document.lines):
        return Source(source.file, source.line, 1, source.line + 1, 1)
    separator = len(after) - len(after.lstrip(" \t;."))
    return Source(source.file, source.line, source.column, source.line, source.end_column + separator)


def _header(document: Document) -> Edit:
    first = next(iter(document.script.statements), None)
    if isinstance(first, Header):
        line, column = first.source.end_line, first.source.end_column
        return Edit(Source(document.file, line, column, line, column), VIEWPOINT)
    return Edit(Source(document.file, 1, 1, 1, 1), f"layout{VIEWPOINT}\n")


def rename(document: Document, line: int, column: int, new_name: str) -> list[Edit]:
    """Return the edits that rename an object in all its mentions.

    The members of a counted name such as ``2 cup`` are renamed with it: ``cup_1`` becomes ``mug_1``.

    Parameters
    ----------
    document
        Script with the name.
    line, column
        Position of any mention of the object, counted from 1.
    new_name
        New name as the user typed it.

    Returns
    -------
    list of Edit
        One edit for each mention in this text.

    Raises
    ------
    RenameError
        If there is no name at the position, the new name is empty or too long, it belongs to another object, the name
        belongs to an included file too, or the object is one of several counted ones.

    Examples
    --------
    >>> document = Document("fork left of plate; knife on fork")
    >>> [(edit.source.column, edit.text) for edit in rename(document, 1, 2, "spoon")]
    [(1, 'spoon'), (30, 'spoon')]
    """
    here = document.name_at(line, column)
    if here is None:
        raise RenameError("there is no name of an object here; put the cursor on one")
    old = key_of(here.name)
    for group in document.groups.values():
        if old in map(key_of, group.names):
            raise RenameError(f"'{here.name}' is one of {group.count} '{group.name}'; rename '{group.name}'")
    new = _plain(new_name, here.source)
    taken = {key_of(name.name) for name in document.names} | set(document.spellings)
    becomes = {old: new}
    if old in document.groups:
        number_of = document.groups[old].count or 0
        becomes |= {key_of(f"{here.name}_{n}"): f"{new}_{n}" for n in range(1, number_of + 1)}
    for key, name in becomes.items():
        if key_of(name) in taken and key_of(name) not in becomes and key_of(name) != key:
            raise RenameError(f"there is an object called '{name}' already; choose another name")
    if any(isinstance(statement, Include) for statement in document.script.statements):
        inside = {key_of(name) for name in _included_names(document)}
        if old in inside:
            raise RenameError(f"an included file mentions '{here.name}'; rename it there first")
    written = {key: _written(document, name) for key, name in becomes.items()}
    return [Edit(name.source, written[key_of(name.name)]) for name in document.names if key_of(name.name) in written]


def _plain(new_name: str, source: Source) -> str:
    """Return the new name with underscores for blanks."""
    from deixis.grammar.errors import StatementError

    try:
        plain = unquote(new_name.strip().strip('"'), source)
    except StatementError as error:
        raise RenameError(f"rename: {error.message}; choose another name") from None
    if len(plain) > MAX_NAME or '"' in plain:
        raise RenameError(f"a name must have at most {MAX_NAME:,} characters, and no quotation marks")
    return plain


def _included_names(document: Document) -> Iterator[str]:
    from deixis.grammar.script import mentions

    for statement in document.script.all_statements():
        if statement.source.file != document.file:
            yield from (mention.name for mention in mentions(statement))


def _written(document: Document, name: str) -> str:
    return name if document.language.reads_as_name(name) else f'"{name}"'


def formatted(document: Document) -> str | None:
    """Return the document in canonical form, or None if it has errors or was not read completely.

    Parameters
    ----------
    document
        Script to format.

    Returns
    -------
    str or None
        Text that ``deixis fmt`` writes.
    """
    if document.reading.problems or not document.reading.complete:
        return None
    return format_script(document.script)
