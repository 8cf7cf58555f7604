"""The dialogue at the terminal, and the oracle."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.questions.candidates import Candidates
from deixis.reasoning.grounding.questions.inquiry import Inquiry, begin
from deixis.reasoning.grounding.questions.selection import QuestionKind
from deixis.reasoning.grounding.questions.situation import situation_of
from deixis.workflows.grounding.dialogue import Oracle, OracleError, Terminal, closing_lines, read_oracle, run

RELATIONS = default_ontology().relations


def three_cups(*kinds: QuestionKind) -> Inquiry:
    """Three cups in a row of which only the third is settled by the first question or so."""
    boxes = np.array([[[2.0 * i, 0.0], [2.0 * i + 1, 1.0]] for i in range(3)])
    description = RelationGraph.from_facts(RELATIONS, ["big_cup", "cup", "mug"], [])
    situation = situation_of(description, scene_relations(["o1", "o2", "o3"], boxes, RELATIONS))
    maps = np.array([[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0]])
    return begin(situation, Candidates(maps, np.ones(4)), kinds or tuple(QuestionKind))


def typed(inquiry: Inquiry, *lines: str) -> tuple[Inquiry, str]:
    out = io.StringIO()
    done = run(inquiry, Terminal(io.StringIO("".join(f"{line}\n" for line in lines)), out), out)
    return done, out.getvalue() + "\n".join(closing_lines(done)) + "\n"


def test_answers_at_the_terminal_lead_to_one_grounding() -> None:
    done, text = typed(three_cups(QuestionKind.RELATION), "YES", "y", "n", "no")
    assert done.candidates.count == 1
    assert text.startswith("1. Is the big cup left of the cup?   [1.00 bits]\n   (yes, no, ?) ")
    assert text.endswith("One of the considered groundings is left after 2 questions.\n")


def test_an_invalid_answer_is_asked_again() -> None:
    done, text = typed(three_cups(QuestionKind.RELATION), "perhaps", "yess", "yes")
    assert "'perhaps' is not an answer" in text
    assert "'yess' is not an answer; did you mean 'yes'?" in text
    assert [exchange.answer for exchange in done.exchanges] == ["yes"]


def test_the_end_of_input_ends_the_dialogue_politely() -> None:
    done, text = typed(three_cups())
    assert done.candidates.count == 4
    assert "No further answers." in text
    assert text.endswith("4 groundings are left after 0 questions; undecided: big cup, cup, mug.\n")


def test_pointing_questions_list_candidates_with_their_places() -> None:
    _, text = typed(three_cups(QuestionKind.POINTING))
    assert "o1 at the far left" in text
    assert "none, ?)" in text


def test_an_answer_that_fits_no_grounding_ends_the_questions() -> None:
    done, text = typed(three_cups(QuestionKind.POINTING), "none", "o1")
    assert "No considered grounding agrees with this answer; the groundings are computed again." in text
    assert len(done.exchanges) == 1
    assert done.candidates.count == 4


def test_a_contradictory_answer_names_the_answer_it_contradicts() -> None:
    done, text = typed(three_cups(QuestionKind.POINTING), "o1", "o1")
    assert done.exchanges[0].question.text != done.exchanges[1].question.text
    assert "This answer is ignored: it contradicts the answer to 1." in text
    assert "undecided: cup, mug." in text


def test_who_does_not_know_is_asked_something_else() -> None:
    done, _ = typed(three_cups(), "?", "don't know")
    assert len({exchange.question.text for exchange in done.exchanges}) == 2
    assert done.candidates.count == 4


def test_a_thing_that_is_called_none_can_still_be_pointed_at() -> None:
    boxes = np.array([[[0.0, 0.0], [1.0, 1.0]], [[2.0, 0.0], [3.0, 1.0]]])
    description = RelationGraph.from_facts(RELATIONS, ["cup", "mug"], [])
    situation = situation_of(description, scene_relations(["none", "y"], boxes, RELATIONS))
    both = begin(situation, Candidates(np.array([[0, 1], [1, 0]]), np.ones(2)), (QuestionKind.POINTING,))
    done, _ = typed(both, "none")
    assert done.candidates.assignments.tolist() == [[0, 1]]


def oracle_file(tmp_path: Path, data: object) -> Path:
    file = tmp_path / "truth.json"
    file.write_text(data if isinstance(data, str) else json.dumps(data), encoding="utf-8")
    return file


def test_the_oracle_answers_until_one_grounding_is_left(tmp_path: Path) -> None:
    out, inquiry = io.StringIO(), three_cups()
    oracle = read_oracle(oracle_file(tmp_path, {"big_cup": "o3", "cup": "o2", "mug": "o1"}), inquiry.situation, out)
    done = run(inquiry, oracle, out)
    assert done.candidates.assignments.tolist() == [[2, 1, 0]]


def test_the_oracle_says_which_object_it_does_not_know() -> None:
    out = io.StringIO()
    done = run(three_cups(), Oracle({"cup": "o2"}, out), out)
    assert "(the oracle does not know 'big_cup')" in out.getvalue()
    assert all(row[1] == 1 for row in done.candidates.assignments.tolist())


def test_the_oracle_knows_what_is_not_there() -> None:
    out = io.StringIO()
    inquiry = three_cups(QuestionKind.POINTING)
    done = run(inquiry, Oracle({"big_cup": None, "cup": None, "mug": None}, out), out)
    assert {exchange.answer for exchange in done.exchanges} == {"absent"}


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ("{", "not valid JSON"),
        ([], "a truth file must be a JSON object"),
        ({"cup": 1}, "a truth file must be a JSON object"),
        ({"cup": "o22"}, "which is not in the scene; did you mean 'o2'?"),
        ({"cup": "o1", "mug": "o1"}, "two objects have the id 'o1'"),
    ],
)
def test_a_malformed_truth_file_is_refused(tmp_path: Path, data: object, message: str) -> None:
    with pytest.raises(OracleError, match="truth") as error:
        read_oracle(oracle_file(tmp_path, data), three_cups().situation, io.StringIO())
    assert message in str(error.value)


def test_the_error_names_a_missing_truth_file(tmp_path: Path) -> None:
    with pytest.raises(OracleError, match=r"nowhere\.json: there is no such file"):
        read_oracle(tmp_path / "nowhere.json", three_cups().situation, io.StringIO())


def test_incomplete_candidates_are_not_reported_as_one_grounding() -> None:
    several = three_cups(QuestionKind.POINTING)
    alone = begin(several.situation, Candidates(np.array([[0, 1, 2]]), np.ones(1), complete=False))
    assert typed(alone)[1] == (
        "Only one grounding was considered, so there was no question to ask.\n"
        "Not all groundings could be considered; others may fit as well.\n"
    )
    cut = begin(several.situation, Candidates(several.start.assignments, np.ones(4), complete=False), several.kinds)
    assert "One of the considered groundings is left after 1 question.\n" in typed(cut, "o3", "o1")[1]
