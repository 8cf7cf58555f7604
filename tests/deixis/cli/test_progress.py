"""Progress bars: count and time on a terminal, nothing elsewhere."""

from __future__ import annotations

import io
from contextlib import redirect_stderr

import pytest
from timing import until

from deixis.cli import progress
from deixis.cli.progress import progress_bar, stage_bar, step_bar, time_bar


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
    assert "\x1b[3" not in shown.getvalue()


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


def test_a_bar_appears_in_work_that_reports_nothing(shown: Terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.05)
    with redirect_stderr(shown), progress_bar("reading"):
        assert until(lambda: "reading" in shown.getvalue())


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
