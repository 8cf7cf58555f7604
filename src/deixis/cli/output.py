"""Safe output: control characters from users and files are written as escapes, and cannot change the terminal."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TextIO, cast

from deixis.printable import MAX_MESSAGE, shortened, visible, visible_line

MAX_LINE = MAX_MESSAGE + len("deixis: ")
"""Maximum number of characters in a line on standard error."""

MAX_ANSWER = 10_000
"""Maximum number of characters that are read from a line of standard input."""


class VisibleStream:
    """Text stream that writes control characters as escapes, except tabs and line ends."""

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream

    def write(self, text: str) -> int:
        """Write a text with its control characters as escapes; return the number of characters given."""
        self.stream.write(visible(text))
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        """Write texts one after another."""
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)


class MessageStream(VisibleStream):
    """Visible stream for messages: long lines are shortened.

    ``names`` are the words of the command line; a word with line ends in it, such as a file name, is written on one
    line.
    """

    def __init__(self, stream: TextIO, names: Iterable[str]) -> None:
        super().__init__(stream)
        self._names = {name: visible_line(name) for name in names if name.strip() and visible_line(name) != name}

    def write(self, text: str) -> int:
        """Write a message with each line shortened to :data:`MAX_LINE`; return the number of characters given."""
        for name, shown in self._names.items():
            text = text.replace(name, shown)
        super().write("\n".join(shortened(line, MAX_LINE) for line in text.split("\n")))
        return len(text)


_changed: list[Path] = []  # memories that the command has changed


@contextmanager
def visible_output() -> Iterator[None]:
    """Make standard output and standard error visible streams inside the block."""
    before = sys.stdout, sys.stderr
    _changed.clear()
    if sys.stdout is not None:
        sys.stdout = cast(TextIO, VisibleStream(sys.stdout))
    if sys.stderr is not None:
        sys.stderr = cast(TextIO, MessageStream(sys.stderr, sys.argv[1:]))
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before


def terminal(stream: TextIO) -> TextIO:
    """Return the stream behind a visible one, for libraries that draw with control characters."""
    return stream.stream if isinstance(stream, VisibleStream) else stream


_COLOURS = {"doubt": "33", "violation": "31"}  # yellow and red, by ANSI codes


def colour_of(line: str) -> str | None:
    """Return the ANSI code of a line's colour on standard output, or None for a plain line.

    Marked lines of a report have a colour on a terminal, unless ``NO_COLOR`` is set (https://no-color.org) or the
    terminal has no colours.
    """
    mark = getattr(line, "mark", None)
    if mark is None or sys.stdout is None or not sys.stdout.isatty():
        return None
    if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
        return None
    return _COLOURS[mark.value]


class StandardInput:
    """Lines of standard input; a closed one has no lines. Raises DeixisError where it cannot be read or decoded.

    With ``undecoded="surrogateescape"``, bytes that cannot be decoded become single surrogates.
    """

    def __init__(self, undecoded: str = "strict") -> None:
        if undecoded != "strict" and isinstance(sys.stdin, io.TextIOWrapper):
            sys.stdin.reconfigure(errors=undecoded)

    def readline(self, most: int = MAX_ANSWER) -> str:
        """Return the next line, cut after ``most`` characters; an empty text at the end."""
        from deixis.errors import DeixisError

        if sys.stdin is None:
            return ""
        try:
            return sys.stdin.readline(most)
        except UnicodeDecodeError as error:
            raise DeixisError(f"standard input: not text ({error.reason})") from error
        except (OSError, ValueError) as error:
            raise DeixisError(f"standard input: cannot be read ({error})") from error

    def lines(self, most: int = MAX_ANSWER) -> Iterator[str]:
        """Yield the lines until the end, each cut after ``most`` characters."""
        while line := self.readline(most):
            rest = line
            while rest and not rest.endswith("\n"):
                rest = self.readline(most)
            yield line


def note_change(memory: Path) -> None:
    """Record that the command changed a memory, for the message of a later failure."""
    _changed.append(memory)


def what_is_kept() -> str:
    """Return the end of an error message about a memory that the failed command had changed, or an empty text."""
    if not _changed:
        return ""
    return f"; the memory at {_changed[-1]} was already changed: do not run the command again"
