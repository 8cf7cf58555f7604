"""Cut a text into tokens: find the terminals of ``layout.lark``, join the words of a name, and drop articles.

Lark's own lexer could find the terminals; this one is three times as fast, and makes tokens of errors too.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping

from lark import Token
from lark.lexer import TerminalDef

from deixis.grammar.layout.words import KEYWORDS
from deixis.ontology.relations.relation import ARTICLES

NOUN_PHRASE_TERMINALS = frozenset({"COUNT", "STRING", "COMPOUND"})
TERMINALS_WITHOUT_RULE = ("END", "COMMENT", "COMPOUND", "NUMBER", "OPEN_STRING", "UNKNOWN")
"""Terminals that no rule uses: separators of statements, and errors in any statement."""


class Scanner:
    """Lexer that cuts any text into tokens.

    Parameters
    ----------
    terminals
        Terminals of ``layout.lark``.
    patterns
        Regular expressions by terminal name, which replace those of ``layout.lark``.
    """

    def __init__(self, terminals: Iterable[TerminalDef], patterns: Mapping[str, str]) -> None:
        ordered = sorted((t for t in terminals if t.pattern is not None), key=lambda t: -t.priority)
        union = "|".join(f"(?P<{t.name}>{patterns.get(t.name) or t.pattern.to_regexp()})" for t in ordered)
        self._next = re.compile(union).finditer

    def tokens(self, text: str) -> Iterator[Token]:
        """Yield the tokens of a text, with the words of each name joined.

        No rule of the grammar accepts FUNCTION, ARTICLE or ``TERMINALS_WITHOUT_RULE``.

        Parameters
        ----------
        text
            The text.

        Yields
        ------
        Token
            A token.
        """
        run: list[Token] = []
        for token in self._terminals(text):
            if token.type == "NAME":
                keyword = KEYWORDS.get(token.casefold())
                if keyword is None:
                    run.append(token)
                    continue
                token.type = keyword
            if run:
                yield from join(run, token.type)
                run = []
            if token.type == "COMPOUND":
                token = _name([token], token.replace("_", " "))
            yield token
        if run:
            yield from join(run, "END")

    def _terminals(self, text: str) -> Iterator[Token]:
        line, line_start = 1, -1
        for match in self._next(text):
            terminal = match.lastgroup
            if terminal == "_BLANK" or terminal is None:
                continue
            start, end = match.span()
            yield Token(terminal, match[0], start, line, start - line_start, line, end - line_start, end)
            if terminal == "END" and match[0] == "\n":
                line += 1
                line_start = start


def join(run: list[Token], following: str) -> Iterator[Token]:
    """Yield the names in a run of words: an article before a word starts a new name and is dropped.

    ``a`` is a name if no word follows it, so that ``left(a, b)`` and ``a is a plate`` mean an object called a.

    Parameters
    ----------
    run
        Tokens of consecutive words.
    following
        Type of the token after the run.

    Yields
    ------
    Token
        A token of a name.
    """
    words: list[Token] = []
    last = len(run) - 1
    for i, word in enumerate(run):
        if word.casefold() not in ARTICLES or (i == last and following not in NOUN_PHRASE_TERMINALS and word in "aA"):
            words.append(word)
            continue
        if words:
            yield _name(words, " ".join(words))
            words = []
        if i == last and following not in NOUN_PHRASE_TERMINALS:
            word.type = "ARTICLE"
            yield word
    if words:
        yield words[0] if len(words) == 1 and words[0].isascii() else _name(words, " ".join(words))


def _name(words: list[Token], text: str) -> Token:
    """Join words into one NAME token, or return UNKNOWN at the first character that names may not contain."""
    for word in words:
        for i, character in enumerate("" if word.isascii() else word):
            if character != "-" and not (character if i == 0 else "x" + character).isidentifier():
                assert word.column is not None
                column = word.column + i
                return Token("UNKNOWN", character, None, word.line, column, word.line, column + 1)
    first, last = words[0], words[-1]
    value = unicodedata.normalize("NFC", "_".join(text.split()))
    return Token("NAME", value, first.start_pos, first.line, first.column, last.end_line, last.end_column, last.end_pos)
