"""Completion: the words that the grammar accepts at a position."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from lark import Token

from deixis.grammar.layout.names import key_of
from deixis.grammar.layout.unfinished import Expected, expected_next
from deixis.grammar.layout.words import chains
from deixis.lsp.document import MAX_STATEMENT, Document
from deixis.ontology.relations.relation import Reading

MAX_LINES_JOINED = 100  # maximum number of lines of one statement that are read before the position
MAX_WORDS = 5  # maximum number of words before the position that can begin a phrase
MAX_COMPLETIONS = 1_000
KEYWORD_OF = {
    "NOT": ("not",),
    "OPTIONAL": ("optional",),
    "_AND": ("and",),
    "_OR": ("or",),
    "_LAYOUT": ("layout",),
    "_INCLUDE": ("include",),
    "_SEEN": ("seen from",),
    "_FROM": ("from",),
    "IS": ("is a", "are"),
}
"""Words to complete by terminal, for the terminals whose words are few."""


class Role(StrEnum):
    """Meaning of a completed word: a name of the script, a kind, a colour, a relation, or a word of the grammar."""

    NAME = "name"
    KIND = "kind"
    COLOUR = "colour"
    RELATION = "relation"
    KEYWORD = "keyword"


@dataclass(frozen=True, slots=True)
class Completion:
    """A word or a phrase; it replaces the text from ``column`` to the position, on the line of the position."""

    text: str
    role: Role
    column: int
    detail: str = ""


def completions(document: Document, line: int, column: int) -> list[Completion]:
    """Return what can be written at a position: first names of the script, then relations, kinds and other words.

    Parameters
    ----------
    document
        Script with the cursor in it.
    line, column
        Position of the cursor, counted from 1; the characters before it are completed.

    Returns
    -------
    list of Completion
        At most :data:`MAX_COMPLETIONS` texts; none in a comment, in an open quotation or in a statement
        of more than :data:`~deixis.lsp.document.MAX_STATEMENT` characters.

    Examples
    --------
    >>> [found.text for found in completions(Document("fork left of plate; fo"), 1, 23)][:2]
    ['fork', 'food']
    """
    if not 1 <= line <= len(document.lines):
        return []
    before = document.lines[line - 1][: column - 1]
    above = _joined_lines(document, line)
    found: dict[str, Completion] = {}
    if len(above) + len(before) > MAX_STATEMENT:
        return []
    for start in _starts(before):
        typed = " ".join(re.split(r"[\s_]+", before[start:].casefold()))
        expected = expected_next(above + before[:start], document.words)
        if expected.inside:
            return []
        for text, role, detail in _choices(document, expected, (line, start + 1)):
            if " ".join(text.casefold().split("_")).startswith(typed):
                found.setdefault(text, Completion(text, role, start + 1, detail))
                if len(found) >= MAX_COMPLETIONS:
                    return list(found.values())
    return list(found.values())


def _joined_lines(document: Document, line: int) -> str:
    """Return the lines before a line that belong to its statement, since they end in a comma or in *and*."""
    first = line - 1
    while first > 0 and line - first < MAX_LINES_JOINED:
        if not re.search(r"(?:,|\band)\s*(?:#.*)?$", document.lines[first - 1], re.IGNORECASE):
            break
        first -= 1
    joined = "".join(one + "\n" for one in document.lines[first : line - 1])
    # a header is possible only in the first statement
    return joined if first == 0 and not joined else joined or "\n"


def _starts(before: str) -> Iterator[int]:
    """Yield the columns, from 0, at which the phrase that is being typed may begin: one word more each time."""
    words = [match.start() for match in re.finditer(r"[^\s,;.()#\"]+", before)]
    if not before or before[-1] in ' \t,;.()#"':
        words.append(len(before))
    yield from reversed(words[-MAX_WORDS:])


def _choices(document: Document, expected: Expected, place: tuple[int, int]) -> Iterator[tuple[str, Role, str]]:
    """Yield the texts that are accepted next, each with its role and a short explanation."""
    ontology, accepted = document.words, expected.terminals
    last: Token | None = expected.tokens[-1] if expected.tokens else None
    if last is not None and last.type == "IS" and "NAME" in accepted:
        for kind in ontology.kinds:
            yield kind.words[0] if kind.words else kind.label, Role.KIND, "kind"
        for colour in ontology.colours:
            yield from ((word, Role.COLOUR, "colour") for word in colour.words)
    elif "NAME" in accepted and (last is None or last.type not in ("_LAYOUT", "_INCLUDE")):
        yield from _names(document, place)
    if "RELATION" in accepted:
        for relation in ontology.relations.of_reading(Reading.WIDE):
            yield relation.phrase, Role.RELATION, "relation"
        for relation in ontology.relations.of_reading(Reading.WIDE):
            for word in relation.words:
                yield word.replace("_", " "), Role.RELATION, f"same as '{relation.phrase}'"
    if "NAME" in accepted and (last is None or last.type not in ("IS", "_LAYOUT", "_INCLUDE")):
        for kind in ontology.kinds:
            yield from ((word, Role.KIND, "kind, as a new name") for word in kind.words)
    for terminal, words in KEYWORD_OF.items():
        if terminal in accepted and (terminal != "_LAYOUT" or place[0] == 1):
            yield from ((word, Role.KEYWORD, "") for word in words)
    if "HEDGE" in accepted:
        yield from ((word, Role.KEYWORD, f"weight {weight:g}") for word, weight in ontology.hedges.items())
    if "CHAIN" in accepted:
        yield from ((f"{head}:", Role.KEYWORD, "chain") for head in chains(ontology))


def _names(document: Document, place: tuple[int, int]) -> Iterator[tuple[str, Role, str]]:
    """Yield the names of the script, without the name that is being typed at ``place``."""
    seen: set[str] = set()
    for name in document.names:
        key = key_of(name.name)
        if key in seen or (name.source.line, name.source.column) == place:
            continue
        seen.add(key)
        kind = document.script.kinds.get(name.name) or document.words.of_name(name.name)[0]
        yield name.name, Role.NAME, kind.label if kind else "name"
