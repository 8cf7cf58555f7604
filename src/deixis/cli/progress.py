"""Progress of long work: count and time on standard error, on a terminal only.

The bar appears after :data:`PATIENCE` seconds and goes when the work ends. It has no colours where ``NO_COLOR`` is set.
Work whose steps cannot be counted shows the time that has passed.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Lock, Thread, Timer
from typing import Any, TextIO

from deixis.cli.output import terminal

PATIENCE = 2.0
"""Seconds before a progress bar appears."""

SECONDS_SHOWN = 0.5
"""Seconds between two updates of a bar that shows a time limit."""


class _LateBar:
    """Progress bar that is made when the work has taken :data:`PATIENCE` seconds, so that short work stays fast."""

    def __init__(self, what: str, stream: TextIO) -> None:
        self._stream, self._begun = stream, time.monotonic()
        self._state: tuple[int, int | None, str] = (0, None, what)
        self._bar: Any = None
        self._lock = Lock()
        self._timer = Timer(PATIENCE, self._appear)
        self._timer.daemon = True
        self._timer.start()

    def report(self, done: int, total: int | None, step: str | None = None) -> None:
        """Show how many steps are done, of how many, and optionally the name of the step."""
        with self._lock:
            self._state = (done, total, self._state[2] if step is None else step)
            if self._bar is not None:
                self._bar.update(self._bar.tasks[0].id, completed=done, total=total, description=self._state[2])

    def close(self) -> None:
        """Remove the bar for good."""
        self._timer.cancel()
        self._timer.join()
        if self._bar is not None:
            self._bar.stop()

    def _appear(self) -> None:
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Task,
            TextColumn,
            TimeElapsedColumn,
            TimeRemainingColumn,
        )
        from rich.progress import Progress as Bar
        from rich.text import Text

        class Count(MofNCompleteColumn):
            """Number of steps that are done, of their total if that is known; nothing before the first step."""

            def render(self, task: Task) -> Text:
                if task.total is None:
                    return Text(str(int(task.completed)) if task.completed else "", style="progress.download")
                return super().render(task)

        class TimeLeft(TimeRemainingColumn):
            """Estimated time until the last step is done; nothing where their number is not known."""

            def render(self, task: Task) -> Text:
                return Text() if task.total is None else Text("left: ") + super().render(task)

        columns = (
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            Count(),
            TimeElapsedColumn(),
            TimeLeft(),
        )
        bar = Bar(*columns, console=Console(file=self._stream), transient=True)
        with self._lock:
            done, total, step = self._state
            bar.add_task(step, total=total, completed=done)
            bar.tasks[0].start_time = bar.get_time() - (time.monotonic() - self._begun)
            bar.start()
            self._bar = bar


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[..., None] | None]:
    """Show a progress bar with count and time on standard error; ``what`` names the work.

    Yield a function of the steps done, their total and optionally the name of the step, or None without a terminal.
    """
    if not sys.stderr.isatty():
        yield None
        return
    bar = _LateBar(what, terminal(sys.stderr))
    try:
        yield bar.report
    finally:
        bar.close()


@contextmanager
def step_bar(total: int, what: str = "experiment") -> Iterator[Callable[[str], None]]:
    """Show a progress bar of ``total`` steps; yield a function to call with the name of each finished step."""
    with progress_bar(what) as progress:
        done = 0
        if progress is not None:
            progress(done, total, what)

        def tick(step: str) -> None:
            nonlocal done
            done += 1
            if progress is not None:
                progress(done, total, step)

        yield tick


@contextmanager
def stage_bar(*stages: str) -> Iterator[Callable[[str], None]]:
    """Show a progress bar of named stages; yield a function to call with the name of each stage that begins."""
    with progress_bar(stages[0]) as progress:

        def begin(stage: str) -> None:
            if progress is not None:
                progress(stages.index(stage), len(stages), stage)

        begin(stages[0])
        yield begin


@contextmanager
def time_bar(what: str, limit: float, source: str | None = None) -> Iterator[None]:
    """Show a progress bar of the seconds of a time limit, for work whose steps cannot be counted.

    Without a limit, the bar shows the time that has passed. There is no bar while a user types the ``source`` of the
    work, which is then ``-``.
    """
    if source == "-" and sys.stdin is not None and sys.stdin.isatty():
        yield
        return
    with progress_bar(what) as progress:
        if progress is None or math.isinf(limit):
            yield
            return
        begun, ended = time.monotonic(), Event()

        def run() -> None:
            while not ended.wait(SECONDS_SHOWN):
                progress(round(min(time.monotonic() - begun, limit)), round(limit), f"{what}, seconds")

        clock = Thread(target=run, daemon=True)
        clock.start()
        try:
            yield
        finally:
            ended.set()
            clock.join()
