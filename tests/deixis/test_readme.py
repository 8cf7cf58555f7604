"""What README.md shows, runs: its Python, and the commands of its consoles."""

from __future__ import annotations

import io
from contextlib import redirect_stdout

import pytest
from consoles import ROOT, Shown, blocks, shown

README = ROOT / "README.md"
COMMANDS = [entry for entry in shown(README) if entry.command.startswith("deixis ")]
PYTHON = [text for language, text in blocks(README) if language == "python"]

pytestmark = pytest.mark.skipif(not README.exists(), reason="there is no README.md")


def test_there_is_something_to_run() -> None:
    assert COMMANDS
    assert PYTHON


@pytest.mark.parametrize("text", PYTHON)
def test_python(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    with redirect_stdout(io.StringIO()):
        exec(compile(text, str(README), "exec"), {})


@pytest.mark.parametrize("entry", COMMANDS, ids=lambda entry: entry.command)
def test_console(entry: Shown, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    code, out, _ = entry.run()
    assert code == 0
    assert out
