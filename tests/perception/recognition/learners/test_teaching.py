"""The teaching protocol, with learners whose answers are known beforehand."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.learner import Prediction, TaughtViews
from deixis.perception.recognition.learners.teaching import Course, End, Teaching, teach
from deixis.perception.recognition.learners.view_features import ViewFeatures


class Scripted(TaughtViews):
    """A learner that is right or wrong as its script says, and right after the end of the script."""

    name = "scripted"

    def __init__(self, truth: dict[int, str], script: Iterator[bool]) -> None:
        super().__init__()
        self.truth, self.script = truth, script
        self.asked: list[str] = []
        self.met: list[str] = []

    def predict(self, view: ViewFeatures) -> Prediction:
        truth = self.truth[id(view)]
        if truth not in self.categories:
            self.met.append(truth)
            return Prediction.of({"nonsense": 1.0}, 1.0)
        self.asked.append(truth)
        right = next(self.script, True)
        return Prediction.of({truth if right else "nonsense": 1.0}, 0.0 if right else 2.0)

    def _added(self, category: str, view: ViewFeatures) -> None:
        assert self.truth[id(view)] == category

    def _rebuilt(self, category: str, views: tuple[ViewFeatures, ...]) -> None: ...


def course(
    script: list[bool], categories: int = 3, views: int = 200, teaching: Teaching | None = None
) -> tuple[Course, Scripted]:
    shown = {f"c{i}": [ViewFeatures({}) for _ in range(views)] for i in range(categories)}
    learner = Scripted({id(view): name for name, some in shown.items() for view in some}, iter(script))
    return teach(learner, shown, list(shown), teaching or Teaching(first=1)), learner


def test_a_perfect_learner_needs_one_question_per_category() -> None:
    found, _ = course([])
    assert found.end is End.LEARNED and found.learned == 3
    assert found.iterations == 1 + 2 + 3 and found.introduced == (0, 1, 3)
    assert found.stored == 3 and found.instances == 1.0
    assert found.global_accuracy == found.protocol_accuracy == 1.0


def test_a_learner_that_is_never_right_exhausts_patience() -> None:
    found, learner = course([False] * 500)
    assert found.end is End.FRUITLESS and found.learned == 0 and found.iterations == 100
    assert found.stored == 1 + 100 == learner.stored and found.global_accuracy == 0.0


def test_only_wrong_answers_are_corrected_and_stored() -> None:
    found, learner = course([False, True, True, True], categories=1)
    # after wrong, right, right: 2 / 3 is not above 0.67; the window of 3 then holds three right ones
    assert [answer.right for answer in found.answers] == [False, True, True, True]
    assert [answer.accuracy for answer in found.answers] == pytest.approx([0, 1 / 2, 2 / 3, 1])
    assert learner.stored == 2 and [answer.stored for answer in found.answers] == [2, 2, 2, 2]
    assert found.global_accuracy == 0.75 and found.protocol_accuracy == pytest.approx((0.5 + 2 / 3 + 1) / 4)


def test_only_answers_since_the_last_introduction_count() -> None:
    found, _ = course([True, False, False, True, True, True, True], categories=2)
    assert [answer.accuracy for answer in found.answers[1:]] == pytest.approx([0, 0, 1 / 3, 2 / 4, 3 / 5, 4 / 6, 5 / 6])


def test_each_category_is_asked_for_once_in_every_round() -> None:
    _, learner = course([True] * 3 + [False] * 6, categories=3)
    assert [sorted(learner.asked[3 + i : 6 + i]) for i in (0, 3)] == [["c0", "c1", "c2"]] * 2


def test_a_course_ends_where_a_category_has_no_view_left() -> None:
    found, _ = course([False] * 50, categories=1, views=5)
    assert found.end is End.NO_VIEWS and found.iterations == 4 and found.learned == 0


def test_a_category_is_introduced_by_as_many_views_as_asked_for() -> None:
    found, _ = course([], teaching=Teaching(first=3))
    assert found.stored == 9 and found.instances == 3.0


def test_new_categories_are_met_before_they_are_taught() -> None:
    found, learner = course([], teaching=Teaching(first=3))
    assert learner.met == ["c1"] * 3 + ["c2"] * 3 and found.doubts == (1.0,) * 6
    assert found.unknown_auroc == 1.0


def test_doubt_separates_the_unknown_from_the_asked() -> None:
    found, _ = course([True, False, True, True, True], categories=2)  # doubts 0, 2, 0, 0, 0 and, of the new one, 1
    assert [answer.unknown for answer in found.answers] == [0, 2, 0, 0, 0] and found.unknown_auroc == 0.8


def test_a_single_category_leaves_nothing_unknown() -> None:
    found, _ = course([], categories=1)
    assert found.doubts == () and np.isnan(found.unknown_auroc)


def test_the_same_seed_asks_in_the_same_order() -> None:
    assert course([True] * 3 + [False] * 9)[1].asked == course([True] * 3 + [False] * 9)[1].asked


@pytest.mark.parametrize(
    ("order", "said"),
    [
        ([], "at least one category"),
        (["a", "a"], "each once"),
        (["a", "b"], "'b' must have at least 2 views"),
        (["z"], "'z' must have at least 2 views"),
    ],
)
def test_orders_that_cannot_be_taught_are_an_error(order: list[str], said: str) -> None:
    views = {"a": [ViewFeatures({})] * 5, "b": [ViewFeatures({})]}
    with pytest.raises(RecognitionError, match=said):
        teach(Scripted({}, iter([])), views, order, Teaching(first=1))


def test_a_course_begins_without_categories() -> None:
    view = ViewFeatures({})
    learner = Scripted({id(view): "a"}, iter([]))
    learner.learn("a", view)
    with pytest.raises(RecognitionError, match="begin without categories"):
        teach(learner, {"a": [view] * 5}, ["a"])


@pytest.mark.parametrize("wrong", [{"threshold": 1.0}, {"window": 0}, {"patience": 0}, {"first": 0}])
def test_a_teacher_that_could_never_be_content_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(RecognitionError, match="threshold"):
        Teaching(**wrong)  # type: ignore[arg-type]
