r"""Tokens of a SPARQL query, for checking it before it is run.

This is not a parser. It finds keywords, prefixed names, IRIs and strings as Oxigraph's parser does. Where the two could
disagree about the beginning of a string or a comment, the query is refused: ``FILTER(?a<?b#>`` can be read as an IRI or
as a comparison and a comment, and ``trueSERVICE`` as one word or two.

>>> [token.text for token in tokens("ASK { ?s a dx:Scene }")]
['ASK', '{', '?s', 'a', 'dx:Scene', '}']
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum


class TokenKind(StrEnum):
    """Kind of a token."""

    COMMENT = "comment"
    IRI = "iri"
    STRING = "string"
    VARIABLE = "variable"
    LANGUAGE = "language"
    NUMBER = "number"
    NAME = "name"
    WORD = "word"
    SIGN = "sign"


@dataclass(frozen=True, slots=True)
class Token:
    """A token, with its kind and its offset."""

    kind: TokenKind
    text: str
    start: int

    @property
    def upper(self) -> str:
        """Text of the token in capitals."""
        return self.text.upper()


_ESCAPE = r"\\u[0-9A-Fa-f]{4}|\\U[0-9A-Fa-f]{8}"
_IRI = rf"<(?:[^<>\"{{}}|^`\\\x00-\x20]|{_ESCAPE})*>"
_LOCAL = r"(?:[\w·:-]|\.(?=[\w·:.\\%-])|%[0-9A-Fa-f]{2}|\\[_~.\-!$&'()*+,;=/?#@%])*"

_MAX_PREFIX = 200
"""Maximum characters of a prefix, so that finding the end of words such as ``a.a.a.a`` takes linear time."""

_STRINGS = "|".join(
    [
        r'"""(?:[^"\\]|\\.|"(?!""))*"""',
        r"'''(?:[^'\\]|\\.|'(?!''))*'''",
        r'"(?:[^"\\\n\r]|\\.)*"',
        r"'(?:[^'\\\n\r]|\\.)*'",
    ]
)

_TOKEN = re.compile(
    "|".join(
        [
            r"(?P<comment>#[^\n\r]*)",
            rf"(?P<iri>{_IRI})",
            rf"(?P<string>{_STRINGS})",
            r"(?P<variable>[?$]\w+)",
            r"(?P<language>@[A-Za-z]+(?:-[A-Za-z0-9]+)*)",
            r"(?P<number>\d+(?:\.\d+)?(?:[eE][+-]?\d+)?)",
            rf"(?P<name>(?:_:|(?:[^\W\d_](?:[\w·.-]{{0,{_MAX_PREFIX}}}[\w·-])?)?:){_LOCAL})",
            r"(?P<word>[^\W\d]\w*)",
            r"(?P<sign>\\.|<<|>>|\S)",
        ]
    ),
    re.DOTALL,
)

_SKIPPED = re.compile(rf"(?:#[^\n\r]*|{_IRI}|{_STRINGS})|(?P<escape>{_ESCAPE})", re.DOTALL)


def tokens(text: str) -> Iterator[Token]:
    """Yield the tokens of a decoded query, without comments.

    Parameters
    ----------
    text
        The query.

    Yields
    ------
    Token
        A token.
    """
    for match in _TOKEN.finditer(text):
        kind = TokenKind(match.lastgroup or "sign")
        if kind is not TokenKind.COMMENT:
            yield Token(kind, match.group(), match.start())


def decoded(text: str) -> tuple[str, list[tuple[int, int]]]:
    r"""Decode codepoint escapes outside strings, comments and IRIs.

    Only escapes of letters, digits and ``_:?$-`` are decoded; SPARQL does not allow others there.

    Parameters
    ----------
    text
        The query.

    Returns
    -------
    tuple
        The decoded text, and pairs of offsets, in the decoded and in the given text, to translate places.

    Examples
    --------
    >>> decoded(r"SEL\u0045CT * {}")[0]
    'SELECT * {}'
    """
    parts: list[str] = []
    places = [(0, 0)]
    done = length = 0
    for match in _SKIPPED.finditer(text):
        escape = match.group("escape")
        if escape is None or (letter := _letter(escape)) is None:
            continue
        parts += [text[done : match.start()], letter]
        length += match.start() - done + 1
        done = match.end()
        places.append((length, done))
    return "".join([*parts, text[done:]]), places


def _letter(escape: str) -> str | None:
    code = int(escape[2:], 16)
    letter = chr(code) if code <= 0x10FFFF and not 0xD800 <= code <= 0xDFFF else ""
    return letter if letter and (letter.isalnum() or letter in "_:?$-") else None


def given_offset(offset: int, places: list[tuple[int, int]]) -> int:
    """Return the offset in the given text for an offset in the decoded text.

    Parameters
    ----------
    offset
        Offset in the decoded text.
    places
        Pairs of offsets, as of :func:`decoded`.

    Returns
    -------
    int
        The offset.
    """
    here, there = max(place for place in places if place[0] <= offset)
    return there + offset - here


def ambiguous(token: Token, prefixes: Collection[str]) -> bool:
    """Return whether an IRI may be a comparison that hides the beginning of a comment, a string or a SERVICE.

    Parameters
    ----------
    token
        The token of the IRI.
    prefixes
        Known prefixes.

    Returns
    -------
    bool
        True if it may be one.
    """
    return bool(_may_be_comparison(token, prefixes) and re.search(r"[#']|service", token.text, re.IGNORECASE))


def _may_be_comparison(iri: Token, prefixes: Collection[str]) -> bool:
    """Return False for an IRI that begins with a scheme, unless the scheme is a prefix of the query."""
    scheme = re.match(r"<([A-Za-z][A-Za-z0-9+.-]*):", iri.text)
    return scheme is None or scheme.group(1) in prefixes


_OPENING = {")": "(", "]": "[", "}": "{", ">>": "<<"}
"""Opening bracket of each closing bracket."""

_PREFIX_OPERATORS = {"!", "-", "+", "^"}


def too_deep(found: Sequence[Token], prefixes: Collection[str], limit: int) -> Token | None:
    """Return the first token that is nested too deeply.

    Open brackets of all sorts count, ``<<`` among them, and prefix operators in a row. The count is never below the
    nesting that a parser meets: brackets within an IRI that may be a comparison count too, as in ``?a<((?b>?c``.

    Parameters
    ----------
    found
        The tokens.
    prefixes
        Known prefixes.
    limit
        Maximum number of levels.

    Returns
    -------
    Token or None
        The token, or None.

    Examples
    --------
    >>> words = list(tokens("ASK { FILTER(!!(?a)) }"))
    >>> too_deep(words, (), 5), too_deep(words, (), 4).start
    (None, 15)
    """
    levels: list[tuple[str, int]] = []  # open brackets, each with its depth
    depth = operators = 0
    for token in found:
        if token.kind is TokenKind.SIGN and token.text in _PREFIX_OPERATORS:
            operators += 1
        else:
            for sign in _brackets(token, prefixes):
                if sign in _OPENING.values():
                    levels.append((sign, depth + operators + 1))
                elif any(opened == _OPENING[sign] for opened, _ in levels):
                    while levels.pop()[0] != _OPENING[sign]:
                        pass  # brackets left open inside end here, or the query is malformed
                depth = levels[-1][1] if levels else 0
                operators = 0
            operators = 0
        if depth + operators > limit:
            return token
    return None


def _brackets(token: Token, prefixes: Collection[str]) -> list[str]:
    """Return the brackets of a token: itself, or those within an IRI that may be a comparison."""
    if token.kind is TokenKind.SIGN:
        return [token.text] if token.text in _OPENING or token.text in _OPENING.values() else []
    if token.kind is TokenKind.IRI and _may_be_comparison(token, prefixes):
        return re.findall(r"[(\[]", token.text)
    return []
