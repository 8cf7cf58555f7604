"""What README.md shows, runs: its Python, and the commands of its consoles."""

from __future__ import annotations

import io
from contextlib import redirect_stdout
from pathlib import Path

import pytest
from consoles import ROOT, Shown, blocks, shown

README = ROOT / "README.md"
COMMANDS = [entry for entry in shown(README) if entry.command.startswith("deixis ")]
PYTHON = [text for language, text in blocks(README) if language == "python"]

pytestmark = pytest.mark.skipif(not README.exists(), reason="there is no README.md")


def test_there_is_something_to_run() -> None:
    assert COMMANDS
    assert PYTHON


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the examples, as the reader's is, but not the reader's."""
    folder = tmp_path_factory.mktemp("readme")
    (folder / "examples").symlink_to(ROOT / "examples")
    return folder


@pytest.mark.parametrize("text", PYTHON)
def test_python(text: str, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(place)
    with redirect_stdout(io.StringIO()):
        exec(compile(text, str(README), "exec"), {})


@pytest.mark.parametrize("entry", COMMANDS, ids=lambda entry: entry.command)
def test_console(entry: Shown, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(place)
    code, out, _ = entry.run()
    assert code == 0
    assert out
