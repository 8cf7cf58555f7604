"""What is damaged is left out and named, and what is kept for something that fails is taken back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import plyvel
import pytest

from deixis.errors import DeixisError
from deixis.memory.errors import MemoryWriteError
from deixis.memory.perceptual import keys
from deixis.memory.perceptual.in_folder import restored_on_failure
from deixis.memory.perceptual.level import LevelMemory, UndamagedMemory
from deixis.memory.perceptual.protocol import PerceptualMemory
from deixis.memory.perceptual.records import Batch, CategoryRecord, View

Content = Callable[..., Any]
Make = Callable[..., View]


def spoil(folder: Path, kind: bytes, number: int) -> None:
    """Changes a value behind LevelDB's checksums."""
    with plyvel.DB(str(folder / "store-2")) as db:
        key, value = list(db.iterator(prefix=kind))[number]
        db.put(key, value[:-1] + bytes([value[-1] ^ 1]))
    (folder / "seal.json").unlink(missing_ok=True)


def test_damaged_views_and_records_are_left_out_and_named(kept: Path) -> None:
    with LevelMemory.open(kept) as memory:
        whole = [key.id for key in memory.listing()]
    spoil(kept, keys.ARRAYS, 0)
    spoil(kept, keys.VIEW, 3)
    spoil(kept, keys.CATEGORY, 2)
    with UndamagedMemory.open(kept) as memory:
        assert [view.id for view in memory.views()] == [whole[1], whole[2], *whole[4:]]
        assert [key.id for key in memory.listing("fork")] == ["fork-1-1"]
        assert memory.categories() == ("fork", "mug", "plate")
        assert dict(memory.category("plate").state) == {}
        assert memory.left_out == [
            "view 'fork-1-0' of 'fork': its arrays are not what was written",
            "view 'mug-0-1' of 'mug': what is said of it is not what was written",
            "what is known of category 'plate' is not what was written",
        ]


def test_a_memory_that_is_whole_reads_the_same(kept: Path, content: Content) -> None:
    with LevelMemory.open(kept) as memory, UndamagedMemory.open(kept) as readable:
        assert content(readable) == content(memory)
        assert readable.left_out == []


def test_what_was_kept_for_something_that_fails_is_taken_back(
    memory: PerceptualMemory, make_view: Make, make_record: Callable[..., CategoryRecord], content: Content
) -> None:
    memory.write(Batch([make_view("a", "mug"), make_view("b", "mug")], [make_record("mug")]))
    before = content(memory)
    views = [make_view("a", "cup", 5, 5), make_view("new", "fork")]

    def keep_and_fail() -> None:
        with restored_on_failure(memory, views):
            memory.write(Batch(views, [CategoryRecord("mug"), make_record("cup"), make_record("fork")]))
            raise DeixisError("refused")

    with pytest.raises(DeixisError, match="refused"):
        keep_and_fail()
    assert content(memory) == before
    with restored_on_failure(memory, views):
        memory.write(Batch(views))
    assert memory.view("a").category == "cup"


def test_what_cannot_be_taken_back_is_told(
    memory: PerceptualMemory, make_view: Make, monkeypatch: pytest.MonkeyPatch
) -> None:
    view = make_view("a")

    def full(*_: object) -> None:
        raise MemoryWriteError("the disk is full")

    def keep_and_fail() -> None:
        with restored_on_failure(memory, [view]):
            memory.write(Batch([view]))
            monkeypatch.setattr(memory, "write", full)
            raise DeixisError("the lesson was refused")

    with pytest.raises(MemoryWriteError, match=r"the lesson was refused; .* stays kept all the same: the disk is full"):
        keep_and_fail()
    assert memory.view("a").id == "a"


def test_a_views_arrays_are_its_own(make_view: Make) -> None:
    """A view is laid out when it is made: whoever changes the array that it came from changes nothing in it."""
    array = np.ones((2, 3), np.float32, order="F")
    view = View("v", "mug", make_view("x").time, {"n": array})
    array[:] = 0
    assert view.descriptors["n"].tolist() == [[1, 1, 1], [1, 1, 1]]
    with pytest.raises(ValueError, match="read-only"):
        view.descriptors["n"][0, 0] = 2
