"""The demo prints every chapter and writes all its pictures."""

from __future__ import annotations

import re
import shlex
import tempfile
from html import unescape
from pathlib import Path

import pytest
from commands import deixis

from deixis.cli.robot.story import tell
from deixis.examples_data import EXAMPLES

CHAPTERS = [
    "1. A person describes a laid table",
    "2. The robot sees a table, but knows no names",
    "3. Which object does each name refer to, by the words alone?",
    "4. A fuller script settles it",
    "5. A fact that the script implies but does not state",
    "6. A script that contradicts itself",
    "7. The robot learns the layout",
    "8. A SPARQL query: which cutlery is known, and from which lesson?",
    "9. Another table, with labelled things. What is wrong with it?",
    "10. The same table seen by a simulated depth camera: points instead of boxes",
    "11. Another cloud without a description. What does the robot recognise?",
    "12. The robot runs: a teacher shows and tells, and asks about the next customer's table",
]


def test_the_whole_story(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    tell(tmp_path / "out")
    told = capsys.readouterr().out
    assert [line for line in told.splitlines() if line[:1].isdigit()] == CHAPTERS
    for said in (
        "right(water_glass, dinner_plate)",
        "It sees 12 boxes, from the chair",
        "dinner_knife, water_glass",
        "of 12 names stay open",
        "left(salad_fork, soup_spoon)   by transitivity",
        "The script contradicts itself",
        "fish knife     dx:FishKnife     lx:lesson/formal_dinner-1",
        "missing      water_glass",
        "misplaced    dinner_fork (p3), where dinner_knife belongs",
        "one napkin too many",
        "12 things found on the table",
        "I learned how 'tea' is laid",
    ):
        assert said in told
    for name in ("script1.png", "second_table.png", "table.png", "another.png", "live/story.png"):
        picture = tmp_path / "out" / name
        assert f"Picture: out/{name}" in told
        assert picture.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
        assert picture.stat().st_size > 20_000
    assert str(EXAMPLES) not in told and str(tmp_path) not in told and tempfile.gettempdir() not in told
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert "<p>A person describes how a table is laid." in page
    assert "All of this on one page: out/index.html" in told
    assert [unescape(title) for title in re.findall("<h2>(.*)</h2>", page)] == CHAPTERS
    linked = re.findall('(?:src|href)="([^"]*)"', page)
    assert len(linked) == 5 and all((tmp_path / "out" / name).is_file() for name in linked)
    for shown in re.findall(
        r"^(?:<pre class=\"command\">)?(deixis (?:parse|ground|infer) .*?)(?:</pre>)?$", page, re.M
    ):
        _, *argv = shlex.split(unescape(shown).replace("examples/", f"{EXAMPLES}/"))
        _, printed, errors = deixis(*argv)
        assert printed and not errors, shown
