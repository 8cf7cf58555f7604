"""Modules on one blackboard: the same tests for threads and processes."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from episodic_fluents import SEEN
from timing import BUSY_SECONDS, until

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import episodic
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot import processes
from deixis.robot.modules import Clock, ModuleError, ModuleSpec
from deixis.robot.runtime import Runtime

ECHO, TRESPASSER = ModuleSpec("robot_modules:Echo", {"fail_at": 3}), ModuleSpec("robot_modules:Trespasser")


def say(board: Blackboard, *words: str, predicate: str = "said") -> None:
    """Write what was said, one write a word."""
    for word in words:
        board.write(Add(episodic(board.new_id("s"), ("anna", predicate, word), start=0.0, source=SEEN)), by="anna")


def heard(board: Blackboard) -> list[str | None]:
    """Return what the echo heard, in the order of the log."""
    found = board.changes(pattern=Pattern(predicate="heard"))
    return [change.after.statement.object for change in found if change.after is not None]


@pytest.mark.parametrize("processes", [False, True], ids=["threads", "processes"])
def test_modules_get_changes_in_order_and_keep_to_declarations(tmp_path: Path, processes: bool) -> None:
    lines: list[str] = []
    words = [f"word {number}" for number in range(6)]
    with Blackboard.open(tmp_path, create=True) as board:
        with Runtime(board, [ECHO, TRESPASSER], processes, lines.append) as runtime:
            say(board, *words)
            assert until(lambda: len(heard(board)) == 6 and len(board.now(Pattern("trespasser"))) == 2), lines
            assert runtime.wait(board.sequence, BUSY_SECONDS)
            assert set(runtime.positions().values()) == {board.sequence}
        assert heard(board) == words
        assert [each.statement.object for each in board.now(Pattern("trespasser"))] == [
            "the module 'trespasser' must not write said(cup, hello); it declares refused",
            "the module 'trespasser' must not read said; it declares refused",
        ]
        assert [line for line in lines if "RuntimeError: no battery" in line], lines
        assert all("'echo' is failing" in line for line in lines), lines


@pytest.mark.parametrize("processes", [False, True], ids=["threads", "processes"])
def test_module_that_hangs_is_named(processes: bool) -> None:
    lines: list[str] = []
    with Blackboard.transient() as board, Runtime(board, [ModuleSpec("robot_modules:Stuck")], processes, lines.append):
        say(board, "hello")
        assert until(lambda: lines == ["the subscriber 'stuck' is slow, 1 change behind"]), lines


@pytest.mark.kills
def test_killed_process_goes_on_from_its_position(tmp_path: Path) -> None:
    lines: list[str] = []
    with Blackboard.open(tmp_path, create=True) as board, Runtime(board, [ECHO], True, lines.append):
        say(board, "one", "two")
        assert until(lambda: len(heard(board)) == 2), lines
        say(board, "now", predicate="kill")
        say(board, "three", "four")
        assert until(lambda: len(heard(board)) == 5), lines
        assert heard(board) == ["one", "two", "killed", "three", "four"]
    assert lines == ["the process of the module 'echo' ended with -9 and is started again"]


@pytest.mark.kills
def test_process_that_always_dies_is_given_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "MAX_STARTS", 2)
    lines: list[str] = []
    dying = ModuleSpec("robot_modules:Dying")
    given_up = "the process of the module 'dying' ended with 3 after each of 2 starts and is not started again"
    with Blackboard.open(tmp_path, create=True) as board, Runtime(board, [dying, ECHO], True, lines.append) as runtime:
        assert until(lambda: runtime.failure() == given_up), lines
        say(board, "one")
        assert until(lambda: heard(board) == ["one"]), lines
    assert lines == ["the process of the module 'dying' ended with 3 and is started again", given_up]


def test_two_modules_cannot_have_one_name() -> None:
    with Blackboard.transient() as board:
        with pytest.raises(ModuleError, match="two modules have the name 'echo'"):
            Runtime(board, [ECHO, ECHO])
        with pytest.raises(ModuleError, match="cannot be loaded: No module named 'nowhere'"):
            Runtime(board, [ModuleSpec("nowhere:Echo")])


def test_clock_that_runs_backwards_is_reported_once_and_stays() -> None:
    origin = datetime(2026, 11, 23, tzinfo=UTC)
    moments = iter([5.0, 3.0, 4.0, 6.0])
    lines: list[str] = []
    clock = Clock(origin, lines.append, lambda: origin + timedelta(seconds=next(moments)))
    assert [clock.seconds() for _ in range(4)] == [5.0, 5.0, 5.0, 6.0]
    assert lines == ["the clock went back by 2 s; times stay at 5.000000 s"]
