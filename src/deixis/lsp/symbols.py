"""Objects of a document with their places, for an editor's outline."""

from __future__ import annotations

from dataclasses import dataclass

from deixis.grammar.layout.names import key_of
from deixis.lsp.document import Document
from deixis.ontology.graph.facts import Source


@dataclass(frozen=True, slots=True)
class Symbol:
    """An object with the label of its kind, or an empty text, and the place of its first mention."""

    name: str
    kind: str
    source: Source


def symbols(document: Document) -> list[Symbol]:
    """Return the objects of a document in the order of their first mention, also those of statements with errors.

    Parameters
    ----------
    document
        Script that may have errors.

    Returns
    -------
    list of Symbol
        One symbol for each object, with the label of its kind, or an empty label for no known kind.

    Examples
    --------
    >>> [(found.name, found.kind) for found in symbols(Document("fork left of gizmo; fork lft of"))]
    [('fork', 'fork'), ('gizmo', ''), ('fork_lft', '')]
    """
    found: dict[str, Symbol] = {}
    for name in document.names:
        kind = document.script.kinds.get(name.name) or document.words.of_name(name.name)[0]
        found.setdefault(key_of(name.name), Symbol(name.name, kind.label if kind else "", name.source))
    return list(found.values())


def mentions_of(document: Document, line: int, column: int) -> list[Source]:
    """Return the places of all mentions of the object that is named at a position; the first mention comes first.

    Parameters
    ----------
    document
        Script that may have errors.
    line, column
        Position of any mention of the object, counted from 1.

    Returns
    -------
    list of Source
        Spans in this text; empty if there is no name at the position.
    """
    here = document.name_at(line, column)
    if here is None:
        return []
    key = key_of(here.name)
    return [name.source for name in document.names if key_of(name.name) == key]
