r"""Text that is safe to print: control characters as escapes, long text shortened.

What users and files say may hold characters that move a terminal's cursor, change its colours, or turn the order of
letters round. Each is shown by its code, as in ``\u001b``, which JSON, Turtle and SPARQL read as that character.
"""

from __future__ import annotations

import re

MAX_MESSAGE = 500
"""Characters of a line of a message that are shown."""

WINDOW = 100
"""Characters of a quoted line that are shown."""

_UNSAFE = re.compile(
    r"\r(?!\n)|[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u206f\ufff9-\ufffb\ud800-\udfff]"
)
_SHORT = {"\n": r"\n", "\r": r"\r", "\t": r"\t"}


def visible(text: str) -> str:
    r"""Return a text of lines with every other control character as an escape; tabs and line ends stay.

    >>> print(visible("fork\x1b[2J\nknife\u202e"))
    fork\u001b[2J
    knife\u202e
    """
    return _UNSAFE.sub(lambda found: f"\\u{ord(found[0]):04x}", text)


def visible_line(text: str) -> str:
    r"""Return a text on one line: as :func:`visible`, with tabs and line ends as escapes too.

    >>> print(visible_line("fork\nknife\tspoon"))
    fork\nknife\tspoon
    """
    return visible(re.sub(r"[\n\r\t]", lambda found: _SHORT[found[0]], text))


def shortened(text: str, limit: int = MAX_MESSAGE) -> str:
    """Return a text of at most ``limit`` characters: of a longer one its beginning and its end.

    >>> shortened("a" * 100 + " must be a name", 30)
    'aaaaaaaaaaaaaaaaaaa… be a name'
    """
    if len(text) <= limit:
        return text
    end = limit // 3
    return text[: limit - end - 1] + "…" + text[len(text) - end :]


def window(line: str, column: int) -> tuple[str, int]:
    """Return what is shown of a line around a column (from 0), and the column in that.

    What cannot be printed takes one column: blanks as spaces, anything else as the replacement character.

    >>> window("a\\tb", 2), window("a" * 500 + "b" + "c" * 500, 500)[0].count("a")
    (('a b', 2), 50)
    """
    left = 0 if len(line) <= WINDOW else max(0, min(column - WINDOW // 2, len(line) - WINDOW))
    right = min(len(line), left + WINDOW)
    plain = "".join(c if c.isprintable() else " " if c.isspace() else "\ufffd" for c in line[left:right])
    shown = ("…" if left else "") + plain + ("…" if right < len(line) else "")
    return shown, column - left + (left > 0)
