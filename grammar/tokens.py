"""From characters to tokens: finds the terminals of ``layout.lark``, joins the words of a name, drops articles.

Lark's own lexer would do for the first part; this one is three times as fast, and stops at nothing.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Iterator, Mapping

from lark import Token
from lark.lexer import TerminalDef

from deixis.grammar.words import KEYWORDS
from deixis.ontology.relation import ARTICLES

NOUN_PHRASE_TERMINALS = frozenset({"COUNT", "STRING", "COMPOUND"})
TERMINALS_WITHOUT_RULE = ("END", "COMMENT", "COMPOUND", "NUMBER", "OPEN_STRING", "UNKNOWN")
"""Terminals that no rule uses: those that part statements, and those that are wrong in every statement."""


class Scanner:
    """Cuts a text into tokens; there is no text that it cannot cut.

    ``patterns`` stand for those of the terminals of the same names.
    """

    def __init__(self, terminals: Iterable[TerminalDef], patterns: Mapping[str, str]) -> None:
        ordered = sorted((t for t in terminals if t.pattern is not None), key=lambda t: -t.priority)
        union = "|".join(f"(?P<{t.name}>{patterns.get(t.name) or t.pattern.to_regexp()})" for t in ordered)
        self._next = re.compile(union).finditer

    def tokens(self, text: str) -> Iterator[Token]:
        """Yield the tokens of a text, names joined.

        No rule of the grammar takes FUNCTION, ARTICLE and TERMINALS_WITHOUT_RULE.
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
    """Yield the names in a run of words: an article before a word starts a new name, and is dropped.

    ``a`` is a name where no word follows it, so that ``left(a, b)`` and ``a is a plate`` mean an object called a.
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
    """Join words into one NAME token, or return UNKNOWN at the first character that no name may hold."""
    for word in words:
        for i, character in enumerate("" if word.isascii() else word):
            if character != "-" and not (character if i == 0 else "x" + character).isidentifier():
                assert word.column is not None
                column = word.column + i
                return Token("UNKNOWN", character, None, word.line, column, word.line, column + 1)
    first, last = words[0], words[-1]
    value = unicodedata.normalize("NFC", "_".join(text.split()))
    return Token("NAME", value, first.start_pos, first.line, first.column, last.end_line, last.end_column, last.end_pos)
