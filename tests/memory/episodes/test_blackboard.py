"""The blackboard: atomic writes, the log, what holds in a window, and the current situation."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime

import pytest
from episodic_fluents import SEEN, on, some_fluents
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.memory.episodes import blackboard as module
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Delete, Finish, Update
from deixis.memory.episodes.fluents.episode import EpisodicFluent, episodic
from deixis.memory.errors import EpisodeError, UnknownFluentError
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.fluent import Pattern, Statement


@settings(max_examples=60, deadline=None)
@given(some_fluents(), st.integers(-25, 25), st.integers(0, 10), st.booleans())
def test_window_finds_what_a_scan_of_all_fluents_finds(
    fluents: list[EpisodicFluent], start: int, length: int, certainly: bool
) -> None:
    with Blackboard.transient() as board:
        board.write(*map(Add, fluents), by="test")
        for pattern in (Pattern(), Pattern("a"), Pattern(predicate="near"), Pattern(predicate="on", object="b")):
            found = board.holding(pattern, start, start + length, certainly=certainly)
            wanted = {
                each.id
                for each in fluents
                if pattern.matches(each.statement)
                and each.may_hold(start, start + length)
                and (not certainly or each.must_hold(start, start + length))
            }
            assert {each.id for each in found} == wanted
            assert len(found) == len(wanted)
        assert {each.id for each in board.holding()} == {each.id for each in fluents}
        assert {each.id for each in board.now()} == {each.id for each in fluents if each.is_open}


@settings(max_examples=40, deadline=None)
@given(some_fluents(6), st.data())
def test_log_replayed_gives_the_blackboard(fluents: list[EpisodicFluent], data: st.DataObject) -> None:
    with Blackboard.transient() as board:
        board.write(*map(Add, fluents), by="test")
        for each in fluents:
            match data.draw(st.sampled_from(["keep", "delete", "update", "finish"])):
                case "delete":
                    board.delete(each.id, by="test")
                case "update":
                    board.update(each.id, by="test", statement=Statement("c", "on"), start=-50.0, certainty=0.5)
                case "finish" if each.is_open:
                    board.finish(each.id, 60.0, by="test")
        replayed: dict[str, EpisodicFluent] = {}
        for number, change in enumerate(board.changes(), 1):
            assert change.sequence == number
            assert replayed.pop(change.id, None) == change.before
            if change.after is not None:
                replayed[change.id] = change.after
        assert set(board.holding()) == set(replayed.values())
        assert set(board.now()) == {each for each in replayed.values() if each.is_open}
        assert set(board.holding(start=-1e6, end=1e6)) == set(replayed.values())


def test_fluent_holds_at_its_start_and_not_at_its_finish() -> None:
    with Blackboard.transient() as board:
        board.add(on("f1", 2.0, 5.0), by="test")
        held = [bool(board.holding(start=time, end=time)) for time in (1.999999, 2.0, 4.999999, 5.0)]
    assert held == [False, True, True, False]


def test_certainly_leaves_out_what_only_may_have_held() -> None:
    with Blackboard.transient() as board:
        board.add(on("f1", Bounds(0, 4), Bounds(6, 9)), by="test")
        assert [each.id for each in board.holding(start=2, end=3)] == ["f1"]
        assert board.holding(start=2, end=3, certainly=True) == ()
        assert [each.id for each in board.holding(start=4, end=5, certainly=True)] == ["f1"]


def test_refused_change_leaves_the_whole_batch_unwritten() -> None:
    with Blackboard.transient() as board:
        board.add(on("f1"), by="test")
        with pytest.raises(EpisodeError, match="'f1' is on the blackboard already"):
            board.write(Add(on("f2")), Delete("f1"), Add(on("f1")), Add(on("f1")), by="test")
        assert board.sequence == 1
        assert [each.id for each in board.now()] == ["f1"]


def test_changes_of_one_batch_apply_in_order() -> None:
    with Blackboard.transient() as board:
        last = board.write(Add(on("f1", 1.0)), Finish("f1", 2.0), Delete("f1"), Add(on("f1", 3.0)), by="test")
        assert last == 4
        assert [str(each.fluent) for each in board.holding()] == ["f1: on(cup, table) from [3, 3] to (-∞, ∞)"]
        assert {each.last for each in board.changes()} == {4}


def test_all_fluents_of_a_pattern_get_new_values_in_one_write() -> None:
    with Blackboard.transient() as board:
        board.write(Add(on("f1", 1.0, 2.0)), Add(on("f2", 3.0)), Add(on("f3", 5.0)), by="test")
        last = board.update_where(Pattern("cup"), "judge", start=2.5, end=9.0, certainty=0.5, new_finish=8.0)
        assert {each.last for each in board.changes(since=3)} == {last}
        assert [(each.id, each.certainty, each.finish.lower) for each in board.holding()] == [
            ("f1", 1.0, 2.0), ("f2", 0.5, 8.0), ("f3", 0.5, 8.0)
        ]  # fmt: skip


def test_unknown_finished_and_backward_changes_are_refused() -> None:
    with Blackboard.transient() as board:
        with pytest.raises(UnknownFluentError, match="no fluent 'f9'"):
            board.finish("f9", 1.0, by="test")
        board.add(on("f1", 5.0), by="test")
        with pytest.raises(EpisodeError, match="does a clock run backwards"):
            board.finish("f1", 4.0, by="test")
        board.finish("f1", 6.0, by="test")
        with pytest.raises(EpisodeError, match="has finished already"):
            board.finish("f1", 7.0, by="test")
        board.write(Update("f1", finish=Bounds()), by="test")
        assert [each.id for each in board.now()] == ["f1"]


def test_fluents_that_cannot_be_stored_are_refused() -> None:
    with pytest.raises(EpisodeError, match="above 0 and at most 1, got 0"):
        episodic("f1", ("cup", "clean"), start=None, certainty=0, source=SEEN)
    with pytest.raises(EpisodeError, match="one line of printable text"):
        episodic("f1", ("cup", "said", "a\nb"), start=None, source=SEEN)
    with Blackboard.transient() as board, pytest.raises(EpisodeError, match="must not end before it starts"):
        board.holding(start=2, end=1)


def test_new_ids_are_never_given_twice() -> None:
    with Blackboard.transient() as board:
        given = [board.new_id("t"), board.new_id("t"), board.new_id("s"), board.new_id("t")]
    assert given == ["t1", "t2", "s1", "t3"]


def test_times_are_counted_from_the_origin() -> None:
    origin = datetime(2026, 11, 23, 12, tzinfo=UTC)
    with Blackboard.transient(origin) as board:
        assert board.seconds(board.moment(90.5)) == 90.5
        assert board.origin == origin


def test_subjects_of_many_fluents_are_found_in_a_window(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MAX_LOOKED_UP", 3)
    with Blackboard.transient() as board:
        board.write(*(Add(on(f"f{n}", float(n), n + 1.0)) for n in range(9)), by="test")
        assert [each.id for each in board.holding(Pattern("cup"), 4.5, 5.5)] == ["f4", "f5"]
        assert len(board.holding(Pattern("cup"))) == len(board.holding(Pattern(predicate="on"))) == 9


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda board: board.write("cup", by="test"), "a change must be Add"),
        (lambda board: board.add("cup", by="test"), "a change must be Add"),
        (lambda board: board.holding("cup"), "`pattern` must be a Pattern"),
        (lambda board: board.now("cup"), "`pattern` must be a Pattern"),
        (lambda board: board.holding(Pattern("cup"), "noon"), "the ends of a window must be numbers"),
        (lambda board: board.subscribe("listener", Pattern("cup"), "print"), "`callback` must be a function"),
    ],
    ids=["change", "fluent", "pattern", "pattern of now", "window", "callback"],
)
def test_arguments_of_wrong_types_are_refused(call: Callable[[Blackboard], object], message: str) -> None:
    with Blackboard.transient() as board:
        with pytest.raises(EpisodeError, match=message):
            call(board)
        assert board.sequence == 0 and board.subscribers() == ()
