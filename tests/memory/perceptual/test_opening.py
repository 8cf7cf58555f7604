"""Open a perceptual memory: new, foreign, old, newer, in use by another process, changed while closed."""

from __future__ import annotations

import hashlib
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import plyvel
import pytest

from deixis.memory import owner as disk
from deixis.memory.errors import DamagedMemoryError, MemoryBusyError, MemoryFormatError, MemoryWriteError
from deixis.memory.owner import OwnerLock
from deixis.memory.perceptual.database import keys
from deixis.memory.perceptual.database.migrations import MIGRATIONS
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.records import Batch, CategoryRecord, View
from deixis.memory.perceptual.transient import TransientMemory

Content = Callable[..., Any]


def digest(folder: Path) -> dict[str, str]:
    return {
        str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in sorted(folder.rglob("*"))
        if file.is_file()
    }


def content_of(folder: Path, content: Content) -> Any:
    with LevelMemory.open(folder) as memory:
        return content(memory)


def test_a_new_memory_is_made_only_when_asked(tmp_path: Path) -> None:
    with pytest.raises(MemoryFormatError, match="there is no perceptual memory at"):
        LevelMemory.open(tmp_path / "a" / "b")
    assert not (tmp_path / "a").exists()
    LevelMemory.open(tmp_path / "a" / "b", create=True).close()
    assert sorted(entry.name for entry in (tmp_path / "a" / "b").iterdir()) == [
        "acknowledged",
        "owner.lock",
        "seal.json",
        "store-2",
    ]


def test_a_foreign_folder_a_file_and_a_dead_link_are_left_alone(tmp_path: Path) -> None:
    folder = tmp_path / "f"
    folder.mkdir()
    (folder / "letter.txt").write_text("dear")
    (tmp_path / "link").symlink_to(tmp_path / "gone")
    for path, message in (
        (folder, r"it has other files \(letter.txt\)"),
        (folder / "letter.txt", "is a file"),
        (tmp_path / "link", "broken link"),
    ):
        with pytest.raises(MemoryFormatError, match=message):
            LevelMemory.open(path, create=True)
    assert [entry.name for entry in folder.iterdir()] == ["letter.txt"]


def test_a_newer_memory_is_an_error_and_is_not_changed(kept: Path) -> None:
    (kept / "store-2").rename(kept / "store-7")
    before = digest(kept)
    with pytest.raises(MemoryFormatError, match=r"written by a newer version \(format 7, .* knows 2\); upgrade deixis"):
        LevelMemory.open(kept, create=True)
    assert digest(kept) == before


def test_a_version_without_a_migration_is_an_error(kept: Path) -> None:
    (kept / "store-2").rename(kept / "store-0")
    with pytest.raises(MemoryFormatError, match="unknown format version 0"):
        LevelMemory.open(kept)


@pytest.fixture
def version_1(tmp_path: Path) -> Path:
    """Closed memory in format version 1 with the views of :func:`content_of_version_1`."""
    folder = tmp_path / "old"
    with zipfile.ZipFile(Path(__file__).with_name("version-1.zip")) as archive:
        archive.extractall(folder)
    return folder


def content_of_version_1(content: Content) -> Any:
    noon, minute = datetime(2026, 5, 1, 12, tzinfo=UTC), timedelta(minutes=1)
    spin = (np.arange(45 * 101) % 7).astype(np.float32).reshape(45, 101)
    state = {
        "threshold": np.array(0.5),
        "icd": np.arange(4),
        "none": np.zeros((0, 3), np.float32),
        "odd": np.array([True, False, True]),
    }
    views = [
        View("v1", "mug", noon, {"spin": spin}, None, {"scene": "s1", "teacher": "Ada"}),
        View("v2", "mug", noon + minute, {"n": np.full((1, 3), 2, np.float32)}, np.eye(3, dtype=np.float32)),
        View("v3", "plate", noon, {"n": np.full((2, 1), 3, np.float32)}),
        View("v\0 4", "fork\0", noon, {}),
    ]
    with TransientMemory() as memory:
        memory.write(Batch(views, [CategoryRecord("mug", state, {"learner": "instances"}), CategoryRecord("plate")]))
        return content(memory)


def test_a_memory_of_version_1_is_brought_up_to_date(version_1: Path, content: Content) -> None:
    assert content_of(version_1, content) == content_of_version_1(content)
    assert sorted(entry.name for entry in (version_1).iterdir()) == [
        "acknowledged",
        "owner.lock",
        "seal.json",
        "store-2",
    ]
    with LevelMemory.open(version_1) as memory:
        assert memory.verify() == ()
        stats = memory.stats()
        assert (stats.views, stats.batches, stats.lost, stats.version) == (4, 3, 0, 2)
        memory.rename("plate", "saucer")
        assert memory.view("v3").category == "saucer"


