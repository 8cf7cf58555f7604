"""Test the export and import of episodes."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import pytest
from episodic_fluents import on, some_fluents
from hypothesis import given, settings

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.exchange import export_episodes, import_episodes
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
            with pytest.raises(ImportFormatError, match=r"^a: "):
                import_episodes(second, text, "a")
