"""The command that runs the robot: without standard streams, and with a story that cannot be written."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest
from commands import deixis
from read_only import make_read_only


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Folder with a cloud that cannot be used."""
    (tmp_path / "clouds").mkdir()
    (tmp_path / "clouds" / "a.pcd").touch()
    return tmp_path / "clouds"


@pytest.mark.parametrize("given", [None, io.TextIOWrapper(io.BytesIO(b"\xff\n")), io.StringIO("a" * 100_000)])
def test_the_robot_needs_no_standard_input(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, given: object
) -> None:
    monkeypatch.setattr(sys, "stdin", given)
    code, out, err = deixis("robot", "run", "--from", folder, "--memory", tmp_path / "m", "--stay")
    assert (code, err) == (0, "") and "Layout: unknown" in out


def test_a_story_that_cannot_be_written_is_refused_at_first(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "out").touch()
    code, out, err = deixis("robot", "run", "--from", folder, "--memory", tmp_path / "m", "--story", tmp_path / "out")
    assert (code, out) == (2, "") and "story.png: the folder of the picture cannot be made" in err
    assert not (tmp_path / "m").exists()


def test_a_memory_that_can_only_be_read_is_refused(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    memory = tmp_path / "m"
    assert deixis("episodes", "add", "cup", "shines", "--start", 1, "--memory", memory)[0] == 0
    make_read_only(memory, monkeypatch)
    code, out, err = deixis("robot", "run", "--from", folder, "--memory", memory)
    assert (code, out) == (2, "") and "cannot be opened for writing" in err
