"""Suggestions for misspelt words."""

from __future__ import annotations

from difflib import SequenceMatcher

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.spelling import mistakes, nearest

WORDS = st.text("abc", max_size=6)


@pytest.mark.parametrize(
    ("word", "meant"), [("rihgt", "right"), ("beekeepr", "beekeeper"), ("lft", "left"), ("dinner_plat", "dinner_plate")]
)
def test_a_misspelt_word_has_its_word_as_suggestion(word: str, meant: str) -> None:
    assert nearest(word, ["right", "left", "beekeeper", "dinner_plate", "plate"]) == meant


@pytest.mark.parametrize(
    ("word", "other"),
    [
        ("xyz", "left"),
        ("hive frame", "silverware"),
        ("hive_tool", "Washer_Tool"),
        ("title", "Rattle"),
        ("to the", "top"),
    ],
)
def test_a_very_different_word_is_not_suggested(word: str, other: str) -> None:
    assert nearest(word, [other]) is None
    assert nearest(word, []) is None


@given(WORDS, WORDS)
def test_mistakes_are_a_symmetric_distance_of_letters(word: str, meant: str) -> None:
    found = mistakes(word, meant)
    assert found == mistakes(meant, word)
    assert abs(len(word) - len(meant)) <= found <= max(len(word), len(meant))
    assert (found == 0) == (word == meant)
    common = sum(block.size for block in SequenceMatcher(None, word, meant, autojunk=False).get_matching_blocks())
    assert found <= len(word) + len(meant) - 2 * common


@given(st.text("abcde", min_size=2, max_size=8), st.data())
def test_one_edit_is_one_mistake(word: str, data: st.DataObject) -> None:
    at = data.draw(st.integers(0, len(word) - 2))
    edits = [word[:at] + word[at + 1 :], word[:at] + "x" + word[at:], word[:at] + "x" + word[at + 1 :]]
    if word[at] != word[at + 1]:
        edits.append(word[:at] + word[at + 1] + word[at] + word[at + 2 :])
    assert all(mistakes(word, edited) == 1 for edited in edits)
