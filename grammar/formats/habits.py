"""Read where a person puts things: examples such as ``yo-yo: cabinet``, rules such as ``every soft toy: shelf``."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from deixis.errors import DeixisError
from deixis.grammar.files import read_text

MAX_LINES = 10_000
"""Maximum number of examples and rules in a file."""


class HabitsFileError(DeixisError, ValueError):
    """A file of habits that cannot be read."""


@dataclass(frozen=True, slots=True)
class StatedHabits:
    """Contents of a file: places by thing, places by the words of a rule, and further places."""

    examples: dict[str, str]
    rules: dict[str, str]
    places: tuple[str, ...]


def parse_habits(text: str, file: str = "<text>") -> StatedHabits:
    r"""Parse lines ``thing: place``; ``every`` or ``all`` before the thing makes the line a rule.

    ``places: shelf, drawer`` adds places without an example; ``#`` begins a comment.

    Parameters
    ----------
    text
        The lines.
    file
        Name of the text in error messages.

    Returns
    -------
    StatedHabits
        The examples, the rules and the places.

    Raises
    ------
    HabitsFileError
        If a line has another form, or puts a thing in two places; with file, line and column.

    Examples
    --------
    >>> parse_habits("yo-yo: cabinet  # a toy\nevery soft toy: shelf")
    StatedHabits(examples={'yo-yo': 'cabinet'}, rules={'soft toy': 'shelf'}, places=())
    """
    examples: dict[str, str] = {}
    rules: dict[str, str] = {}
    places: list[str] = []
    for number, raw in enumerate(text.lstrip("\ufeff").splitlines(), 1):
        line = raw.partition("#")[0]
        if not line.strip():
            continue
        named, colon, where = line.partition(":")
        thing, place = " ".join(named.split()), " ".join(where.split())
        column = len(line) - len(line.lstrip()) + 1
        if not colon or not thing or not place:
            raise HabitsFileError(f"{file}:{number}:{column}: expected 'thing: place', such as 'sneakers: rack'")
        if thing == "places":
            places += [" ".join(one.split()) for one in place.split(",") if one.strip()]
            continue
        stated = re.sub(r"^(?:every|all|each)\s+", "", thing)
        known = examples if stated == thing else rules
        if known.setdefault(stated, place) != place:
            raise HabitsFileError(
                f"{file}:{number}:{column}: '{thing}' is already in '{known[stated]}'; "
                "keep one of the lines, or number two things of one name"
            )
        if len(examples) + len(rules) > MAX_LINES:
            raise HabitsFileError(f"{file}:{number}:1: more than {MAX_LINES} lines; leave some out")
    if not examples and not rules:
        raise HabitsFileError(f"{file}: no habit is stated; write lines such as 'sneakers: rack'")
    return StatedHabits(examples, rules, tuple(places))


def read_habits(path: str | Path) -> StatedHabits:
    """Read a file of habits.

    Parameters
    ----------
    path
        The file; :func:`parse_habits` says what it holds.

    Returns
    -------
    StatedHabits
        The examples, the rules and the places.

    Raises
    ------
    HabitsFileError
        If a line has another form, or puts a thing in two places.
    ScriptFileError
        If the file cannot be read.
    """
    return parse_habits(read_text(Path(path), str(path)), str(path))
