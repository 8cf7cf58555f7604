"""The demo: every chapter is told, and all pictures are there."""

from __future__ import annotations

from pathlib import Path

import pytest

from deixis.cli.story import tell

CHAPTERS = [
    "1. Somebody says how a table is laid",
    "2. The robot looks at a table and can name nothing on it",
    "3. Who is who, going by the words alone?",
    "4. A fuller script settles it",
    "5. What the script implies without saying so",
    "6. A script that cannot be laid",
    "7. What was understood is learned",
    "8. And can be asked for, in SPARQL: what cutlery do I know, and from which lesson?",
    "9. Another table, whose things have names by now. What is wrong with it?",
    "10. The same with a depth camera, simulated: points, and no boxes",
    "11. Another table of points, and nobody says a word. What looks familiar?",
]


def test_the_whole_story(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    tell(tmp_path / "out")
    told = capsys.readouterr().out
    assert [line for line in told.splitlines() if line[:1].isdigit()] == CHAPTERS
    for said in (
        "right(water_glass, dinner_plate)",
        "It sees 12 boxes, from the chair",
        "dinner_knife, water_glass",
        "12 names are open",
        "left(salad_fork, soup_spoon)   by transitivity",
        "The script contradicts itself",
        "fish knife     dx:FishKnife     lx:lesson/formal_dinner-1",
        "missing     water_glass",
        "misplaced   dinner_fork (p3), in the place of dinner_knife",
        "one napkin too many",
        "12 things found on the table",
    ):
        assert said in told
    for name in ("script1.png", "second_table.png", "table.png", "another.png"):
        picture = tmp_path / "out" / name
        assert str(picture) in told
        assert picture.read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
        assert picture.stat().st_size > 20_000
