"""A reasoner with dumped classes gives the same answers, and runs without them if they cannot be dumped."""

from __future__ import annotations

from pathlib import Path

import pytest
from ontologies import CUTLERY, ntriples

from deixis.reasoning.description_logic import reasoners as java_classes
from deixis.reasoning.description_logic.reasoners import Reasoner, classify, prepare

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the dumped classes for a small ontology."""
    folder = tmp_path_factory.mktemp("kept") / "classes"
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(java_classes, "_KEPT", folder)
        assert prepare(Reasoner.HERMIT, ntriples(CUTLERY))
    return folder


def test_dumped_classes_change_no_answer(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = ntriples(CUTLERY + ":Spork rdfs:subClassOf :Fork, :Spoon . :f a :DessertFork .")
    monkeypatch.setattr(java_classes, "_KEPT", Path("/nowhere"))
    expected = classify(text, properties=True)
    monkeypatch.setattr(java_classes, "_KEPT", kept)
    assert classify(text, properties=True) == expected


def test_damaged_dumps_are_ignored(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(java_classes, "_KEPT", kept)
    (classes,) = kept.glob("*.jsa")
    classes.write_bytes(classes.read_bytes()[:1_000_000])
    assert "Cutlery" in classify(ntriples(CUTLERY)).inferred


def test_without_write_access_nothing_is_dumped(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setattr(java_classes, "_KEPT", tmp_path / "file" / "classes")
    assert not prepare(Reasoner.HERMIT, ntriples(CUTLERY))
    assert "Cutlery" in classify(ntriples(CUTLERY)).inferred
