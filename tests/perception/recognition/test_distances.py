"""Equations 1 and 2, by hand and compared with a naive double loop."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.distances import category_distance, view_distance, view_distances
from deixis.perception.recognition.views import PackedViews

Descriptors = NDArray[np.float32]


def naive_view_distance(target: Descriptors, view: Descriptors) -> float:
    """Compute equation 1 as it is written."""
    total = 0.0
    for wanted in target:
        total += min(math.dist(wanted.tolist(), other.tolist()) for other in view)
    return total / len(target)


def rows(*values: list[float]) -> Descriptors:
    return np.array(values, np.float32)


@st.composite
def some_views(draw: st.DrawFn, count: int = 4) -> list[Descriptors]:
    """Draw views with descriptors of one length, near to each other and far, on scales from tiny to large."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    size, scale = draw(st.integers(1, 40)), 10.0 ** draw(st.integers(-6, 6))
    offset = draw(st.sampled_from([0.0, 1.0, 1000.0]))
    views = []
    for _ in range(draw(st.integers(2, count))):
        grain = draw(st.sampled_from([1e-4, 1.0]))
        views.append(((rng.normal(size=(rng.integers(1, 9), size)) * grain + offset) * scale).astype(np.float32))
    return views


def test_each_target_descriptor_matches_its_nearest() -> None:
    target = rows([0, 0], [10, 0], [0, 1])
    view = rows([0, 3], [13, 4])
    assert view_distance(target, view) == pytest.approx((3 + 5 + 2) / 3, abs=1e-15)
    assert view_distance(view, target) == pytest.approx((2 + 5) / 2, abs=1e-15)


def test_category_distance_is_that_of_the_nearest_view() -> None:
    views = PackedViews.of([("far", rows([9.0])), ("near", rows([2.0], [7.0])), ("as near", rows([2.0]))])
    assert category_distance(rows([0.0]), views) == (2.0, 1)


def test_a_category_without_views_is_infinitely_far() -> None:
    assert category_distance(rows([0.0]), PackedViews.of([])) == (math.inf, -1)


def test_similar_descriptors_far_from_the_origin_differ() -> None:
    target = rows([4096.0, 4096.0])
    view = rows([4096.0, 4096.001], [4096.0, 4096.0005], [4096.0, 4096.002])
    assert view_distance(target, view) == naive_view_distance(target, view) > 0


@settings(deadline=None)
@given(some_views())
def test_distance_is_the_naive_double_loop(views: list[Descriptors]) -> None:
    packed = PackedViews.of([(str(i), view) for i, view in enumerate(views)])
    found = view_distances(views[0], packed)
    wanted = [naive_view_distance(views[0], view) for view in views]
    np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=0)


@settings(deadline=None)
@given(some_views())
def test_distance_to_itself_is_zero(views: list[Descriptors]) -> None:
    assert all(view_distance(view, view) == 0.0 for view in views)


@settings(deadline=None)
@given(some_views())
def test_another_view_never_increases_the_distance(views: list[Descriptors]) -> None:
    target, *others = views
    packed = [PackedViews.of([(str(i), view) for i, view in enumerate(others[:n])]) for n in range(len(others) + 1)]
    distances = [category_distance(target, pack)[0] for pack in packed]
    assert distances == sorted(distances, reverse=True)


@settings(deadline=None)
@given(some_views())
def test_the_order_of_views_and_of_descriptors_does_not_matter(views: list[Descriptors]) -> None:
    rng = np.random.default_rng(0)
    target, *others = views
    named = [(str(i), view) for i, view in enumerate(others)]
    turned = [(name, view[rng.permutation(len(view))]) for name, view in reversed(named)]
    one = category_distance(target, PackedViews.of(named))[0]
    other = category_distance(target[rng.permutation(len(target))], PackedViews.of(turned))[0]
    assert other == pytest.approx(one, rel=1e-12, abs=0)


@pytest.mark.parametrize(
    ("target", "view", "said"),
    [
        (np.empty((0, 2), np.float32), rows([0, 0]), "the target view must have at least one"),
        (rows([0, 0]), np.empty((0, 2), np.float32), "view 'the view' must have at least one"),
        (rows([0, 0, 0]), rows([0, 0]), "have 3 numbers, and the remembered views' 2"),
        (rows([math.nan, 0]), rows([0, 0]), "must be finite"),
        (rows([1e20, 0]), rows([0, 0]), "below 1e"),
        (np.zeros(3, np.float32), rows([0, 0, 0]), r"must have shape \(k, 3\)"),
    ],
)
def test_descriptors_that_do_not_fit_are_an_error(target: Descriptors, view: Descriptors, said: str) -> None:
    with pytest.raises(RecognitionError, match=said):
        view_distance(target, view)


def test_products_in_pieces_are_those_in_one() -> None:
    from deixis.perception.recognition.kernels import ONE_THREAD, _products

    rng = np.random.default_rng(0)
    for rows, columns, size in ((120, 100, 153), (7, 3, 5), (3, 2, ONE_THREAD)):
        view = rng.normal(size=(rows, size)).astype(np.float32)
        target = rng.normal(size=(size, columns)).astype(np.float32)
        np.testing.assert_allclose(_products(view, target), view @ target, rtol=1e-4, atol=1e-2)
