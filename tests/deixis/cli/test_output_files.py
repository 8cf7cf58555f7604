"""A file is written where its name says what will be in it, and nothing else is written over."""

from __future__ import annotations

from pathlib import Path

import pytest
from commands import deixis

from deixis.examples_data import example

SCRIPT1, SCENE = example("script1.layout"), example("place_setting.scene.json")
WRITERS = {
    "perceive": ("perceive", "table.pcd", "-o"),
    "simulate": ("simulate", SCRIPT1, "--truth"),
    "imagine": ("imagine", SCRIPT1, "-o"),
    "recognise": ("recognise", SCENE, "-o"),
}


@pytest.mark.parametrize("name", ["dear.png", "dear.layout", "dear"])
@pytest.mark.parametrize("writer", WRITERS)
def test_a_scene_is_written_to_a_file_that_ends_in_json(tmp_path: Path, writer: str, name: str) -> None:
    (tmp_path / name).write_text("dear\n")
    code, out, err = deixis(*WRITERS[writer], tmp_path / name)
    assert (code, out) == (2, "")
    assert err == f"deixis: {tmp_path / name}: the name of a scene must end in .json\n"
    assert (tmp_path / name).read_text() == "dear\n"
