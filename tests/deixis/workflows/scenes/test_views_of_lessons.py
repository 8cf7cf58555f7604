"""Writes over both stores: killed at any step, they have happened or they have not."""

from __future__ import annotations

import random
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from all_stores import Example, example_in, findings, state
from killing import KilledAtSteps, killed_at_steps
from read_only import make_read_only

from deixis.errors import DeixisError
from deixis.memory.errors import MemoryWriteError, ReadOnlyMemoryError
from deixis.memory.journal import JOURNAL
from deixis.memory.perceptual.database.handle import Handle
from deixis.memory.semantic.rdf import ledger
from deixis.session import Session

DECISIVE = {"update", "update_in_bulk", "write", "replace"}
"""The steps before and after which the outcome differs."""

KILLS = 2  # of each write; benchmarks/bench_kills.py kills at every step


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Example:
    return example_in(tmp_path_factory.mktemp("example"))


@pytest.fixture(scope="module")
def killed() -> Iterator[KilledAtSteps]:
    with killed_at_steps() as kills:
        yield kills


@pytest.fixture
def memory(example: Example, tmp_path: Path) -> Path:
    return shutil.copytree(example.memory, tmp_path / "memory")


def full(*_: object, **__: object) -> None:
    raise MemoryWriteError("the disk is full")


WRITES = tuple(Example(Path()).writes())


@pytest.mark.kills
@pytest.mark.slow
@pytest.mark.parametrize("write", WRITES)
def test_a_killed_write_has_happened_or_has_not(
    write: str, example: Example, tmp_path: Path, killed: KilledAtSteps
) -> None:
    code, begin = example.writes()[write], example.begin(write)

    def fresh() -> Path:
        shutil.rmtree(tmp_path / "m", ignore_errors=True)
        return tmp_path / "m" if begin is None else shutil.copytree(begin, tmp_path / "m")

    before, steps = state(fresh()), killed.run(tmp_path / "m", code)
    after = state(tmp_path / "m")
    assert before != after and findings(tmp_path / "m") == ()
    assert steps is not None
    decisive = [number for number, name in enumerate(steps, start=1) if name in DECISIVE]
    for step in sorted(random.Random(write).sample(decisive, min(KILLS, len(decisive)))):
        assert killed.run(fresh(), code, step) is None
        assert findings(tmp_path / "m", inferred=False) == (), step
        assert state(tmp_path / "m") in (before, after), step


def test_a_write_that_the_semantic_store_refuses_changes_neither(
    example: Example, memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = state(memory)

    def no_room(*_: object) -> None:
        raise OSError("No space left on device")

    with Session(memory) as session:
        monkeypatch.setattr(ledger, "update", no_room)
        with pytest.raises(MemoryWriteError, match="could not be written"):
            session.learn(example.script, example.scene(4))
        assert not (memory / "perceptual" / JOURNAL).exists()
        monkeypatch.undo()
        assert session.categories() == {"fork": 1, "knife": 1, "plate": 1}
    assert state(memory) == before and findings(memory) == ()


def test_views_are_written_as_soon_as_the_disk_allows(
    example: Example, memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Session(memory) as session, monkeypatch.context() as patched:
        patched.setattr(Handle, "write", full)
        with pytest.raises(MemoryWriteError, match="the lessons are stored, and their views will be"):
            session.learn(example.script, example.scene(4))
    assert (memory / "perceptual" / JOURNAL).exists()
    with Session(memory) as session:
        assert session.categories() == {"fork": 2, "knife": 2, "plate": 2}
        assert session.memory().lessons() == ("tea-1", "tea-2")
    assert findings(memory) == ()


def test_a_journal_that_was_cut_short_changes_nothing(memory: Path) -> None:
    before = state(memory)
    (memory / "perceptual" / JOURNAL).write_bytes(b"deixis journal 1\n{")
    assert state(memory) == before and findings(memory) == ()
    assert not (memory / "perceptual" / JOURNAL).exists()


def test_the_stores_agree_after_each_write(example: Example, memory: Path) -> None:
    with Session(memory) as session:
        again = session.learn(example.script, example.scene(3))  # the same views belong to two lessons
        views = set(session.views().lessons_of_views())
        assert set(session.views().lessons_of_views().values()) == {again.lesson.id}
        session.forget(again.lesson.id)
        assert session.views().lessons_of_views() == dict.fromkeys(views, "tea-1")
        session.rename_category("fork", "prongs")
        session.merge_categories("knife", "prongs")
    assert findings(memory) == ()
    with Session(memory) as session:
        taught = session.teach(example.scene(3), "o1", "gizmo")
        assert taught.view not in session.views().lessons_of_views()
        session.forget_category("prongs")
        session.forget("tea-1")
        assert session.views().lessons_of_views() == {}
    assert findings(memory) == ()


def test_verify_names_where_the_stores_differ(example: Example, memory: Path) -> None:
    with Session(memory) as session:
        session.views().rename("fork", "prongs")  # behind the back of the lessons
        session.memory().forget("tea-1", inferred=[])
    told = " ".join(findings(memory))
    assert "it belongs to the lesson 'tea-1', which is missing" in told
    with Session(memory) as session:
        session.learn(example.script, example.scene(4))
        session.views().rename("fork", "tines")
        session.views().forget("plate")
    told = " ".join(findings(memory))
    assert "of 'fork', which is now of 'tines'" in told and "of 'plate', which is missing" in told
    shutil.rmtree(memory / "perceptual")
    assert sum("which is missing" in line for line in findings(memory)) == 3


def test_what_is_refused_makes_no_journal(example: Example, memory: Path) -> None:
    with Session(memory) as session, pytest.raises(DeixisError):
        session.forget("tea-2")
    assert not (memory / "perceptual" / JOURNAL).exists()


def test_a_read_only_memory_is_queried_verified_grounded_against(
    example: Example, memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make_read_only(memory, monkeypatch)
    assert findings(memory) == ()
    with Session(memory) as session:
        assert session.query("SELECT ?role { ?role a dx:Role } ORDER BY ?role").rows
        assert session.ground(example.script, example.scene(4)).matches
        assert session.recognise(example.scene(4)).answers
        for write in (
            lambda: session.learn(example.script, example.scene(4)),
            lambda: session.teach(example.scene(4), "o1", "mug"),
            lambda: session.forget("tea-1"),
            lambda: session.forget_category("fork"),
        ):
            with pytest.raises(ReadOnlyMemoryError, match="Read-only file system; make the folder writable"):
                write()


def test_a_write_cut_short_is_finished_in_a_read_only_memory(
    example: Example, memory: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Session(memory) as session, monkeypatch.context() as patched:
        patched.setattr(Handle, "write", full)
        with pytest.raises(MemoryWriteError):
            session.learn(example.script, example.scene(4))
    make_read_only(memory, monkeypatch)
    with Session(memory) as session:
        assert session.categories() == {"fork": 2, "knife": 2, "plate": 2}
    assert findings(memory) == ()
    assert (memory / "perceptual" / JOURNAL).exists()
