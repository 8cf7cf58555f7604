"""What README.md shows, runs: its Python, and the commands of its consoles."""

from __future__ import annotations

import io
import re
import shlex
import sys
from contextlib import redirect_stdout
from pathlib import Path
from unittest.mock import patch

import pytest

from deixis.cli import main

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
BLOCKS = re.findall(
    r"^```(\w+)\n(.*?)^```$", README.read_text(encoding="utf-8") if README.exists() else "", re.M | re.S
)
COMMANDS = [
    line[2:] for tag, text in BLOCKS if tag == "console" for line in text.splitlines() if line[:8] == "$ deixis"
]

pytestmark = pytest.mark.skipif(not README.exists(), reason="there is no README.md")


def test_there_is_something_to_run() -> None:
    assert COMMANDS
    assert any(tag == "python" for tag, _ in BLOCKS)


@pytest.mark.parametrize("text", [text for tag, text in BLOCKS if tag == "python"])
def test_python(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    with redirect_stdout(io.StringIO()):
        exec(compile(text, str(README), "exec"), {})


@pytest.mark.parametrize("command", COMMANDS)
def test_console(command: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    argv = patch.object(sys, "argv", shlex.split(command))
    with argv, redirect_stdout(io.StringIO()) as out, pytest.raises(SystemExit) as end:
        main()
    assert not end.value.code
    assert out.getvalue()
