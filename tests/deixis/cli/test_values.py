"""Check that options of numbers and paths say in words what they allow, in their help and in their errors."""

from __future__ import annotations

from typing import Any

import pytest
import typer
from commands import deixis

from deixis.cli.app import COMMANDS, app


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("retrieve --top 0 a", "'--top': must be a whole number of at least 1, got 0"),
        ("retrieve --top many a", "'--top': must be a whole number of at least 1, got many"),
        ("retrieve --least 3 a", "'--least': must be a number from 0 to 1, got 3"),
        ("time --at noon a", "'--at': must be a number, got noon"),
        ("episodes add a b c --certainty high", "'--certainty': must be a number"),
        ("retrieve --top \x1b[31m a", r"got \u001b[31m"),
    ],
)
def test_the_error_says_what_is_allowed(command: str, message: str) -> None:
    code, out, err = deixis(*command.split(" "))
    assert (code, out) == (2, "")
    assert message in err


def test_the_help_gives_the_range_in_words() -> None:
    _, out, _ = deixis("retrieve", "--help")
    text = " ".join(out.split())
    assert "[default: 5; at least 1]" in text
    assert "[default: 0.5; 0 to 1]" in text


def test_a_number_within_the_range_is_taken() -> None:
    code, out, _ = deixis("simulate", "--seed", "0", "--help")
    assert code == 0
    assert "at least 0" in out


def options_of(*kinds_of_values: str) -> list[tuple[str, str, int]]:
    """Return each command with each of its options that take such values, and how many values the option takes."""
    found = []

    def visit(command: Any, path: tuple[str, ...]) -> None:
        for name, subcommand in getattr(command, "commands", {}).items():
            visit(subcommand, (*path, name))
        for parameter in command.params:
            kinds = [kind.name for kind in getattr(parameter.type, "types", [parameter.type])]
            if any(kind.startswith(kinds_of_values) for kind in kinds) and parameter.opts[0].startswith("-"):
                found.append((" ".join(path), parameter.opts[-1], len(kinds)))

    group: Any = typer.main.get_group(app)
    for name in COMMANDS:
        visit(group.get_command(None, name), (name,))
    return found


@pytest.mark.parametrize(("command", "option", "numbers"), options_of("int", "float"))
@pytest.mark.parametrize("given", ["nan", "-NaN", "x"])
def test_no_option_takes_what_is_not_a_number(command: str, option: str, numbers: int, given: str) -> None:
    code, out, err = deixis(*command.split(), *[option, *[given] * numbers])
    assert (code, out) == (2, "")
    assert option in err and "must be a" in err and f"got {given}" in err


@pytest.mark.parametrize(("command", "option", "paths"), options_of("path", "file", "directory"))
def test_no_option_takes_an_empty_path(command: str, option: str, paths: int) -> None:
    code, out, err = deixis(*command.split(), *[option, *[""] * paths])
    assert (code, out) == (2, "")
    assert option in err and "must name a file or a folder, got an empty text" in err
