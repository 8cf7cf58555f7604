"""Texts in English in an editor: what is not understood, contradictions, and the facts of a sentence."""

from __future__ import annotations

import pytest

from deixis.lsp.edits import RenameError
from deixis.lsp.english import (
    EnglishText,
    english_completions,
    english_fixes,
    english_hover,
    english_mentions,
    english_noun_at,
    english_problems,
    english_rename,
)

TEXT = "The fork is left of the plate.\r\nIt zorbles the quux blargh wibble.\r\nThe knife is right of the plate."


def test_phrases_that_are_not_understood_are_marked() -> None:
    found = english_problems(EnglishText(TEXT))
    assert {(problem.source.line, problem.is_error) for problem in found} == {(2, False)}


@pytest.mark.parametrize("text", ["", " \n", "???", "Bonjour, la fourchette est ici."])
def test_a_text_without_facts_is_one_error_or_nothing(text: str) -> None:
    found = english_problems(EnglishText(text))
    assert [problem.source.line for problem in found[:1]] == ([1] if text.strip() else [])
    assert english_hover(EnglishText(text), 1, 1) is None


def test_warnings_have_codes_and_fixes_in_an_english_text() -> None:
    text = "The fork is left of the plate. The cups are near the plaet. The spoon is next to the fork."
    found = english_problems(EnglishText(text))
    assert {"N001", "E003"} <= {problem.code for problem in found}
    assert [edit.text for fix in english_fixes(found) for edit in fix.edits] == ["plate"]


def test_completion_offers_names_and_relations_of_english() -> None:
    text = "The sugar bowl is left of the plate. The fork is next"
    assert "next to" in [one.text for one in english_completions(EnglishText(text), 1, len(text) + 1)]
    text += " to the su"
    found = english_completions(EnglishText(text), 1, len(text) + 1)
    assert (found[0].text, found[0].column) == ("sugar bowl", len(text) - 1)
    assert english_completions(EnglishText(text), 7, 1) == []


def test_hover_shows_the_facts_of_the_sentence() -> None:
    assert "`right(knife, plate)`" in (english_hover(EnglishText(TEXT), 3, 4) or "")
    assert "left" not in (english_hover(EnglishText(TEXT), 3, 4) or "left")


JUGS = "The milk jug is on the tray.\nTwo cups stand next to the jug. It is left of the pot; the cups are red."


def test_all_mentions_of_an_object_are_found() -> None:
    places = [(one.line, one.column, one.end_column) for one in english_mentions(EnglishText(JUGS), 2, 26)]
    assert places == [(1, 1, 13), (2, 24, 31)]
    assert english_mentions(EnglishText(JUGS), 2, 12) == [] and english_mentions(EnglishText(JUGS), 9, 1) == []


@pytest.mark.parametrize(
    ("line", "column", "new", "expected"),
    [
        (1, 6, "tea_pot", [(1, 5, "tea pot"), (2, 28, "tea pot")]),
        (2, 6, "glass", [(2, 5, "glasses"), (2, 60, "glasses")]),
    ],
)
def test_renaming_changes_the_nouns_of_all_mentions(
    line: int, column: int, new: str, expected: list[tuple[int, int, str]]
) -> None:
    edits = english_rename(EnglishText(JUGS), line, column, new)
    assert [(edit.source.line, edit.source.column, edit.text) for edit in edits] == expected


@pytest.mark.parametrize(
    ("column", "new", "message"),
    [(6, "pot", "already"), (6, "a;b", "words"), (6, " ", "words"), (15, "vase", "no object")],
)
def test_names_that_cannot_be_given_are_refused(column: int, new: str, message: str) -> None:
    with pytest.raises(RenameError, match=message):
        english_rename(EnglishText(JUGS), 1, column, new)


def test_the_noun_is_found_whatever_other_objects_are_called() -> None:
    found = english_noun_at(EnglishText("The thing is on the tray. The milk jug is near the thing."), 1, 32)
    assert found is not None and (found.column, found.end_column) == (31, 39)
    assert english_noun_at(EnglishText("The cup is on the tray."), 1, 9) is None


def test_completion_offers_names_after_an_article() -> None:
    text = JUGS + " The fork is left of the "
    found = english_completions(EnglishText(text), 2, len(text.split("\n")[1]) + 1)
    assert {"milk jug", "pot"} <= {one.text for one in found}


def test_hover_shows_kind_size_and_what_follows_for_an_object() -> None:
    shown = english_hover(EnglishText("The fork is left of the plate. The plate is left of the knife."), 1, 6) or ""
    assert shown.startswith("**fork**: fork, usually 12.5 to 23 cm") and "- follows: left of knife" in shown
