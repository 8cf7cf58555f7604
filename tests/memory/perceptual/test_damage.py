"""A flipped byte of any file is detected or harmless, and never gives a wrong value."""

from __future__ import annotations

import contextlib
import random
import shutil
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import plyvel
import pytest

from deixis.errors import DeixisError
from deixis.memory.errors import DamagedMemoryError
from deixis.memory.perceptual.database import keys
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.records import Batch, View

Content = Callable[..., Any]
Said = Callable[..., dict[str, Any]]
FLIPS = 5  # positions in each file


def outcome(folder: Path, before: Any, content: Content, said: Said) -> str:
    """Return whether damage was detected, and where; fail for a wrong value or an unnoticed loss."""
    views, records = before
    known = {view["id"]: view for view in views} | {("record", record["name"]): record for record in records}
    try:
        memory = LevelMemory.open(folder)
    except DeixisError:
        return "refused"
    with memory:
        for view in views:
            with contextlib.suppress(DeixisError):
                assert said(memory.view(view["id"])) == known[view["id"]]
        for record in records:
            with contextlib.suppress(DeixisError):
                assert said(memory.category(record["name"])) == known["record", record["name"]]
        found = memory.verify()
        try:
            whole = content(memory) == before
        except DeixisError:
            assert found, "reading fails where verify finds nothing"
            return "found"
        assert whole or found, "something is missing, and nothing was said"
        return "found" if found else "harmless"


