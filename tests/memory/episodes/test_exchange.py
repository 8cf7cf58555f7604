"""Test the export and import of episodes."""

from __future__ import annotations

import copy
import json
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from episodic_fluents import on, some_fluents
from hypothesis import given, settings

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.exchange import export_episodes, import_episodes, read_episodes
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import EpisodicFluent
from deixis.memory.errors import ImportFormatError, RejectedWriteError

ORIGIN = datetime(2026, 11, 23, tzinfo=UTC)


@settings(max_examples=25, deadline=None)
@given(some_fluents())
def test_export_and_import_give_the_same_fluents(fluents: list[EpisodicFluent]) -> None:
    with Blackboard.transient(ORIGIN) as first, Blackboard.transient(ORIGIN) as second:
        if fluents:
            first.write(*map(Add, fluents), by="test")
        text = export_episodes(first)
        assert import_episodes(second, text, "a") == len(fluents)
        assert second.holding() == first.holding()
        assert (export_episodes(second), import_episodes(second, text, "a")) == (text, 0)
        assert second.new_id("f") not in {each.id for each in fluents}


def test_times_are_moved_to_the_origin_of_the_memory() -> None:
    with Blackboard.transient(ORIGIN) as first, Blackboard.transient(ORIGIN - timedelta(seconds=60)) as second:
        first.add(on("f1", 2.0, 3.0), by="test")
        import_episodes(second, export_episodes(first), "a")
        (moved,) = second.holding()
        assert first.moment(2.0) == second.moment(moved.start.lower)


def test_refused_imports_change_nothing() -> None:
    with Blackboard.transient(ORIGIN) as first, Blackboard.transient(ORIGIN) as second:
        first.write(Add(on("f1", 2.0)), Add(on("f2", 2.0)), by="test")
        second.add(on("f2", 4.0), by="test")
        with pytest.raises(RejectedWriteError, match="its fluent 'f2' differs"):
            import_episodes(second, export_episodes(first), "a")
        assert len(second.holding()) == 1
        head = '{"format": "deixis-episodes", "version": 1, "origin": '
        bad = ("", "[]", '{"format": "other"}', head + "3}", head + '"2026-11-23T00:00:00Z", "fluents": [[1]]}')
        for text in bad:
            with pytest.raises(ImportFormatError, match=r"^a:"):
                import_episodes(second, text, "a")


GOOD = ["f1", ["cup", "on", "tray"], [1.0, 2, None, None], 0.5, ["seen", "camera", "frame 1"]]
VALUES: list[Any] = [None, True, -1, 0.5, 10**300, "", "abc", "abcd", "abcde", [], [None], {}, {"a": 1}]


@pytest.mark.parametrize(
    "place", [(0,), (1,), (1, 0), (1, 2), (2,), (2, 0), (2, 3), (3,), (4,), (4, 0), (4, 2)], ids=str
)
@pytest.mark.parametrize("value", VALUES, ids=str)
def test_a_wrong_part_of_a_fluent_is_refused_in_words(place: tuple[int, ...], value: Any) -> None:
    entry = copy.deepcopy(GOOD)
    inner: Any = entry
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    text = json.dumps({"format": "deixis-episodes", "version": 1, "origin": ORIGIN.isoformat(), "fluents": [entry]})
    with Blackboard.transient(ORIGIN) as board:
        try:
            import_episodes(board, text, "a")
        except (ImportFormatError, RejectedWriteError) as error:
            message = str(error)
            assert not board.holding()
        else:
            message = ""
            assert json.loads(export_episodes(board))["fluents"] == [entry]  # nothing was read as something else
    assert not message or message.startswith("a: fluent 1 of the list: ")
    assert not any(word in message for word in ("NoneType", "unpack", "iterable", "dict", "isoformat"))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ('{"format": "deixis-episodes" 1}', "a:1:30: this is not valid JSON"),
        ('{"format": "deixis-episodes", "version": [2]}', "the version of the format must be 1, got [2]"),
        (
            '{"format": "deixis-episodes", "version": 1}',
            "'origin' must be a time as in 2026-11-23T12:30:00+00:00, got nothing",
        ),
        ('{"format": "deixis-episodes", "version": 1, "origin": "noon"}', 'got "noon"'),
        (
            '{"format": "deixis-episodes", "version": 1, "origin": "2026-11-23T00:00:00Z"}',
            "'fluents' must be a list, got nothing",
        ),
    ],
)
def test_the_head_of_an_export_is_checked_in_words(text: str, reason: str) -> None:
    with pytest.raises(ImportFormatError) as caught:
        read_episodes(text, "a")
    assert reason in str(caught.value)
