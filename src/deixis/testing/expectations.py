"""Expectation blocks: comments at the end of a ``.layout`` file that say what must be true of it.

A block starts with the comment ``# expect:``; the rest of its line, and each comment line after it, is one
expectation. The word may be repeated on each line::

    # expect:
    #   consistent
    #   follows left(salad_fork, soup_spoon)
    #   not follows left(salad_fork, napkin)
    #   grounds place_setting.scene.json: napkin = o2, dinner_plate = o8, candle = absent
    #   decides place_setting.scene.json: napkin = o2
    #   checks place_setting.scene.json
    #   checks second_table.scene.json: missing water_glass; misplaced dinner_fork, dinner_knife; extra p1

Names of scenes are relative to the folder of the script.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from deixis.errors import DeixisError

if TYPE_CHECKING:
    from deixis.grammar.script import Script

START = re.compile(r"^[ \t]*#[ \t]*expect:", re.MULTILINE)


class ExpectationError(DeixisError, ValueError):
    """An expectation that cannot be read; the message has its file and line."""


@dataclass(frozen=True, slots=True)
class Expectation:
    """One line of an expectation block."""

    line: int
    text: str


def expectations_in(text: str, file: str) -> Iterator[Expectation]:
    """Yield the expectations of a script's text.

    Parameters
    ----------
    text
        The script.
    file
        Its name, for messages.

    Yields
    ------
    Expectation
        An expectation with its line.

    Raises
    ------
    ExpectationError
        If a line of the block is malformed.
    """
    start = START.search(text)
    if start is None:
        return
    first = text.count("\n", 0, start.end()) + 1
    for line, content in enumerate(f"#{text[start.end() :]}".split("\n"), start=first):
        comment = content.strip()
        if not comment:
            continue
        if not comment.startswith("#"):
            raise ExpectationError(
                f"{file}:{line}:1: an expectation block is comments up to the end, got '{comment:.40}'"
            )
        comment = comment.lstrip("#").strip().removeprefix("expect:").strip()
        if comment and _check(comment) is None:
            known = ", ".join(CHECKS)
            raise ExpectationError(f"{file}:{line}:1: '{comment:.60}' is not an expectation; one starts with {known}")
        if comment:
            yield Expectation(line, comment)


def run(expectation: Expectation, script: Script, folder: Path) -> None:
    """Raise AssertionError unless a script meets an expectation.

    Parameters
    ----------
    expectation
        What is expected.
    script
        The script.
    folder
        Folder that names of scenes are relative to.

    Raises
    ------
    AssertionError
        If the script does not meet it.
    """
    check = _check(expectation.text)
    assert check is not None, "expectations_in yields only what starts with a known word"
    word, function = check
    place = f"{script.file}:{expectation.line}:1"
    function(script, expectation.text[len(word) :].strip(), folder, place)


def _check(text: str) -> tuple[str, Callable[[Script, str, Path, str], None]] | None:
    return next(((word, check) for word, check in CHECKS.items() if re.match(rf"{word}\b", text)), None)


def _consistent(script: Script, rest: str, folder: Path, place: str) -> None:
    from deixis.testing.assertions import assert_consistent

    assert_consistent(script)


def _contradictory(script: Script, rest: str, folder: Path, place: str) -> None:
    from deixis.testing.assertions import assert_contradictory

    assert_contradictory(script)


def _follows(script: Script, rest: str, folder: Path, place: str) -> None:
    from deixis.testing.assertions import assert_follows

    assert_follows(script, rest)


def _not_follows(script: Script, rest: str, folder: Path, place: str) -> None:
    from deixis.testing.assertions import assert_not_follows

    assert_not_follows(script, rest)


def _grounds(script: Script, rest: str, folder: Path, place: str) -> None:
    from deixis.testing.assertions import assert_grounds

    scene, expected = _matches(rest, place)
    assert_grounds(script, folder / scene, expected)


def _decides(script: Script, rest: str, folder: Path, place: str) -> None:
    from deixis.testing.assertions import assert_grounds

    scene, expected = _matches(rest, place)
    assert_grounds(script, folder / scene, expected, decided=True)


def _matches(rest: str, place: str) -> tuple[str, dict[str, str | None]]:
    """Return the scene and the expected matches of ``SCENE: name = id, name = absent``."""
    scene, _, pairs = rest.partition(":")
    expected: dict[str, str | None] = {}
    for pair in filter(None, (part.strip() for part in pairs.split(","))):
        name, equals, thing = (part.strip() for part in pair.partition("="))
        if not equals or not name or not thing:
            raise ExpectationError(f"{place}: '{pair}' must be 'name = id' or 'name = absent'")
        expected[name] = None if thing == "absent" else thing
    if not expected:
        raise ExpectationError(f"{place}: after the scene, write a colon and what is expected: 'SCENE: fork = o3'")
    return scene.strip(), expected


def _checks(script: Script, rest: str, folder: Path, place: str) -> None:
    from deixis.testing.assertions import assert_checks

    scene, _, faults = rest.partition(":")
    named: dict[str, list[str]] = {}
    for part in filter(None, (part.strip() for part in faults.split(";"))):
        fault, _, names = part.partition(" ")
        if fault not in FAULTS:
            raise ExpectationError(f"{place}: '{fault}' is not a fault; the faults are {', '.join(FAULTS)}")
        named[fault] = [name.strip() for name in names.split(",")]
    assert_checks(script, folder / scene.strip(), **named)


FAULTS = ("missing", "misplaced", "miscoloured", "extra")

CHECKS: dict[str, Callable[[Script, str, Path, str], None]] = {
    "consistent": _consistent,
    "contradictory": _contradictory,
    "follows": _follows,
    "not follows": _not_follows,
    "grounds": _grounds,
    "decides": _decides,
    "checks": _checks,
}
"""The word that each kind of expectation starts with, and what runs it."""
