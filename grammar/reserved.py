"""Words that an unquoted name cannot contain: what each is reserved for, and how a name with it is written."""

from __future__ import annotations

from lark import Token

from deixis.grammar.errors import shortened
from deixis.grammar.words import NOUNS_TOO

KEPT_FOR = {
    "FUNCTION": "is kept for sentences",
    "RELATION": "is a word for a relation",
    "HEDGE": "says how sure a fact is",
    "IS": "is a verb",
    "VERB": "is a verb",
    "NOT": "denies a fact",
    "OPTIONAL": "marks facts that need not hold",
    "_AND": "joins names",
    "_OR": "joins relations",
    "_LAYOUT": "begins a header",
    "_SEEN": "belongs to a header",
    "_FROM": "belongs to a header",
    "_INCLUDE": "begins an include",
}
"""What the terminals are for that are words, and no names."""

LINKS = frozenset({"RELATION", "IS", "VERB"})


def names_things_too(token: Token) -> bool:
    """Whether a word that makes sentences is the name of a thing as well: a watering can."""
    return token.type == "FUNCTION" and token.casefold() in NOUNS_TOO


def may_be_meant_as_name(tokens: list[Token], at: int) -> bool:
    """Whether the word number ``at`` is reserved, and no relation that the statement needs."""
    others = (token.type for number, token in enumerate(tokens) if number != at)
    return tokens[at].type in KEPT_FOR and (tokens[at].type != "RELATION" or not LINKS.isdisjoint(others))


def how_to_name(tokens: list[Token], at: int) -> str:
    """How a name is written to which the reserved word number ``at`` belongs, with the words around it."""
    word = tokens[at]
    parts = [str(t) for t in tokens[max(at - 1, 0) : at + 2] if t is word or t.type == "NAME"]
    joined = "_".join("_".join(parts).split())
    if len(parts) == 1:
        return f"if '{shortened(word)}' is a name, quote it: \"{shortened(word)}\""
    kept = f"'{shortened(word)}' {KEPT_FOR[word.type]}"
    return f"{kept}; if it belongs to a name, write {shortened(joined)} or quote the name"
