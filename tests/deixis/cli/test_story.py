"""The demo prints every chapter and writes all its pictures."""

from __future__ import annotations

from pathlib import Path

import pytest

from deixis.cli.story import tell

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
]


def test_the_whole_story(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
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
        "missing     water_glass",
        "misplaced   dinner_fork (p3), where dinner_knife belongs",
        "one napkin too many",
        "12 things found on the table",
    ):
        assert said in told
    for name in ("script1.png", "second_table.png", "table.png", "another.png"):
        picture = tmp_path / "out" / name
        assert str(picture) in told
        assert picture.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
        assert picture.stat().st_size > 20_000
