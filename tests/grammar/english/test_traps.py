"""Sentences made from templates, which state a place or only mention one."""

import pytest
from bench_english import wrong_about
from english_traps import made

from deixis.grammar.english.reader import read_english


@pytest.mark.parametrize("seed", [0, 1])
def test_made_traps_are_no_facts_and_made_statements_are(seed: int) -> None:
    assert [(sentence.text, faults) for sentence in made(1, seed) if (faults := wrong_about(sentence))] == []


def test_doubtful_fact_is_reported_and_not_asserted() -> None:
    reading = read_english("I hope Anna's radio is under the drawer. The cup is on the box.").reading
    assert reading is not None
    doubtful, certain = reading.stated
    assert (doubtful.asserted, certain.asserted) == (False, True)
    assert doubtful.guesses == ("RUN_ON",)
    assert doubtful.confidence < certain.confidence
    (problem,) = reading.sentences[0].problems
    assert problem.hint is not None
    assert "The radio is under the drawer." in problem.hint
