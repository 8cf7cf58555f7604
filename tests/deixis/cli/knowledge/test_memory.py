"""The commands about a memory, where one of its two stores is not there, or damaged, or the folder is a typo."""

from __future__ import annotations

import io
import json
import shutil
from pathlib import Path

import pytest
from commands import deixis

from deixis.examples_data import example
from deixis.memory.perceptual.in_folder import open_in
from deixis.memory.semantic.store import SemanticMemory

SCRIPT1, SCENE = example("script1.layout"), example("place_setting.scene.json")
BOX = {"id": "o1", "min": [10, 20], "max": [40, 60]}


@pytest.fixture
def concepts(tmp_path: Path) -> Path:
    SemanticMemory.open(tmp_path / "concepts", create=True).close()
    return tmp_path / "concepts"


@pytest.fixture
def views(tmp_path: Path) -> Path:
    open_in(tmp_path / "views", create=True).close()
    return tmp_path / "views"


def scene(path: Path, **content: object) -> Path:
    path.write_text(json.dumps({"objects": [], **content}), encoding="utf-8")
    return path


def damage(memory: Path) -> None:
    file = max((memory / "semantic").glob("*.sst"), key=lambda file: file.stat().st_size)
    sound = file.read_bytes()
    place = len(sound) // 2
    file.write_bytes(sound[:place] + bytes([sound[place] ^ 1]) + sound[place + 1 :])


def test_verify_lists_what_it_read_and_what_is_absent(concepts: Path, views: Path) -> None:
    code, out, _ = deixis("memory", "verify", "--memory", concepts)
    assert (code, out) == (0, "All concepts are undamaged.\nThere are no views in this memory.\n")
    code, out, _ = deixis("memory", "verify", "--memory", views)
    assert (code, out) == (0, "All views are undamaged.\nThere are no concepts in this memory.\n")
    open_in(concepts, create=True).close()
    code, out, _ = deixis("memory", "verify", "--memory", concepts)
    assert (code, out) == (0, "All concepts and views are undamaged.\n")


def test_verify_finds_a_flipped_byte_of_what_was_learned(concepts: Path) -> None:
    damage(concepts)
    code, out, err = deixis("memory", "verify", "--memory", concepts)
    assert (code, err) == (1, "")
    assert out.startswith("semantic: ")
    assert "undamaged" not in out
    code, out, _ = deixis("memory", "verify", "--json", "--memory", concepts)
    found = json.loads(out)
    assert (code, found["verified"]) == (1, {"concepts": True, "views": False, "episodes": False})
    assert found["findings"][0]["where"] == "semantic"
    assert "checksum" in found["findings"][0]["what"]


def test_a_memory_of_views_alone_is_not_called_empty(views: Path, tmp_path: Path) -> None:
    for arguments in (("memory", "export"), ("retrieve", SCENE), ("show", "table"), ("query", "ASK {}")):
        code, out, err = deixis(*arguments, "--memory", views)
        assert (code, out) == (2, ""), arguments
        assert "has views, but no lessons" in err
        assert len(err.splitlines()) == 1
    assert "'--format views -o FILE' writes them" in deixis("memory", "export", "--memory", views)[2]
    assert deixis("memory", "export", "--format", "views", "-o", tmp_path / "v.zip", "--memory", views)[0] == 0


def test_an_export_says_that_it_leaves_views_behind(concepts: Path, tmp_path: Path) -> None:
    arguments = ("memory", "export", "-o", tmp_path / "all.trig", "--memory", concepts)
    written = f"Written: {tmp_path / 'all.trig'}\n"
    assert deixis(*arguments) == (0, written, "")
    open_in(concepts, create=True).close()
    code, out, err = deixis(*arguments)
    assert (code, out, len(err.splitlines())) == (0, written, 1)
    assert "'--format views -o FILE' writes them" in err


@pytest.mark.parametrize(("format", "name"), [("views", "v.txt"), ("trig", "all.zip"), ("turtle", "all.trig")])
def test_an_export_has_a_name_that_import_reads_as_what_it_is(
    concepts: Path, tmp_path: Path, format: str, name: str
) -> None:
    open_in(concepts, create=True).close()
    code, out, err = deixis("memory", "export", "--format", format, "-o", tmp_path / name, "--memory", concepts)
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert "must end in" in err
    assert not (tmp_path / name).exists()


