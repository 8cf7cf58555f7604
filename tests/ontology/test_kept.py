"""Results that are kept beside bytecode: they are used while nothing that they were made from has changed."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from deixis.ontology import tbox
from deixis.ontology.kept import kept


class Counted:
    """A function that counts its calls."""

    def __init__(self) -> None:
        self.calls = 0

    def __call__(self) -> dict[str, int]:
        self.calls += 1
        return {"calls": self.calls}


@pytest.fixture
def source(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(sys, "pycache_prefix", None)
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    file = tmp_path / "words.ttl"
    file.write_text("a", encoding="utf-8")
    return file


def _files(source: Path) -> list[Path]:
    return sorted(source.parent.glob("__pycache__/*"))


def test_a_result_is_made_once_for_the_same_files(source: Path) -> None:
    make = Counted()
    assert [kept("words", [source], make) for _ in range(3)] == [{"calls": 1}] * 3
    assert len(_files(source)) == 1


def test_a_changed_file_replaces_the_result(source: Path) -> None:
    make = Counted()
    kept("words", [source], make)
    source.write_text("b", encoding="utf-8")
    assert kept("words", [source], make) == {"calls": 2}
    assert len(_files(source)) == 1


@pytest.mark.parametrize("damage", [b"", b"no digest", b"0\nx"])
def test_a_damaged_result_is_made_again(source: Path, damage: bytes) -> None:
    make = Counted()
    kept("words", [source], make)
    _files(source)[0].write_bytes(damage)
    assert kept("words", [source], make) == {"calls": 2}
    assert kept("words", [source], make) == {"calls": 2}


def test_a_folder_that_cannot_be_written_keeps_nothing(source: Path) -> None:
    (source.parent / "__pycache__").write_text("a file instead of the folder", encoding="utf-8")
    make = Counted()
    assert [kept("words", [source], make)["calls"] for _ in range(2)] == [1, 2]


def test_nothing_is_written_where_python_writes_no_bytecode(source: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    kept("words", [source], Counted())
    assert not _files(source)


def test_the_kept_ontology_equals_the_one_that_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "pycache_prefix", str(tmp_path))
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    read, loaded = tbox.load_ontology(), tbox.default_ontology.__wrapped__
    loaded()
    monkeypatch.setattr(tbox, "load_ontology", None)  # is not called again
    again = loaded()
    assert list(again.relations) == list(read.relations) and list(again.kinds) == list(read.kinds)
    assert again.hedges == read.hedges and list(again.colours) == list(read.colours)
    assert [again.sizes.of(kind.iri) for kind in again.kinds] == [read.sizes.of(kind.iri) for kind in read.kinds]
    assert again.kinds_key == read.kinds_key and again.quality("red mug") == read.quality("red mug")
