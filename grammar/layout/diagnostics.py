"""Explain a syntax error in the user's terms, from the token at which the parser stopped."""

from __future__ import annotations

import re
from dataclasses import replace
from difflib import SequenceMatcher

from lark import Token

from deixis.grammar.errors import MAX_PROBLEMS_SHOWN, StatementError, shortened
from deixis.grammar.layout.draft import Draft
from deixis.grammar.layout.names import RESERVED_FOR, is_also_noun, may_be_meant_as_name, naming_hint
from deixis.grammar.layout.tree import UNQUALIFIED_DECLARATION, source_of, span_of
from deixis.grammar.layout.words import DENIALS
from deixis.ontology.graph.facts import Source
from deixis.ontology.relations.relation import plain_phrase

RELATION_EXPECTED = "expected a relation such as 'left of', or 'is a'"
SMART_QUOTES = "“”„‟«»‘’"
QUOTE_HINT = "if it belongs to a name, quote the name"
NEARNESS_WORDS = {"nearer", "next", "close", "closer", "besides", "far", "farther"}
NEARNESS_HINT = "say 'near', 'next to' or 'far from' for nearness"
UNSURE_HINT = "what is not sure is said with 'perhaps': fork perhaps left of plate"
FACT_HINT = "a statement says how the table is laid: fork left of plate"
DENIAL_HINT = "write a denial with 'not': fork not left of plate"
SEPARATOR_HINT = "';' separates two statements on one line"
ONE_QUALITY_HINT = "an object has one kind and one colour: state the main one"
HINTS = {
    **dict.fromkeys(NEARNESS_WORDS, NEARNESS_HINT),
    **dict.fromkeys(("may", "might", "could", "would"), UNSURE_HINT),
    **dict.fromkeys(("must", "should", "will", "was", "were", "been", "had"), FACT_HINT),
    **dict.fromkeys(DENIALS, DENIAL_HINT),
}
"""Hints for words where a relation is expected."""
NAMES = ("NAME", "STRING")
RESERVED = ("RELATION", "HEDGE", "IS", "VERB", "NOT", "OPTIONAL")
QUALIFIERS = ("NOT", "OPTIONAL", "HEDGE")
OUT_OF_PLACE = ("_LAYOUT", "_INCLUDE", "_SEEN", "_FROM", "CHAIN")
MIN_SIMILARITY = 0.7  # least ratio, in [0, 1], between the words given and a relation phrase that is suggested
MAX_NAME_SEARCHED = 200  # maximum length in characters of a name that is searched for a misspelt relation


def bad_token(token: Token) -> StatementError:
    """Return the error for a token that is not allowed anywhere in a script.

    Parameters
    ----------
    token
        The token.

    Returns
    -------
    StatementError
        The error, which is not raised.
    """
    if token.type == "UNKNOWN":
        character, where = token[0], source_of(token)
        where = replace(where, end_column=where.column + 1)
        if character in SMART_QUOTES:
            return StatementError(where, f"quote names with \", not with '{character}'")
        if character == ":":
            return StatementError(where, "a colon is allowed only after the head of a chain, such as 'left to right:'")
        if not character.isprintable():
            return StatementError(where, f"a control character (U+{ord(character):04X}) cannot be in a script")
        return StatementError(
            where, f"unexpected character '{character}'", "quote a name that contains such characters"
        )
    if token.type == "OPEN_STRING":
        return StatementError(source_of(token), "this quotation mark is not closed on its line")
    shown = shortened(token)
    if token.lstrip("-").isdigit():
        return StatementError(source_of(token), f"a count must be from 1 to 99, got {shown}")
    message = f"a name must start with a letter, got '{shown}'"
    return StatementError(source_of(token), message, f'quote it: "{shown}"')


def unexpected(tokens: list[Token], at: int, accepts: set[str], draft: Draft) -> StatementError:
    """Return the error for a statement in which the parser does not accept a token.

    Parameters
    ----------
    tokens
        Tokens of the statement.
    at
        Position of the token.
    accepts
        Terminals that the parser accepts there.
    draft
        The script so far, whose names may be suggested.

    Returns
    -------
    StatementError
        The error, which is not raised.
    """
    if tokens[0].type == "_LAYOUT":
        found = f", not '{shortened(tokens[at])}'" if at < len(tokens) else ""
        hint = 'as in: layout dinner "A dinner" seen from chair'
        message = f"expected a name, a title in quotation marks, or 'seen from'{found}"
        return StatementError(_place(tokens, at), message, hint)
    if tokens[0].type == "_INCLUDE":
        hint = 'as in: include "other.layout"'
        return StatementError(_place(tokens, at), "expected a file name in quotation marks, and nothing else", hint)
    if at == len(tokens):
        return _premature_end(tokens, accepts, draft)
    token = tokens[at]
    if token.type == "ARTICLE":
        # No name follows the article; perhaps a reserved word was meant as a name.
        message = f"expected a name after '{tokens[at]}'"
        if at + 1 == len(tokens) or not may_be_meant_as_name(tokens, at + 1):
            return StatementError(source_of(tokens[at]), message)
        word = tokens[at + 1]
        message = f"{message}, not '{shortened(word)}', which {RESERVED_FOR[word.type]}"
        return StatementError(source_of(word), message, naming_hint(tokens, at + 1))
    if token.type in OUT_OF_PLACE:
        return StatementError(source_of(token), f"'{token}' is not expected here", QUOTE_HINT)
    if token.type == "_LPAR" and at == 1 and tokens[0].type == "NAME" and any(t.type == "_COMMA" for t in tokens):
        return _unknown_relation(tokens[0], draft)
    if "RELATION" in accepts and (distance := _WITHOUT_UNIT.match(" ".join(tokens[at : at + 4]))) is not None:
        message = f"the distance '{shortened(distance[0])}' has no unit"
        return StatementError(source_of(token), message, f"write, for example, {distance[1]} cm from")
    if token.type == "FUNCTION" or (token.type in NAMES and at and tokens[at - 1].type in NAMES):
        return _missing_relation(tokens, at, accepts, draft)
    return _unexpected_token(tokens, at, accepts)


