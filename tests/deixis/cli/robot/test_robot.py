"""The command that runs the robot: without standard streams, and with a story that cannot be written."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from commands import deixis
from read_only import make_read_only
from timing import BUSY_SECONDS, until

import deixis as package
from deixis.grammar.layout.parser import parse_script
from deixis.perception.errors import SimulationError
from deixis.robot.live.story import simulated_story


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


def test_the_first_line_names_the_memory(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DEIXIS_MEMORY", str(tmp_path / "own"))
    code, out, _ = deixis("robot", "run", "--from", folder)
    assert code == 0 and out.splitlines()[0] == f"Memory: {tmp_path / 'own'}"


def test_a_story_that_cannot_be_written_is_refused_at_first(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "out").touch()
    code, out, err = deixis("robot", "run", "--from", folder, "--memory", tmp_path / "m", "--story", tmp_path / "out")
    assert (code, out) == (2, "") and "story.png: the folder of the picture cannot be created" in err
    assert not (tmp_path / "m").exists()


def test_a_memory_that_can_only_be_read_is_refused(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    memory = tmp_path / "m"
    assert deixis("episodes", "add", "cup", "shines", "--start", 1, "--memory", memory)[0] == 0
    make_read_only(memory, monkeypatch)
    code, out, err = deixis("robot", "run", "--from", folder, "--memory", memory)
    assert (code, out) == (2, "") and "cannot be opened for writing" in err


@pytest.mark.parametrize("source", ["simulator", "laying"])
@pytest.mark.parametrize(
    ("script", "reason"),
    [
        ("", "the story needs a script with at least 1 thing, got 0"),
        ("layout tea\n", "the story needs a script with at least 1 thing, got 0"),
        ("fork\n", "a.layout:1:1: this statement says nothing about 'fork'\nfork\n^^^^"),
        (None, "a.layout: there is no such file"),
    ],
    ids=["empty", "head", "mistake", "missing"],
)
def test_a_script_that_makes_no_story_is_refused_at_first(
    tmp_path: Path, source: str, script: str | None, reason: str
) -> None:
    file = tmp_path / "a.layout"
    if script is not None:
        file.write_text(script, encoding="utf-8")
    memory = tmp_path / "m"
    code, out, err = deixis("robot", "run", "--from", source, "--layout", file, "--memory", memory)
    assert (code, out) == (2, "") and reason in err and "Error: " not in err
    assert "the story has ended" not in err and not memory.exists()


@pytest.mark.parametrize("script", ["fork left of fork_2", "cup on saucer", "cup on saucer; saucer on plate"])
def test_a_story_of_two_customers_needs_two_free_things(script: str) -> None:
    free = len(parse_script(script).objects) - script.count(" on ")
    if free < 2:
        with pytest.raises(SimulationError, match="at least two things on which nothing lies"):
            simulated_story(parse_script(script))
    else:
        assert simulated_story(parse_script(script)).words


@pytest.mark.parametrize(
    ("source", "option"),
    [
        ("simulator", ("--grows",)),
        ("simulator", ("--camera", "walk")),
        ("laying", ("--intrinsics", "a.json")),
        ("some.module:Camera", ("--rate", "2")),
        (".", ("--seed", "0")),
        ("some.module:Camera", ("--grows",)),
        ("some.module:Camera", ("--layout", "a.layout")),
        (".", ("--layout", "a.layout")),
    ],
    ids=str,
)
def test_an_option_that_the_source_cannot_use_is_refused(tmp_path: Path, source: str, option: tuple[str, ...]) -> None:
    code, out, err = deixis("robot", "run", "--from", source, "--memory", tmp_path / "m", *option)
    assert (code, out) == (2, "") and err.startswith(f"deixis: `{option[0][2:]}` goes with ")
    assert err.endswith(f"only, not with '{source}'; leave it out\n") and not (tmp_path / "m").exists()


@pytest.mark.parametrize("option", ["--say", "--intrinsics"])
def test_a_file_that_cannot_be_read_is_refused_at_first(folder: Path, tmp_path: Path, option: str) -> None:
    (tmp_path / "bad").write_bytes(b"\xff\xfe\x00")
    code, out, err = deixis("robot", "run", "--from", folder, "--memory", tmp_path / "m", option, tmp_path / "bad")
    assert (code, out) == (2, "") and err.startswith(f"deixis: {tmp_path / 'bad'}: ")
    assert "the story has ended" not in err and not (tmp_path / "m").exists()


MAIN_WITH_CTRL_C = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell starts background jobs with SIGINT ignored
from deixis.__main__ import main
main()
"""


@pytest.mark.parametrize("started", [0.0, 1.0], ids=["while it starts", "later"])
@pytest.mark.parametrize("processes", [[], ["--processes"]], ids=["threads", "processes"])
def test_ctrl_c_ends_the_robot_and_all_its_processes_quietly(
    tmp_path: Path, processes: list[str], started: float
) -> None:
    (tmp_path / "clouds").mkdir()
    memory = tmp_path / "memory"
    command = ["robot", "run", "--from", tmp_path / "clouds", "--grows", "--memory", memory, *processes]
    robot = subprocess.Popen(
        [sys.executable, "-c", MAIN_WITH_CTRL_C, *map(str, command)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": str(Path(package.__file__).parents[1])},
        start_new_session=True,
    )
    assert until(memory.exists)
    time.sleep(started)
    os.killpg(robot.pid, signal.SIGINT)
    _, err = robot.communicate(timeout=BUSY_SECONDS)
    assert (robot.returncode, err) == (130, b"")


def test_an_unwritable_story_of_apprentice_is_refused_at_first(tmp_path: Path) -> None:
    (tmp_path / "out").touch()
    code, out, err = deixis("experiment", "apprentice", "--tables", 10**9, "--story", tmp_path / "out")
    assert (code, out) == (2, "") and "the folder of the picture cannot be created" in err
