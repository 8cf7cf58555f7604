"""Fluents that are written in one step with lessons: all of it or nothing, also after a kill or with a full disk."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest
from episodic_fluents import on

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Delete, Finish, Update
from deixis.memory.episodes.fluents.codec import change_of_list, change_to_list
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.memory.episodes.store.disk import DiskKeys
from deixis.memory.errors import EpisodeError, MemoryWriteError
from deixis.memory.journal import JOURNAL, JointWrite, write_together
from deixis.memory.semantic.rdf.change import Change
from deixis.memory.semantic.rdf.links import linking
from deixis.memory.semantic.store import SemanticMemory
from deixis.memory.verify import verify
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.fluent import Statement


def ids(folder: Path) -> list[str]:
    with Blackboard.open(folder) as board:
        assert not (folder / "episodes" / JOURNAL).exists()
        return [each.id for each in board.holding()]


def killed(write: JointWrite | None) -> None:
    """End a write as a kill does, which calls no further method of the parts."""
    raise SystemExit


@pytest.mark.parametrize("committed", [False, True])
def test_the_next_opening_does_what_the_semantic_store_decided(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, committed: bool
) -> None:
    with SemanticMemory.open(tmp_path, create=True) as memory, Blackboard.open(tmp_path, create=True) as board:
        board.add(on("f1"), by="test")

        def commit(write: JointWrite | None) -> None:
            if committed:
                memory.commit(Change(), write=write)
            raise SystemExit

        part = board.part(Add(on("f2")), Delete("f1"), by="test")
        monkeypatch.setattr(type(part), "settle", lambda part: None)
        with pytest.raises(SystemExit):
            write_together(commit, [part])
        assert [each.id for each in board.holding()] == ["f1"]
    assert ids(tmp_path) == (["f2"] if committed else ["f1"])
    assert verify(tmp_path).findings == ()


def test_others_write_meanwhile_and_what_does_not_fit_is_left() -> None:
    with Blackboard.transient() as board:
        for name in ("f1", "f2"):
            board.add(on(name), by="test")

        def commit(_: JointWrite | None) -> None:
            board.write(Finish("f1", 5.0), Delete("f2"), by="other")

        write_together(commit, [board.part(Finish("f1", 9.0), Finish("f2", 9.0), Add(on("f3")), by="test")])
        assert [(each.id, each.is_open) for each in board.holding()] == [("f1", False), ("f3", True)]
        assert [change.sequence for change in board.changes()] == [1, 2, 3, 4, 5]


def test_a_refused_change_refuses_the_write(tmp_path: Path) -> None:
    with Blackboard.open(tmp_path, create=True) as board:
        board.add(on("f1"), by="test")
        with pytest.raises(EpisodeError, match="is on the blackboard already"):
            write_together(killed, [board.part(Add(on("f1")), by="test")])
        assert not (tmp_path / "episodes" / JOURNAL).exists()


def test_a_full_disk_after_the_commit_delays_the_fluents(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(keys: DiskKeys, pairs: Mapping[bytes, bytes | None]) -> None:
        raise MemoryWriteError("no space left on device")

    with SemanticMemory.open(tmp_path, create=True) as memory, Blackboard.open(tmp_path, create=True) as board:
        with monkeypatch.context() as patched:
            patched.setattr(DiskKeys, "write", full)
            part = board.part(Add(on("f1")), by="test")
            write_together(lambda write: memory.commit(Change(), write=write), [part])
        assert board.holding() == ()
        assert "their episodes will be when the disk has room" in board.troubles[0]
        board.add(on("f2"), by="test")
        assert [(each.id, each.by) for each in board.changes()] == [("f1", "test"), ("f2", "test")]


def test_verify_names_what_the_episodes_lack(tmp_path: Path) -> None:
    with SemanticMemory.open(tmp_path, create=True) as memory, Blackboard.open(tmp_path, create=True) as board:
        memory.commit(linking("tea-1", {}, ("sentence1", "sentence2")))
        source = Source(Origin.SAID, "Ada", "sentence1")
        board.add(episodic("f1", ("Ada", "said", "tea"), start=0.0, source=source), by="test")
        board.delete("f1", by="test")  # what was said stays in the log
        marker = episodic("c1", ("dinner", "consolidated", "tea-9"), start=0.0, source=source)
        board.add(marker, by="test")
    assert [str(found) for found in verify(tmp_path).findings] == [
        "lesson 'tea-1': it was taught by 'sentence2', which the episodes never had",
        "experience 'dinner': it taught the lesson 'tea-9', which is missing",
    ]


def test_changes_are_the_same_after_encoding() -> None:
    source = Source(Origin.SAID, "Ada", "sentence 1")
    for change in (
        Add(on("f1", Bounds(1.0, 2.0))),
        Finish("f1", 5.0),
        Delete("f1"),
        Update("f1", Statement("a", "b", "c"), Bounds(1.0, 2.0), Bounds(), 0.5, source),
        Update("f1", certainty=0.5),
    ):
        again = change_of_list(change_to_list(change))
        assert change_to_list(again) == change_to_list(change) and type(again) is type(change)
