"""Cut a text into tokens: find the terminals of ``layout.lark``, join the words of a name, and drop articles.

Lark's own lexer could find the terminals; this one is faster, and makes tokens of errors too.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from lark import Token
from lark.lexer import TerminalDef

from deixis.grammar.layout.words import KEYWORDS, NOUNS_IN_LY, first_word
from deixis.ontology.relations.relation import ARTICLES

NOUN_PHRASE_TERMINALS = frozenset({"COUNT", "STRING", "COMPOUND"})
TERMINALS_WITHOUT_RULE = ("END", "COMMENT", "COMPOUND", "NUMBER", "OPEN_STRING", "UNKNOWN")
"""Terminals that no rule uses: separators of statements, and errors in any statement."""

SEPARATORS = frozenset({"END", "COMMENT", "STRING", "_COMMA", "_LPAR", "_RPAR"})
"""Terminals at which no phrase begins."""


@dataclass(frozen=True)
class Phrases:
    """Phrases of a terminal by first word, and what makes a regular expression of those with one first word."""

    of_word: Mapping[str, Sequence[str]]
    pattern: Callable[[Sequence[str]], str]


class Scanner:
    """Lexer that cuts any text into tokens.

    An ontology has hundreds of phrases. Those with one first word are compiled when a text has that word, because
    compiling all of them takes a fifth of the time in which a command reads a script.

    Parameters
    ----------
    terminals
        Terminals of ``layout.lark``.
    phrases
        Phrases by terminal, which replace the patterns in ``layout.lark``.
    """

    def __init__(self, terminals: Iterable[TerminalDef], phrases: Mapping[str, Phrases]) -> None:
        ordered = sorted((t for t in terminals if t.pattern is not None), key=lambda t: -t.priority)
        union = "|".join(f"(?P<{t.name}>{t.pattern.to_regexp()})" for t in ordered if t.name not in phrases)
        self._next = re.compile(union).search
        self._phrases = {t.name: phrases[t.name] for t in ordered if t.name in phrases}
        self._words = frozenset(word for each in phrases.values() for word in each.of_word)
        self._compiled: dict[str, re.Pattern[str]] = {}

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
                adverb = run.pop() if is_adverb(run) else None
                yield from join(run, token.type if adverb is None else "FUNCTION")
                run = []
                if adverb is not None:
                    adverb.type = "FUNCTION"
                    yield adverb
            if token.type == "COMPOUND":
                token = _name([token], token.replace("_", " "))
            yield token
        if run:
            yield from join(run, "END")

    def _terminals(self, text: str) -> Iterator[Token]:
        line, line_start, end = 1, -1, 0
        while (match := self._next(text, end)) is not None:
            start, end = match.span()
            terminal = match.lastgroup
            if terminal == "_BLANK":
                continue
            if terminal not in SEPARATORS and (phrase := self._phrase(text, start)) is not None:
                terminal, end = phrase.lastgroup, phrase.end()
            assert terminal is not None
            yield Token(terminal, text[start:end], start, line, start - line_start, line, end - line_start, end)
            if terminal == "END" and text[start] == "\n":
                line += 1
                line_start = start

    def _phrase(self, text: str, start: int) -> re.Match[str] | None:
        """Return the match of the phrase at a place of a text; None if there is none."""
        word = first_word(text, start)
        if word not in self._words:
            return None
        if word not in self._compiled:
            known = ((name, each) for name, each in self._phrases.items() if word in each.of_word)
            union = "|".join(f"(?P<{name}>{each.pattern(each.of_word[word])})" for name, each in known)
            self._compiled[word] = re.compile(union, re.IGNORECASE)
        return self._compiled[word].match(text, start)


def is_adverb(run: Sequence[str]) -> bool:
    """Return True if the last of several words is an adverb, which cannot end a name: *cup vertically*.

    Parameters
    ----------
    run
        Consecutive words that are not reserved.

    Returns
    -------
    bool
        False for a noun such as *jelly*, and for one word alone.

    Examples
    --------
    >>> is_adverb(["cup", "vertically"]), is_adverb(["plum", "jelly"]), is_adverb(["Sally"])
    (True, False, False)
    """
    last = run[-1].casefold()
    several = sum(word.casefold() not in ARTICLES for word in run) > 1
    return several and last.endswith("ly") and last not in NOUNS_IN_LY


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