def _place(tokens: list[Token], at: int) -> Source:
    """Return the place of token ``at``, or the place after the last token when ``at`` is past the end."""
    if at < len(tokens):
        return source_of(tokens[at])
    end = source_of(tokens[-1])
    return Source(end.file, end.end_line, end.end_column, end.end_line, end.end_column + 1)


def _premature_end(tokens: list[Token], accepts: set[str], draft: Draft) -> StatementError:
    """Return the error for a statement that ends too early: it names what is missing."""
    last, where = tokens[-1], _place(tokens, len(tokens))
    if "IS" in accepts and last.type in NAMES:
        listed = [token for token in tokens if token.type in NAMES]
        if len(listed) > 1:
            return StatementError(
                span_of(tokens), f"this statement says nothing about these {len(listed)} objects", RELATION_EXPECTED
            )
        name = str(listed[0])
        message = f"this statement says nothing about '{shortened(name.strip(chr(34)))}'"
        if len(name) <= MAX_NAME_SEARCHED and listed[0].type == "NAME":
            words = name.split("_")
            for at, word in enumerate(words[1:-1], start=1):
                near = draft.nearest(word, list(draft.phrases))
                if near is not None:
                    meant = draft.phrases[near]
                    corrected = " ".join(("_".join(words[:at]), meant, "_".join(words[at + 1 :])))
                    whole = corrected if len(tokens) == 1 else None
                    return StatementError(
                        span_of(tokens), message, f"did you mean '{meant}' instead of '{word}'?", whole
                    )
        return StatementError(span_of(tokens), message, RELATION_EXPECTED)
    if last.type == "IS":
        return StatementError(where, f"expected a kind of thing or a relation after '{last}'")
    if accepts & {"NAME", "STRING"}:
        return StatementError(where, f"expected a name after '{shortened(last)}'")
    if "_COMMA" in accepts:
        return StatementError(where, "expected a comma and a second name")
    if "_RPAR" in accepts:
        return StatementError(where, "expected a closing bracket")
    if "_LPAR" in accepts:
        return StatementError(where, "expected a pair in brackets, as in left(fork, plate)")
    return StatementError(where, f"expected a relation such as 'left of' after '{shortened(last)}'")


def _missing_relation(tokens: list[Token], at: int, accepts: set[str], draft: Draft) -> StatementError:
    """Return the error for a token where a relation is expected; suggest a relation phrase that resembles the words."""
    token, shown = tokens[at], shortened(tokens[at])
    if is_also_noun(token):
        if accepts & {"NAME", "STRING"}:
            message = _no_bare_name(shown)
        elif "RELATION" in accepts:
            message = f"{RELATION_EXPECTED}, not '{shown}'"
        else:
            message = f"'{shown}' is not expected here"
        return StatementError(source_of(token), message, naming_hint(tokens, at))
    hint = HINTS.get(token.casefold())
    if hint == DENIAL_HINT or (hint is not None and hint != NEARNESS_HINT and "RELATION" in accepts):
        return StatementError(source_of(token), f"{RELATION_EXPECTED}, not '{shown}'", hint)
    if "RELATION" in accepts and (verb := _relation_of_verb(token, draft)) is not None:
        return StatementError(source_of(token), f"expected a relation, not '{shown}'", f"did you mean '{verb}'?", verb)
    if "RELATION" in accepts and (meant := _nearest_relation(tokens, at, draft)) is not None:
        words_given, where, phrase = meant
        if hint is not None and not phrase.startswith(token.casefold()):
            return StatementError(source_of(token), f"{RELATION_EXPECTED}, not '{shown}'", hint)  # 'close by'
        return StatementError(where, f"expected a relation, not '{words_given}'", f"did you mean '{phrase}'?", phrase)
    if token.type in NAMES:
        return _unexpected_token(tokens, at, accepts)
    if at and tokens[at - 1].type == "NAME":
        if "RELATION" not in accepts:
            return _unexpected_token(tokens, at, accepts)
        parts = [str(t) for t in tokens[at - 1 : at + 2] if t.type in ("NAME", "FUNCTION")]
        hint = hint or f"if it belongs to a name, write {shortened('_'.join(parts))} or quote the name"
        return StatementError(source_of(token), f"{RELATION_EXPECTED}, not '{shown}'", hint)
    return StatementError(source_of(token), _no_bare_name(shown), hint)