@pytest.mark.parametrize(
    ("kind", "place", "told"),
    [
        (keys.ARRAYS, 500, "its arrays differ from what was written"),
        (keys.VIEW, -1, "its header differs from what was written"),
        (keys.CATEGORY, 100, "the record of category 'mug' differs from what was written"),
    ],
)
def test_what_was_damaged_in_version_1_stays_damaged(version_1: Path, kind: bytes, place: int, told: str) -> None:
    with plyvel.DB(str(version_1 / "store-1")) as db:
        key, value = next((key, value) for key, value in db.iterator(prefix=kind) if len(value) > 100 or place < 0)
        changed = bytearray(value)
        changed[place] ^= 1
        db.put(key, bytes(changed))
    (version_1 / "seal.json").unlink()
    with LevelMemory.open(version_1) as memory:
        (finding,) = memory.verify()
        assert told in str(finding)


def test_no_byte_that_flipped_in_version_1_gives_a_wrong_value(
    version_1: Path, tmp_path: Path, content: Content
) -> None:
    expected = content_of_version_1(content)
    (version_1 / "seal.json").unlink()
    (table,) = (version_1 / "store-1").glob("*.ldb")
    whole = table.read_bytes()
    told = 0
    for place in range(3, len(whole), len(whole) // 40):
        copy = tmp_path / "copy"
        shutil.copytree(version_1, copy)
        changed = bytearray(whole)
        changed[place] ^= 1 + place % 255
        (copy / "store-1" / table.name).write_bytes(changed)
        try:
            with LevelMemory.open(copy) as memory:
                if not memory.verify():
                    assert content(memory) == expected
                else:
                    told += 1
        except DamagedMemoryError:
            told += 1
        shutil.rmtree(copy)
    assert told >= 20


def make_older(folder: Path) -> None:
    """Convert a memory of version 1 to a version 0, whose keys all began with ``old:``."""
    with plyvel.DB(str(folder / "store-1")) as new, plyvel.DB(str(folder / "store-0"), create_if_missing=True) as old:
        for key, value in new.iterator():
            old.put(b"old:" + key, value)
    disk.remove(folder / "store-1")
    (folder / "seal.json").unlink()


def from_0(old: plyvel.DB, new: plyvel.DB) -> None:
    for key, value in old.iterator(verify_checksums=True):
        new.put(key.removeprefix(b"old:"), value)


def test_an_older_memory_takes_several_steps(
    version_1: Path, content: Content, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_older(version_1)
    monkeypatch.setitem(MIGRATIONS, 0, from_0)
    assert content_of(version_1, content) == content_of_version_1(content)
    assert sorted(entry.name for entry in (version_1).iterdir()) == [
        "acknowledged",
        "owner.lock",
        "seal.json",
        "store-2",
    ]
    with LevelMemory.open(version_1) as memory:
        assert memory.verify() == ()
        assert memory.stats().lost == 0


@pytest.mark.parametrize("steps", range(8))
def test_a_crash_while_migrating_loses_nothing(
    version_1: Path, content: Content, steps: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_older(version_1)
    monkeypatch.setitem(MIGRATIONS, 0, from_0)
    left = [steps]

    def crashing(real: Callable[..., None]) -> Callable[..., None]:
        def step(*given: Any) -> None:
            if left[0] == 0:
                raise KeyboardInterrupt
            left[0] -= 1
            real(*given)

        return step

    with monkeypatch.context() as patched:
        patched.setattr(disk, "rename", crashing(disk.rename))
        patched.setattr(disk, "remove", crashing(disk.remove))
        for version, migration in list(MIGRATIONS.items()):
            patched.setitem(MIGRATIONS, version, crashing(migration))
        with pytest.raises(KeyboardInterrupt):
            LevelMemory.open(version_1)
    assert content_of(version_1, content) == content_of_version_1(content)


def test_a_second_opening_in_one_process_shares_the_handle(
    kept: Path, tmp_path: Path, make_view: Callable[..., View]
) -> None:
    (tmp_path / "link").symlink_to(kept)
    with LevelMemory.open(kept) as one, LevelMemory.open(tmp_path / "link") as two:
        assert one.handle is two.handle
        two.write(Batch([make_view("new")]))
        one.close()
        one.close()
        assert two.view("new").category == "mug"
        with pytest.raises(MemoryFormatError, match="closed"):
            one.categories()
        with pytest.raises(plyvel.Error, match="lock"):
            plyvel.DB(str(kept / "store-2"))
    with plyvel.DB(str(kept / "store-2")) as free:
        assert list(free.iterator(prefix=keys.category_prefix("mug") + b"new"))


HOLDER = """
import sys, time
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.database.migrations import MIGRATIONS
memory = LevelMemory.open(sys.argv[1])
print("open", flush=True)
time.sleep(60)
"""


def test_a_living_owner_is_named_and_a_dead_one_is_ignored(kept: Path, content: Content) -> None:
    before = content_of(kept, content)
    holder = subprocess.Popen([sys.executable, "-c", HOLDER, str(kept)], stdout=subprocess.PIPE, text=True)
    try:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "open\n"
        with pytest.raises(MemoryBusyError, match=rf"in use by process {holder.pid} \(.*\) since \d{{4}}-"):
            LevelMemory.open(kept)
    finally:
        holder.kill()
        holder.wait()
        if holder.stdout:
            holder.stdout.close()
    assert content_of(kept, content) == before


def test_the_second_of_two_creators_keeps_the_first_memory(
    kept: Path, tmp_path: Path, content: Content, monkeypatch: pytest.MonkeyPatch
) -> None:
    before, place = content_of(kept, content), tmp_path / "new"

    def too_late(folder: Path) -> None:
        shutil.copytree(kept, folder, dirs_exist_ok=True)
        raise MemoryBusyError("in use by process 1")

    with monkeypatch.context() as patched:
        patched.setattr("deixis.memory.owner.OwnerLock.acquire", too_late)
        with pytest.raises(MemoryBusyError):
            LevelMemory.open(place, create=True)
    assert content_of(place, content) == before


@pytest.mark.parametrize("there", [False, True])
def test_a_failed_opening_removes_only_what_it_made(
    kept: Path, tmp_path: Path, content: Content, monkeypatch: pytest.MonkeyPatch, there: bool
) -> None:
    before, place, acquire = content_of(kept, content), tmp_path / "new", OwnerLock.acquire

    def after_another(folder: Path) -> OwnerLock:
        if there:
            shutil.copytree(kept, folder, dirs_exist_ok=True)
        return acquire(folder)

    def full(*rest: object) -> None:
        raise OSError("no space left on device")

    with monkeypatch.context() as patched:
        patched.setattr("deixis.memory.owner.OwnerLock.acquire", after_another)
        patched.setattr("deixis.memory.perceptual.database.handle._counted", full)
        with pytest.raises(MemoryWriteError):
            LevelMemory.open(place, create=True)
    assert place.exists() == there
    assert not there or content_of(place, content) == before


@pytest.mark.parametrize("name", ["MANIFEST-*", "CURRENT", "*.ldb", "*.log"])
def test_files_changed_while_closed_are_an_error(kept: Path, name: str) -> None:
    next((kept / "store-2").glob(name)).unlink()
    before = digest(kept)
    opens_rest = ", or delete seal.json to open what is left" if name == "*.log" else ""
    with pytest.raises(
        DamagedMemoryError, match=f"has changed since it was closed; restore the folder from a copy{opens_rest}$"
    ):
        LevelMemory.open(kept)
    assert digest(kept) == before


def test_without_a_seal_a_missing_table_is_still_told(kept: Path) -> None:
    (kept / "seal.json").unlink()
    next((kept / "store-2").glob("*.ldb")).unlink()
    with pytest.raises(DamagedMemoryError, match="missing files"):
        LevelMemory.open(kept)


def test_a_missing_current_without_a_seal_makes_no_new_memory(kept: Path) -> None:
    (kept / "seal.json").unlink()
    (kept / "store-2" / "CURRENT").unlink()
    with pytest.raises(DamagedMemoryError, match="damaged"):
        LevelMemory.open(kept, create=True)
    assert list((kept / "store-2").glob("*.ldb"))


def test_batches_that_were_acknowledged_and_are_gone_are_counted(
    kept: Path, tmp_path: Path, make_view: Callable[..., View]
) -> None:
    """Simulate a power cut: the end of the log never reached the disk, but the tally did."""
    power_cut = tmp_path / "cut"
    with LevelMemory.open(kept) as memory:
        shutil.copytree(kept, power_cut)
        memory.write(Batch([make_view("gone")]))
        memory.write(Batch([make_view("gone too")]))
        shutil.copy(kept / "acknowledged", power_cut)
    for _ in range(2):
        with LevelMemory.open(power_cut) as memory:
            assert memory.stats().lost == 2
            assert [str(finding) for finding in memory.verify()] == ["counts: 2 acknowledged batches are missing"]
            memory.write(Batch([make_view("after")]))


FORKER = """
import os, sys
from deixis.memory.errors import MemoryBusyError
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.records import Batch

memory = LevelMemory.open(sys.argv[1])
child = os.fork()
if child == 0:
    try:
        memory.write(Batch())
    except MemoryBusyError as error:
        print(error, flush=True)
    os._exit(0)
os.waitpid(child, 0)
memory.write(Batch())
print(memory.verify())
"""


def test_a_forked_child_cannot_write_its_parents_memory(kept: Path) -> None:
    run = subprocess.run([sys.executable, "-c", FORKER, str(kept)], capture_output=True, text=True, timeout=60)
    told, found = run.stdout.splitlines()
    assert f"{kept} is held by the process from which this one was forked" in told, run.stderr
    assert found == "()"
