"""Weights of the word classes are those that the tool writes, and they give the marked classes."""

from __future__ import annotations

from pathlib import Path

from fit_word_classes import SENTENCES, WEIGHTS, fit, read_marked, written, wrong

from deixis.grammar.english.tagging import weights

UNSEEN = Path(__file__).parents[1] / "grammar" / "english" / "tagging" / "unseen.txt"
MIN_RIGHT = 0.985
MIN_RIGHT_UNSEEN = 0.95


def test_marked_words_get_their_classes() -> None:
    sentences = read_marked(SENTENCES)
    marks = sum(len(marked.marks) for marked in sentences)
    assert len(wrong(sentences, weights.WEIGHTS)) <= (1 - MIN_RIGHT) * marks


def test_words_of_sentences_that_were_not_fitted() -> None:
    sentences = read_marked(UNSEEN)
    marks = sum(len(marked.marks) for marked in sentences)
    assert len(wrong(sentences, weights.WEIGHTS)) <= (1 - MIN_RIGHT_UNSEEN) * marks


def test_weights_are_written_as_they_are_read() -> None:
    assert written(weights.WEIGHTS) == WEIGHTS.read_text(encoding="utf-8")


def test_fitting_prefers_the_marked_classes(tmp_path: Path) -> None:
    file = tmp_path / "marked.txt"
    file.write_text("The cups stand/verb here.\nThe cup stand/noun is here.\n" * 8, encoding="utf-8")
    sentences = read_marked(file)
    assert wrong(sentences, fit(sentences)) == []
