"""Behaviour that all learners share."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.committee import Committee
from deixis.perception.recognition.learners.instance_based import InstanceBased
from deixis.perception.recognition.learners.learner import Learner
from deixis.perception.recognition.learners.naive_bayes import Codebook, NaiveBayes
from deixis.perception.recognition.learners.one_class import SupportVectorDescription
from deixis.perception.recognition.learners.vector_quantisation import VectorQuantisation
from deixis.perception.recognition.learners.view_features import ViewFeatures
from deixis.perception.recognition.settings import PAPER

BINS = 12
PLACES = {"cup": 1, "fork": 5, "plate": 9}
"""Bins in which the histograms of each category have their mass."""


def view_of(category: str, seed: int) -> ViewFeatures:
    """Return histograms around the category's place, with noise."""
    rng = np.random.default_rng([seed, PLACES[category]])
    across = np.arange(BINS)
    rows = np.exp(-0.5 * (across - PLACES[category]) ** 2) + rng.uniform(0, 0.15, (6, BINS))
    rows /= rows.sum(axis=1, keepdims=True)
    one = rows.mean(axis=0, keepdims=True)
    return ViewFeatures(
        {name: part.astype(np.float32) for name, part in (("spin_images", rows), ("good", one), ("d2_extents", one))}
    )


EMPTY = ViewFeatures({name: np.empty((0, BINS), np.float32) for name in ("spin_images", "good", "d2_extents")})


def codebook() -> Codebook:
    return Codebook.of([view_of(category, seed) for category in PLACES for seed in range(100, 103)], words=8)


LEARNERS: dict[str, Callable[[], Learner]] = {
    "paper": lambda: InstanceBased(settings=PAPER),
    "things": InstanceBased,
    "distance": lambda: InstanceBased(by_distance=True),
    "svdd": SupportVectorDescription,
    "committee": lambda: Committee([InstanceBased(), InstanceBased("good", name="good"), NaiveBayes(codebook())]),
    "lvq": VectorQuantisation,
    "bayes": lambda: NaiveBayes(codebook()),
}


@pytest.fixture(params=LEARNERS)
def learner(request: pytest.FixtureRequest) -> Learner:
    return LEARNERS[request.param]()


def taught(learner: Learner, categories: tuple[str, ...] = tuple(PLACES), views: int = 3) -> Learner:
    for category in categories:
        for seed in range(views):
            learner.learn(category, view_of(category, seed))
    return learner


def test_there_are_no_categories_before_teaching(learner: Learner) -> None:
    found = learner.predict(view_of("cup", 1))
    assert learner.categories == () and learner.stored == 0
    assert found.best is None and found.ranked == () and found.unknown == float("inf")


def test_one_view_makes_a_category(learner: Learner) -> None:
    learner.learn("cup", view_of("cup", 0))
    assert learner.categories == ("cup",) and learner.stored == 1
    assert learner.predict(view_of("plate", 1)).best == "cup"


def test_new_views_get_the_name_of_their_category(learner: Learner) -> None:
    taught(learner)
    assert [learner.predict(view_of(c, s)).best for c in PLACES for s in (50, 51)] == [c for c in PLACES for _ in "12"]


def test_each_category_is_ranked_once_the_likeliest_first(learner: Learner) -> None:
    found = taught(learner).predict(view_of("fork", 9))
    scores = [score for _, score in found.ranked]
    assert scores == sorted(scores, reverse=True) and np.isfinite([*scores, found.unknown]).all()
    assert {name for name, _ in found.ranked} <= set(PLACES)


def test_an_untaught_category_has_a_higher_unknown_score(learner: Learner) -> None:
    taught(learner, ("cup", "fork"), views=5)
    known = [learner.predict(view_of(category, seed)).unknown for category in ("cup", "fork") for seed in range(20, 30)]
    unknown = [learner.predict(view_of("plate", seed)).unknown for seed in range(20, 30)]
    assert np.median(unknown) > np.median(known)


def test_asking_changes_nothing(learner: Learner) -> None:
    taught(learner)
    first = learner.predict(view_of("cup", 7))
    assert learner.predict(view_of("plate", 8)) and learner.predict(view_of("cup", 7)) == first


def test_a_correction_is_stored_and_followed(learner: Learner) -> None:
    taught(learner)
    before, odd = learner.stored, view_of("plate", 60)
    assert learner.predict(odd).best == "plate"
    for _ in range(4):
        learner.correct("tray", odd)
    assert "tray" in learner.categories and learner.stored > before
    assert learner.predict(odd).best == "tray"


def test_a_confirmation_stores_nothing(learner: Learner) -> None:
    taught(learner)
    before = learner.stored
    learner.confirm("cup", view_of("cup", 9))
    assert learner.stored == before


def test_a_forgotten_category_is_never_predicted(learner: Learner) -> None:
    taught(learner).forget("cup")
    found = learner.predict(view_of("cup", 5))
    assert learner.categories == ("fork", "plate") and "cup" not in dict(found.ranked) and found.best is not None


def test_a_renamed_category_keeps_its_views(learner: Learner) -> None:
    before = taught(learner).predict(view_of("cup", 5))
    learner.rename("cup", "beaker")
    after = learner.predict(view_of("cup", 5))
    assert learner.categories == ("beaker", "fork", "plate")
    assert after.best == "beaker" and dict(after.ranked)["beaker"] == pytest.approx(dict(before.ranked)["cup"])


def test_merged_categories_answer_for_both(learner: Learner) -> None:
    stored = taught(learner).stored
    learner.merge("cup", "plate")
    assert learner.categories == ("fork", "plate") and learner.stored == stored
    assert {learner.predict(view_of(category, 5)).best for category in ("cup", "plate")} == {"plate"}


def test_a_view_without_descriptors_is_not_an_error(learner: Learner) -> None:
    taught(learner).learn("cup", EMPTY)
    assert learner.predict(EMPTY).best is None
    learner.learn("shadow", EMPTY)
    assert learner.predict(view_of("cup", 5)).best == "cup"
    learner.forget("shadow")


@pytest.mark.parametrize(
    ("act", "said"),
    [
        (lambda learner: learner.forget("mug"), "unknown category 'mug'"),
        (lambda learner: learner.confirm("mug", view_of("cup", 1)), "unknown category 'mug'"),
        (lambda learner: learner.rename("mug", "cup"), "unknown category 'mug'"),
        (lambda learner: learner.rename("cup", "fork"), "'fork' already"),
        (lambda learner: learner.merge("cup", "cup"), "into itself"),
        (lambda learner: learner.merge("cup", "mug"), "unknown category 'mug'"),
    ],
)
def test_wrong_names_are_an_error_and_change_nothing(
    learner: Learner, act: Callable[[Learner], None], said: str
) -> None:
    taught(learner)
    with pytest.raises(RecognitionError, match=said):
        act(learner)
    assert learner.categories == tuple(PLACES)


@pytest.mark.parametrize("name", LEARNERS)
def test_the_same_lessons_give_the_same_answers(name: str) -> None:
    one, other = taught(LEARNERS[name]()), taught(LEARNERS[name]())
    assert one.predict(view_of("fork", 4)) == other.predict(view_of("fork", 4))
