"""docs/reference/inference.md: every command prints what the page shows, and its Python runs."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from commands import deixis

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reference" / "inference.md").read_text(encoding="utf-8")
CONSOLE = re.findall(r"^```console\n\$ deixis (.*?)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture(autouse=True)
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)


@pytest.mark.parametrize(("command", "shown"), CONSOLE, ids=[command for command, _ in CONSOLE])
def test_a_command_prints_what_the_page_shows(command: str, shown: str) -> None:
    code, out, err = deixis(*shlex.split(command))
    assert (out, err) == (shown, "")
    assert code == (1 if "contradict" in command else 0)


def test_the_python_of_the_page_runs() -> None:
    (source,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    exec(compile(source, "docs/reference/inference.md", "exec"), {})
