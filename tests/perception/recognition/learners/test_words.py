"""A codebook of local shapes, and naive Bayes over its words."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.naive_bayes import Codebook, NaiveBayes
from deixis.perception.recognition.learners.view_features import ViewFeatures

BOOK = Codebook("spin_images", np.array([[0.0], [10.0]]))


def view(*numbers: float) -> ViewFeatures:
    return ViewFeatures({"spin_images": np.square(np.array(numbers, np.float32))[:, None]})


def test_descriptors_are_counted_as_their_nearest_word() -> None:
    assert BOOK.counts(view(1.0, 4.0, 6.0, 11.0, 12.0)).tolist() == [2, 3]


def test_a_codebook_finds_clusters_without_names() -> None:
    rng = np.random.default_rng(1)
    near = [view(*(place + rng.uniform(-0.1, 0.1, 20))) for place in (1.0, 5.0, 9.0)]
    assert np.sort(Codebook.of(near, words=3).centres[:, 0]) == pytest.approx([1, 5, 9], abs=0.1)


def test_a_codebook_is_deterministic_and_bounded() -> None:
    views = [view(1.0, 1.0, 2.0, 3.0)]
    assert np.array_equal(Codebook.of(views, words=2).centres, Codebook.of(views, words=2).centres)
    assert len(Codebook.of(views, words=50)) == 3


@pytest.mark.parametrize("views", [[], [ViewFeatures({"spin_images": np.empty((0, 3), np.float32)})]])
def test_no_codebook_comes_from_nothing(views: list[ViewFeatures]) -> None:
    with pytest.raises(RecognitionError, match="cannot be found among 0"):
        Codebook.of(views)


def test_scores_are_mean_log_likelihoods() -> None:
    learner = NaiveBayes(BOOK, smoothing=1.0)
    learner.learn("cup", view(0.0, 0.0, 10.0))  # (2 + 1) / 5 and (1 + 1) / 5
    learner.learn("fork", view(10.0))  # 1 / 3 and 2 / 3
    found = learner.predict(view(0.0, 10.0))
    assert dict(found.ranked) == pytest.approx(
        {"cup": np.log([3 / 5, 2 / 5]).mean(), "fork": np.log([1 / 3, 2 / 3]).mean()}
    )


def test_unknown_is_the_divergence_from_the_best_category() -> None:
    learner = NaiveBayes(BOOK, smoothing=1.0)
    learner.learn("cup", view(0.0, 10.0))  # one half each
    learner.learn("fork", view(10.0, 10.0))
    assert learner.predict(view(0.0, 10.0)).unknown == pytest.approx(0.0)
    divergence = 3 / 4 * np.log(3 / 4 / (1 / 2)) + 1 / 4 * np.log(1 / 4 / (1 / 2))
    assert learner.predict(view(0.0, 0.0, 0.0, 10.0)).unknown == pytest.approx(divergence)


def test_a_prior_favours_what_was_taught_more_often() -> None:
    learner = NaiveBayes(BOOK, smoothing=1.0, prior=1.0)
    for _ in range(3):
        learner.learn("cup", view(0.0, 10.0))
    learner.learn("mug", view(*[0.0, 10.0] * 3))
    assert dict(learner.predict(view(0.0)).ranked) == pytest.approx(
        {"cup": np.log(0.5) + np.log(3 / 4), "mug": np.log(0.5) + np.log(1 / 4)}
    )
