"""Progress of long work: count and time on standard error, on a terminal only.

The bar appears after :data:`PATIENCE` seconds and goes when the work ends. It has no colours where ``NO_COLOR`` is set.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from deixis.cli.output import terminal

PATIENCE = 2.0
"""Seconds before a progress bar appears."""


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

    started = time.perf_counter()
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

        def progress(done: int, total: int, step: str = what) -> None:
            late = time.perf_counter() - started > PATIENCE
            bar.update(task, completed=done, total=total, description=step, visible=late)

        yield progress


@contextmanager
def step_bar(total: int) -> Iterator[Callable[[str], None]]:
    """Show a progress bar of ``total`` steps; yield a function to call with the name of each finished step."""
    with progress_bar("experiment") as progress:
        done = 0

        def tick(step: str) -> None:
            nonlocal done
            done += 1
            if progress is not None:
                progress(done, total, step)

        yield tick
