"""The root of every error that Deixis raises on purpose, and the ones of this room."""

from __future__ import annotations


class DeixisError(Exception):
    """Root of the errors of all rooms.

    Each also derives from the built-in that a caller would expect, and its message says what is wrong, where, and
    what to do. The command line prints it in one piece and exits with 2.
    """


class UnknownTermError(DeixisError, KeyError):
    """A word, a relation or a term that the ontology does not have."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else "unknown term"


class OntologyError(DeixisError, ValueError):
    """An ontology file that cannot be read, or does not say what code needs of it."""


class GraphError(DeixisError, ValueError):
    """A relation graph whose parts do not fit together."""
