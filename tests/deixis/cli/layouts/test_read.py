"""The command ``deixis read``: facts of English texts as lines, JSON and layouts."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import deixis

from deixis.deadline import Deadline


@pytest.fixture
def text(tmp_path: Path) -> Path:
    """Text with a fact, a conditional fact and a phrase that is not understood."""
    file = tmp_path / "table.txt"
    file.write_text("The fork is left of the plate. If you serve soup, the spoon is right of it.", encoding="utf-8")
    return file


def test_each_sentence_has_its_facts_and_a_paraphrase(text: Path) -> None:
    code, out, _ = deixis("read", text)
    assert code == 0
    assert "    = The fork is left of the plate.\n    left(fork, plate)\n" in out
    assert "[if you serve soup]" in out


def test_json_has_the_words_that_state_each_fact(text: Path) -> None:
    code, out, _ = deixis("read", text, "--json")
    first, second = json.loads(out)["facts"]
    start, end = first["span"]
    assert code == 0
    assert text.read_text(encoding="utf-8")[start:end].startswith("The fork is left of the plate")
    assert (first["asserted"], first["condition"]) == (True, None)
    assert (second["asserted"], second["condition"]) == (False, "if you serve soup")


def test_the_layout_is_read_as_a_script(text: Path, tmp_path: Path) -> None:
    _, written, _ = deixis("read", text, "--format", "layout")
    layout = tmp_path / "table.layout"
    layout.write_text(written, encoding="utf-8")
    code, out, _ = deixis("parse", layout, "--json")
    facts = [(f["relation"], f["subject"], f["object"]) for f in json.loads(out)["facts"]]
    assert (code, facts) == (0, [("left", "fork", "plate")])


def test_a_text_without_facts_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "letter.txt"
    file.write_text("She left the table.", encoding="utf-8")
    code, _, error = deixis("read", file)
    assert code == 2
    assert "nothing in this text" in error


def test_strict_refuses_what_is_not_understood(tmp_path: Path) -> None:
    file = tmp_path / "notes.txt"
    file.write_text("The cup is on the mat. The glass is left over.", encoding="utf-8")
    assert deixis("read", file)[0] == 0
    assert deixis("read", file, "--strict")[0] == 2


def test_sentences_before_the_time_limit_are_printed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    answers = iter([False, False, False, True])  # parsing asks twice for a sentence; reading its facts asks later
    monkeypatch.setattr(Deadline, "passed", property(lambda deadline: next(answers, False)))
    file = tmp_path / "long.txt"
    file.write_text("The cup is on the mat. The fork is left of the cup. " * 9, encoding="utf-8")
    code, out, error = deixis("read", file)
    assert code == 3
    assert "    on(cup, mat)\n" in out and "left(fork, cup)" not in out
    assert "time limit reached after 1 sentence;" in error
