"""Temporary folders, and processes that work in them: neither outlives the process that made it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from deixis import scratch
from deixis.scratch import ScratchFolder, remove_stale, scratch_folder

WAITING = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts background jobs with SIGINT ignored
signal.signal(signal.SIGHUP, signal.SIG_DFL)  # nohup ignores it
from deixis.reasoning.description_logic import reasoners
reasoners._java = lambda arguments: ["sleep", "600"]  # a reasoner that takes long
reasoners.classify("")
print("was not ended")
"""


def children_of(process: int) -> list[int]:
    return [int(child) for child in Path(f"/proc/{process}/task/{process}/children").read_text().split()]


def is_running(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


@pytest.fixture
def temporary(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Empty folder in which scratch folders are made."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(scratch, "MIN_AGE", 0.0)
    return tmp_path


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="processes are looked up in /proc")
@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGKILL])
def test_a_reasoner_ends_with_the_process_that_runs_it(temporary: Path, end: signal.Signals) -> None:
    deadline = time.monotonic() + 60
    with subprocess.Popen([sys.executable, "-c", WAITING], stderr=subprocess.DEVNULL) as run:
        try:
            while not (reasoners := children_of(run.pid)):
                assert time.monotonic() < deadline and run.poll() is None
                time.sleep(0.02)
            time.sleep(0.2)  # until it has become the reasoner
            os.kill(run.pid, end)
            assert run.wait(30) == -end
        finally:
            run.kill()
    while any(map(is_running, reasoners)):
        assert time.monotonic() < deadline
        time.sleep(0.02)
    if end is not signal.SIGKILL:
        assert list(temporary.iterdir()) == []
    remove_stale()
    assert list(temporary.iterdir()) == []


def test_a_folder_in_use_is_not_stale(temporary: Path) -> None:
    with scratch_folder() as folder:
        remove_stale()
        assert folder.parent == temporary and folder.is_dir()
    other = ScratchFolder()
    dead = temporary / f"deixis-{2**22 + 1}-held"  # no process has that number; another container's holds the lock
    other.path.rename(dead)
    remove_stale()
    assert dead.is_dir()
    os.close(other._descriptor)
    remove_stale()
    assert not dead.exists()


def test_only_scratch_folders_are_removed(temporary: Path) -> None:
    (temporary / "deixis-notes").mkdir()
    (temporary / f"deixis-{2**22 + 1}-file").write_text("x")
    remove_stale()
    assert len(list(temporary.iterdir())) == 2


def test_signals_are_handled_as_before_once_the_work_is_done(temporary: Path) -> None:
    before = {number: signal.signal(number, signal.SIG_DFL) for number in scratch.ENDING_SIGNALS}
    first = scratch.ENDING_SIGNALS[0]
    try:
        with scratch_folder():
            assert all(callable(signal.getsignal(number)) for number in scratch.ENDING_SIGNALS)
        assert all(signal.getsignal(number) is signal.SIG_DFL for number in scratch.ENDING_SIGNALS)
        signal.signal(first, signal.SIG_IGN)
        with scratch_folder():
            assert signal.getsignal(first) is signal.SIG_IGN
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
