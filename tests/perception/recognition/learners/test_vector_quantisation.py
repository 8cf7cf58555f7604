"""Prototypes, and the features that categories select."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.learner import Prediction
from deixis.perception.recognition.learners.vector_quantisation import VectorQuantisation
from deixis.perception.recognition.learners.view_features import ViewFeatures


def view(*numbers: float) -> ViewFeatures:
    return ViewFeatures({"good": np.square(np.array([numbers], np.float32))})


def places(learner: VectorQuantisation, category: str) -> list[list[float]]:
    found = learner._known[category]
    assert found is not None
    rows: list[list[float]] = found.places.tolist()
    return rows


def test_right_answers_attract_the_prototype_ever_less() -> None:
    learner = VectorQuantisation(["good"], rate=0.5, decay=1.0)
    learner.correct("cup", view(1.0, 1.0))
    learner.confirm("cup", view(3.0, 1.0))
    assert places(learner, "cup")[0] == pytest.approx([2.0, 1.0])
    learner.confirm("cup", view(4.0, 1.0))
    assert places(learner, "cup")[0] == pytest.approx([2.0 + 2 * 0.5 * np.exp(-1), 1.0])
    assert learner.stored == 1


def test_a_wrong_answer_adds_a_prototype_and_repels_another() -> None:
    learner = VectorQuantisation(["good"], rate=0.5)
    learner.correct("cup", view(1.0, 1.0))
    learner.correct("mug", view(2.0, 1.0))
    assert places(learner, "mug")[0] == pytest.approx([2.0, 1.0])
    assert places(learner, "cup")[0] == pytest.approx([0.5, 1.0]) and learner.stored == 2


def test_a_lesson_that_is_known_already_makes_no_prototype() -> None:
    learner = VectorQuantisation(["good"])
    learner.learn("cup", view(1.0, 1.0))
    learner.learn("fork", view(5.0, 1.0))
    learner.learn("cup", view(1.1, 1.0))
    assert learner.stored == 2


def test_a_category_looks_only_at_features_that_set_it_apart() -> None:
    rng = np.random.default_rng(4)
    chosen, all_of_them = (VectorQuantisation(["good"], features=count) for count in (1, 40))
    for learner in (chosen, all_of_them):
        for _ in range(8):
            for category, place in (("cup", 1.0), ("fork", 2.0)):
                learner.learn(category, view(place, *rng.uniform(0, 4, 39)))
    asked = [(c, view(p, *rng.uniform(0, 4, 39))) for _ in range(20) for c, p in (("cup", 1.0), ("fork", 2.0))]

    def share(learner: VectorQuantisation) -> float:
        return float(np.mean([learner.predict(seen).best == category for category, seen in asked]))

    assert share(chosen) == 1.0 > share(all_of_them)


def test_forgetting_takes_its_numbers_away_again() -> None:
    plain, other = VectorQuantisation(["good"], rate=0.0), VectorQuantisation(["good"], rate=0.0)
    for learner in (plain, other):
        learner.correct("cup", view(1.0, 1.0))
        learner.correct("fork", view(5.0, 1.0))
    other.correct("plate", view(9.0, 9.0))
    other.forget("plate")
    said: list[Prediction] = [learner.predict(view(2.0, 1.0)) for learner in (plain, other)]
    assert said[0] == said[1]


def test_settings_out_of_range_are_an_error() -> None:
    with pytest.raises(RecognitionError, match="`features` must be at least 1"):
        VectorQuantisation(features=0)
