"""docs/explanation/asking.md: the dialogue that it shows is the one that is held."""

from __future__ import annotations

import io

import pytest
from consoles import ROOT, shown

PAGE = ROOT / "docs" / "explanation" / "asking.md"

pytestmark = pytest.mark.skipif(not PAGE.exists(), reason="there is no docs/explanation/asking.md")


def test_the_dialogue_is_as_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    consoles = shown(PAGE)
    assert consoles
    for entry in consoles:
        monkeypatch.setattr("sys.stdin", io.StringIO(""))
        code, out, err = entry.run()
        assert code == 0, (entry.command, err)
        for line, printed in zip(entry.lines, out.splitlines(), strict=False):
            assert printed.rstrip().startswith(line.split("…")[0].rstrip()), entry.command
