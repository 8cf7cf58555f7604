"""The examples of README.md run as they are, and the page stays short."""

from __future__ import annotations

from pathlib import Path

import pytest
from consoles import ROOT, run_page

README = ROOT / "README.md"
MAX_LINES = 100

pytestmark = pytest.mark.skipif(not README.exists(), reason="there is no README.md")


def test_the_examples_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run_page(README, tmp_path, monkeypatch) >= 4


def test_the_page_is_short() -> None:
    assert len(README.read_text(encoding="utf-8").splitlines()) <= MAX_LINES
