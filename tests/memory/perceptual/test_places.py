"""Views are found by id at any place, at any moment, and also where their headers are damaged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import plyvel
import pytest

from deixis.memory.errors import DamagedMemoryError, UnknownViewError
from deixis.memory.perceptual.database import keys
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.records import Batch, View

Make = Callable[..., View]


def test_a_snapshot_finds_views_where_they_were(kept: Path, make_view: Make) -> None:
    with LevelMemory.open(kept) as memory, memory.snapshot() as before:
        memory.rename("mug", "cup")
        memory.write(Batch([make_view("new"), make_view("plate-0-1", "dish", 7, 7)], forgotten=["fork-1-0"]))
        with memory.snapshot() as after:
            memory.forget("cup")
            assert before.view("mug-0-0").category == "mug"
            assert before.view("fork-1-0").category == "fork"
            assert before.view("plate-0-1").category == "plate"
            assert after.view("mug-0-0").category == "cup"
            assert after.view("plate-0-1").category == "dish"
            for reading, gone in ((before, "new"), (after, "fork-1-0"), (memory, "mug-0-0")):
                with pytest.raises(UnknownViewError):
                    reading.view(gone)
        assert memory.stats().views == len(list(memory.listing())) == memory.snapshot().counts().views
        assert memory.verify() == ()


def test_a_reopened_memory_knows_which_view_is_replaced(kept: Path, make_view: Make) -> None:
    with LevelMemory.open(kept) as memory:
        memory.write(Batch([make_view("mug-0-0", "fork", 9, 9)]))
        assert [key.id for key in memory.listing("mug")] == ["mug-0-1", "mug-0-2", "mug-1-0", "mug-1-1"]
        assert memory.view("mug-0-0").category == "fork"
        assert memory.stats().views == 10
        assert memory.verify() == ()


@pytest.fixture
def spoilt(kept: Path) -> Path:
    """Memory with a renamed view whose header is unreadable, so that the place of its arrays is unknown."""
    with LevelMemory.open(kept) as memory:
        memory.rename("plate", "dish")
    with plyvel.DB(str(kept / "store-2")) as db:
        key, value = next(db.iterator(prefix=keys.category_prefix("dish")))
        db.put(key, value[:-1] + bytes([value[-1] ^ 1]))
    (kept / "seal.json").unlink()
    return kept


def test_rewriting_a_view_repairs_its_damaged_header(spoilt: Path, make_view: Make) -> None:
    with LevelMemory.open(spoilt) as memory:
        assert [finding.where for finding in memory.verify()] == ["view 'plate-0-0' of 'dish'"]
        with pytest.raises(DamagedMemoryError, match="teach it again, or forget the category; nothing was changed"):
            memory.rename("dish", "plate")
        memory.write(Batch([make_view("plate-0-0", "dish")]))
        assert memory.verify() == ()
        assert memory.stats().views == 10


def test_a_view_with_a_damaged_note_is_forgotten_with_its_arrays(spoilt: Path) -> None:
    with LevelMemory.open(spoilt) as memory:
        memory.forget("dish")
        assert memory.verify() == ()
        assert memory.stats().views == 7


def test_nothing_is_written_where_keys_cannot_be_read(kept: Path, make_view: Make) -> None:
    """Otherwise a view could be written beside an older one with its id. Views before the damage are still found."""
    with LevelMemory.open(kept) as memory:
        views = [make_view(f"z{number:02}", "zoo") for number in range(99)]
        memory.write(Batch([replace(view, metadata={"note": f"marker {view.id}" * 9}) for view in views]))
    for table in (kept / "store-2").glob("*.ldb"):
        table.write_bytes(table.read_bytes().replace(b"marker z50", b"marker y50"))
    with LevelMemory.open(kept) as memory:
        assert memory.view("mug-0-0").category == "mug"
        for act in (
            lambda: memory.write(Batch([make_view("new")])),
            lambda: memory.forget("mug"),
            lambda: memory.view("z50"),
            lambda: list(memory.views()),
        ):
            with pytest.raises(DamagedMemoryError, match=r"is damaged .*orruption.*; restore the folder from a copy"):
                act()
        assert any(finding.where == "order of views" for finding in memory.verify())
