"""The index finds the nearest view without comparing all views."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.distances import Target, category_distance, view_distances
from deixis.perception.recognition.index import Effort, InvertedFile, ViewIndex
from deixis.perception.recognition.kernels import AXES
from deixis.perception.recognition.views import PackedViews, mapped, open_views, write_views


def clustered(seed: int, count: int, size: int = 60, scale: float = 1.0) -> list[NDArray[np.float32]]:
    """Return views of descriptors in a few directions, some of them copies of others."""
    rng = np.random.default_rng(seed)
    directions = rng.normal(size=(6, size)) * scale
    views: list[NDArray[np.float32]] = []
    for number in range(count):
        middle = rng.normal(size=6)
        weights = middle + 0.5 * rng.normal(size=(rng.integers(1, 50), 6))
        noisy = weights @ directions + 0.05 * scale * rng.normal(size=(len(weights), size))
        views.append(views[number // 2] if number % 7 == 6 else noisy.astype(np.float32))
    return views


def packed(views: list[NDArray[np.float32]]) -> PackedViews:
    return PackedViews.of([(str(i), view) for i, view in enumerate(views)])


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 30), st.sampled_from([1, 2, 23, 24, 25, 60]), st.integers(-5, 5))
def test_pruned_search_equals_comparing_all(seed: int, count: int, size: int, power: int) -> None:
    target, *views = clustered(seed, count + 1, size, 10.0**power)
    index = ViewIndex.of(packed(views))
    found = index.nearest(Target.of(target), index.reduction(target))
    assert (found.distance, found.place) == category_distance(target, index.views)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 23, 40]), st.sampled_from([0.0, 100.0]))
def test_bounds_never_exceed_distances(seed: int, size: int, offset: float) -> None:
    target, *views = (view + np.float32(offset) for view in clustered(seed, 12, size))
    index = ViewIndex.of(packed(views))
    bounds = index._bounds(index.reduction(target))
    assert (bounds <= view_distances(target, index.views)).all()


def test_few_directions_of_variance_spare_most_comparisons() -> None:
    target, *views = clustered(3, 300)
    index = ViewIndex.of(packed(views))
    assert index.nearest(Target.of(target), index.reduction(target)).compared < 60


def test_the_first_of_equally_near_views_is_returned() -> None:
    view = clustered(1, 1)[0]
    index = ViewIndex.of(packed([view + 1, view, view]))
    assert index.nearest(Target.of(view), index.reduction(view)).place == 1


def test_approximate_search_mostly_finds_the_nearest() -> None:
    views = clustered(5, 460)
    index = ViewIndex.of(packed(views[:400]))
    assert len(index.filed.centres) > 100
    hits = 0
    for target in views[400:]:
        seen, reduced = Target.of(target), index.reduction(target)
        exact, found = index.nearest(seen, reduced), index.nearest(seen, reduced, Effort())
        assert found.distance == view_distances(target, index.views)[found.place] >= exact.distance
        assert found.compared <= Effort().few
        hits += found.distance == exact.distance
    assert hits >= 58


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 30))
def test_an_approximate_search_that_looks_everywhere_is_exact(seed: int, count: int) -> None:
    target, *views = clustered(seed, count + 1)
    index = ViewIndex.of(packed(views))
    found = index.nearest(Target.of(target), index.reduction(target), Effort(lists=512, few=count))
    assert found.distance == category_distance(target, index.views)[0]


def test_estimates_from_all_lists_are_the_bounds() -> None:
    target, *views = clustered(4, 200)
    index = ViewIndex.of(packed(views))
    reduced = index.reduction(target)
    np.testing.assert_allclose(index.filed.estimates(reduced, 512), index._bounds(reduced), rtol=1e-3)


def test_each_descriptor_is_in_the_list_of_its_centre() -> None:
    views = packed(clustered(6, 60))
    reduced = ViewIndex.of(views).reduced
    filed = InvertedFile.of(reduced, views.starts)
    assert filed.starts[0] == 0 and filed.starts[-1] == len(reduced) and filed.count == 60
    np.testing.assert_array_equal(np.bincount(filed.views), np.diff(views.starts))
    np.testing.assert_array_equal(np.sort(filed.reduced, axis=0), np.sort(reduced, axis=0))
    apart = np.linalg.norm(filed.reduced[:, None, :-1] - filed.centres, axis=2)
    own = apart[np.arange(len(apart)), np.repeat(np.arange(len(filed.centres)), np.diff(filed.starts))]
    np.testing.assert_allclose(own, apart.min(axis=1), rtol=1e-4, atol=1e-4)


def test_approximate_search_works_on_mapped_views(tmp_path: Path) -> None:
    target, *views = clustered(2, 90)
    write_views(tmp_path / "views", ((str(i), view) for i, view in enumerate(views)))
    found = [
        index.nearest(Target.of(target), index.reduction(target), Effort())
        for index in (ViewIndex.of(packed(views)), ViewIndex.of(open_views(tmp_path / "views")))
    ]
    assert found[0] == found[1] and found[0].compared == Effort().few


def test_a_reduction_made_for_other_views_gives_the_same_answer() -> None:
    target, *views = clustered(8, 40)
    other = ViewIndex.of(packed(clustered(9, 10)))
    index = ViewIndex.of(packed(views), other.reduction)
    found = index.nearest(Target.of(target), index.reduction(target))
    assert (found.distance, found.place) == category_distance(target, index.views)


def test_reduced_descriptors_keep_distances_where_axes_suffice() -> None:
    views = [np.random.default_rng(i).normal(size=(9, AXES - 1)).astype(np.float32) for i in range(5)]
    index = ViewIndex.of(packed(views))
    bounds = index._bounds(index.reduction(views[0] + 1))
    np.testing.assert_allclose(bounds, view_distances(views[0] + 1, index.views), rtol=1e-4)


def test_views_mapped_from_a_file_give_the_same_answers(tmp_path: Path) -> None:
    target, *views = clustered(2, 30)
    write_views(tmp_path / "views", ((str(i), view) for i, view in enumerate(views)))
    opened = open_views(tmp_path / "views")
    assert not opened.descriptors.flags.owndata and not opened.descriptors.flags.writeable
    index = ViewIndex.of(opened)
    found = index.nearest(Target.of(target), index.reduction(target))
    assert (found.distance, found.place) == category_distance(target, packed(views))
    assert opened.ids == packed(views).ids and (opened.squares == packed(views).squares).all()


def test_views_on_disk_leave_no_file_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    views = clustered(2, 30)
    found = mapped((str(i), view) for i, view in enumerate(views))
    assert not list(tmp_path.iterdir()) and not found.descriptors.flags.owndata
    assert found.ids == packed(views).ids and (found.descriptors == packed(views).descriptors).all()
    assert len(mapped([])) == 0


def test_a_folder_without_room_for_views_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "nowhere"))
    with pytest.raises(RecognitionError, match="set TMPDIR to a folder"):
        mapped([("a", np.zeros((2, 3), np.float32))])


def test_a_folder_without_views_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(RecognitionError, match="holds no readable views"):
        open_views(tmp_path)
    write_views(tmp_path, [("a", np.zeros((2, 3), np.float32))])
    with pytest.raises(RecognitionError, match="choose another folder"):
        write_views(tmp_path, [])
    np.save(tmp_path / "lengths.npy", np.array([3]))
    with pytest.raises(RecognitionError, match="do not belong together"):
        open_views(tmp_path)
    (tmp_path / "descriptors.npy").write_bytes(b"\x93NUMPY")
    with pytest.raises(RecognitionError, match="holds no readable views"):
        open_views(tmp_path)


@pytest.mark.parametrize("second", ["a", "b"])
def test_views_that_cannot_be_compared_are_not_written(tmp_path: Path, second: str) -> None:
    views = [("a", np.zeros((2, 3), np.float32)), (second, np.zeros((2 if second == "a" else 0, 3), np.float32))]
    with pytest.raises(RecognitionError, match="occurs twice" if second == "a" else "no descriptor"):
        write_views(tmp_path / "views", views)
