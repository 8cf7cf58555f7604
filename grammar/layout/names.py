"""Names of objects in a script: spelling, counted names, quoted names and reserved words."""

from __future__ import annotations

import unicodedata

from lark import Token

from deixis.grammar.errors import StatementError, shortened
from deixis.grammar.layout.words import NOUNS_TOO
from deixis.grammar.script import Mention
from deixis.ontology.graph.facts import Source

RESERVED_FOR = {
    "FUNCTION": "is a reserved word",
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
    "_THAN": "belongs to a comparison",
    "_NOTHING": "states that no object is there",
    "_UNSEEN": "marks what is not among the objects",
    "CLAIM": "says where something is, or what it is like",
    "CLAIM_OF": "says where something is",
    "HAS": "states a property",
}
"""Uses of the reserved words, by terminal; messages put the word in front."""

RELATING_TERMINALS = frozenset({"RELATION", "IS", "VERB"})


def is_also_noun(token: Token) -> bool:
    """Return whether a function word can also name a thing: a watering can.

    Parameters
    ----------
    token
        The token of the word.

    Returns
    -------
    bool
        True if it can.
    """
    return token.type == "FUNCTION" and token.casefold() in NOUNS_TOO


def may_be_meant_as_name(tokens: list[Token], at: int) -> bool:
    """Return whether a reserved word may have been written as a name.

    Parameters
    ----------
    tokens
        Tokens of the statement.
    at
        Position of the word.

    Returns
    -------
    bool
        False if it is the only word that can relate the others.
    """
    others = (token.type for number, token in enumerate(tokens) if number != at)
    return tokens[at].type in RESERVED_FOR and (
        tokens[at].type != "RELATION" or not RELATING_TERMINALS.isdisjoint(others)
    )


def naming_hint(tokens: list[Token], at: int) -> str:
    """Return a hint on how to write a name that contains a reserved word.

    Parameters
    ----------
    tokens
        Tokens of the statement.
    at
        Position of the word.

    Returns
    -------
    str
        The hint.
    """
    word = tokens[at]
    parts = [str(t) for t in tokens[max(at - 1, 0) : at + 2] if t is word or t.type == "NAME"]
    joined = "_".join("_".join(parts).split())
    if len(parts) == 1:
        return f"if '{shortened(word)}' is a name, quote it: \"{shortened(word)}\""
    kept = f"'{shortened(word)}' {RESERVED_FOR[word.type]}"
    return f"{kept}; if it belongs to a name, write {shortened(joined)} or quote the name"


MAX_NAME = 1_000  # maximum length in characters of a name or a title
MAX_OBJECTS = 1_000_000  # maximum number of objects in a script, its includes counted
BLANKS = "\t\u00a0\u2002\u2003\u2009\u202f\u3000"  # without the space, which is printable
JOINERS = "\u200c\u200d"  # invisible, but part of words in Persian and the scripts of India


def key_of(name: str) -> str:
    """Return the key by which names are compared: casefolded, and in Unicode normal form C.

    Parameters
    ----------
    name
        The name.

    Returns
    -------
    str
        The key.

    Examples
    --------
    >>> key_of("Dinner_Plate") == key_of("dinner_plate")
    True
    """
    return name.casefold() if name.isascii() else unicodedata.normalize("NFC", name.casefold())


def unquote(text: str, source: Source) -> str:
    """Return the name that a quoted text stands for, with blanks as underscores.

    Parameters
    ----------
    text
        The text with its quotes.
    source
        Its place.

    Returns
    -------
    str
        The name.

    Raises
    ------
    StatementError
        If the name is empty or has a control character.
    """
    for i, character in enumerate(text):
        if not (character.isprintable() or character in BLANKS or character in JOINERS):
            place = Source(source.file, source.line, source.column + 1 + i, source.line, source.column + 2 + i)
            raise StatementError(place, f"a control character (U+{ord(character):04X}) cannot be in a name")
    name = "_".join(unicodedata.normalize("NFC", text).split())
    if not name:
        raise StatementError(source, "a name must not be empty")
    return name


def require_short(name: str, source: Source) -> None:
    """Raise StatementError for a name or a title that is too long.

    Parameters
    ----------
    name
        The name.
    source
        Its place.

    Raises
    ------
    StatementError
        If it has more than ``MAX_NAME`` characters.
    """
    if len(name) > MAX_NAME:
        raise StatementError(source, f"a name must have at most {MAX_NAME:,} characters, got {len(name):,}")


class NameTable:
    """Names that were mentioned so far, in a script and in the files that it includes."""

    def __init__(self) -> None:
        self._spelling: dict[str, str] = {}
        self._counts: dict[str, int] = {}
        self._names: dict[str, tuple[str, ...]] = {}

    def mention(self, name: str, count: int | None, source: Source) -> Mention:
        """Return the object or objects that a name means.

        Parameters
        ----------
        name
            The name.
        count
            Number before the name, or None.
        source
            Its place.

        Returns
        -------
        Mention
            The mention.

        Raises
        ------
        StatementError
            If it contradicts earlier mentions.
        """
        require_short(name, source)
        key = key_of(name)
        if count is not None:
            known = self._counts.get(key)
            if known is None and key in self._spelling:
                hint = "give the count with every mention of a name, or with none"
                raise StatementError(
                    source, f"'{shortened(name)}' named one object before, and {count} objects here", hint
                )
            if known is not None and known != count:
                message = f"there are {known} of '{shortened(name)}', not {count}"
                raise StatementError(source, message, f"say `{known} {shortened(name)}`")
            if known is None:
                self._make_room(count, source)
                self._counts[key] = count
                self._spelling[key] = name
                each = [f"{name}_{number}" for number in range(1, count + 1)]
                self._names[key] = tuple(self._spelling.setdefault(key_of(one), one) for one in each)
            return Mention(self._spelling[key], source, count, self._names[key])
        if key in self._counts:
            shown, known = shortened(self._spelling[key]), self._counts[key]
            each = [f"{shown}_{number}" for number in range(1, known + 1)]
            listed = ", ".join(each if known <= 3 else [each[0], "…", each[-1]])
            hint = f"there are {known}: say {listed} or `{known} {shown}`"
            raise StatementError(source, f"'{shortened(name)}' alone does not say which one is meant", hint)
        spelled = self._spelling.get(key)
        if spelled is None:
            self._make_room(1, source)
            spelled = self._spelling[key] = name
        return Mention(spelled, source, None, (spelled,))

    def _make_room(self, more: int, source: Source) -> None:
        if len(self._spelling) + more > MAX_OBJECTS:
            raise StatementError(
                source, f"a script must name at most {MAX_OBJECTS:,} objects; this statement exceeds that"
            )
