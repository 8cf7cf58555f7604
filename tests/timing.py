"""Bounds on time that hold on a busy machine: processor time instead of the clock, conditions instead of pauses."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from deixis.deadline import CLOCK

BUSY_SECONDS = 60.0
"""Longest time in seconds to wait for another thread or process, which a busy machine may keep waiting."""


@contextmanager
def processor_time_below(seconds: float) -> Iterator[None]:
    """Assert that a block takes less processor time than a bound, which other processes do not change.

    A block that keeps to a time limit on the clock keeps to it in processor time as well. As in time limits, compiling
    does not count: which test of a run is the first to need a kernel is left to chance.

    Parameters
    ----------
    seconds
        The bound in seconds, for all threads of this process together.

    Yields
    ------
    None
    """

    def counted() -> float:
        stopped = time.monotonic() - CLOCK.now()  # seconds in which code was compiled, since the start of the process
        return time.process_time() - stopped

    started = counted()
    yield
    taken = counted() - started
    assert taken < seconds, f"took {taken:.2f} s of processor time, allowed are {seconds:g} s"


def until(condition: Callable[[], bool], seconds: float = BUSY_SECONDS) -> bool:
    """Wait until a condition holds.

    Parameters
    ----------
    condition
        The condition, which is called every hundredth of a second.
    seconds
        Time in seconds after which the condition counts as failed.

    Returns
    -------
    bool
        True if it holds.
    """
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()
