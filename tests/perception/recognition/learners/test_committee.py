"""The committee: combinations of learners, and the choice among them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.committee import BELIEF, VOTE, Committee, dempster_shafer, majority
from deixis.perception.recognition.learners.learner import Prediction, TaughtViews
from deixis.perception.recognition.learners.view_features import ViewFeatures

VIEW = ViewFeatures({})


class Stubborn(TaughtViews):
    """A learner with a constant answer."""

    def __init__(self, name: str, says: str) -> None:
        super().__init__()
        self.name, self.says, self.asked = name, says, 0

    def predict(self, view: ViewFeatures) -> Prediction:
        self.asked += 1
        return Prediction.of({self.says: 1.0}, 0.25)

    def _added(self, category: str, view: ViewFeatures) -> None: ...

    def _rebuilt(self, category: str, views: tuple[ViewFeatures, ...]) -> None: ...


def test_the_member_that_was_right_lately_answers() -> None:
    committee = Committee([Stubborn("a", "cup"), Stubborn("b", "fork"), Stubborn("c", "fork")], window=4)
    for _ in range(4):
        committee.correct("cup", VIEW)
    assert committee.attended == "a" and committee.predict(VIEW).best == "cup"
    for _ in range(4):
        committee.correct("fork", VIEW)
    assert committee.attended in (BELIEF, VOTE, "b", "c") and committee.predict(VIEW).best == "fork"


def test_success_is_forgotten_outside_the_window() -> None:
    committee = Committee([Stubborn("a", "cup")], window=2)
    for category in ("cup", "cup", "fork", "fork"):
        committee.correct(category, VIEW)
    assert committee.accuracies["a"] == pytest.approx(1 / 4)


def test_only_the_best_members_are_combined() -> None:
    committee = Committee([Stubborn("a", "cup"), Stubborn("b", "fork"), Stubborn("c", "fork")], best=1)
    committee.correct("cup", VIEW)
    assert committee._predictions(VIEW)[VOTE].ranked == (("cup", 1.0),)


def test_members_are_asked_once_per_corrected_view() -> None:
    member = Stubborn("a", "cup")
    committee = Committee([member])
    committee.predict(VIEW)
    committee.correct("fork", VIEW)
    assert member.asked == 1


def test_unknown_is_the_first_members() -> None:
    assert Committee([Stubborn("a", "cup"), Stubborn("b", "fork")]).predict(VIEW).unknown == 0.25


def test_the_majority_wins_and_the_earlier_voter_breaks_ties() -> None:
    assert max(votes := majority([("cup", 0.6), ("mug", 0.9)]), key=lambda name: votes[name]) == "cup"


def test_dempsters_rule_by_hand() -> None:
    # {cup: .6, all: .4} with {cup: .5, all: .5}: cup .8; with {mug: .5, all: .5}: conflict .4, so cup .4 / .6
    assert dempster_shafer([("cup", 0.6), ("cup", 0.5), ("mug", 0.5)]) == pytest.approx(
        {"cup": 0.4 / 0.6, "mug": 0.1 / 0.6}
    )


@given(st.lists(st.tuples(st.sampled_from("abc"), st.floats(0.01, 0.99)), min_size=1, max_size=6))
def test_dempsters_rule_is_that_of_pairs_in_any_order(support: list[tuple[str, float]]) -> None:
    masses: dict[str | None, float] = {None: 1.0}
    for category, mass in reversed(support):
        joined: dict[str | None, float] = {}
        for one, its in masses.items():
            for other, weight in ((category, mass), (None, 1.0 - mass)):
                if one is None or other is None or one == other:
                    key = one or other
                    joined[key] = joined.get(key, 0.0) + its * weight
        masses = {key: value / sum(joined.values()) for key, value in joined.items()}
    del masses[None]
    assert dempster_shafer(support) == pytest.approx(masses)


def test_members_need_distinct_names() -> None:
    with pytest.raises(RecognitionError, match="distinct names"):
        Committee([Stubborn("a", "cup"), Stubborn("a", "fork")])
