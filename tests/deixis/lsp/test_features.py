"""Features of a document: errors and warnings, completion, hover, quick fixes, renaming, outline."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from timing import processor_time_below

from deixis.grammar.layout.parser import parse_script
from deixis.lsp.completion import Role, completions
from deixis.lsp.diagnostics import Problem, errors, warnings
from deixis.lsp.document import Document
from deixis.lsp.edits import Edit, RenameError, fixes, formatted, rename
from deixis.lsp.hover import hover
from deixis.lsp.symbols import mentions_of, symbols

WORDS = [
    "fork",
    "the",
    "left of",
    "lft of",
    "plate",
    "is a",
    "mug",
    "not",
    ",",
    ";",
    "\n",
    "2",
    "(",
    ")",
    '"',
    "#",
    "on",
]
TEXTS = st.lists(st.sampled_from([*WORDS, "layout", "usually", "left to right:", "é", "🍴"])).map(" ".join)


def at_bar(marked: str) -> tuple[Document, int, int]:
    """Return the document without its mark ``|``, and the line and the column of the mark."""
    before, _, after = marked.partition("|")
    return Document(before + after), before.count("\n") + 1, len(before.rpartition("\n")[2]) + 1


def applied(text: str, edits: list[Edit] | tuple[Edit, ...]) -> str:
    """Return the text with the edits made, the last one first."""
    starts = [0]
    for line in text.split("\n"):
        starts.append(starts[-1] + len(line) + 1)
    for edit in sorted(edits, key=lambda edit: edit.source, reverse=True):
        start = starts[edit.source.line - 1] + edit.source.column - 1
        end = starts[edit.source.end_line - 1] + edit.source.end_column - 1
        text = text[:start] + edit.text + text[end:]
    return text


def completed(marked: str) -> list[str]:
    return [found.text for found in completions(*at_bar(marked))]


def test_errors_of_all_statements_are_found() -> None:
    found = errors(Document("fork lft of plate\nspoon on\ncup on saucer"))
    assert [(problem.source.line, problem.is_error) for problem in found] == [(1, True), (2, True)]
    assert "did you mean 'left of'?" in found[0].message


def test_warnings_cover_the_statements_without_errors() -> None:
    found = warnings(Document("layout seen from chair\nfork left of plate\nknife right of plaet\nspoon lft"))
    assert [(problem.code, problem.replacement) for problem in found if problem.code == "N001"] == [("N001", "plate")]


def test_an_unfinished_text_has_no_warnings_about_the_whole() -> None:
    assert "L001" in [problem.code for problem in warnings(Document("fork left of plate", Path("a.layout")))]
    assert "L001" not in [p.code for p in warnings(Document("fork left of plate\nknife", Path("a.layout")))]


def test_an_included_file_is_read_and_its_errors_shown(tmp_path: Path) -> None:
    (tmp_path / "part.layout").write_text("cup lft of saucer\n", encoding="utf-8")
    document = Document('include "part.layout"\nfork left of plate', tmp_path / "all.layout")
    (found,) = errors(document)
    assert (found.source.line, "part.layout:1:5" in found.message) == (1, True)
    assert len(document.script.facts) == 1


@pytest.mark.parametrize(
    ("marked", "first"),
    [
        ("dinner fork left of plate\nd|", "dinner_fork"),
        ("fork left of plate\nfork lef|", "left of"),
        ("fork to the le|", "to the left of"),
        ("x is a win|", "wine glass"),
        ("x is a re|", "red"),
        ("fork usu|", "usually"),
        ("left to ri|", "left to right:"),
        ("fork |", "left of"),
        ("lay|", "layout"),
        ("layout dinner se|", "seen from"),
        ("left to right: fork,\n  fo|", "fork"),
    ],
)
def test_completion_offers_what_fits(marked: str, first: str) -> None:
    assert first in completed(marked)[:12]


@pytest.mark.parametrize(
    "marked", ["fork left of plate # le|", 'fork on "my le|', "fork left of plate |; cup on tray", "fork on , l|"]
)
def test_completion_offers_no_relation_out_of_place(marked: str) -> None:
    assert not [found for found in completions(*at_bar(marked)) if found.role is Role.RELATION]


def test_the_word_being_typed_is_not_offered_as_a_name() -> None:
    assert "qwer" not in completed("fork left of qwer|")
    assert "qwer" in completed("qwer left of fork; plate on qwe|")


def test_a_chosen_completion_makes_a_statement_that_can_be_read() -> None:
    marked = "fork to the le|"
    document, line, column = at_bar(marked)
    (found, *_) = completions(document, line, column)
    written = document.lines[line - 1][: found.column - 1] + found.text
    assert [fact.relations[0].name for fact in parse_script(f"{written} plate").facts] == ["left"]


@pytest.mark.parametrize(
    ("marked", "said"),
    [
        ("fo|rk left of plate", "usually 12.5 to 23 cm long"),
        ("fo|rk left of plate; plate left of knife", "follows: left of knife"),
        ("fork left of pl|ate", "states: right of fork"),
        ("fork le|ft of plate", "inverse: right of"),
        ("fork is a red m|ug", "colour red"),
        ("fork usu|ally left of plate", "weight 0.8"),
        ("2 cu|p on tray", "2 objects"),
        ("gi|zmo on tray", "kind unknown"),
    ],
)
def test_hover_explains_the_word(marked: str, said: str) -> None:
    assert said in (hover(*at_bar(marked)) or "")


def test_hover_says_nothing_about_other_places() -> None:
    assert hover(*at_bar("fork left of plate  |")) is None
    assert hover(Document("fork"), 9, 9) is None


@pytest.mark.parametrize(
    ("text", "mended"),
    [
        ("fork lft of plate", "fork left of plate"),
        ("the fork lft plate", "the fork left plate"),
        ("x is a red mgu; x on tray", "x is a red mug; x on tray"),
        ("fork left of plate\nknife on plaet\n", "fork left of plate\nknife on plate\n"),
        ("fork left of plate\nfork left of plate\ncup on plate\n", "fork left of plate\ncup on plate\n"),
        ("fork left of plate; fork left of plate; cup on plate", "fork left of plate; cup on plate"),
    ],
)
def test_a_quick_fix_mends_the_text(text: str, mended: str) -> None:
    document = Document(text)
    problems: list[Problem] = [*errors(document), *warnings(document)]
    assert mended in [applied(text, fix.edits) for fix in fixes(document, problems)]


@pytest.mark.parametrize(
    ("text", "mended"),
    [
        ("fork left of plate", "layout seen from chair\nfork left of plate"),
        ("layout tea\nfork left of plate", "layout tea seen from chair\nfork left of plate"),
    ],
)
def test_a_quick_fix_adds_the_viewpoint(text: str, mended: str) -> None:
    document = Document(text, Path("a.layout"))
    added = [fix for fix in fixes(document, warnings(document)) if fix.problem.code == "L001"]
    assert [applied(text, fix.edits) for fix in added] == [mended]


@pytest.mark.parametrize(
    ("marked", "new", "renamed"),
    [
        ("fo|rk left of plate; fork on the Fork tray", "spoon", "spoon left of plate; spoon on the Fork tray"),
        ("fo|rk is a fork; fork on tray", "spoon", "spoon is a fork; spoon on tray"),
        ("2 cu|p on tray; cup_1 left of cup_2", "mug", "2 mug on tray; mug_1 left of mug_2"),
        ("fo|rk on tray; fork lft", "my spoon", "my_spoon on tray; fork lft"),
        ("fo|rk on tray", "left", '"left" on tray'),
    ],
)
def test_rename_changes_every_mention(marked: str, new: str, renamed: str) -> None:
    document, line, column = at_bar(marked)
    assert applied(document.text, rename(document, line, column, new)) == renamed


@pytest.mark.parametrize(
    ("marked", "new", "reason"),
    [
        ("fo|rk on tray", "Tray", "already"),
        ("2 cup on tray; cu|p_1 on mat", "mug", "rename 'cup'"),
        ("fork o|n tray", "mug", "no name"),
        ("fo|rk on tray", "  ", "empty"),
    ],
)
def test_rename_refuses_with_a_reason(marked: str, new: str, reason: str) -> None:
    with pytest.raises(RenameError, match=reason):
        rename(*at_bar(marked), new)


def test_formatting_leaves_a_text_with_errors_alone() -> None:
    assert formatted(Document("left(the fork, plate)")) == "fork left of plate\n"
    assert formatted(Document("left(the fork, plate); x")) is None


def test_the_outline_lists_objects_once() -> None:
    document = Document("layout tea\nfork left of plate\nplate is a Plate\ncup on Plate")
    assert [symbol.name for symbol in symbols(document)] == ["fork", "plate", "cup"]
    assert [place.line for place in mentions_of(document, 3, 1)] == [2, 3, 4]


@given(TEXTS, st.integers(1, 4), st.integers(1, 40))
@settings(max_examples=40, deadline=None)
def test_no_text_makes_a_feature_fail(text: str, line: int, column: int) -> None:
    document = Document(text, Path("a.layout"))
    found = [*errors(document), *warnings(document)]
    for fix in fixes(document, found):
        assert applied(text, fix.edits) != text
    completions(document, line, column)
    hover(document, line, column)
    symbols(document)
    name = document.name_at(line, column)
    if name is not None:
        try:
            renamed = applied(text, rename(document, line, column, "zzz"))
        except RenameError:
            return
        assert len(Document(renamed).script.facts) == len(document.script.facts)


def test_a_line_without_end_is_answered_at_once() -> None:
    document = Document("fork lft " * 30_000)
    with processor_time_below(5):
        assert errors(document) and completions(document, 1, 270_001) == [] and hover(document, 1, 3) is None


def test_features_of_a_long_script_stay_fast() -> None:
    text = "\n".join(f"cup_a{n} left of cup_a{n + 1}" for n in range(3_000))
    document = Document(text + "\ncup lef", Path("a.layout"))
    with processor_time_below(5):
        assert len(errors(document)) == 1
        assert completions(document, 3_001, 8)[0].text == "left of"
