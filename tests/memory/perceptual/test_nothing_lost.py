"""No acknowledged write is lost: processes killed at random moments, full disks, read-only folders."""

from __future__ import annotations

import random
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from killing import forks_of
from read_only import make_read_only

from deixis.memory.errors import MemoryWriteError, ReadOnlyMemoryError
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.records import Batch, View

KILLS = 50

WRITERS = """
import os
from datetime import UTC, datetime
import numpy as np
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.records import Batch, CategoryRecord, View

def work(folder, seed):
    category, now = f"c{seed}", datetime(2026, 5, 1, tzinfo=UTC)
    memory = LevelMemory.open(folder, create=True)
    for turn in range(1, 100_000):
        array = np.full((100, 15), turn, np.float32)
        views = [View(f"{seed}-{turn}-{place}", category, now, {"n": array}) for place in range(turn % 5 + 1)]
        old = turn - 3
        gone = [f"{seed}-{old}-{place}" for place in range(old % 5 + 1)] if old > 0 else []
        memory.write(Batch(views, [CategoryRecord(category, {"turn": np.array(turn)})], gone))
        os.write(1, b"acknowledged %d\\n" % turn)
"""


def check(memory: LevelMemory, seed: int, acknowledged: int) -> int:
    """Return the last turn of a seed, after checking that just its views are complete."""
    category = f"c{seed}"
    if category not in memory.categories():
        assert acknowledged == 0
        return 0
    turn = int(memory.category(category).state["turn"])
    assert turn in (acknowledged, acknowledged + 1)
    turns = range(max(1, turn - 2), turn + 1)
    expected = {f"{seed}-{number}-{place}": number for number in turns for place in range(number % 5 + 1)}
    assert {view.id: int(view.descriptors["n"].mean()) for view in memory.views(category)} == expected
    return turn


@pytest.mark.slow
def test_kills_lose_no_acknowledged_batch_and_leave_no_half_one(tmp_path: Path) -> None:
    """Open the memory after every fifth kill; the children in between start where one was killed."""
    rng, folder = random.Random(3), tmp_path / "m"
    acknowledged, turns = dict[int, int](), dict[int, int]()
    with forks_of(WRITERS) as writers:
        for seed in range(KILLS):
            said = writers.kill_after(folder, seed, rng.randrange(8), rng.uniform(0, 0.02))
            assert said == [f"acknowledged {turn}" for turn in range(1, len(said) + 1)]
            acknowledged[seed] = len(said)
            if seed % 5 == 4:
                with LevelMemory.open(folder, create=True) as memory:
                    turns |= {each: check(memory, each, acknowledged[each]) for each in range(seed - 4, seed + 1)}
                    assert memory.stats().lost == 0
    with LevelMemory.open(folder) as memory:
        for seed, turn in turns.items():
            assert check(memory, seed, turn) == turn
        assert memory.verify() == ()
    assert sum(turn > 3 for turn in turns.values()) >= KILLS / 4, turns


FILLER = """
import resource, sys
from datetime import UTC, datetime
import numpy as np
from deixis.memory.errors import MemoryWriteError, ReadOnlyMemoryError
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.records import Batch, View

memory = LevelMemory.open(sys.argv[1])
limit = int(sys.argv[2])
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
now, array = datetime(2026, 5, 1, tzinfo=UTC), np.ones((100, 153), np.float32)
views = [View(f"n{n}", "new", now, {"n": array}) for n in range(99)]
done = 0
try:
    for view in views:
        memory.write(Batch([view]))
        done += 1
except MemoryWriteError as error:
    print(done)
    print(error)
try:
    memory.write(Batch([]))
except MemoryWriteError as error:
    print(error)
memory.view("fork-1-0")
memory.close()
"""


@pytest.mark.parametrize("limit", [2_000, 100_000, 1_000_000])
def test_a_full_disk_is_a_one_line_error_and_loses_nothing(kept: Path, content: Callable[..., Any], limit: int) -> None:
    with LevelMemory.open(kept) as memory:
        before = content(memory)[0]
    run = subprocess.run(
        [sys.executable, "-c", FILLER, str(kept), str(limit)], capture_output=True, text=True, timeout=60
    )
    assert not run.stderr, run.stderr
    done, first, second = run.stdout.splitlines()
    assert "could not be read or written (IO error" in first and "check that the disk has room" in first
    assert "an earlier write" in second and "open it again" in second
    with LevelMemory.open(kept) as memory:
        assert sorted(view.id for view in memory.views() if view.category == "new") == sorted(
            f"n{n}" for n in range(int(done))
        )
        if int(done):
            memory.forget("new")
        assert content(memory)[0] == before
        assert memory.verify() == ()
        assert memory.stats().lost == 0


def test_creating_on_a_full_disk_leaves_nothing_behind(tmp_path: Path) -> None:
    code = (
        "import resource, sys; from deixis.memory.perceptual.level import LevelMemory\n"
        "from deixis.memory.errors import MemoryWriteError\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (20, 20))\n"
        "try: LevelMemory.open(sys.argv[1], create=True)\n"
        "except MemoryWriteError as error: print(error)\n"
    )
    run = subprocess.run([sys.executable, "-c", code, str(tmp_path / "m")], capture_output=True, text=True, timeout=60)
    assert len(run.stdout.splitlines()) == 1, run.stderr
    assert not (tmp_path / "m").exists()


def test_a_read_only_folder_is_read_and_refuses_writes(
    kept: Path, content: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    with LevelMemory.open(kept) as memory:
        before = content(memory)
    files = {file: file.stat().st_mtime_ns for file in kept.rglob("*")}
    with monkeypatch.context() as patched:
        make_read_only(kept, patched)
        with LevelMemory.open(kept) as memory:
            assert content(memory) == before and memory.verify() == ()
            with pytest.raises(ReadOnlyMemoryError, match="cannot be opened for writing: Read-only file system"):
                memory.forget("mug")
            assert content(memory) == before
        with pytest.raises(MemoryWriteError, match="cannot be opened for writing"):
            LevelMemory.open(kept / "new", create=True)
    assert {file: file.stat().st_mtime_ns for file in kept.rglob("*")} == files
    LevelMemory.open(kept).close()


def test_a_place_where_no_folder_can_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(MemoryWriteError, match="cannot be created"):
        LevelMemory.open(tmp_path / "file" / "m", create=True)


def test_what_was_written_survives_closing_and_opening(kept: Path, make_view: Callable[..., View]) -> None:
    for number in range(5):
        with LevelMemory.open(kept) as memory:
            memory.write(Batch([make_view(f"again-{number}")]), sync=number % 2 == 0)
            assert memory.stats().views == 7 + number + 4
