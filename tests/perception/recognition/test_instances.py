"""Categories of views, with the distances of equation 3 kept up to date."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.distances import view_distances
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.views import PackedViews

View = tuple[str, NDArray[np.float32]]


def view(name: str, *values: float) -> View:
    """Return a view of descriptors that are single numbers."""
    return name, np.array(values, np.float32)[:, None]


@st.composite
def named_views(draw: st.DrawFn) -> list[View]:
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    count = draw(st.integers(1, 6))
    return [(str(i), rng.normal(size=(rng.integers(1, 7), 5)).astype(np.float32)) for i in range(count)]


def test_intra_category_distance_is_the_mean_over_ordered_pairs() -> None:
    category = InstanceCategory.of("mug", [view("a", 0), view("b", 2, 3), view("c", 10)])
    # a-b 2, b-a (2 + 3) / 2, a-c 10, c-a 10, b-c (8 + 7) / 2, c-b 7
    assert category.intra_category_distance == pytest.approx((2 + 2.5 + 10 + 10 + 7.5 + 7) / 6, abs=1e-15)


def test_icd_needs_two_views_and_is_zero_for_copies() -> None:
    none, one = InstanceCategory("mug"), InstanceCategory.of("mug", [view("a", 1)])
    assert none.intra_category_distance is None and one.intra_category_distance is None
    assert one.with_view(*view("b", 1)).intra_category_distance == 0.0


@settings(deadline=None)
@given(named_views())
def test_growing_view_by_view_equals_computing_from_scratch(views: list[View]) -> None:
    grown = InstanceCategory("mug")
    for each in views:
        grown = grown.with_view(*each)
    whole = InstanceCategory.of("mug", views)
    np.testing.assert_array_equal(grown.distances, whole.distances)
    assert grown.views.ids == whole.views.ids and (grown.views.descriptors == whole.views.descriptors).all()


@settings(deadline=None)
@given(named_views(), st.integers(0, 5))
def test_removing_a_view_equals_never_having_seen_it(views: list[View], which: int) -> None:
    lost = views[which % len(views)][0]
    left = InstanceCategory.of("mug", views).without_view(lost)
    without = InstanceCategory.of("mug", [each for each in views if each[0] != lost])
    np.testing.assert_array_equal(left.distances, without.distances)
    assert left.views.ids == without.views.ids


@settings(deadline=None)
@given(named_views())
def test_the_order_of_views_does_not_change_it(views: list[View]) -> None:
    one, other = InstanceCategory.of("mug", views), InstanceCategory.of("mug", views[::-1])
    np.testing.assert_array_equal(one.distances, other.distances[::-1, ::-1])


def test_an_empty_view_is_kept_and_enters_no_equation() -> None:
    empty = np.empty((0, 1), np.float32)
    category = InstanceCategory.of("mug", [view("a", 0), ("dark", empty), view("b", 2)]).with_view("darker", empty)
    assert category.empty == ("dark", "darker") and len(category) == 2
    assert category.intra_category_distance == 2.0
    assert category.without_view("dark").empty == ("darker",)


def test_learning_costs_distances_to_the_own_category_only(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []

    def counted(target: NDArray[np.float32], views: PackedViews) -> NDArray[np.float64]:
        asked.append(len(views))
        return view_distances(target, views)

    category = InstanceCategory.of("mug", [view(str(i), i) for i in range(7)])
    monkeypatch.setattr("deixis.perception.recognition.instances.view_distances", counted)
    category.with_view(*view("new", 0.5))
    assert sum(asked) == 14


def test_views_that_do_not_fit_are_an_error() -> None:
    category = InstanceCategory.of("mug", [view("a", 0)])
    with pytest.raises(RecognitionError, match="already has a view 'a'"):
        category.with_view(*view("a", 1))
    with pytest.raises(RecognitionError, match="has no view 'x'"):
        category.without_view("x")
    with pytest.raises(RecognitionError, match="remembered views' 1"):
        category.with_view("b", np.zeros((1, 2), np.float32))
    with pytest.raises(RecognitionError, match="must have shape \\(1, 1\\)"):
        InstanceCategory("mug", category.views, np.zeros((2, 2)))


def test_things_come_and_go_with_their_views() -> None:
    category = InstanceCategory.of("mug", [view("a", 0), view("b", 2)], {"a": "red", "b": "red"})
    assert category.width(over_things=True).icd is None and category.intra_category_distance == 2.0
    grown = category.with_view(*view("c", 5), thing="blue").with_view(*view("d", 5))
    assert grown.shown.tolist() == [0, 0, 1, 2]
    assert grown.width(over_things=True).icd == pytest.approx((5 + 5 + 3 + 3 + 0) / 5) and len(grown.things) == 3
    assert grown.without_view("a").shown.tolist() == [0, 1, 2] and "a" not in grown.without_view("a").things


def test_a_view_without_a_thing_shows_its_own() -> None:
    category = InstanceCategory.of("mug", [view("a", 0), view("b", 2)], {"a": "b"})
    assert category.width(over_things=True).icd == 2.0


@settings(deadline=None)
@given(named_views())
def test_icd_of_one_view_per_thing_is_equation_3(views: list[View]) -> None:
    category = InstanceCategory.of("mug", views, {name: f"thing {name}" for name, _ in views})
    assert category.width(over_things=True).icd == category.intra_category_distance
