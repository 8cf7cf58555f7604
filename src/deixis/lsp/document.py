"""A layout script as an editor holds it: its text, its statements without errors, and the word at a position."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from lark import Token

from deixis.deadline import Deadline
from deixis.grammar.layout.language import Language, language_of
from deixis.grammar.layout.names import key_of
from deixis.grammar.layout.unfinished import UnfinishedScript, read_unfinished
from deixis.grammar.script import Mention, Script, mentions
from deixis.ontology.graph.facts import Source
from deixis.ontology.tbox import Ontology, default_ontology

READ_TIME_LIMIT = 2.0
"""Time limit in seconds for reading a script."""

MAX_STATEMENT = 20_000
"""Maximum length in characters of a line or a statement in which completion and hover look at single words."""


@dataclass(frozen=True)
class NameToken:
    """A name of an object in the text, as it is written there; ``counted`` is True after a count, as in ``2 cup``."""

    name: str
    source: Source
    counted: bool


@dataclass(frozen=True)
class Document:
    """A text that may have errors; ``path`` is the file that the editor shows, or None for a text without a file."""

    text: str
    path: Path | None = None
    ontology: Ontology | None = None

    @cached_property
    def lines(self) -> list[str]:
        """Lines of the text without their ends, as the parser counts them."""
        return self.text.replace("\r\n", "\n").split("\n")

    @cached_property
    def file(self) -> str:
        """Name of the text in sources."""
        return "untitled.layout" if self.path is None else str(self.path)

    @cached_property
    def reading(self) -> UnfinishedScript:
        """The statements without errors, and the errors."""
        folder = None if self.path is None else self.path.parent
        return read_unfinished(self.text, self.file, folder, self.words, Deadline.after(READ_TIME_LIMIT))

    @property
    def script(self) -> Script:
        """The script of the statements without errors."""
        return self.reading.script

    @cached_property
    def words(self) -> Ontology:
        """The ontology whose words the script may use."""
        return self.ontology or default_ontology()

    @cached_property
    def language(self) -> Language:
        """The lexer and the parser."""
        return language_of(self.words)

    @cached_property
    def groups(self) -> dict[str, Mention]:
        """Mentions of counted names such as ``2 cup``, by the key of the name."""
        return {
            key_of(mention.name): mention
            for statement in self.script.all_statements()
            for mention in mentions(statement)
            if mention.count is not None
        }

    @cached_property
    def spellings(self) -> dict[str, str]:
        """Objects of the script by the key of their name, in the order of their first mention."""
        return {key_of(name): name for name in self.script.objects}

    def token_at(self, line: int, column: int) -> tuple[Token | None, Token | None]:
        """Return the token at a position, or the token that ends there, and the token before it on its line.

        Parameters
        ----------
        line, column
            Position, counted from 1.

        Returns
        -------
        tuple
            Token and the token before it; both None if there is no token at the position or the line has more than
            :data:`MAX_STATEMENT` characters.
        """
        before: Token | None = None
        found: tuple[Token | None, Token | None] = (None, None)
        if not 1 <= line <= len(self.lines) or len(self.lines[line - 1]) > MAX_STATEMENT:
            return found
        for token in self.language.scanner.tokens(self.lines[line - 1]):
            start, end = token.column or 0, token.end_column or 0
            if start <= column <= end:
                found = (token, before)
                if column < end:
                    break
            before = token
        return found

    @cached_property
    def names(self) -> tuple[NameToken, ...]:
        """The names of objects in the text, also those in statements with errors; without the names of kinds."""
        return tuple(self._names())

    def name_at(self, line: int, column: int) -> NameToken | None:
        """Return the name of an object at a position, or None.

        Parameters
        ----------
        line, column
            Position, counted from 1. A position right after the name belongs to it.

        Returns
        -------
        NameToken or None
            Name in this text, without those of included files.
        """
        for name in self.names:
            if name.source.line == line and name.source.column <= column <= name.source.end_column:
                return name
        return None

    def _names(self) -> Iterator[NameToken]:
        opening: str | None = None  # type of the first token of the statement
        before: Token | None = None
        for token in self.language.scanner.tokens(self.text.replace("\r\n", "\n")):
            if token.type == "COMMENT":
                continue
            if token.type == "END":
                if token != "\n" or before is None or before.type not in ("_COMMA", "_AND"):
                    opening, before = None, None
                continue
            opening = opening or token.type
            if is_object(token, before, opening):
                assert token.line is not None and token.column is not None
                assert token.end_line is not None and token.end_column is not None
                place = Source(self.file, token.line, token.column, token.end_line, token.end_column)
                yield NameToken(name_of(token), place, before is not None and before.type == "COUNT")
            before = token


def is_object(token: Token, before: Token | None, opening: str | None) -> bool:
    """Return True for a token that names an object, and not a kind, a layout, a title or a file.

    Parameters
    ----------
    token
        Token of a layout script.
    before
        Token before it on its line, or None at the beginning.
    opening
        Type of the first token of the statement, such as ``_LAYOUT``, or None where it is not known.

    Returns
    -------
    bool
        True for the name of an object.
    """
    if token.type not in ("NAME", "STRING") or opening == "_INCLUDE":
        return False
    if opening == "_LAYOUT":
        return before is not None and before.type == "_FROM"
    return before is None or before.type != "IS"


def name_of(token: Token) -> str:
    """Return the name that a NAME or STRING token stands for.

    Parameters
    ----------
    token
        Token of type NAME or STRING.

    Returns
    -------
    str
        Name without quotation marks, with an underscore for each run of spaces.

    Examples
    --------
    >>> name_of(Token("STRING", '"left shoe"'))
    'left_shoe'
    """
    return "_".join(token.strip('"').split())
