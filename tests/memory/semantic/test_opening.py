"""Open a memory: new, empty, foreign, damaged, old, newer, in use by another process."""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pyoxigraph as ox
import pytest
from timing import processor_time_below

from deixis.errors import DeixisError
from deixis.memory import folder as files
from deixis.memory import owner as disk
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.errors import MemoryBusyError, MemoryFormatError, MemoryWriteError
from deixis.memory.folder import VERSION
from deixis.memory.semantic import opening
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.semantic.rdf.graphs import GRAPHS, GraphName
from deixis.memory.semantic.rdf.package import packaged
from deixis.memory.semantic.store import SemanticMemory

Damage = Callable[[Path], object]


def digest(folder: Path) -> dict[str, str]:
    return {
        str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest() if file.is_file() else "folder"
        for file in sorted(folder.rglob("*"))
    }


@pytest.fixture
def kept(tmp_path: Path, kept_folder: Path) -> Path:
    """A closed memory of this test's own, with one lesson."""
    return shutil.copytree(kept_folder, tmp_path / "kept")


@pytest.fixture(scope="module")
def kept_old_folder(kept_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A closed memory with one lesson in format version 0."""
    folder = shutil.copytree(kept_folder, tmp_path_factory.mktemp("old") / "memory")
    make_old(folder)
    return folder


@pytest.fixture
def kept_old(tmp_path: Path, kept_old_folder: Path) -> Path:
    return shutil.copytree(kept_old_folder, tmp_path / "old")


def test_a_new_memory_is_made_only_when_asked(tmp_path: Path) -> None:
    with pytest.raises(MemoryFormatError, match="there is no memory at"):
        SemanticMemory.open(tmp_path / "a" / "b")
    assert not (tmp_path / "a").exists()
    SemanticMemory.open(tmp_path / "a" / "b", create=True).close()
    assert sorted(entry.name for entry in (tmp_path / "a" / "b").iterdir()) == ["memory.json", "owner.lock", "semantic"]
    mark = json.loads((tmp_path / "a" / "b" / "memory.json").read_text())
    assert (mark["format"], mark["version"]) == ("deixis-memory", VERSION)


def test_an_empty_folder_becomes_one_only_when_asked(tmp_path: Path) -> None:
    with pytest.raises(MemoryFormatError, match="no memory yet in the empty folder"):
        SemanticMemory.open(tmp_path)
    assert not list(tmp_path.iterdir())
    SemanticMemory.open(tmp_path, create=True).close()


@pytest.mark.parametrize("create", [True, False])
def test_a_foreign_folder_is_left_alone(tmp_path: Path, create: bool) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    (tmp_path / "semantic").mkdir()
    before = digest(tmp_path)
    with pytest.raises(MemoryFormatError, match=r"is not a memory: it has other files \(letter.txt"):
        SemanticMemory.open(tmp_path, create=create)
    assert digest(tmp_path) == before


def test_a_file_is_refused_as_a_memory(tmp_path: Path) -> None:
    (tmp_path / "f").write_text("x")
    for path in (tmp_path / "f", tmp_path / "f" / "below" / "it"):
        with pytest.raises(MemoryFormatError, match="is a file"):
            SemanticMemory.open(path, create=True)


def _store_file(folder: Path, start: str) -> Path:
    return next(file for file in sorted((folder / "semantic").iterdir()) if file.name.startswith(start))


def _largest_table(folder: Path) -> Path:
    return max((folder / "semantic").glob("*.sst"), key=lambda file: file.stat().st_size)


DAMAGES: dict[str, Damage] = {
    "mark is not json": lambda folder: (folder / "memory.json").write_text("{"),
    "mark is binary": lambda folder: (folder / "memory.json").write_bytes(b"\xff\x00"),
    "mark is a list": lambda folder: (folder / "memory.json").write_text("[]"),
    "mark of another program": lambda folder: (folder / "memory.json").write_text('{"format": "x", "version": 1}'),
    "mark without version": lambda folder: (folder / "memory.json").write_text('{"format": "deixis-memory"}'),
    "version is a word": lambda folder: (folder / "memory.json").write_text(
        '{"format": "deixis-memory", "version": "1"}'
    ),
    "version from before the first": lambda folder: (folder / "memory.json").write_text(
        '{"format": "deixis-memory", "version": -1}'
    ),
    "mark missing": lambda folder: (folder / "memory.json").unlink(),
    "no CURRENT": lambda folder: (folder / "semantic" / "CURRENT").unlink(),
    "CURRENT empty": lambda folder: (folder / "semantic" / "CURRENT").write_text(""),
    "no manifest": lambda folder: _store_file(folder, "MANIFEST").unlink(),
    "manifest cut short": lambda folder: _store_file(folder, "MANIFEST").write_bytes(b"\x00" * 20),
    "a table missing": lambda folder: _largest_table(folder).unlink(),
    "a table cut short": lambda folder: _largest_table(folder).write_bytes(b"x"),
}


@pytest.mark.parametrize("create", [True, False])
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_memory_is_an_error_and_is_not_changed(kept: Path, damage: str, create: bool) -> None:
    DAMAGES[damage](kept)
    before = digest(kept)
    with pytest.raises(MemoryFormatError) as caught:
        SemanticMemory.open(kept, create=create)
    assert digest(kept) == before
    assert "\n" not in str(caught.value)
    assert str(kept) in str(caught.value)


def test_a_damaged_memory_without_a_lock_file_gets_none(kept: Path) -> None:
    (kept / "owner.lock").unlink()
    _largest_table(kept).unlink()
    before = digest(kept)
    with pytest.raises(MemoryFormatError, match="damaged"):
        SemanticMemory.open(kept)
    assert digest(kept) == before


def test_a_newer_memory_is_an_error_and_is_not_changed(kept: Path) -> None:
    (kept / "memory.json").write_text('{"format": "deixis-memory", "version": 99}')
    before = digest(kept)
    with pytest.raises(MemoryFormatError, match=r"written by a newer version \(format 99.*upgrade deixis"):
        SemanticMemory.open(kept)
    assert digest(kept) == before


def make_old(folder: Path) -> None:
    """Convert a memory to version 0, which had other names of graphs."""
    new, old = ox.Store(folder / "semantic"), ox.Store(folder / "older")
    for quad in new:
        assert isinstance(quad.graph_name, ox.NamedNode)
        name = "urn:deixis:graph:" + quad.graph_name.value.removeprefix(GRAPHS).replace("/", ":")
        old.add(ox.Quad(quad.subject, quad.predicate, quad.object, ox.NamedNode(name)))
    old.flush()
    del new, old
    disk.remove(folder / "semantic")
    (folder / "older").rename(folder / "semantic")
    (folder / "memory.json").write_text('{"format": "deixis-memory", "version": 0}')


def _exported(folder: Path) -> str:
    with SemanticMemory.open(folder) as memory:
        return export_memory(memory)


def test_an_old_memory_is_brought_up_to_date(kept_old: Path, kept_export: str) -> None:
    assert _exported(kept_old) == kept_export
    assert files.read_mark(kept_old)["version"] == VERSION
    assert sorted(entry.name for entry in (kept_old).iterdir()) == ["memory.json", "owner.lock", "semantic"]


def test_damage_found_while_migrating_is_called_damage(kept_old_folder: Path, tmp_path: Path) -> None:
    said = []
    for number, table in enumerate((kept_old_folder / "semantic").glob("*.sst")):
        folder = shutil.copytree(kept_old_folder, tmp_path / str(number))
        data = table.read_bytes()
        (folder / "semantic" / table.name).write_bytes(bytes(byte ^ 1 for byte in data[:20]) + data[20:])
        try:
            SemanticMemory.open(folder).close()
        except MemoryFormatError as error:  # MemoryWriteError would say that it could not be written
            said.append(str(error))
    assert all("is damaged" in text and "restore the folder from a copy" in text for text in said)
    assert any(f"{tmp_path}" in text and "does not open" not in text for text in said)


@pytest.mark.parametrize("steps", range(6))
def test_a_crash_while_migrating_loses_nothing(
    kept_old: Path, kept_export: str, steps: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a crash at any renaming or removal, the next opening continues from there."""
    left = [steps]

    def crashing(real: Callable[..., None]) -> Callable[..., None]:
        def step(*paths: Path) -> None:
            if left[0] == 0:
                raise KeyboardInterrupt
            left[0] -= 1
            real(*paths)

        return step

    with monkeypatch.context() as patched:
        patched.setattr(disk, "rename", crashing(disk.rename))
        patched.setattr(disk, "remove", crashing(disk.remove))
        with pytest.raises(KeyboardInterrupt):
            SemanticMemory.open(kept_old)
    assert _exported(kept_old) == kept_export


@pytest.mark.parametrize("steps", range(3))
def test_a_crash_while_creating_is_mended(tmp_path: Path, steps: int, monkeypatch: pytest.MonkeyPatch) -> None:
    left = [steps]
    real = disk.rename

    def crashing(old: Path, new: Path) -> None:
        if left[0] == 0:
            raise RuntimeError("crash")
        left[0] -= 1
        real(old, new)

    with monkeypatch.context() as patched:
        patched.setattr(disk, "rename", crashing)
        if steps < 2:
            with pytest.raises(MemoryWriteError):
                SemanticMemory.open(tmp_path / "m", create=True)
        else:
            SemanticMemory.open(tmp_path / "m", create=True).close()
    with SemanticMemory.open(tmp_path / "m", create=True) as memory:
        assert memory.stats().triples[GraphName.ONTOLOGY] > 1000


def test_another_ontology_is_brought_in_on_opening(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    content = dict(packaged())
    extra = ox.Triple(ox.NamedNode("urn:new"), ox.NamedNode("urn:p"), ox.Literal("term"))
    gone = content[GraphName.ONTOLOGY][0]
    changed = {**content, GraphName.ONTOLOGY: (*content[GraphName.ONTOLOGY][1:], extra)}
    with monkeypatch.context() as patched:
        patched.setattr(opening, "packaged", lambda: changed)
        patched.setattr(opening, "package_digest", lambda: "other")
        with SemanticMemory.open(kept) as memory:
            ontology = set(memory.triples(GraphName.ONTOLOGY))
            assert extra in ontology
            assert gone not in ontology
            assert memory.lessons() == ("dinner-1",)
    with SemanticMemory.open(kept) as memory:
        assert extra not in set(memory.triples(GraphName.ONTOLOGY))


def test_one_process_opens_a_memory_once_whatever_the_path(kept: Path, tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(kept)
    with SemanticMemory.open(kept), pytest.raises(MemoryBusyError, match="this process has it open already"):
        SemanticMemory.open(tmp_path / "link")
    SemanticMemory.open(tmp_path / "link").close()


def test_a_link_that_leads_nowhere(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "gone")
    with pytest.raises(MemoryFormatError, match="broken link"):
        SemanticMemory.open(tmp_path / "link", create=True)


HOLDER = """
import sys, time
from deixis.memory.semantic.rdf.package import packaged
from deixis.memory.semantic.store import SemanticMemory
memory = SemanticMemory.open(sys.argv[1])
print("open", flush=True)
time.sleep(60)
"""


def test_a_living_owner_is_named_and_a_dead_one_is_ignored(kept: Path) -> None:
    holder = subprocess.Popen([sys.executable, "-c", HOLDER, str(kept)], stdout=subprocess.PIPE, text=True)
    try:
        assert holder.stdout is not None
        assert holder.stdout.readline() == "open\n"
        lock = (kept / "owner.lock").read_text()
        with pytest.raises(MemoryBusyError, match=rf"in use by process {holder.pid} \(.*\) since \d{{4}}-.*; wait"):
            SemanticMemory.open(kept)
        assert (kept / "owner.lock").read_text() == lock
    finally:
        holder.kill()
        holder.wait()
        if holder.stdout:
            holder.stdout.close()
    assert (kept / "owner.lock").read_text()
    with SemanticMemory.open(kept) as memory:
        assert memory.lessons() == ("dinner-1",)


def test_every_error_of_opening_is_ours_and_narrow(kept: Path) -> None:
    (kept / "memory.json").unlink()
    with pytest.raises(ValueError, match="damaged") as caught:
        SemanticMemory.open(kept)
    assert isinstance(caught.value, DeixisError)
    assert issubclass(MemoryBusyError, BlockingIOError)
    assert issubclass(MemoryWriteError, OSError)


def test_opening_is_quick(kept: Path) -> None:
    SemanticMemory.open(kept).close()
    with processor_time_below(2):
        SemanticMemory.open(kept).close()


def test_a_memory_of_episodes_alone_is_not_called_empty(tmp_path: Path) -> None:
    Blackboard.open(tmp_path, create=True).close()
    with pytest.raises(MemoryFormatError, match="has episodes, but no lessons yet"):
        SemanticMemory.open(tmp_path)
