"""Damaged views are left out and named."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import plyvel
import pytest

from deixis.memory.perceptual.database import keys
from deixis.memory.perceptual.level import LevelMemory, UndamagedMemory
from deixis.memory.perceptual.records import View

Content = Callable[..., Any]
Make = Callable[..., View]


def spoil(folder: Path, kind: bytes, number: int) -> None:
    """Change a value without LevelDB noticing."""
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
            "view 'fork-1-0' of 'fork': its arrays differ from what was written",
            "view 'mug-0-1' of 'mug': its header differs from what was written",
            "the record of category 'plate' differs from what was written",
        ]


def test_a_memory_that_is_whole_reads_the_same(kept: Path, content: Content) -> None:
    with LevelMemory.open(kept) as memory, UndamagedMemory.open(kept) as readable:
        assert content(readable) == content(memory)
        assert readable.left_out == []


def test_a_views_arrays_are_its_own(make_view: Make) -> None:
    """Change the original array of a view: the view has a copy."""
    array = np.ones((2, 3), np.float32, order="F")
    view = View("v", "mug", make_view("x").time, {"n": array})
    array[:] = 0
    assert view.descriptors["n"].tolist() == [[1, 1, 1], [1, 1, 1]]
    with pytest.raises(ValueError, match="read-only"):
        view.descriptors["n"][0, 0] = 2
