"""Files of habits: examples, stated rules, places, and errors with their place."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.grammar.formats.habits import HabitsFileError, parse_habits, read_habits


def test_examples_rules_and_places_are_read(tmp_path: Path) -> None:
    file = tmp_path / "room.habits"
    file.write_text("\ufeff# room\nyo-yo :  cabinet # a toy\nevery soft toy: shelf\nplaces: shelf, top drawer\n")
    found = read_habits(file)
    assert found.examples == {"yo-yo": "cabinet"} and found.rules == {"soft toy": "shelf"}
    assert found.places == ("shelf", "top drawer")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "<text>: no habit is stated"),
        ("a: b\n  sneakers", "<text>:2:3: expected 'thing: place'"),
        (": rack", "<text>:1:1: expected"),
        ("a: b\na: c", "<text>:2:1: 'a' is already in 'b'"),
    ],
)
def test_errors_name_their_place(text: str, message: str) -> None:
    with pytest.raises(HabitsFileError, match=message):
        parse_habits(text)


@given(st.text())
def test_any_text_is_read_or_refused(text: str) -> None:
    with suppress(HabitsFileError):
        found = parse_habits(text)
        assert found.examples or found.rules
