"""Texts in English in an editor: what is not understood, contradictions, and the facts of a sentence."""

from __future__ import annotations

import pytest

from deixis.lsp.english import EnglishText, english_completions, english_fixes, english_hover, english_problems

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