_WITHOUT_UNIT = re.compile(r"(?:[a-z ]+ )?(\d+(?:\.\d+)?)(?= (?:from|away)\b)")
"""A distance without its unit: *about 5 from*."""


def _relation_of_verb(token: Token, draft: Draft) -> str | None:
    """Return the relation with the participle of a verb: *touching* for *touches*, *facing* for *faces*."""
    word = token.casefold()
    forms = (f"{stem}ing" for stem in (word.removesuffix("s"), word.removesuffix("es"))) if word.endswith("s") else ()
    return next((draft.phrases[form] for form in forms if form in draft.phrases), None)


def _unknown_relation(name: Token, draft: Draft) -> StatementError:
    """Return the error for a pair in brackets after a word that is not a relation; suggest the nearest relation."""
    message = f"there is no relation '{shortened(name)}'"
    near = draft.nearest(plain_phrase(name), list(draft.phrases)) if len(name) <= MAX_NAME_SEARCHED else None
    if near is None:
        return StatementError(source_of(name), message, "a pair in brackets follows a relation: left(fork, plate)")
    meant = draft.phrases[near]
    return StatementError(source_of(name), message, f"did you mean '{meant}'?", meant)


def _no_bare_name(shown: str) -> str:
    return f"expected a name; '{shown}' cannot be part of an unquoted name"


def _nearest_relation(tokens: list[Token], at: int, draft: Draft) -> tuple[str, Source, str] | None:
    """Return the words around token ``at``, their place, and the relation phrase that resembles them most."""
    phrases = draft.phrases
    best, found = MIN_SIMILARITY, None
    if len(draft.problems) >= MAX_PROBLEMS_SHOWN:
        return None
    for start in (at - 1, at):
        if start < 0 or (start < at and tokens[start].type != "NAME"):
            continue
        for end in range(at, min(at + 3, len(tokens))):
            if end > at and tokens[end].type in NAMES:
                break
            if start == end and tokens[end].type == "FUNCTION":
                continue  # "to" alone resembles too many phrases
            words_given = " ".join([tokens[start].rpartition("_")[2], *tokens[start + 1 : end + 1]])
            near = draft.nearest(plain_phrase(words_given), list(phrases))
            if near is None:
                continue
            ratio = SequenceMatcher(None, plain_phrase(words_given), near).ratio()
            if ratio > best:
                best, found = ratio, (words_given, _from_last_word(tokens[start], tokens[end]), phrases[near])
    return found


def _from_last_word(first: Token, last: Token) -> Source:
    start, end = source_of(first), source_of(last)
    column = start.end_column - len(first.rpartition("_")[2])
    return Source(start.file, start.end_line, column, end.end_line, end.end_column)


def _unexpected_token(tokens: list[Token], at: int, accepts: set[str]) -> StatementError:
    token, shown = tokens[at], shortened(tokens[at])
    where = source_of(token)
    if at == 0:
        hint = QUOTE_HINT if token.type in RESERVED else None
        return StatementError(where, f"expected a name before '{shown}'", hint)
    before = shortened(tokens[at - 1])
    if accepts & {"NAME", "STRING"}:
        hint = QUOTE_HINT if token.type in RESERVED else None
        return StatementError(where, f"expected a name after '{before}', not '{shown}'", hint)
    if "RELATION" in accepts:
        if token.type in NAMES and tokens[at - 1].type in QUALIFIERS:
            return StatementError(where, f"{RELATION_EXPECTED}, not '{shown}'", UNQUALIFIED_DECLARATION)
        return StatementError(where, f"{RELATION_EXPECTED}, not '{shown}'")
    if "_COMMA" in accepts and "$END" not in accepts:
        return StatementError(where, f"expected a comma and a second name, not '{shown}'")
    if "_RPAR" in accepts:
        return StatementError(where, f"expected a closing bracket, not '{shown}'")
    if "_LPAR" in accepts:
        named = token.type == "NAME" and may_be_meant_as_name(tokens, at - 1)
        hint = naming_hint(tokens, at - 1) if named else None
        return StatementError(where, f"expected a pair in brackets, as in left(fork, plate), not '{shown}'", hint)
    if "$END" in accepts:
        quality = token.type in ("_AND", "_OR") and tokens[at - 2].type == "IS"
        return StatementError(
            where, f"expected the end of the statement, not '{shown}'", ONE_QUALITY_HINT if quality else SEPARATOR_HINT
        )
    return StatementError(where, f"'{shown}' is not expected here")
