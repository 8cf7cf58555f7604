"""Doubt and violations in colour: on a terminal only, and not with NO_COLOR."""

from __future__ import annotations

import io
import json
import re
import sys
from contextlib import redirect_stderr, redirect_stdout, suppress
from pathlib import Path
from unittest.mock import patch

import pytest
from commands import deixis

from deixis.cli.app import main
from deixis.examples_data import example

RED, YELLOW = "\x1b[31m", "\x1b[33m"
CONFLICT = example("contradiction.layout")
SCRIPT1, SCENE = example("script1.layout"), example("place_setting.scene.json")


class Terminal(io.StringIO):
    """Text stream that calls itself a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def plain_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")


def on_terminal(*args: object) -> str:
    """Return what a command prints where standard output is a terminal."""
    out, argv = Terminal(), ["deixis", *map(str, args)]
    with patch.object(sys, "argv", argv), redirect_stdout(out), redirect_stderr(io.StringIO()), suppress(SystemExit):
        main()
    return out.getvalue()


def test_a_contradiction_is_red_and_its_advice_is_plain() -> None:
    lines = on_terminal("infer", CONFLICT).splitlines()
    assert all(line.startswith(RED) and line.endswith("\x1b[0m") for line in lines[:-1])
    assert lines[-1] == "Leave out or change any one of these."


def test_undecided_matches_are_yellow_and_decided_ones_plain() -> None:
    out = on_terminal("ground", SCRIPT1, SCENE, "--no-sizes", "--time-limit", "60")
    rows = [line for line in out.splitlines() if re.search(r" o\d+ +(0|1)", line)]
    assert len(rows) == 12
    assert all(line.startswith(YELLOW) == ("   or " in line) for line in rows)
    assert f"{YELLOW}Sure of 1 of 12 names" in out


def test_a_wrong_table_is_red() -> None:
    out = on_terminal("check", example("formal_dinner.layout"), example("second_table.scene.json"), "--no-memory")
    assert f"{RED}This table is not laid" in out and f"{RED}missing      water_glass" in out
    assert "\ncorrect      9 of 12" in out


@pytest.mark.parametrize(("name", "value"), [("NO_COLOR", "1"), ("TERM", "dumb")])
def test_no_color_and_dumb_terminals_get_plain_text(name: str, value: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(name, value)
    assert "\x1b" not in on_terminal("infer", CONFLICT)


def test_an_empty_no_color_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NO_COLOR", "")
    assert RED in on_terminal("infer", CONFLICT)


def test_a_pipe_and_json_get_plain_text() -> None:
    assert "\x1b" not in deixis("infer", CONFLICT)[1]
    assert json.loads(on_terminal("infer", CONFLICT, "--json"))["consistent"] is False


def test_names_cannot_bring_colours_of_their_own(tmp_path: Path) -> None:
    script = tmp_path / "a\x1b[2Jb.layout"
    script.write_text(CONFLICT.read_text(encoding="utf-8"), encoding="utf-8")
    out = on_terminal("infer", script)
    assert "\x1b[2J" not in out and r"a\u001b[2Jb.layout" in out