def test_recognise_refuses_a_memory_folder_that_does_not_exist(tmp_path: Path) -> None:
    code, out, err = deixis("recognise", SCENE, "--memory", tmp_path / "typo")
    assert (code, out) == (2, "")
    assert "there is no memory at" in err
    assert not (tmp_path / "typo").exists()


def test_no_question_is_asked_about_a_scene_that_cannot_answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("o1\n"))
    bare = scene(tmp_path / "bare.scene.json", objects=[BOX])
    code, out, err = deixis("ask", "cup", bare, "--memory", tmp_path / "memory")
    assert (code, out) == (2, "")
    assert "no object in it has a cloud" in err
    nothing = scene(tmp_path / "nothing.scene.json")
    code, out, err = deixis("ask", "cup", nothing, "--memory", tmp_path / "memory")
    assert (code, err) == (1, "")
    assert out == f"There are no objects in {nothing} that a word could refer to.\n"


def test_a_thing_without_a_cloud_is_not_taken_for_an_answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("o2\n\n"))
    mixed = scene(tmp_path / "mixed.scene.json", objects=[{**BOX, "cloud": "o1.pcd"}, {**BOX, "id": "o2"}])
    code, out, _ = deixis("ask", "cup", mixed, "--memory", tmp_path / "memory")
    assert (code, "'o2' has no cloud" in out) == (1, True)


def test_pixels_are_printed_as_pixels(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("\n"))
    image = scene(tmp_path / "image.scene.json", unit="px", objects=[{**BOX, "cloud": "o1.pcd"}])
    out = deixis("ask", "cup", image, "--memory", tmp_path / "memory")[1]
    assert out.splitlines()[0].split() == ["o1", "30", "x", "40", "px", "at", "25,", "40"]


def test_a_file_that_is_not_an_archive_makes_no_memory(tmp_path: Path) -> None:
    (tmp_path / "views.zip").write_bytes(b"PK\x03\x04 and nothing more")
    code, out, err = deixis("memory", "import", tmp_path / "views.zip", "--memory", tmp_path / "new")
    assert (code, out, len(err.splitlines())) == (2, "", 1)
    assert not (tmp_path / "new").exists()


def test_category_list_refuses_a_memory_that_does_not_exist(tmp_path: Path) -> None:
    code, out, err = deixis("category", "list", "--memory", tmp_path / "mistyped")
    assert (code, out) == (2, "")
    assert "there is no memory" in err


def test_a_missing_store_is_reported_and_nothing_is_created(views: Path) -> None:
    shutil.rmtree(views / "perceptual" / "store-2")
    for arguments in (("memory", "verify"), ("category", "list"), ("memory", "stats")):
        code, out, err = deixis(*arguments, "--memory", views)
        assert (code, out) == (2, ""), arguments
        assert "are lost" in err


def test_episodes_are_exported_imported_counted_and_verified(tmp_path: Path) -> None:
    one, other, file = tmp_path / "one", tmp_path / "other", tmp_path / "a.episodes.json"
    deixis("episodes", "add", "t1", "on", "table", "--start", 1, "--origin", "seen", "--by", "tracker", "--memory", one)
    assert deixis("memory", "export", "--format", "episodes", "-o", file, "--memory", one)[0] == 0
    code, out, _ = deixis("memory", "import", file, "--memory", other)
    assert (code, out) == (0, f"Imported 1 fluents of {file} into the memory {other}.\n")
    assert deixis("memory", "export", "--format", "episodes", "--memory", other)[1] == file.read_text(encoding="utf-8")
    counted = json.loads(deixis("memory", "stats", "--json", "--memory", other)[1])
    assert {name: counted["episodes"][name] for name in ("fluents", "open", "changes")} == {
        "fluents": 1, "open": 1, "changes": 1,
    }  # fmt: skip
    verified = json.loads(deixis("memory", "verify", "--json", "--memory", other)[1])["verified"]
    assert verified == {"concepts": False, "views": False, "episodes": True}
    file.write_text("{}", encoding="utf-8")
    assert deixis("memory", "import", file, "--memory", tmp_path / "third")[0] == 2
    assert not (tmp_path / "third").exists()


def test_what_cannot_be_imported_is_refused_by_what_it_is(tmp_path: Path) -> None:
    (tmp_path / "bad.zip").write_bytes(b"no archive")
    for file, reason in ((tmp_path / "bad.zip", "not an archive of views"), (tmp_path, "this is a folder")):
        code, out, err = deixis("memory", "import", file, "--memory", tmp_path / "m")
        assert (code, out) == (2, "") and reason in err and "unknown format" not in err
