"""Progress of long work: count and time on standard error, on a terminal only.

The bar appears after :data:`PATIENCE` seconds and goes when the work ends. It has no colours where ``NO_COLOR`` is set.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread, Timer

from deixis.cli.output import terminal

PATIENCE = 2.0
"""Seconds before a progress bar appears."""

SECONDS_SHOWN = 0.5
"""Seconds between two updates of a bar that shows a time limit."""


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[..., None] | None]:
    """Show a progress bar with count and time on standard error; ``what`` names the work.

    Yield a function of the steps done, their total and optionally the name of the step, or None without a terminal.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left:"),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=Console(file=terminal(sys.stderr)), transient=True) as bar:
        task = bar.add_task(what, total=None, visible=False)
        appear = Timer(PATIENCE, lambda: bar.update(task, visible=True))
        appear.daemon = True
        appear.start()

        def progress(done: int, total: int, step: str = what) -> None:
            bar.update(task, completed=done, total=total, description=step)

        try:
            yield progress
        finally:
            appear.cancel()
            appear.join()


@contextmanager
def step_bar(total: int, what: str = "experiment") -> Iterator[Callable[[str], None]]:
    """Show a progress bar of ``total`` steps; yield a function to call with the name of each finished step."""
    with progress_bar(what) as progress:
        done = 0

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
def time_bar(what: str, limit: float) -> Iterator[None]:
    """Show a progress bar of the seconds of a time limit, for work whose steps cannot be counted."""
    with progress_bar(what) as progress:
        if progress is None:
            yield
            return
        begun, ended = time.monotonic(), Event()

        def run() -> None:
            while not ended.wait(SECONDS_SHOWN):
                progress(min(round(time.monotonic() - begun), round(limit)), round(limit), f"{what}, seconds")

        clock = Thread(target=run, daemon=True)
        clock.start()
        try:
            yield
        finally:
            ended.set()
            clock.join()
