"""Subscriptions: each change once and in order, whatever subscribers and writers do."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import pytest
from episodic_fluents import SEEN, on
from hypothesis import given, settings
from hypothesis import strategies as st
from timing import BUSY_SECONDS, until

from deixis.memory.episodes import subscription as module
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Logged
from deixis.memory.episodes.fluents.episode import episodic
from deixis.memory.episodes.subscription import Condition
from deixis.memory.errors import EpisodeError
from deixis.reasoning.temporal.fluent import Pattern


@settings(max_examples=15, deadline=None)
@given(
    writers=st.lists(st.lists(st.integers(1, 4), min_size=1, max_size=5), min_size=1, max_size=4),
    failing=st.sets(st.integers(1, 20), max_size=2),
    since=st.integers(0, 3),
)
def test_subscribers_get_each_change_once_and_in_order(writers: list[list[int]], failing: set[int], since: int) -> None:
    all_changes: list[Logged] = []
    of_a: list[Logged] = []
    raised: set[int] = set()

    def accept(change: Logged) -> None:
        if change.sequence in failing and change.sequence not in raised:
            raised.add(change.sequence)
            raise ValueError("not yet")
        all_changes.append(change)

    def write(name: str, batches: list[int]) -> None:
        for batch, size in enumerate(batches):
            ids = [f"{name}.{batch}.{number}" for number in range(size)]
            board.write(*(Add(episodic(id, (name, "moves"), start=0.0, source=SEEN)) for id in ids), by=name)

    with Blackboard.transient() as board:
        board.write(*(Add(on(f"before {number}")) for number in range(3)), by="test")
        first = board.subscribe("all", Pattern(), accept, since)
        second = board.subscribe("of w0", Pattern("w0"), of_a.append)
        threads = [threading.Thread(target=write, args=(f"w{k}", batches)) for k, batches in enumerate(writers)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert first.wait(board.sequence, BUSY_SECONDS)
        assert second.wait(board.sequence, BUSY_SECONDS)
        log = list(board.changes())
    assert all_changes == log[since:]
    assert of_a == [change for change in log if change.concerns(Pattern("w0"))]
    assert [change.sequence for change in log] == list(range(1, len(log) + 1))


def test_writers_do_not_wait_and_the_hanging_subscriber_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PATIENCE", 0.02)
    called, release = threading.Event(), threading.Event()
    got: list[int] = []

    def hang(change: Logged) -> None:
        called.set()
        release.wait(BUSY_SECONDS)
        got.append(change.sequence)

    lines: list[str] = []
    with Blackboard.transient(report=lines.append) as board:
        stuck = board.subscribe("stuck", Pattern(), hang)
        board.add(on("f1"), by="test")
        assert called.wait(BUSY_SECONDS)
        time.sleep(0.05)
        board.add(on("f2"), by="test")
        assert got == []  # so that the writer has not waited for the subscriber
        assert stuck.state.condition is Condition.SLOW
        assert len(lines) == 1
        assert lines[0].startswith("the subscriber 'stuck' is slow, ")
        release.set()
        assert stuck.wait(2, BUSY_SECONDS)
    assert got == [1, 2]


def test_hanging_subscriber_is_named_without_further_writes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PATIENCE", 0.02)
    release = threading.Event()
    lines: list[str] = []
    with Blackboard.transient(report=lines.append) as board:
        board.subscribe("stuck", Pattern(), lambda change: release.wait(BUSY_SECONDS))
        board.add(on("f1"), by="test")
        assert until(lambda: lines == ["the subscriber 'stuck' is slow, 1 change behind"]), lines
        release.set()


def test_subscriber_that_raises_is_named_and_catches_up() -> None:
    calls: list[int] = []

    def fail_once(change: Logged) -> None:
        calls.append(change.sequence)
        if len(calls) == 1:
            raise RuntimeError("no camera")

    with Blackboard.transient() as board:
        subscription = board.subscribe("detector", Pattern(), fail_once)
        board.add(on("f1"), by="test")
        board.add(on("f2"), by="test")
        assert subscription.wait(2, BUSY_SECONDS)
        assert calls == [1, 1, 2]
        assert len(board.troubles) == 1
        assert "'detector' is failing" in board.troubles[0]
        assert board.troubles[0].endswith("RuntimeError: no camera")
        assert subscription.state.error is None


def test_two_subscribers_cannot_have_one_name() -> None:
    with Blackboard.transient() as board:
        board.subscribe("tracker", Pattern(), print)
        with pytest.raises(EpisodeError, match="named 'tracker' is there already"):
            board.subscribe("tracker", Pattern(), print)
        board.unsubscribe("tracker")
        board.subscribe("tracker", Pattern(), print)


def test_subscribers_to_a_fluent_and_to_a_shape_get_only_those(tmp_path: Path) -> None:
    shapes = tmp_path / "shapes.ttl"
    shapes.write_text(
        "@prefix sh: <http://www.w3.org/ns/shacl#> .\n@prefix ep: <https://w3id.org/deixis/episodes#> .\n"
        "<urn:sure> a sh:NodeShape ; sh:targetClass ep:Fluent ; sh:property <urn:half> .\n"
        "<urn:half> sh:path ep:certainty ; sh:maxExclusive 0.5 .\n"
    )
    of_fluent: list[str] = []
    unsure: list[str] = []
    with Blackboard.transient() as board:
        one = board.subscribe("one", "f1", lambda change: of_fluent.append(change.kind))
        other = board.subscribe("unsure", shapes, lambda change: unsure.append(f"{change.kind} {change.id}"))
        board.write(Add(on("f1", 0.0)), Add(on("f2", 0.0)), by="test")
        board.update("f2", by="test", certainty=0.25)
        board.finish("f1", 3.0, by="test")
        board.delete("f2", by="test")
        assert one.wait(board.sequence, BUSY_SECONDS)
        assert other.wait(board.sequence, BUSY_SECONDS)
    assert of_fluent == ["add", "finish"]
    assert unsure == ["update f2", "delete f2"]


def test_callback_that_exits_is_called_again() -> None:
    calls: list[int] = []

    def accept(change: Logged) -> None:
        calls.append(change.sequence)
        if len(calls) == 1:
            raise SystemExit(3)

    with Blackboard.transient() as board:
        subscriber = board.subscribe("exits", Pattern(), accept)
        board.write(Add(on("f1")), by="test")
        assert subscriber.wait(board.sequence, BUSY_SECONDS)
    assert calls == [1, 1]
