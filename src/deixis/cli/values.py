"""Values of options and arguments: errors and help texts that say in words which numbers and paths are allowed."""

from __future__ import annotations

import copy
import math
from typing import Any

import typer

from deixis.printable import visible_line

_NOUNS = {"int": "a whole number", "int range": "a whole number", "float": "a number", "float range": "a number"}
"""Noun phrase of each numeric type, by its name in the library that parses the command line."""

_PATHS = ("path", "file", "directory")
"""Names of the types of paths in that library."""


class _Number:
    """Mixin of a numeric type of the library that parses the command line: its range and its error in words."""

    def _describe_range(self: Any) -> str:
        """Return the range, which the library prints in help texts."""
        if self.min is None:
            return f"at most {self.max:g}"
        return f"at least {self.min:g}" if self.max is None else f"{self.min:g} to {self.max:g}"

    def convert(self: Any, value: Any, parameter: Any, context: Any) -> Any:
        """Return the number that a text stands for, except NaN; fail with what is allowed and what was given."""
        try:
            number = super().convert(value, parameter, context)  # type: ignore[misc]
        except typer.BadParameter:
            number = math.nan
        if not math.isnan(number):
            return number
        allowed = _NOUNS[self.name]
        if "range" in self.name:
            allowed += f" {'from' if None not in (self.min, self.max) else 'of'} {self._describe_range()}"
        self.fail(f"must be {allowed}, got {visible_line(str(value))}", parameter, context)


class _Path:
    """Mixin of the type of paths: an empty text, such as that of a variable that is not set, does not name a path."""

    def convert(self: Any, value: Any, parameter: Any, context: Any) -> Any:
        """Return the path that a text stands for; fail if it is empty, which would mean the current folder."""
        if value == "":
            self.fail("must name a file or a folder, got an empty text", parameter, context)
        return super().convert(value, parameter, context)  # type: ignore[misc]


def say_values_in_words(command: Any) -> None:
    """Make the parameters of a command, and of its subcommands, say in words which numbers and paths they allow.

    Parameters
    ----------
    command
        Command of the library that parses the command line.
    """
    for subcommand in getattr(command, "commands", {}).values():
        say_values_in_words(subcommand)
    for parameter in command.params:
        parameter.type = _in_words(parameter.type)


def _in_words(kind: Any) -> Any:
    """Return a type of numbers or paths, or a tuple of such types, that says in words what it allows."""
    kind = copy.copy(kind)
    if hasattr(kind, "types"):
        kind.types = [_in_words(each) for each in kind.types]
        return kind
    mixin = _Number if kind.name in _NOUNS else _Path if kind.name in _PATHS else None
    if mixin is not None:
        kind.__class__ = type(type(kind).__name__, (mixin, type(kind)), {})
    return kind
