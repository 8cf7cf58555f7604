"""The canonical form of a script: its text, and that reading it back changes nothing."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_scripts import meaning, scripts

from deixis.grammar.errors import ScriptError
from deixis.grammar.layout.format import format_script
from deixis.grammar.layout.parser import parse_script
from deixis.grammar.script import Script


def canonical(text: str) -> str:
    return format_script(parse_script(text))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", ""),
        ('layout x "T  t" seen from "left"', 'layout x "T t" seen from "left"\n'),
        ("left(a, the b)", "a left of b\n"),
        ("the Fork is usually to the left of a plate.", "usually Fork left of plate\n"),
        ("optional fork is perhaps not upon or under x", "optional perhaps fork not on or under x\n"),
        ("a and b, and c above d", "a, b, c above d\n"),
        ("two glass are glasses; 2 glass on x", "2 glass are Glass\n2 glass on x\n"),
        ('x is the tea cup; "is" is an under_plate', 'x is a Teacup\n"is" is a ChargerPlate\n'),
        ("above to below: a, b", "top to bottom: a, b\n"),
        ('"left shoe" on "on"; "the" on "a"', 'left_shoe on "on"\n"the" on a\n'),
        ('"upper" on x; "to the" left of y', '"upper" on x\n"to_the" left of y\n'),
        ('"1st" on "two"', '"1st" on "two"\n'),
        ("a on b # x\n\n\n\n#y\nc on d", "a on b  # x\n\n# y\nc on d\n"),
        ("a on b; c on d # x", "a on b\nc on d  # x\n"),
        ("a on b, # x\n # y\n c # z", "# x\n# y\na on b, c  # z\n"),
        ("#\n#   x  \n\n", "#\n# x\n"),
    ],
)
def test_canonical_form(text: str, expected: str) -> None:
    assert canonical(text) == expected
    assert canonical(expected) == expected


@settings(deadline=None, max_examples=80)
@given(scripts(claims=True))
def test_reading_the_canonical_form_changes_nothing(script: Script) -> None:
    text = format_script(script)
    again = parse_script(text)
    assert meaning(again) == meaning(script)
    assert [c.text for c in again.comments] == [c.text for c in script.comments]
    assert format_script(again) == text


@given(st.text(min_size=1).filter(lambda name: '"' not in name))
def test_names_round_trip(name: str) -> None:
    try:
        script = parse_script(f'"{name}" on other_thing')
    except ScriptError:
        return
    assert parse_script(format_script(script)).objects == script.objects
