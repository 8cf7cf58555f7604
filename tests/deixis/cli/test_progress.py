"""Progress bars: count and time on a terminal, nothing elsewhere."""

from __future__ import annotations

import io
import json
import time
from contextlib import closing, redirect_stderr, redirect_stdout, suppress
from pathlib import Path
from typing import TextIO

import pytest
from rich.console import Console
from timing import until

from deixis.cli import progress
from deixis.cli.app import main
from deixis.cli.progress import progress_bar, stage_bar, step_bar, time_bar
from deixis.cli.robot.tour import Tour


class Terminal(io.StringIO):
    """Text stream that calls itself a terminal."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    stream = Terminal()
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("NO_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "120")
    return stream


def test_long_work_shows_its_count_without_colours(shown: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with redirect_stderr(shown), step_bar(4) as tick:
        tick("one")
        tick("two")
        assert until(lambda: "two" in shown.getvalue())
    assert "two" in shown.getvalue() and "2/4" in shown.getvalue() and "0:00:0" in shown.getvalue()
    assert "left: " in shown.getvalue()
    assert "\x1b[3" not in shown.getvalue()


def test_the_number_of_steps_is_shown_before_the_first(shown: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with redirect_stderr(shown), step_bar(4):
        assert until(lambda: "0/4" in shown.getvalue())


def test_stages_show_their_name_and_number(shown: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with redirect_stderr(shown), stage_bar("reading", "looking", "cutting") as begin:
        begin("looking")
        assert until(lambda: "looking" in shown.getvalue())
    assert "looking" in shown.getvalue() and "1/3" in shown.getvalue()


def test_work_without_steps_shows_the_seconds_of_its_limit(shown: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    monkeypatch.setattr(progress, "SECONDS_SHOWN", 0.05)
    with redirect_stderr(shown), time_bar("grounding", 30.0):
        assert until(lambda: "/30" in shown.getvalue())
    assert "grounding" in shown.getvalue() and "/30" in shown.getvalue()


def test_work_that_counts_no_steps_shows_its_time_alone(shown: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 1.1)
    with redirect_stderr(shown), progress_bar("reading"):
        assert until(lambda: "0:00:01" in shown.getvalue())
    assert "reading" in shown.getvalue()
    assert "/?" not in shown.getvalue() and "left:" not in shown.getvalue()


def test_steps_without_a_known_total_are_counted(shown: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with redirect_stderr(shown), progress_bar("following, frames") as report:
        assert report is not None
        report(41, None)
        assert until(lambda: " 41 " in shown.getvalue())
    assert "/?" not in shown.getvalue() and "left:" not in shown.getvalue()


def test_short_work_shows_no_bar(shown: Terminal) -> None:
    with redirect_stderr(shown), progress_bar("reading") as report:
        assert report is not None
        report(1, 2)
    assert "reading" not in shown.getvalue()


def test_a_pipe_shows_no_bar() -> None:
    stream = io.StringIO()
    with redirect_stderr(stream), progress_bar("reading") as report:
        assert report is None
    assert stream.getvalue() == ""


def test_a_bar_that_appears_late_shows_the_count_and_time_so_far(
    shown: Terminal, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 1.1)
    with redirect_stderr(shown), progress_bar("reading") as report:
        assert report is not None
        report(3, 7)
        assert until(lambda: "3/7" in shown.getvalue())
    assert "0:00:01" in shown.getvalue()


def test_an_endless_limit_shows_the_time_alone(shown: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with redirect_stderr(shown), time_bar("grounding", float("inf")):
        assert until(lambda: "0:00:0" in shown.getvalue())
    assert "grounding" in shown.getvalue() and "/?" not in shown.getvalue()


def test_no_bar_disturbs_a_user_who_types_the_input(shown: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    monkeypatch.setattr("sys.stdin", Terminal())
    with redirect_stderr(shown), time_bar("reading", 10.0, source="-"):
        time.sleep(0.1)
    assert shown.getvalue() == ""


@pytest.mark.parametrize(
    "command",
    [
        ("ground", "two.layout", "two.scene.json"),
        ("infer", "two.layout"),
        ("imagine", "two.layout"),
        ("lint", "two.layout"),
        ("tell", "two.layout"),
        ("reason", "two.ttl"),
        ("validate", "two.ttl"),
        ("refer", "the fork", "two.scene.json"),
    ],
    ids=lambda command: command[0],
)
def test_commands_that_may_take_long_have_a_bar(
    command: tuple[str, ...], shown: Terminal, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.layout").write_text("fork left of plate\n")
    boxes = [
        {"id": "o1", "min": [0, 0], "max": [0.02, 0.2], "label": "fork"},
        {"id": "o2", "min": [1, 0], "max": [2, 1]},
    ]
    (tmp_path / "two.scene.json").write_text(json.dumps({"objects": boxes}))
    (tmp_path / "two.ttl").write_text("<urn:a> a <urn:b> .\n")
    bars: list[str] = []
    made = progress._LateBar.__init__

    def noted(bar: progress._LateBar, what: str, stream: TextIO) -> None:
        bars.append(what)
        made(bar, what, stream)

    monkeypatch.setattr(progress._LateBar, "__init__", noted)
    monkeypatch.setattr("sys.argv", ["deixis", *command])
    with redirect_stderr(shown), redirect_stdout(io.StringIO()), suppress(SystemExit):
        main()
    assert bars


def test_a_chapter_of_the_demo_shows_its_number(
    shown: Terminal, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.05)
    with redirect_stderr(shown), closing(Tour(Console(file=io.StringIO()), tmp_path, 12)) as tour:
        tour.chapter("One")
        tour.chapter("Two")
        assert until(lambda: "1/12" in shown.getvalue())
