"""Dialogues: how many questions they take, what an answer leaves, and what contradicts what."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.questions.candidates import Candidates
from deixis.reasoning.grounding.questions.inquiry import (
    PATIENCE,
    ContradictionError,
    ExchangeOutcome,
    Inquiry,
    begin,
    update,
)
from deixis.reasoning.grounding.questions.selection import (
    ABSENT,
    DONT_KNOW,
    QuestionKind,
    answers_of,
    best_question,
    questions,
)
from deixis.reasoning.grounding.questions.situation import Situation, situation_of

YES_NO = (QuestionKind.RELATION, QuestionKind.IDENTITY)
RELATIONS = default_ontology().relations


def row_of(n: int, *facts: Fact) -> Situation:
    """Return n cups in a row from left to right, described by facts."""
    names = [f"cup_{i}" for i in range(n)]
    boxes = np.array([[[2.0 * i, 0.0], [2.0 * i + 1, 1.0]] for i in range(n)])
    return situation_of(
        RelationGraph.from_facts(RELATIONS, names, facts),
        scene_relations([f"o{i}" for i in range(n)], boxes, RELATIONS),
    )


def asked(inquiry: Inquiry, truth: NDArray[np.int64]) -> Inquiry:
    while (question := inquiry.next_question()) is not None:
        inquiry = inquiry.answered(question, answers_of(question, inquiry.situation, truth[None])[0])
    return inquiry


def test_figure_7_automorphisms_take_three_questions(inquiry_of: Callable[..., Inquiry]) -> None:
    start = inquiry_of("script1")
    assert start.candidates.count == 8
    for truth in start.candidates.assignments:
        done = asked(start, truth)
        assert done.candidates.assignments.tolist() == [truth.tolist()]
        assert len(done.exchanges) == 3
        assert {exchange.question.kind for exchange in done.exchanges} == {QuestionKind.RELATION}
        assert {exchange.question.bits for exchange in done.exchanges} == {1.0}


@pytest.mark.parametrize("kinds", [tuple(QuestionKind), YES_NO])
@pytest.mark.parametrize(("crisp", "margin"), [(False, 0.0), (True, 0.0), (False, 2.0)])
@pytest.mark.parametrize("script", ["script1", "script2", "formal_dinner"])
def test_dialogue_takes_at_most_one_question_over_the_bound(
    inquiry_of: Callable[..., Inquiry], script: str, crisp: bool, margin: float, kinds: tuple[QuestionKind, ...]
) -> None:
    start = inquiry_of(script, margin, crisp, kinds)
    bound = math.ceil(math.log2(start.candidates.count))
    every = max(1, len(start.candidates) // 12)
    for truth in start.candidates.assignments[::every]:
        done = asked(start, truth)
        assert done.candidates.count == 1
        assert len(done.exchanges) <= bound + 1


@pytest.mark.parametrize("script", ["script1", "script2"])
def test_gain_is_bounded_and_answers_only_narrow(inquiry_of: Callable[..., Inquiry], script: str) -> None:
    start = inquiry_of(script, margin=1.0)
    for question in questions(start.situation, start.candidates):
        assert 0 <= question.bits <= math.log2(len(question.answers)) + 1e-12
        left = 0.0
        for answer, chance in question.answers:
            after = update(start.situation, start.candidates, question, answer)
            assert 0 < len(after) < len(start.candidates)
            left += chance * after.bits
        assert start.candidates.bits - left == pytest.approx(question.bits, abs=1e-9)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_order_of_the_input_changes_no_question(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n, k = 4, int(rng.integers(2, 8))
    maps = np.array([rng.permutation(n) for _ in range(k)])
    weights = rng.choice([1.0, 2.0, 3.0], k)
    names, boxes = [f"cup_{i}" for i in range(n)], rng.uniform(0, 1, (n, 1, 2)) + np.array([[[0, 0], [0.1, 0.1]]])
    rows, columns, order = rng.permutation(n), rng.permutation(n), rng.permutation(k)

    def first(objects: NDArray[np.int64], things: NDArray[np.int64], listed: NDArray[np.int64]) -> str | None:
        description = RelationGraph.from_facts(RELATIONS, [names[i] for i in objects], [])
        scene = scene_relations([f"o{p}" for p in things], boxes[things], RELATIONS)
        found = Candidates(np.argsort(things)[maps[listed][:, objects]], weights[listed])
        question = best_question(situation_of(description, scene), found)
        return None if question is None else question.text

    plain = np.arange(n)
    assert first(plain, plain, np.arange(k)) == first(rows, columns, order)


def test_what_is_said_or_follows_is_never_asked() -> None:
    left, right, on = RELATIONS["left"], RELATIONS["right"], RELATIONS["on"]
    everything = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]
    situation = row_of(3, Fact("cup_0", (left,), "cup_1"), Fact("cup_1", (left,), "cup_2"))
    possible = list(questions(situation, Candidates(np.array(everything), np.ones(6)), [QuestionKind.RELATION]))
    for question in possible:
        assert question.relation not in (left, right, on)
    assert not possible


def test_what_is_denied_is_never_asked() -> None:
    denied = row_of(2, Fact("cup_0", (RELATIONS["left"],), "cup_1", positive=False))
    both = Candidates(np.array([[0, 1], [1, 0]]), np.ones(2))
    texts = {question.text for question in questions(denied, both, [QuestionKind.RELATION])}
    assert texts == {"Is the cup 0 right of the cup 1?"}


def test_question_without_information_is_not_asked() -> None:
    same = Candidates(np.array([[0, 1, 2], [0, 2, 1]]), np.ones(2))
    for question in questions(row_of(3), same):
        assert question.bits > 0
        assert question.subject != 0


def test_one_candidate_leaves_nothing_to_ask() -> None:
    assert best_question(row_of(2), Candidates(np.array([[0, 1]]), np.ones(1))) is None


def test_things_are_distinguished_by_their_place() -> None:
    both = Candidates(np.array([[0, 1, 2], [1, 0, 2]]), np.ones(2))
    texts = [question.text for question in questions(row_of(3), both, [QuestionKind.IDENTITY])]
    assert "Is the thing at the far left (o0) the cup 0?" in texts
    assert "Is the thing o1 the cup 0?" in texts


def test_pointing_settles_twelve_alike_without_listing() -> None:
    start = begin(row_of(12), Candidates(np.arange(12)[None], np.ones(1), groups=(tuple(range(12)),)))
    assert start.candidates.count == math.factorial(12)
    truth = np.random.default_rng(3).permutation(12)
    done = asked(start, truth)
    assert done.candidates.best.tolist() == truth.tolist()
    assert len(done.exchanges) == 11 <= math.ceil(math.log2(math.factorial(12)))
    assert max(len(step.question.answers) for step in done.exchanges) == 12


def test_a_group_answers_as_all_its_orders_do() -> None:
    situation, orders = row_of(4), Candidates(np.arange(4)[None], np.ones(1), groups=((0, 1, 2, 3),))
    listed = orders.pinned(range(4))
    grouped = {question.text: question for question in questions(situation, orders)}
    plain = {question.text: question for question in questions(situation, listed)}
    assert set(grouped) < set(plain)
    for text, question in grouped.items():
        assert question.bits == pytest.approx(plain[text].bits)
        assert dict(question.answers) == pytest.approx(dict(plain[text].answers))


def test_who_does_not_know_is_not_asked_the_same_again(inquiry_of: Callable[..., Inquiry]) -> None:
    inquiry = inquiry_of("script1")
    seen = set()
    for _ in range(5):
        question = inquiry.next_question()
        assert question is not None
        assert question.look not in seen
        seen.add(question.look)
        inquiry = inquiry.answered(question, DONT_KNOW)
        assert inquiry.candidates is inquiry.start
        assert inquiry.exchanges[-1].outcome is ExchangeOutcome.UNKNOWN


def test_unrecognised_object_is_not_asked_about_again(inquiry_of: Callable[..., Inquiry]) -> None:
    inquiry, unknown = inquiry_of("script1", kinds=(QuestionKind.IDENTITY, QuestionKind.POINTING)), set()
    while (question := inquiry.next_question()) is not None:
        assert question.subject not in unknown
        unknown.add(question.subject)
        inquiry = inquiry.answered(question, DONT_KNOW)
    assert len(unknown) > 1


def test_unknown_answers_end_after_as_many_as_objects(inquiry_of: Callable[..., Inquiry]) -> None:
    inquiry = inquiry_of("script1")
    while (question := inquiry.next_question()) is not None:
        inquiry = inquiry.answered(question, DONT_KNOW)
    assert 0 < len(inquiry.exchanges) <= len(inquiry.situation.objects)


def test_a_dialogue_with_one_who_knows_nothing_ends() -> None:
    inquiry = begin(row_of(3), Candidates(np.array([[0, 1, 2], [1, 2, 0]]), np.ones(2)))
    steps = 0
    while (question := inquiry.next_question()) is not None:
        inquiry, steps = inquiry.answered(question, DONT_KNOW), steps + 1
    assert 0 < steps <= PATIENCE
    assert inquiry.candidates.count == 2


def test_contradiction_names_the_earlier_answer() -> None:
    situation = row_of(3)
    maps = np.array([[0, 1, 2], [1, 0, 2], [0, 2, 1]])
    start = begin(situation, Candidates(maps, np.ones(3)))
    by_text = {question.text: question for question in questions(situation, start.candidates)}
    first = start.answered(by_text["Which one is the cup 2?"], "o2")
    second = first.answered(by_text["Which one is the cup 0?"], "o0")
    third = second.answered(by_text["Which one is the cup 1?"], "o0")
    assert third.exchanges[-1].outcome is ExchangeOutcome.CONTRADICTORY
    assert third.exchanges[-1].against == (1,)
    assert third.candidates.assignments.tolist() == second.candidates.assignments.tolist() == [[0, 1, 2]]


def test_surprising_pointing_is_believed() -> None:
    start = begin(row_of(3), Candidates(np.array([[0, 1, 2], [1, 0, 2]]), np.ones(2)))
    question = next(iter(questions(start.situation, start.candidates, [QuestionKind.POINTING])))
    after = start.answered(question, "o2")
    assert (after.exchanges[0].outcome, after.exchanges[0].against) == (ExchangeOutcome.SURPRISING, ())
    with pytest.raises(ContradictionError, match="contradicts every remaining grounding"):
        update(start.situation, start.candidates, question, "o2")


def test_possibly_missing_objects_allow_the_answer_absent() -> None:
    pointing = (QuestionKind.POINTING,)
    start = begin(row_of(2), Candidates(np.array([[0, 1], [0, UNMATCHED]]), np.ones(2)), pointing)
    question = start.next_question()
    assert question is not None
    assert dict(question.answers) == {"o1": 0.5, ABSENT: 0.5}
    assert start.answered(question, ABSENT).candidates.assignments.tolist() == [[0, UNMATCHED]]
