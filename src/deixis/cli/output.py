"""The border to the terminal: whatever users and files say, what is written moves no cursor and hides nothing."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TextIO, cast

from deixis.printable import MAX_MESSAGE, shortened, visible, visible_line

MAX_LINE = MAX_MESSAGE + len("deixis: ")
"""Characters of a line on standard error."""

MAX_ANSWER = 10_000
"""Characters of a line that are read from standard input."""


class VisibleStream:
    """A text stream in which control characters are written as escapes; tabs and line ends stay."""

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream

    def write(self, text: str) -> int:
        self.stream.write(visible(text))
        return len(text)

    def writelines(self, lines: Iterable[str]) -> None:
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)


class MessageStream(VisibleStream):
    """A visible stream of messages, whose long lines are shortened.

    ``names`` are the words of the command line: one with line ends in it, such as a file's name, stays on one line.
    """

    def __init__(self, stream: TextIO, names: Iterable[str]) -> None:
        super().__init__(stream)
        self._names = {name: visible_line(name) for name in names if name.strip() and visible_line(name) != name}

    def write(self, text: str) -> int:
        for name, shown in self._names.items():
            text = text.replace(name, shown)
        super().write("\n".join(shortened(line, MAX_LINE) for line in text.split("\n")))
        return len(text)


_changed: list[Path] = []  # the memories that this command changed


@contextmanager
def visible_output() -> Iterator[None]:
    """Make standard output and standard error visible streams, for as long as this lasts."""
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
    """Return the stream behind a visible one, for what draws on terminals by control characters itself."""
    return stream.stream if isinstance(stream, VisibleStream) else stream


class StandardInput:
    """Lines of standard input; none where it is closed. Raises DeixisError where it is no text or cannot be read."""

    def readline(self) -> str:
        """Return the next line, at most :data:`MAX_ANSWER` characters of it; an empty text at the end."""
        from deixis.errors import DeixisError

        if sys.stdin is None:
            return ""
        try:
            return sys.stdin.readline(MAX_ANSWER)
        except UnicodeDecodeError as error:
            raise DeixisError(f"standard input: it is no text ({error.reason})") from error
        except (OSError, ValueError) as error:
            raise DeixisError(f"standard input: it cannot be read ({error})") from error


def note_change(memory: Path) -> None:
    """Note that a memory was changed, to be said where its answer cannot be written any more."""
    _changed.append(memory)


def what_is_kept() -> str:
    """Return what a message says of a memory that was changed before the command failed; nothing where none was."""
    if not _changed:
        return ""
    return f"; the memory at {_changed[-1]} was changed before, and keeps that: do not run the command again"
