"""The root of every error that Deixis raises on purpose, and the ones of this room."""

from __future__ import annotations

from deixis.printable import shortened, visible_line

MAX_LINES = 250
"""Lines of a message that are shown."""


class DeixisError(Exception):
    """Root of the errors of all rooms.

    Each also derives from the built-in that a caller would expect, and its message says what is wrong, where, and
    what to do. The command line prints it in one piece and exits with 2.

    A message is one line, unless ``several_lines``. Whatever names and values it repeats, it is safe to print: control
    characters are shown as escapes, and a long line is shortened.

    >>> print(DeixisError("a name\\nof two lines"))
    a name\\nof two lines
    """

    several_lines = False
    """Whether line ends belong to the message."""

    def __str__(self) -> str:
        text = self._message()
        lines = text.split("\n") if self.several_lines else [text]
        shown = [shortened(visible_line(line)) for line in lines[:MAX_LINES]]
        if len(lines) > MAX_LINES:
            shown.append(f"… and {len(lines) - MAX_LINES} more lines")
        return "\n".join(shown)

    def _message(self) -> str:
        """Return what is to be said, as it stands."""
        return str(self.args[0]) if len(self.args) == 1 else super().__str__()


class UnknownTermError(DeixisError, KeyError):
    """A word, a relation or a term that the ontology does not have."""


class OntologyError(DeixisError, ValueError):
    """An ontology file that cannot be read, or does not say what code needs of it."""


class GraphError(DeixisError, ValueError):
    """A relation graph whose parts do not fit together."""
