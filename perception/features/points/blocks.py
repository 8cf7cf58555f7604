"""Share compiled work on many items among threads.

The kernels release the interpreter's lock, so that plain threads run them in parallel. numba's own parallel loops are
not used: with the thread pool OpenMP a process that forks is aborted, and with workqueue one that calls them from two
threads.
"""

from __future__ import annotations

import os
from collections.abc import Callable

from deixis.perception.errors import CloudError

MIN_BLOCK = 32
"""Minimum number of items handed to a thread: the work on fewer takes less time than handing them over."""

BLOCKS_PER_THREAD = 4
"""Number of blocks per thread: enough that no thread waits long for the last block."""


def in_blocks(job: Callable[[int, int], object], count: int, threads: int | None = None) -> None:
    """Call a function for consecutive ranges, in several threads, until all are covered.

    Parameters
    ----------
    job
        Function of the start and the stop of a range.
    count
        End of the whole range, which starts at 0.
    threads
        Number of threads; None means one for each processor that the process may use.

    Raises
    ------
    CloudError
        If ``threads`` is below 1.

    Examples
    --------
    >>> covered = []
    >>> in_blocks(lambda start, stop: covered.append((start, stop)), 40, threads=1)
    >>> covered
    [(0, 40)]

    Raises CloudError if ``threads`` is below 1.
    """
    if threads is not None and threads < 1:
        raise CloudError(f"`threads` must be at least 1, got {threads}")
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
    """Return the number of processors that this process may run on.

    Returns
    -------
    int
        The number, at least 1.
    """
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
