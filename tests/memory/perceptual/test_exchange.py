"""Export a perceptual memory to a file, and import it."""

from __future__ import annotations

import json
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from safetensors.numpy import load, save

from deixis.memory.errors import ImportFormatError, MemoryFormatError, MemoryWriteError, RejectedWriteError
from deixis.memory.perceptual.exchange import Imported, export_views, import_views
from deixis.memory.perceptual.in_folder import export_all, import_all, is_archive, open_in, stats_of
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.protocol import PerceptualMemory
from deixis.memory.perceptual.records import Batch, CategoryRecord, View
from deixis.memory.perceptual.transient import TransientMemory
from deixis.memory.verify import verify

Content = Callable[..., Any]
MakeView = Callable[..., View]
MakeRecord = Callable[..., CategoryRecord]


@pytest.fixture
def file(kept: Path, tmp_path: Path) -> Path:
    with LevelMemory.open(kept) as memory:
        export_views(memory, tmp_path / "views.zip")
    return tmp_path / "views.zip"


def test_progress_is_called_for_every_view(kept: Path, memory: PerceptualMemory, tmp_path: Path) -> None:
    exported: list[tuple[int, int]] = []
    imported: list[tuple[int, int]] = []
    with LevelMemory.open(kept) as original:
        export_views(original, tmp_path / "v.zip", lambda *so_far: exported.append(so_far))
    import_views(tmp_path / "v.zip", memory, lambda *so_far: imported.append(so_far))
    assert exported == [(done, 10) for done in range(1, 11)]
    assert imported == [(done, 20) for done in range(1, 21)]  # each is read twice: compared, then written


def test_what_is_exported_comes_back(memory: PerceptualMemory, file: Path, kept: Path, content: Content) -> None:
    assert import_views(file, memory) == Imported(views=10, categories=3, relearn=())
    with LevelMemory.open(kept) as original:
        assert content(memory) == content(original)
    assert memory.verify() == ()
    again = file.with_name("again.zip")
    export_views(memory, again)
    assert again.read_bytes() == file.read_bytes()


def test_other_programs_can_read_it(file: Path, make_view: MakeView) -> None:
    with zipfile.ZipFile(file) as archive:
        assert json.loads(archive.read("memory.json"))["views"] == 10
        arrays = load(archive.read("views/000000000.safetensors"))
    assert np.array_equal(arrays["descriptor/spin"], make_view("fork-1-0").descriptors["spin"])


def test_importing_twice_changes_nothing(memory: PerceptualMemory, file: Path, content: Content) -> None:
    import_views(file, memory)
    before, batches = content(memory), memory.stats().batches
    assert import_views(file, memory) == Imported(views=0, categories=0, relearn=())
    assert content(memory) == before
    assert memory.stats().batches == batches


def test_a_larger_file_goes_in_in_several_steps(
    memory: PerceptualMemory, file: Path, kept: Path, content: Content, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("deixis.memory.perceptual.exchange._STEP", 4000)
    assert import_views(file, memory).views == 10
    assert memory.stats().batches > 3
    with LevelMemory.open(kept) as original:
        assert content(memory) == content(original)


def test_a_state_is_kept_only_if_it_describes_all_views(
    memory: PerceptualMemory, file: Path, make_view: MakeView, make_record: MakeRecord
) -> None:
    """Import three categories: one is mixed with other views, one is known here without views, one is new."""
    mine = TransientMemory()
    import_views(file, mine)
    fork = next(mine.views("fork"))
    memory.write(Batch([make_view("mine", "mug"), fork], [make_record("mug", 0.9), make_record("fork", 0.9)]))
    assert import_views(file, memory) == Imported(views=9, categories=3, relearn=("mug",))
    assert not memory.category("mug").state
    assert memory.category("mug").metadata == {"learner": "instances"}
    assert float(memory.category("fork").state["threshold"]) == 0.1
    assert float(memory.category("plate").state["threshold"]) == 0.0


def test_what_is_there_stays_where_the_file_knows_less(
    memory: PerceptualMemory, file: Path, make_view: MakeView, make_record: MakeRecord
) -> None:
    import_views(file, memory)
    memory.write(Batch([make_view("more", "fork")], [make_record("fork", 0.9)]))
    assert import_views(file, memory) == Imported(views=0, categories=0, relearn=())
    assert float(memory.category("fork").state["threshold"]) == 0.9


def test_another_view_with_a_known_id_is_refused(
    memory: PerceptualMemory, file: Path, make_view: MakeView, content: Content
) -> None:
    memory.write(Batch([make_view("fork-1-0", "fork", seed=99)]))
    before = content(memory)
    with pytest.raises(RejectedWriteError, match="its view 'fork-1-0' differs from the one in the memory"):
        import_views(file, memory)
    assert content(memory) == before


def test_an_export_that_fails_leaves_the_old_file(tmp_path: Path) -> None:
    with pytest.raises(MemoryWriteError, match="cannot be written: No such file"):
        export_views(TransientMemory(), tmp_path / "gone" / "views.zip")


def rewritten(file: Path, change: Callable[[dict[str, bytes]], object], how: int = zipfile.ZIP_STORED) -> None:
    with zipfile.ZipFile(file) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    change(entries)
    with zipfile.ZipFile(file, "w", how) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)


VIEW = "views/000000000.safetensors"


def _note(said: Any) -> bytes:
    text = said if isinstance(said, str) else json.dumps(said)
    return save({"descriptor/d": np.zeros((1, 1), np.float32)}, {"deixis": text})


GOOD = {"id": "x", "category": "mug", "time": "2026-05-01T12:00:00+00:00", "metadata": {}}


def _head(**more: Any) -> bytes:
    return json.dumps(
        {"format": "deixis-perceptual-memory", "version": 1, "views": 10, "categories": 3, **more}
    ).encode()


