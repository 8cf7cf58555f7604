"""Check that the reference of the commands has every command and option of ``--help``."""

from __future__ import annotations

import re

import pytest
from commands import deixis
from documentation.command_reference import command_reference

from deixis.cli.app import COMMANDS

TEXT = command_reference()


def section(command: str) -> str:
    found = re.search(rf"^###? {re.escape(command)}\n(.*?)(?=^##|\Z)", TEXT, re.M | re.S)
    assert found, command
    return found[1]


def test_all_commands_are_in_the_order_of_the_help() -> None:
    assert re.findall(r"^## deixis (\S+)$", TEXT, re.M) == list(COMMANDS)


@pytest.mark.parametrize("command", ["ground", "memory export", "experiment figure6"])
def test_a_section_names_every_option_of_the_help(command: str) -> None:
    _, help_text, _ = deixis(*command.split(), "--help")
    options = set(re.findall(r"^  (?:-\w, )?(--[\w-]+)", help_text, re.M)) - {"--help"}
    assert options
    assert options <= set(re.findall(r"`(--[\w-]+)", section(f"deixis {command}")))


def test_help_texts_keep_their_special_characters() -> None:
    assert r"\$DEIXIS" not in TEXT
    assert r"$DEIXIS\_MEMORY" in TEXT
