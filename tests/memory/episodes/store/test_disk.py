"""The blackboard on disk: durable, one owner, and sound after kills, a full disk and damage."""

from __future__ import annotations

import fcntl
import random
import subprocess
import sys
from pathlib import Path

import pytest
from episodic_fluents import on
from killing import forks_of
from read_only import make_read_only

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Finish
from deixis.memory.errors import (
    DamagedMemoryError,
    EpisodeError,
    MemoryBusyError,
    MemoryFormatError,
    ReadOnlyMemoryError,
)
from deixis.memory.verify import verify
from deixis.reasoning.temporal.fluent import Pattern


def test_content_survives_closing_and_opening(tmp_path: Path) -> None:
    with Blackboard.open(tmp_path / "m", create=True) as board:
        board.write(*(Add(on(f"f{n}", float(n))) for n in range(9)), by="test")
        board.write(Finish("f3", 20.0), by="test")
        before = board.holding(), board.now(), list(board.changes()), board.origin
        assert board.new_id("t") == "t1"
    with Blackboard.open(tmp_path / "m") as board:
        assert (board.holding(), board.now(), list(board.changes()), board.origin) == before
        assert board.new_id("t") == "t2"
        assert board.add(on("f10"), by="test") == 11


def test_users_of_one_process_share_the_blackboard(tmp_path: Path) -> None:
    one, other = Blackboard.open(tmp_path, create=True), Blackboard.open(tmp_path)
    one.add(on("f1"), by="test")
    one.close()
    assert [each.id for each in other.now()] == ["f1"]
    other.close()
    with pytest.raises(EpisodeError, match="the blackboard is closed"):
        one.now()


def test_owner_of_a_held_blackboard_is_named(tmp_path: Path) -> None:
    Blackboard.open(tmp_path, create=True).close()
    with (tmp_path / "episodes" / "owner.lock").open("r+") as file:
        fcntl.flock(file, fcntl.LOCK_EX)  # as another process would
        file.write('{"pid": 77, "command": "robot", "since": "noon"}')
        file.flush()
        with pytest.raises(MemoryBusyError, match=r"in use by process 77 \(robot\) since noon"):
            Blackboard.open(tmp_path)


def test_folder_without_episodes_is_named(tmp_path: Path) -> None:
    with pytest.raises(MemoryFormatError, match="there are no episodes at"):
        Blackboard.open(tmp_path)
    (tmp_path / "letter.txt").write_text("x")
    with pytest.raises(MemoryFormatError, match="is not a memory"):
        Blackboard.open(tmp_path, create=True)


def test_damaged_value_is_reported(tmp_path: Path) -> None:
    with Blackboard.open(tmp_path, create=True) as board:
        board.add(on("f1"), by="test")
        board._keys._db.put(b"ff1", b"something else")  # type: ignore[attr-defined]
        with pytest.raises(DamagedMemoryError, match="differs from what was written"):
            board.holding(Pattern("cup"))


def test_verify_finds_a_fluent_that_differs_from_the_log(tmp_path: Path) -> None:
    with Blackboard.open(tmp_path, create=True) as board:
        board.write(Add(on("f1", 1.0)), Add(on("f2", 1.0)), Finish("f1", 2.0), by="test")
        assert list(board.verify()) == []
    assert verify(tmp_path).findings == ()
    with Blackboard.open(tmp_path) as board:
        board._keys.write({b"ff1": None})
    assert [each.what for each in verify(tmp_path).findings] == [
        "the fluent 'f1' differs from the log",
        "the index of times and the fluents disagree about 'f1'",
    ]


WRITER = """
import os
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic

def work(folder, seed):
    board = Blackboard.open(folder, create=True)
    source = Source(Origin.SEEN, "tracker")
    for turn in range(1000):
        ids = [f"{seed}.{turn}.{n}" for n in range(1 + turn % 3)]
        board.write(*(Add(episodic(id, ("cup", "moves"), start=turn, source=source)) for id in ids), by="w")
        os.write(1, b"acknowledged %d\\n" % board.sequence)
"""


@pytest.mark.kills
def test_kills_lose_no_acknowledged_write(tmp_path: Path) -> None:
    rng, acknowledged = random.Random(1), 0
    with forks_of(WRITER) as writers:
        for seed in range(6):
            said = writers.kill_after(tmp_path / "m", seed, rng.randrange(8), rng.uniform(0, 0.02))
            acknowledged = int(said[-1].split()[1]) if said else acknowledged
            with Blackboard.open(tmp_path / "m", create=True) as board:
                assert board.sequence >= acknowledged
                log = list(board.changes())
                assert [change.sequence for change in log] == list(range(1, board.sequence + 1))
                assert {change.id for change in log} == {each.id for each in board.holding()}
                assert all(log[change.last - 1].last == change.last for change in log)
                assert board.troubles == ()


FILLER = """
import resource, sys
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.memory.errors import MemoryWriteError

board = Blackboard.open(sys.argv[1], create=True)
old = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, old[1]))
def add(n):
    board.add(episodic(f"f{n}", ("cup", "said", "x" * 2000), start=n, source=Source(Origin.SEEN, "t")), by="t")
for n in range(1000):
    try:
        add(n)
    except MemoryWriteError as error:
        print(n, error)
        break
try:
    add(n)
except MemoryWriteError as error:
    print(n, error)
assert len(board.now()) == n and board.sequence == n
resource.setrlimit(resource.RLIMIT_FSIZE, old)
add(n)
board.close()
"""


def test_full_disk_is_one_line_and_writing_goes_on_later(tmp_path: Path) -> None:
    run = subprocess.run([sys.executable, "-c", FILLER, str(tmp_path)], capture_output=True, text=True, timeout=60)
    assert not run.stderr, run.stderr
    first, second = run.stdout.splitlines()
    assert "check that the disk has room" in first
    assert "the next try" in second
    number = int(first.split()[0])
    with Blackboard.open(tmp_path) as board:
        assert [each.id for each in board.now()] == [f"f{n}" for n in range(number + 1)]
        assert [change.sequence for change in board.changes()] == list(range(1, number + 2))


def test_forked_child_is_refused(tmp_path: Path) -> None:
    code = (
        "import os, sys; from deixis.memory.episodes.blackboard import Blackboard\n"
        "board = Blackboard.open(sys.argv[1], create=True)\n"
        "if os.fork() == 0:\n"
        "    try: board.new_id('t')\n"
        "    except Exception as error: print(type(error).__name__, flush=True)\n"
        "    os._exit(0)\n"
        "os.wait(); print(board.new_id('t')); board.close()"
    )
    run = subprocess.run([sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, timeout=60)
    assert run.stdout.splitlines() == [MemoryBusyError.__name__, "t1"], run.stderr


def test_episodes_that_cannot_be_written_are_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with Blackboard.open(tmp_path, create=True) as board:
        board.write(Add(on("f1")), by="test")
    make_read_only(tmp_path, monkeypatch)
    with Blackboard.open(tmp_path) as board:
        assert [each.id for each in board.now()] == ["f1"]
        with pytest.raises(ReadOnlyMemoryError):
            board.require_writable()
        with pytest.raises(ReadOnlyMemoryError):
            board.write(Add(on("f2")), by="test")
