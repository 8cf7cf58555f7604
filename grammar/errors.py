"""Errors in a script: each problem with its place, its line and carets under the part in question."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from typing import Any

from deixis.errors import DeixisError
from deixis.ontology.graph.facts import Source

MAX_PROBLEMS_SHOWN = 50  # problems that are shown in full
LINE_WINDOW = 100  # characters of a long line that are shown


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One problem at one place in a file; as text, with the line, carets and a hint.

    ``replacement`` is a text that would be correct at this place, or None.

    >>> print(Diagnostic(Source("t.layout", 1, 6, 1, 9), "what is this?", "fork lft plate", "did you mean 'left'?"))
    t.layout:1:6: what is this?
    fork lft plate
         ^^^
    did you mean 'left'?
    """

    source: Source
    message: str
    line_text: str
    hint: str | None = None
    replacement: str | None = None

    def __str__(self) -> str:
        line, caret = _line_with_carets(self.line_text, self.source)
        parts = [f"{self.source}: {self.message}", *((line, caret) if line.strip() else ())]
        return "\n".join(parts if self.hint is None else [*parts, self.hint])


def _line_with_carets(line: str, source: Source) -> tuple[str, str]:
    """Return the line, cut to ``LINE_WINDOW`` characters, and carets under the span of ``source``."""
    start = source.column - 1
    end = source.end_column - 1 if source.end_line == source.line else len(line)
    left = 0 if len(line) <= LINE_WINDOW else max(0, min(start - LINE_WINDOW // 2, len(line) - LINE_WINDOW))
    right = min(len(line), left + LINE_WINDOW)
    before = ("…" if left else "") + line[left:start]
    shown = ("…" if left else "") + line[left:right] + ("…" if right < len(line) else "")
    carets = max(1, _width(line[start : min(end, right)]))
    printable = "".join(c if c.isprintable() else " " if c.isspace() else "\ufffd" for c in shown)
    return printable, " " * _width(before) + "^" * carets


def _width(text: str) -> int:
    """Return the number of columns that a text takes in a terminal."""
    if text.isascii():
        return len(text)
    wide = sum(unicodedata.east_asian_width(c) in "WF" for c in text)
    return len(text) + wide - sum(unicodedata.combining(c) != 0 for c in text)


class ScriptError(DeixisError, ValueError):
    """A script with errors; ``problems`` holds all of them, in order."""

    several_lines = True

    def __init__(self, problems: tuple[Diagnostic, ...]) -> None:
        super().__init__(problems)
        self.problems = problems

    def _message(self) -> str:
        shown = [str(problem) for problem in self.problems[:MAX_PROBLEMS_SHOWN]]
        if len(self.problems) > MAX_PROBLEMS_SHOWN:
            shown.append(f"… and {len(self.problems) - MAX_PROBLEMS_SHOWN} more")
        return "\n".join(shown)


class ScriptTimeError(DeixisError, TimeoutError):
    """The time limit was reached before a script was read; ``read`` is the ``Script`` of what was read, or None."""

    def __init__(self, message: str, read: Any = None) -> None:
        super().__init__(message)
        self.read = read


class ScriptFileError(DeixisError, OSError):
    """A script file that cannot be read: missing, not a regular file, too large, or not UTF-8."""


class StatementError(Exception):
    """A problem that ends one statement; reading continues at the next statement."""

    def __init__(self, source: Source, message: str, hint: str | None = None, replacement: str | None = None) -> None:
        super().__init__(message)
        self.source = source
        self.message = message
        self.hint = hint
        self.replacement = replacement


def shortened(name: str, limit: int = 60) -> str:
    """Shorten a name or phrase for a message.

    Parameters
    ----------
    name
        The name.
    limit
        Maximum number of characters.

    Returns
    -------
    str
        The beginning of the name.
    """
    return name if len(name) <= limit else name[: limit - 1] + "…"
