"""The help texts of the command line: groups of commands, and the terminal's width."""

from __future__ import annotations

import re

import pytest
from commands import deixis

from deixis.cli.app import COMMAND_GROUPS


def sections(help_text: str) -> dict[str, list[str]]:
    """Return the first word of each entry of a help text, by section."""
    found: dict[str, list[str]] = {}
    for line in help_text.splitlines():
        if title := re.fullmatch(r"(\w.*):", line):
            found[title[1]] = []
        elif (entry := re.match(r"  (\S+)", line)) and found:
            list(found.values())[-1].append(entry[1])
    return found


def test_commands_stand_in_named_groups() -> None:
    code, out, _ = deixis("--help")
    shown = sections(out)
    assert code == 0
    assert {title: shown[title] for title in COMMAND_GROUPS} == {
        title: list(group) for title, group in COMMAND_GROUPS.items()
    }
    assert "Commands" not in shown


def test_all_groups_share_one_column() -> None:
    _, out, _ = deixis("--help")
    entries = [line for line in out.splitlines() if re.match(r"  [a-z][a-z-]* {2,}", line)]
    assert len({re.match(r"  [a-z-]+ +", line).end() for line in entries}) == 1  # type: ignore[union-attr]


@pytest.mark.parametrize("group", ["category", "episodes", "memory", "experiment"])
def test_groups_print_whole_summaries(group: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    _, out, _ = deixis(group, "--help")
    assert sections(out)["Commands"]
    assert "..." not in out.partition("Commands:")[2]
    assert max(map(len, out.splitlines())) <= 80


@pytest.mark.parametrize("command", [(), ("check",), ("memory", "export")])
def test_help_uses_the_width_of_the_terminal(command: tuple[str, ...], monkeypatch: pytest.MonkeyPatch) -> None:
    longest = {}
    for columns in (60, 140):
        monkeypatch.setenv("COLUMNS", str(columns))
        _, out, _ = deixis(*command, "--help")
        longest[columns] = max(map(len, out.splitlines()))
    assert longest[60] <= 60 < 80 < longest[140] <= 140
