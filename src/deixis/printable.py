r"""Text that is safe to print: control characters as escapes, long text shortened.

Input from users and files may have characters that move a terminal's cursor, change its colours, or reverse the order
of letters. Each is shown by its code, such as ``\u001b``, which JSON, Turtle and SPARQL read as that character.
"""

from __future__ import annotations

import re

MAX_MESSAGE = 500
"""Maximum number of characters of a line of a message that are shown."""

WINDOW = 100
"""Maximum number of characters of a quoted line that are shown."""

_UNSAFE = re.compile(
    r"\r(?!\n)|[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u206f\ufff9-\ufffb\ud800-\udfff]"
)
_SHORT = {"\n": r"\n", "\r": r"\r", "\t": r"\t"}


def visible(text: str) -> str:
    r"""Return a text with every control character except tabs and line ends as an escape.

    Parameters
    ----------
    text
        The text.

    Returns
    -------
    str
        The text, with the other characters unchanged.

    Examples
    --------
    >>> print(visible("fork\x1b[2J\nknife\u202e"))
    fork\u001b[2J
    knife\u202e
    """
    return _UNSAFE.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


def visible_line(text: str) -> str:
    r"""Return a text on one line: as :func:`visible`, with tabs and line ends as escapes too.

    Parameters
    ----------
    text
        The text.

    Returns
    -------
    str
        The text on one line.

    Examples
    --------
    >>> print(visible_line("fork\nknife\tspoon"))
    fork\nknife\tspoon
    """
    return visible(re.sub(r"[\n\r\t]", lambda found: _SHORT[found[0]], text))


def printed_line(text: str, limit: int = MAX_MESSAGE) -> str:
    r"""Return a text as one line of printable characters: blanks of all kinds become spaces, others a replacement.

    Parameters
    ----------
    text
        The text.
    limit
        Maximum number of characters.

    Returns
    -------
    str
        The text; an ellipsis where nothing is left of it, or where it is cut.

    Examples
    --------
    >>> print(printed_line("what is\n wrong\x07?"), printed_line("\n"))
    what is wrong�? …
    """
    words = " ".join(text.split())
    shown = "".join(sign if sign.isprintable() else "\N{REPLACEMENT CHARACTER}" for sign in words)
    return shortened(shown, limit) or "…"


def shortened(text: str, limit: int = MAX_MESSAGE) -> str:
    """Return a text of limited length: the beginning and the end of a longer one.

    Parameters
    ----------
    text
        The text.
    limit
        Maximum number of characters.

    Returns
    -------
    str
        The text, with an ellipsis where it is cut.

    Examples
    --------
    >>> shortened("a" * 100 + " must be a name", 30)
    'aaaaaaaaaaaaaaaaaaa… be a name'
    """
    if len(text) <= limit:
        return text
    end = limit // 3
    return text[: limit - end - 1] + "…" + text[len(text) - end :]


def window(line: str, column: int) -> tuple[str, int]:
    r"""Return the part of a line around a column.

    Each unprintable character takes one column: blanks become spaces, others the replacement character.

    Parameters
    ----------
    line
        The line.
    column
        Column from 0.

    Returns
    -------
    tuple
        The part, and the column within it.

    Examples
    --------
    >>> window("a\tb", 2), window("a" * 500 + "b" + "c" * 500, 500)[0].count("a")
    (('a b', 2), 50)
    """
    left = 0 if len(line) <= WINDOW else max(0, min(column - WINDOW // 2, len(line) - WINDOW))
    right = min(len(line), left + WINDOW)
    plain = "".join(c if c.isprintable() else " " if c.isspace() else "\ufffd" for c in line[left:right])
    shown = ("…" if left else "") + plain + ("…" if right < len(line) else "")
    return shown, column - left + (left > 0)
