"""Numbers on the command line: errors and help texts that say in words which numbers are allowed."""

from __future__ import annotations

import copy
import math
from typing import Any

import typer

from deixis.printable import visible_line

_NOUNS = {"int": "a whole number", "int range": "a whole number", "float": "a number", "float range": "a number"}
"""Noun phrase of each numeric type, by its name in the library that parses the command line."""


class _InWords:
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


def say_numbers_in_words(command: Any) -> None:
    """Make the numeric parameters of a command, and of its subcommands, say in words what they allow.

    Parameters
    ----------
    command
        Command of the library that parses the command line.
    """
    for subcommand in getattr(command, "commands", {}).values():
        say_numbers_in_words(subcommand)
    for parameter in command.params:
        parameter.type = _in_words(parameter.type)


def _in_words(kind: Any) -> Any:
    """Return a numeric type, or a tuple of such types, that says in words what it allows; another type as it is."""
    kind = copy.copy(kind)
    if hasattr(kind, "types"):
        kind.types = [_in_words(each) for each in kind.types]
    elif getattr(kind, "name", None) in _NOUNS:
        kind.__class__ = type(type(kind).__name__, (_InWords, type(kind)), {})
    return kind
