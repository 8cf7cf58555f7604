"""The parser of ``layout.lark``, and the lexer for the words of an ontology."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path

from lark import Lark, Token
from lark.lark import PostLex

from deixis.grammar.layout.claims import CLAIM_OF_PATTERNS, CLAIM_PATTERNS, HAS, HAS_PATTERN, PHRASE_STARTS
from deixis.grammar.layout.tokens import TERMINALS_WITHOUT_RULE, Phrases, Scanner
from deixis.grammar.layout.tree import TreeBuilder
from deixis.grammar.layout.words import by_first_word, chains, phrase_pattern
from deixis.grammar.parsers import ParsedGrammar
from deixis.ontology.relations.relation import plain_phrase
from deixis.ontology.tbox import Ontology


class KeepUnusedTerminals(PostLex):
    """Postprocessor that keeps lark from dropping the terminals that no rule uses."""

    always_accept = TERMINALS_WITHOUT_RULE

    def process(self, stream: Iterator[Token]) -> Iterator[Token]:
        """Return the tokens unchanged.

        Parameters
        ----------
        stream
            The tokens.

        Yields
        ------
        Token
            A token.
        """
        return stream


LAYOUT = ParsedGrammar(
    Path(__file__).with_name("layout.lark"), start="statement", transformer=TreeBuilder(), postlex=KeepUnusedTerminals()
)
"""The grammar of layouts."""


@dataclass(frozen=True)
class Language:
    """Lexer and parser for the words of one ontology."""

    lark: Lark
    scanner: Scanner
    phrase_starts: frozenset[str]  # words that begin a longer relation phrase: 'upper', 'to', 'in front'

    def reads_as_name(self, text: str) -> bool:
        """Return whether an unquoted text is read as a name of exactly this spelling, also before a relation.

        Parameters
        ----------
        text
            The text.

        Returns
        -------
        bool
            True if it is.
        """
        return plain_phrase(text) not in self.phrase_starts and self.is_name_token(text)

    def is_name_token(self, text: str) -> bool:
        """Return True if the unquoted text, alone, is one NAME token of this spelling, with blanks as underscores.

        Parameters
        ----------
        text
            The text.

        Returns
        -------
        bool
            True if it is.
        """
        found = list(self.scanner.tokens(text))
        return len(found) == 1 and found[0].type == "NAME" and str(found[0]) == text.replace(" ", "_")


def language_of(ontology: Ontology) -> Language:
    """Return the language with the words of an ontology; it is cached by these words.

    Parameters
    ----------
    ontology
        The ontology.

    Returns
    -------
    Language
        The language: its lexer and its parser.
    """
    return _build(
        tuple(ontology.relations.by_word),
        tuple(plain_phrase(hedge) for hedge in ontology.hedges),
        tuple(chains(ontology)),
        tuple(word for word in ontology.kinds.words if " and " in word),
    )


@lru_cache(maxsize=8)
def _build(
    relations: tuple[str, ...], hedges: tuple[str, ...], chain_heads: tuple[str, ...], compounds: tuple[str, ...]
) -> Language:
    lark = _parser()

    def phrases(given: Iterable[str]) -> dict[str, list[str]]:
        return by_first_word(((phrase,), phrase) for phrase in given)

    scanner = Scanner(
        lark.terminals,
        {
            "CLAIM": Phrases(CLAIM_PATTERNS, "|".join),
            "CLAIM_OF": Phrases(CLAIM_OF_PATTERNS, "|".join),
            "HAS": Phrases(by_first_word([(HAS, HAS_PATTERN)]), "|".join),
            "RELATION": Phrases(phrases(relations), phrase_pattern),
            "HEDGE": Phrases(phrases(hedges), phrase_pattern),
            "CHAIN": Phrases(phrases(chain_heads), lambda heads: phrase_pattern(heads) + r"[ \t]*:"),
            "COMPOUND": Phrases(phrases(compounds), phrase_pattern),
        },
    )
    split = [phrase.split() for phrase in relations]
    starts = frozenset(" ".join(words[:end]) for words in split for end in range(1, len(words)))
    return Language(lark, scanner, starts | PHRASE_STARTS)


@cache
def _parser() -> Lark:
    """Return the parser of ``layout.lark``, which all ontologies share."""
    return LAYOUT.parser()
