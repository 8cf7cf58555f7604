"""Run the commands of docs/tutorial/seeing.md in order and compare their output, except numbers."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from consoles import ROOT, blocks, shown

PAGE = ROOT / "docs" / "tutorial" / "seeing.md"

pytestmark = pytest.mark.skipif(not PAGE.exists(), reason="there is no docs/tutorial/seeing.md")


def without_numbers(line: str) -> str:
    """Replace the numbers and view ids of a line, cut it at an ellipsis, and collapse its spaces."""
    line = re.sub(r"'[0-9a-f]{16}'", "'view'", line.split("…")[0])
    return " ".join(re.sub(r"-?\d+(\.\d+)?", "#", line).split())


def test_the_page_runs_as_it_stands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (layout,) = [text for language, text in blocks(PAGE) if language == "layout"]
    Path("tea.layout").write_text(layout, encoding="utf-8")
    ran = 0
    for entry in shown(PAGE):
        if entry.command.startswith("export "):
            monkeypatch.setenv(*entry.command.removeprefix("export ").split("="))
            continue
        code, out, err = entry.run()
        assert code == 0, (entry.command, err)
        printed = [without_numbers(line) for line in out.splitlines()]
        for line in map(without_numbers, entry.lines):
            assert any(found.startswith(line) for found in printed), (entry.command, line, printed)
        ran += 1
    assert ran > 10
    (program,) = [text for language, text in blocks(PAGE) if language == "python"]
    names: dict[str, object] = {}
    exec(compile(program, str(PAGE), "exec"), names)
    assert names["shapes"] and "butter_knife" in dict(names["names"]).values()  # type: ignore[call-overload]
    assert Path("tea.scene.json").exists()
    assert all(Path(name).exists() for name in re.findall(r"--plot (\S+)", PAGE.read_text(encoding="utf-8")))