BAD: dict[str, tuple[dict[str, bytes | None], str]] = {
    "no head": ({"memory.json": None}, r"this is not an export of a memory: it has no 'memory\.json'"),
    "head is not json": ({"memory.json": b"{"}, "memory.json: Expecting"),
    "head is a list": ({"memory.json": b"[]"}, "memory.json"),
    "other format": ({"memory.json": _head(format="x")}, "its format must be deixis-perceptual-memory"),
    "newer": ({"memory.json": _head(version=9)}, r"newer version \(format 9\); upgrade deixis"),
    "fewer views": ({"memory.json": _head(views=9)}, "it lists 9 views"),
    "a view missing": ({VIEW: None}, "not those in the file"),
    "path": ({VIEW: None, "../../etc/passwd": b"x"}, "does not belong in an archive"),
    "no safetensors": ({VIEW: b"x"}, f"{VIEW}: .*header too small"),
    "huge header": ({VIEW: b"\xff" * 20}, "header too large"),
    "no note": ({VIEW: save({"d": np.zeros(1)})}, "'__metadata__' is missing"),
    "note is not json": ({VIEW: _note("{")}, "Expecting"),
    "note is a list": ({VIEW: _note([])}, VIEW),
    "note is deep": ({VIEW: _note("[" * 100_000)}, VIEW),
    "no id": ({VIEW: _note({"category": "mug"})}, "is missing"),
    "id is a number": ({VIEW: _note({**GOOD, "id": 7})}, "a view's id"),
    "time without zone": ({VIEW: _note({**GOOD, "time": "2026-05-01T12:00:00"})}, "time zone"),
    "time is not a time": ({VIEW: _note({**GOOD, "time": "noon"})}, "isoformat"),
    "time is a number": ({VIEW: _note({**GOOD, "time": 1})}, "fromisoformat"),
    "metadata is a list": ({VIEW: _note({**GOOD, "metadata": [1]})}, VIEW),
    "strange array": (
        {VIEW: save({"x": np.zeros((1, 1), np.float32)}, {"deixis": json.dumps(GOOD)})},
        "and no other arrays",
    ),
    "float64": (
        {VIEW: save({"descriptor/d": np.zeros((1, 1))}, {"deixis": json.dumps(GOOD)})},
        "float32 array with two dimensions",
    ),
}


@pytest.mark.parametrize("damage", BAD)
def test_an_invalid_file_is_refused_with_a_one_line_error(memory: PerceptualMemory, file: Path, damage: str) -> None:
    changes, message = BAD[damage]

    def change(entries: dict[str, bytes]) -> None:
        for name, data in changes.items():
            if data is None:
                del entries[name]
            else:
                entries[name] = data

    rewritten(file, change)
    with pytest.raises(ImportFormatError, match=message) as caught:
        import_views(file, memory)
    assert str(file) in str(caught.value) and "\n" not in str(caught.value)
    assert memory.stats().batches == 0


def test_a_compressed_archive_is_refused(memory: PerceptualMemory, file: Path) -> None:
    """Refuse compressed entries, so that a small file cannot become a large one."""
    rewritten(file, lambda entries: None, zipfile.ZIP_DEFLATED)
    with pytest.raises(ImportFormatError, match="compressed"):
        import_views(file, memory)


def test_an_archive_that_was_cut_short_is_known_for_one(
    memory: PerceptualMemory, make_view: MakeView, tmp_path: Path
) -> None:
    memory.write(Batch([make_view("v1")]))
    file = tmp_path / "views.zip"
    export_views(memory, file)
    assert is_archive(file)
    file.write_bytes(file.read_bytes()[:-100])
    assert is_archive(file)
    with pytest.raises(ImportFormatError, match="if it was cut short, get the whole file"):
        import_views(file, memory)
    file.write_text("<a> <b> <c> .")
    assert not is_archive(file)


def test_a_file_that_is_not_an_archive_is_refused(memory: PerceptualMemory, tmp_path: Path) -> None:
    (tmp_path / "x.zip").write_bytes(b"no zip")
    for name in ("x.zip", "gone.zip", "."):
        with pytest.raises(ImportFormatError, match="cannot be read as an archive of views"):
            import_views(tmp_path / name, memory)


def test_cut_or_changed_archives_never_give_a_wrong_view(file: Path, kept: Path, content: Content) -> None:
    with LevelMemory.open(kept) as original:
        before = content(original)
    whole = file.read_bytes()
    rng = np.random.default_rng(5)
    for place in rng.integers(0, len(whole), 60):
        changed = bytearray(whole)
        changed[place] ^= 1 + int(rng.integers(255))
        for data in (bytes(changed), whole[:place]):
            file.write_bytes(data)
            other = TransientMemory()
            try:
                import_views(file, other)
            except ImportFormatError:
                continue
            assert content(other) == before


def test_what_the_commands_call(kept: Path, tmp_path: Path, make_view: MakeView, content: Content) -> None:
    """Run the functions behind the commands on a memory without views, on one with some, and on an exported file."""
    one, two, file = tmp_path / "one", tmp_path / "two", tmp_path / "x.zip"
    one.mkdir()
    assert stats_of(one) is None
    assert verify(one).findings == ()
    with pytest.raises(MemoryFormatError, match="there is no perceptual memory"):
        export_all(one, file)
    shutil.copytree(kept, one / "perceptual")
    export_all(one, file)
    assert is_archive(file)
    assert not is_archive(kept / "seal.json")
    assert import_all(file, two).views == 10
    with open_in(one) as first, open_in(two) as second:
        assert content(first) == content(second)
    counted = stats_of(two)
    assert counted is not None
    assert (counted.views, counted.categories) == (10, 3)
    assert verify(two).findings == ()
