"""Share the timing and the data folder among the benchmarks."""

from __future__ import annotations

import os
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

from deixis.reasoning.kernel import load_compiled


def data_folder(name: str) -> Path | None:
    """Return a folder of the measuring data; print a note and return None if DEIXIS_DATA does not lead to it."""
    root = os.environ.get("DEIXIS_DATA")
    folder = Path(root) / name if root else None
    if folder is None or not folder.is_dir():
        print(f"skipped: set DEIXIS_DATA to the folder that holds {name}/", file=sys.stderr)
        return None
    return folder


def medians(*jobs: Callable[[], object], runs: int = 7) -> list[float]:
    """Return the median seconds of each job, run in turn so that a slow moment of the machine affects them all.

    Kernels run compiled: a process that runs them only shortly interprets them, which ``bench_startup.py`` measures.
    """
    load_compiled()
    times: list[list[float]] = [[] for _ in jobs]
    for job in jobs:
        job()
    for _ in range(runs):
        for job, taken in zip(jobs, times, strict=True):
            started = time.perf_counter()
            job()
            taken.append(time.perf_counter() - started)
    return [statistics.median(taken) for taken in times]
