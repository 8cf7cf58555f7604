"""Progress bars: count and time on a terminal, nothing elsewhere."""

from __future__ import annotations

import io
from contextlib import redirect_stderr

import pytest

from deixis.cli import progress
from deixis.cli.progress import progress_bar, step_bar


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
    monkeypatch.setattr(progress, "PATIENCE", -1.0)
    with redirect_stderr(shown), step_bar(4) as tick:
        tick("one")
        tick("two")
    assert "two" in shown.getvalue() and "2/4" in shown.getvalue() and "0:00:0" in shown.getvalue()
    assert "\x1b[3" not in shown.getvalue()


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
