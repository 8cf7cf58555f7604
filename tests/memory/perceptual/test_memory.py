"""Behaviour of every perceptual memory, on disk or not."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from datetime import timedelta, timezone
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deixis.errors import DeixisError
from deixis.memory.errors import (
    MemoryFormatError,
    RecordError,
    RejectedWriteError,
    UnknownCategoryError,
    UnknownViewError,
)
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.protocol import PerceptualMemory
from deixis.memory.perceptual.records import Batch, CategoryRecord, View

MakeView = Callable[..., View]
MakeRecord = Callable[..., CategoryRecord]
Said = Callable[[View | CategoryRecord], dict[str, Any]]
Content = Callable[..., tuple[list[dict[str, Any]], list[dict[str, Any]]]]


def ids(memory: PerceptualMemory, category: str | None = None) -> list[str]:
    return [key.id for key in memory.listing(category)]


def test_a_new_memory_is_empty(memory: PerceptualMemory) -> None:
    assert not list(memory.views())
    assert not list(memory.listing())
    assert memory.categories() == ()
    stats = memory.stats()
    assert (stats.views, stats.categories, stats.batches, stats.lost, stats.version) == (0, 0, 0, 0, 2)
    assert memory.verify() == ()


def test_views_and_records_come_back_as_they_were(
    memory: PerceptualMemory, make_view: MakeView, make_record: MakeRecord, said: Said
) -> None:
    view, record = make_view("v1"), make_record("mug")
    memory.write(Batch([view], [record]))
    assert said(memory.view("v1")) == said(view)
    assert [said(found) for found in memory.views("mug")] == [said(view)]
    assert said(memory.category("mug")) == said(record)


def test_arrays_that_come_back_cannot_be_written(memory: PerceptualMemory, make_view: MakeView) -> None:
    memory.write(Batch([make_view("v1")]))
    with pytest.raises(ValueError, match="read-only"):
        memory.view("v1").descriptors["spin"][0, 0] = 1


def test_what_the_caller_does_to_his_array_later_changes_nothing(memory: PerceptualMemory, make_view: MakeView) -> None:
    array = np.ones((2, 3), np.float32)
    memory.write(Batch([View("v1", "mug", make_view("x").time, {"spin": array})]))
    array[:] = 7
    assert memory.view("v1").descriptors["spin"].tolist() == [[1, 1, 1], [1, 1, 1]]


def test_views_come_in_order_of_category_then_id(memory: PerceptualMemory, make_view: MakeView) -> None:
    for category, id in (("plate", "v1"), ("mug", "v3"), ("mug", "v2"), ("mug\0", "v0"), ("mugs", "v4")):
        memory.write(Batch([make_view(id, category)]))
    assert [(key.category, key.id) for key in memory.listing()] == [
        ("mug", "v2"),
        ("mug", "v3"),
        ("mug\0", "v0"),
        ("mugs", "v4"),
        ("plate", "v1"),
    ]
    assert ids(memory, "mug") == ["v2", "v3"]
    assert memory.categories() == ("mug", "mug\0", "mugs", "plate")


def test_a_category_may_have_views_only_or_a_record_only(
    memory: PerceptualMemory, make_view: MakeView, make_record: MakeRecord
) -> None:
    memory.write(Batch([make_view("v1", "mug")], [make_record("plate")]))
    assert memory.categories() == ("mug", "plate")
    assert not memory.category("mug").state
    assert list(memory.views("plate")) == []
    assert memory.stats().categories == 2


def test_a_view_of_a_known_id_takes_the_place_of_the_old_one(
    memory: PerceptualMemory, make_view: MakeView, said: Said
) -> None:
    memory.write(Batch([make_view("v1", "mug"), make_view("v2", "mug")]))
    corrected = make_view("v1", "plate", seed=5, minutes=9)
    memory.write(Batch([corrected]))
    assert said(memory.view("v1")) == said(corrected)
    assert (ids(memory, "mug"), ids(memory, "plate")) == (["v2"], ["v1"])
    assert memory.stats().views == 2
    assert memory.verify() == ()


def test_a_batch_forgets_views(memory: PerceptualMemory, make_view: MakeView, make_record: MakeRecord) -> None:
    memory.write(Batch([make_view("v1"), make_view("v2")]))
    memory.write(Batch([make_view("v3")], [make_record("mug")], ["v1"]))
    assert ids(memory) == ["v2", "v3"]
    assert memory.stats().views == 2


def test_a_batch_that_cannot_be_done_does_nothing(
    memory: PerceptualMemory, make_view: MakeView, content: Content
) -> None:
    memory.write(Batch([make_view("v1")]))
    before = content(memory)
    with pytest.raises(UnknownViewError, match="no view 'v7' to forget"):
        memory.write(Batch([make_view("v2")], [], ["v1", "v7"]))
    assert content(memory) == before
    assert memory.stats().batches == 1


def test_a_batch_with_a_repeated_name_is_refused(make_view: MakeView, make_record: MakeRecord) -> None:
    with pytest.raises(RecordError, match="the view 'v1' must occur only once"):
        Batch([make_view("v1")], [], ["v1"])
    with pytest.raises(RecordError, match="the category 'mug' must occur only once"):
        Batch([], [make_record("mug"), make_record("mug")])


def test_rename_takes_views_and_record_along(
    memory: PerceptualMemory, make_view: MakeView, make_record: MakeRecord, said: Said
) -> None:
    memory.write(Batch([make_view("v1", "mug"), make_view("v2", "mugs")], [make_record("mug")]))
    memory.rename("mug", "cup")
    assert memory.categories() == ("cup", "mugs")
    assert said(memory.view("v1")) == said(make_view("v1")) | {"category": "cup"}
    assert said(memory.category("cup")) == said(make_record("cup"))
    memory.write(Batch([make_view("v3", "mug")]))
    assert (ids(memory, "cup"), ids(memory, "mug")) == (["v1"], ["v3"])
    memory.write(Batch([make_view("v1", "mug", seed=2)]))
    assert ids(memory, "mug") == ["v1", "v3"]
    assert memory.verify() == ()


def test_rename_to_a_name_that_is_taken_is_refused(memory: PerceptualMemory, make_view: MakeView) -> None:
    memory.write(Batch([make_view("v1", "mug"), make_view("v2", "cup")]))
    with pytest.raises(RejectedWriteError, match="there is already a category 'cup': merge 'mug' into it"):
        memory.rename("mug", "cup")
    with pytest.raises(RejectedWriteError, match="already"):
        memory.rename("mug", "mug")


def test_merge_moves_the_views_and_drops_the_outdated_state(
    memory: PerceptualMemory, make_view: MakeView, make_record: MakeRecord, said: Said
) -> None:
    memory.write(Batch([make_view("v1", "mug"), make_view("v2", "cup")], [make_record("mug"), make_record("cup")]))
    memory.merge("mug", "cup")
    assert memory.categories() == ("cup",)
    assert ids(memory, "cup") == ["v1", "v2"]
    assert not memory.category("cup").state
    memory.write(Batch([make_view("v3", "mug")]))
    memory.merge("mug", "cup", make_record("cup", 0.7))
    assert said(memory.category("cup")) == said(make_record("cup", 0.7))
    assert memory.verify() == ()


def test_merge_wants_two_categories_and_a_fitting_record(
    memory: PerceptualMemory, make_view: MakeView, make_record: MakeRecord
) -> None:
    memory.write(Batch([make_view("v1", "mug"), make_view("v2", "cup")]))
    with pytest.raises(RecordError, match="cannot be merged"):
        memory.merge("mug", "mug")
    with pytest.raises(RecordError, match="cannot be merged"):
        memory.merge("mug", "cup", make_record("mug"))


def test_forget_takes_views_and_record_away(
    memory: PerceptualMemory, make_view: MakeView, make_record: MakeRecord
) -> None:
    memory.write(Batch([make_view("v1", "mug"), make_view("v2", "cup")], [make_record("mug"), make_record("cup")]))
    memory.forget("mug")
    assert (memory.categories(), ids(memory)) == (("cup",), ["v2"])
    with pytest.raises(UnknownViewError, match="no view 'v1'"):
        memory.view("v1")
    assert memory.verify() == ()


@pytest.mark.parametrize(
    "ask",
    [
        lambda memory: memory.views("mugg"),
        lambda memory: memory.listing("mugg"),
        lambda memory: memory.category("mugg"),
        lambda memory: memory.rename("mugg", "cup"),
        lambda memory: memory.merge("mugg", "mug"),
        lambda memory: memory.merge("mug", "mugg"),
        lambda memory: memory.forget("mugg"),
    ],
)
def test_an_unknown_category_suggests_the_nearest_at_once(
    memory: PerceptualMemory, make_view: MakeView, ask: Callable[[PerceptualMemory], object]
) -> None:
    memory.write(Batch([make_view("v1")]))
    with pytest.raises(UnknownCategoryError, match="no category 'mugg'; did you mean 'mug'") as caught:
        ask(memory)
    assert isinstance(caught.value, KeyError) and isinstance(caught.value, DeixisError)


def test_an_unknown_category_without_a_near_one_lists_some(memory: PerceptualMemory, make_view: MakeView) -> None:
    memory.write(Batch([make_view(f"v{k}", name) for k, name in enumerate("abcde")]))
    with pytest.raises(UnknownCategoryError, match=r"the memory has: a, b, c, d, e$"):
        memory.category("xylophone")
    memory.write(Batch([make_view("v9", "f")]))
    with pytest.raises(UnknownCategoryError, match=r"the memory has: a, b, c, d, e, among others$"):
        memory.category("xylophone")


def test_a_snapshot_stays_as_it_was(
    memory: PerceptualMemory, make_view: MakeView, make_record: MakeRecord, content: Content
) -> None:
    memory.write(Batch([make_view("v1"), make_view("v2", "plate")], [make_record("mug")]))
    before = content(memory)
    with memory.snapshot() as then:
        memory.write(Batch([make_view("v1", seed=3), make_view("v3")], [make_record("mug", 0.9)], ["v2"]))
        memory.rename("mug", "cup")
        assert content(then) == before
        assert then.stats().views == 2
        assert then.verify() == ()
    assert ids(memory) == ["v1", "v3"]
    with pytest.raises(MemoryFormatError, match="closed"):
        then.view("v1")


def test_a_listing_under_way_does_not_see_later_writes(memory: PerceptualMemory, make_view: MakeView) -> None:
    memory.write(Batch([make_view(f"v{number}") for number in range(4)]))
    views = memory.views()
    first = next(views).id
    memory.forget("mug")
    assert [first, *(view.id for view in views)] == ["v0", "v1", "v2", "v3"]


def test_a_closed_memory_says_so(memory: PerceptualMemory, make_view: MakeView) -> None:
    memory.write(Batch([make_view("v1"), make_view("v2")]))
    views: Iterator[View] = memory.views()
    next(views)
    memory.close()
    memory.close()
    for ask in (
        memory.categories,
        memory.stats,
        memory.verify,
        lambda: memory.view("v1"),
        lambda: memory.write(Batch()),
    ):
        with pytest.raises(MemoryFormatError, match="this memory is closed"):
            ask()


def test_verify_tells_how_far_it_is(tmp_path: Path, make_view: MakeView) -> None:
    seen: list[tuple[int, int]] = []
    with LevelMemory.open(tmp_path / "m", create=True) as memory:
        memory.write(Batch([make_view("v1"), make_view("v2")]))
        memory.verify(lambda done, total: seen.append((done, total)))
    assert seen == [(1, 2), (2, 2)]


def test_times_are_kept_to_the_microsecond_in_utc(memory: PerceptualMemory, make_view: MakeView) -> None:
    time = make_view("x").time.replace(microsecond=123456)
    elsewhere = time.astimezone(timezone(timedelta(hours=5, minutes=30)))
    memory.write(Batch([View("v1", "mug", elsewhere, {})]))
    assert memory.view("v1").time == time
    assert memory.view("v1").time.utcoffset() == timedelta(0)
    assert next(iter(memory.listing())).time == time
