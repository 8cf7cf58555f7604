"""Questions about the object that is meant: they describe, tell objects apart, and are answered."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.reasoning.grounding.reference.answer import Question
from deixis.reasoning.grounding.reference.features.room import Room
from deixis.reasoning.grounding.reference.questions import _questions, answered, best_question, fewest_questions


def row_of_chairs(labels: tuple[str | None, ...] = ("chair", "chair", "chair", "door")) -> Room:
    """Return chairs 1, 2 and 4 metres away from a door."""
    centres = np.array([[1.0, 0.0], [2.0, 0.0], [4.0, 0.0], [0.0, 0.0]])
    boxes = np.stack([np.c_[centres - 0.2, np.zeros(4)], np.c_[centres + 0.2, np.full(4, 0.9)]], axis=1)
    return Room.of(("c1", "c2", "c3", "d"), boxes, labels)


def test_the_question_splits_the_probability_evenly() -> None:
    question = best_question(np.array([0.5, 0.25, 0.25, 0.0]), row_of_chairs())
    assert question is not None
    assert set(question.yes) in ({"c1"}, {"c2", "c3"})


def test_a_question_never_names_an_id() -> None:
    room = row_of_chairs()
    for weights in np.random.default_rng(0).dirichlet(np.ones(4), size=20):
        question = best_question(weights, room)
        assert question is not None
        assert not set(room.ids) & set(question.text.replace("?", "").split())


def test_a_question_about_a_plural_label_has_no_article() -> None:
    texts = {asked for asked, _, _ in _questions(row_of_chairs(("chopsticks",) * 4), np.arange(4), True)}
    assert "Are they chopsticks?" in texts


def test_objects_without_labels_are_asked_for_by_measures() -> None:
    question = best_question(np.array([0.5, 0.0, 0.5, 0.0]), row_of_chairs((None,) * 4), labelled=False)
    assert question is not None
    assert "door" not in question.text and len(question.yes) == 1


def test_no_question_asks_for_a_label_that_may_be_missing() -> None:
    question = best_question(np.array([0.5, 0.5, 0.0, 0.0]), row_of_chairs(("chair", None, None, "door")))
    assert question is not None and "chair" not in question.text


@pytest.mark.parametrize(
    ("shares", "enough", "expected"),
    [([0.96, 0.04], 0.95, 0.0), ([0.9, 0.1], 0.95, 1.0), ([0.9, 0.1], 0.9, 0.0), ([0.25] * 4, 0.95, 2.0)],
)
def test_the_least_number_of_questions_is_that_of_a_code(shares: list[float], enough: float, expected: float) -> None:
    assert fewest_questions(np.array(shares), enough) == pytest.approx(expected)


def test_the_least_number_of_questions_is_near_the_entropy() -> None:
    for shares in np.random.default_rng(3).dirichlet(np.ones(6), size=50):
        entropy = float(-(shares * np.log2(shares)).sum())
        assert entropy <= fewest_questions(shares, 1.0) < entropy + 1


def test_there_is_no_question_about_equal_objects() -> None:
    boxes = np.array([[[0.0, 0, 0], [1, 1, 1]], [[0.0, 0, 0], [1, 1, 1]]])
    assert best_question(np.array([0.5, 0.5]), Room.of(("a", "b"), boxes, ("cup", "cup"))) is None


@pytest.mark.parametrize(("yes", "expected"), [(True, 0.998), (False, 0.002)])
def test_an_answer_is_wrong_in_a_few_of_a_thousand_cases(yes: bool, expected: float) -> None:
    after = answered(np.array([0.5, 0.5, 0, 0]), row_of_chairs(), Question("Is it the first one?", ("c1",)), yes)
    assert after[0] == pytest.approx(expected)
