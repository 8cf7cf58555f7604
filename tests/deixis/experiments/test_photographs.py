"""Test reading descriptions of photographs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from deixis.experiments.photographs import PhotographError, photographs, photographs_folder
from deixis.experiments.scoreboard.cases import photograph_cases
from deixis.ontology.tbox import default_ontology

PREDICATES = ["on", "above", "ride"]


def _thing(number: int) -> dict[str, Any]:
    return {"category": number, "bbox": [10 * number, 10 * number + 5, 0, 8]}  # y0, y1, x0, x1


def _said(predicate: int, subject: int, object: int) -> dict[str, Any]:
    return {"predicate": predicate, "subject": _thing(subject), "object": _thing(object)}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    annotations = {
        "a.jpg": [_said(0, 0, 1), _said(1, 2, 3), _said(1, 2, 3), _said(2, 4, 5), _said(0, 1, 1)],
        "b.jpg": [_said(0, 0, 1)],
    }
    (tmp_path / "annotations.json").write_text(json.dumps(annotations))
    (tmp_path / "predicates.json").write_text(json.dumps(PREDICATES))
    (tmp_path / "objects.json").write_text(json.dumps(["dog", "wing chair", "dog", "sky"]))
    return tmp_path


def test_images_with_four_related_objects_are_read_with_y_up(folder: Path) -> None:
    (found,) = photographs(folder, default_ontology())
    assert [str(fact) for fact in found.description.facts()] == ["on(dog_0, wing_chair_1)", "top(dog_2, sky_3)"]
    assert found.boxes[1].tolist() == [[0, -15], [8, -10]]


def test_shuffling_keeps_the_truth(folder: Path) -> None:
    (original,) = photographs(folder, default_ontology())
    cases = list(photograph_cases(folder, 3, None, seed=1))
    assert [case.unit for case in cases] == [0, 0, 0]
    assert len({case.description.nodes for case in cases}) > 1
    for case in cases:
        for node, thing in zip(case.description.nodes, case.truth, strict=True):
            assert case.boxes[thing].tolist() == original.boxes[original.description.index(node)].tolist()


@pytest.mark.parametrize(
    ("name", "text"), [("annotations.json", "{"), ("annotations.json", '{"a": [{}]}'), ("predicates.json", "[]")]
)
def test_files_of_another_format_are_an_error(folder: Path, name: str, text: str) -> None:
    (folder / name).write_text(text)
    with pytest.raises(PhotographError, match="no annotations of Visual Relationship Detection"):
        list(photographs(folder, default_ontology()))


def test_a_missing_file_is_an_error(folder: Path) -> None:
    (folder / "objects.json").unlink()
    with pytest.raises(PhotographError, match=r"objects\.json"):
        list(photographs(folder, default_ontology()))


def test_no_folder_without_the_environment_variable(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("DEIXIS_DATA", raising=False)
    assert photographs_folder() is None
    monkeypatch.setenv("DEIXIS_DATA", str(tmp_path))
    assert photographs_folder() is None
    (tmp_path / "vrd").mkdir()
    assert photographs_folder() == tmp_path / "vrd"
