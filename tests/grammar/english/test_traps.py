"""Sentences made from templates, which state a place or only mention one."""

import pytest
from bench_english import wrong_about
from english_traps import made

from deixis.grammar.english.reader import read_english


@pytest.mark.parametrize("seed", [0, 1])
def test_generated_traps_state_no_facts_and_statements_do(seed: int) -> None:
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


def test_notes_on_the_same_words_are_in_the_order_of_the_facts() -> None:
    reading = read_english("Two jugs are on the A brush lies on the towels.").reading
    assert reading is not None
    hints = [problem.hint for problem in reading.sentences[0].problems]
    assert hints == [
        "write 'There are 2 jugs: the jug 1 and the jug 2.'",
        "write 'The jug 1 is on the brush.'",
        "write 'The jug 2 is on the brush.'",
        "write 'The jug 1 is on the towels.'",
        "write 'The jug 2 is on the towels.'",
    ]
