"""Compiled work on many places at once, shared out among threads.

The kernels release the interpreter's lock, so plain threads run them side by side. numba's own parallel loops are not
used: whichever of their thread pools is at hand, the process may not fork (OpenMP), or may not call them from two
threads of its own (workqueue), or it is aborted.
"""

from __future__ import annotations

import os
from collections.abc import Callable

from deixis.perception.errors import CloudError

MIN_BLOCK = 32
"""Places handed to a thread at a time, at least: fewer are done before they are handed over."""

BLOCKS_PER_THREAD = 4
"""Blocks for each thread: enough that none waits long for the last one."""


def in_blocks(job: Callable[[int, int], object], count: int, threads: int | None = None) -> None:
    """Call ``job(start, stop)`` until 0 to ``count`` are covered; ``threads`` are all the process may use if None.

    >>> covered = []
    >>> in_blocks(lambda start, stop: covered.append((start, stop)), 40, threads=1)
    >>> covered
    [(0, 40)]

    Raises CloudError where ``threads`` is below 1.
    """
    if threads is not None and threads < 1:
        raise CloudError(f"work is shared among 1 thread or more, not {threads}")
    workers = min(threads or available(), count // MIN_BLOCK)
    if workers <= 1:
        job(0, count)
        return
    from concurrent.futures import ThreadPoolExecutor

    block = max(MIN_BLOCK, -(-count // (BLOCKS_PER_THREAD * workers)))
    with ThreadPoolExecutor(workers) as pool:
        for _ in pool.map(lambda start: job(start, min(start + block, count)), range(0, count, block)):
            pass


def available() -> int:
    """Return the number of processors that this process may run on."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
