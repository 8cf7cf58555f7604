"""Base class of all errors that Deixis raises, and errors about vocabulary and graphs."""

from __future__ import annotations

from deixis.printable import shortened, visible_line

MAX_LINES = 250
"""Maximum number of lines of a message that are shown."""


class DeixisError(Exception):
    r"""Base class of all errors of Deixis.

    Each error also derives from the built-in that a caller would expect. Its message says what is wrong, where, and
    what to do. The command line prints the message and exits with 2.

    A message is one line, unless ``several_lines``. It is safe to print, whatever names and values it quotes: control
    characters are shown as escapes, and a long line is shortened.

    >>> print(DeixisError("a name\nof two lines"))
    a name\nof two lines
    """

    several_lines = False
    """True if the message may have several lines."""

    def __str__(self) -> str:
        text = self._message()
        lines = text.split("\n") if self.several_lines else [text]
        shown = [shortened(visible_line(line)) for line in lines[:MAX_LINES]]
        if len(lines) > MAX_LINES:
            shown.append(f"… and {len(lines) - MAX_LINES} more lines")
        return "\n".join(shown)

    def _message(self) -> str:
        """Return the message, neither escaped nor shortened."""
        return str(self.args[0]) if len(self.args) == 1 else super().__str__()


class ArgumentError(DeixisError, TypeError):
    """An argument of a type that its parameter does not take."""


class UnknownTermError(DeixisError, KeyError):
    """A word, a relation or a term that the ontology does not have."""


class OntologyError(DeixisError, ValueError):
    """An ontology file that cannot be read, or lacks something that the code needs."""


class GraphError(DeixisError, ValueError):
    """A relation graph whose parts do not fit together."""