def flips(file: Path, rng: random.Random) -> Iterator[int]:
    """Return positions in a file: the first bytes, the last ones, and some in between."""
    size = file.stat().st_size
    places = {0, 4, 6, size - 1, size - 9, size // 2, *(rng.randrange(size) for _ in range(FLIPS))} if size else set()
    return (place for place in sorted(places) if 0 <= place < size)


@pytest.mark.slow
@pytest.mark.parametrize("state", ["closed", "killed", "without a seal"])
def test_a_flipped_byte_of_any_file_is_detected_or_harmless(
    kept: Path, tmp_path: Path, content: Content, said: Said, make_view: Callable[..., View], state: str
) -> None:
    """Test a closed memory, one whose process was killed, and one whose seal was deleted."""
    rng, outcomes = random.Random(state), Counter[str]()
    whole = tmp_path / "whole"
    with LevelMemory.open(kept) as memory:
        memory.write(Batch([make_view("last", "spoon")]))
        before = content(memory)
        if state == "killed":
            shutil.copytree(kept, whole)
    if state != "killed":
        shutil.copytree(kept, whole)
    if state == "without a seal":
        (whole / "seal.json").unlink()
    for file in sorted(path for path in whole.rglob("*") if path.is_file()):
        for place in flips(file, rng):
            copy = tmp_path / "copy"
            shutil.copytree(whole, copy)
            damaged = copy / file.relative_to(whole)
            changed = bytearray(damaged.read_bytes())
            changed[place] ^= rng.choice([1, 2, 128, 255, rng.randrange(1, 256)])
            damaged.write_bytes(changed)
            outcomes[f"{file.suffix or file.name.split('-')[0]}: {outcome(copy, before, content, said)}"] += 1
            shutil.rmtree(copy)
    detected = sum(number for name, number in outcomes.items() if not name.endswith("harmless"))
    assert detected >= sum(outcomes.values()) / 4, outcomes


def tampered(folder: Path, kind: bytes, change: Callable[[bytes], bytes | None]) -> None:
    """Change the first value of a kind in the database, with correct checksums of LevelDB."""
    with plyvel.DB(str(folder / "store-2")) as db:
        key, value = next(iter(db.iterator(prefix=kind)))
        new = change(value)
        db.delete(key) if new is None else db.put(key, new)
    (folder / "seal.json").unlink()


KINDS = {
    keys.VIEW: "header",
    keys.ARRAYS: "arrays",
    keys.CATEGORY: "category",
    keys.COUNT: "counts",
}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("position", [0, -1])
def test_a_change_with_right_leveldb_checksums_is_detected(kept: Path, kind: bytes, position: int) -> None:
    def flip(value: bytes) -> bytes:
        changed = bytearray(value)
        changed[position] ^= 1
        return bytes(changed)

    tampered(kept, kind, flip)
    if kind == keys.COUNT:
        with pytest.raises(DamagedMemoryError, match="the counts differ from what was written"):
            LevelMemory.open(kept)
        return
    with LevelMemory.open(kept) as memory:
        findings = memory.verify()
        assert any(KINDS[kind] in str(finding) for finding in findings), findings
        with pytest.raises(DamagedMemoryError, match=r"differs? from what was written"):
            [list(memory.views()), [memory.category(name) for name in memory.categories()]]


@pytest.mark.parametrize("kind", [keys.VIEW, keys.ARRAYS])
def test_a_missing_value_is_detected(kept: Path, kind: bytes) -> None:
    tampered(kept, kind, lambda value: None)
    with LevelMemory.open(kept) as memory:
        assert memory.verify()


def test_swapped_values_are_detected(kept: Path) -> None:
    with plyvel.DB(str(kept / "store-2")) as db:
        (one, first), (two, second) = list(db.iterator(prefix=keys.ARRAYS))[:2]
        db.put(one, second)
        db.put(two, first)
    (kept / "seal.json").unlink()
    with LevelMemory.open(kept) as memory:
        assert [finding.what.split(": ")[-1] for finding in memory.verify()] == [
            "its arrays differ from what was written"
        ] * 2
        with pytest.raises(DamagedMemoryError, match="view 'fork-1-0' of 'fork': its arrays differ from"):
            memory.view("fork-1-0")
        assert memory.view("plate-0-0").id == "plate-0-0"


def test_older_arrays_under_the_same_key_are_detected(kept: Path) -> None:
    """Simulate a damaged key of the newer arrays, so that LevelDB finds the older ones in another table."""
    with LevelMemory.open(kept) as memory:
        view = memory.view("fork-1-0")
        with memory.handle as db:
            older = dict(db.iterator(prefix=keys.ARRAYS))
        memory.write(Batch([replace(view, descriptors={name: array + 1 for name, array in view.descriptors.items()})]))
    with plyvel.DB(str(kept / "store-2")) as db:
        for key, sealed in older.items():
            db.put(key, sealed)
    (kept / "seal.json").unlink()
    with LevelMemory.open(kept) as memory:
        for read in (lambda: memory.view("fork-1-0"), lambda: list(memory.views("fork"))):
            with pytest.raises(DamagedMemoryError, match="'fork-1-0' of 'fork': its arrays differ from"):
                read()
        assert [finding.where for finding in memory.verify()] == ["view 'fork-1-0' of 'fork'"]


def test_other_views_stay_readable_beside_a_damaged_one(kept: Path, make_view: Callable[..., View]) -> None:
    tampered(kept, keys.ARRAYS, lambda value: b"")
    with LevelMemory.open(kept) as memory:
        assert len(memory.verify()) == 1
        memory.write(Batch([make_view("fork-1-0", "fork")]))
        assert memory.verify() == ()


def test_listing_reads_no_arrays(kept: Path) -> None:
    """List a memory whose arrays are all damaged: as listing does not read them, it also works for a huge memory."""
    with plyvel.DB(str(kept / "store-2")) as db:
        for key in list(db.iterator(prefix=keys.ARRAYS, include_value=False)):
            db.put(key, b"")
    (kept / "seal.json").unlink()
    with LevelMemory.open(kept) as memory:
        assert len(list(memory.listing())) == 10
        assert memory.categories() == ("fork", "mug", "plate")
        assert memory.stats().views == 10
        memory.rename("mug", "cup")
        assert len(memory.verify()) == 10
