"""Time limits of computations: deadlines on one clock."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Self


class Clock:
    """Seconds of ``time.monotonic``, without those in which the clock was stopped."""

    def __init__(self) -> None:
        self._lock, self._holders = threading.Lock(), 0
        self._state: tuple[float | None, float] = None, 0.0  # start of this stop; seconds of earlier ones

    def now(self) -> float:
        """Return the seconds of the clock.

        Returns
        -------
        float
            Seconds since an arbitrary moment, without the time in :func:`clock_stopped`.
        """
        since, before = self._state
        return (time.monotonic() if since is None else since) - before

    def stop(self) -> None:
        """Stop the clock until :meth:`go_on` is called as many times as this."""
        with self._lock:
            self._holders += 1
            if self._holders == 1:
                self._state = time.monotonic(), self._state[1]

    def go_on(self) -> None:
        """Undo one call of :meth:`stop`."""
        with self._lock:
            since, before = self._state
            self._holders = max(0, self._holders - 1)
            if self._holders == 0 and since is not None:
                self._state = None, before + time.monotonic() - since


CLOCK = Clock()
"""Clock of all deadlines of a process."""

LAST_SHARE = 0.1
"""Share of a time limit that remains for the explanation if the verdict has used all of it."""

MIN_MEASURED, MAX_SLOWNESS = 0.05, 30.0
"""Processor seconds from which the slowness of a machine is measured, and the maximum slowness that counts."""

LONGEST = 1_000_000.0
"""Longest time limit in seconds, 11 days; a longer one counts as none, because the system's waits cannot be as long."""


@contextmanager
def clock_stopped() -> Iterator[None]:
    """Stop the clock of all deadlines, for work that is done once and does not count, such as compiling.

    Yields
    ------
    None
        Nothing; the clock runs again after the block.

    Examples
    --------
    >>> deadline = Deadline.after(0.05)
    >>> with clock_stopped():
    ...     time.sleep(0.1)
    >>> deadline.passed
    False
    """
    CLOCK.stop()
    try:
        yield
    finally:
        CLOCK.go_on()


@dataclass(frozen=True, order=True)
class Deadline:
    """A moment at which work must stop.

    Each phase of a computation gets a share of the time left, so that one time limit holds for all of them. The clock
    is ``time.monotonic``, which does not jump when the system's clock is set; it is stopped while code is compiled
    (:func:`clock_stopped`).

    Parameters
    ----------
    at
        The moment in seconds of the clock; infinity means no limit.
    begun
        Seconds of the clock and of the processor at which the time limit began; now, by default.

    Examples
    --------
    >>> deadline = Deadline.after(10.0)
    >>> deadline.passed, deadline.share(0.5).left <= 5.0
    (False, True)
    >>> Deadline.never().left
    inf
    """

    at: float
    begun: tuple[float, float] = field(
        default_factory=lambda: (CLOCK.now(), time.process_time()), compare=False, repr=False
    )

    @classmethod
    def after(cls, seconds: float | None) -> Self:
        """Return the deadline some seconds from now.

        Parameters
        ----------
        seconds
            Seconds from now; None, and more than :data:`LONGEST`, mean no limit.

        Returns
        -------
        Deadline
            The deadline.
        """
        return cls(math.inf if seconds is None or seconds > LONGEST else CLOCK.now() + seconds)

    @classmethod
    def never(cls) -> Self:
        """Return a deadline that never passes.

        Returns
        -------
        Deadline
            A deadline without a limit.
        """
        return cls(math.inf)

    @property
    def left(self) -> float:
        """Seconds left, at least 0."""
        return max(0.0, self.at - CLOCK.now())

    @property
    def passed(self) -> bool:
        """True if no time is left."""
        return CLOCK.now() >= self.at

    @property
    def slowness(self) -> float:
        """Seconds of the clock per second of the processor since the time limit began, at least 1.

        Other programs slow this one down. Work whose duration is estimated before it begins takes that many times as
        long as on a quiet machine.
        """
        clock, processor = CLOCK.now() - self.begun[0], time.process_time() - self.begun[1]
        if math.isinf(self.at) or processor < MIN_MEASURED:
            return 1.0
        return min(max(1.0, clock / processor), MAX_SLOWNESS)

    def share(self, fraction: float) -> Self:
        """Return an earlier deadline, by which part of the time left is used up.

        Parameters
        ----------
        fraction
            Part of the time left, in [0, 1].

        Returns
        -------
        Deadline
            The earlier deadline.
        """
        if math.isinf(self.at):
            return self
        return replace(self, at=min(self.at, CLOCK.now() + fraction * self.left))

    def for_reasons(self, time_limit: float) -> Self:
        """Return the deadline for finding the reasons of a verdict.

        Parameters
        ----------
        time_limit
            Time limit of the verdict in seconds, whose end is this deadline.

        Returns
        -------
        Deadline
            This deadline, or one that leaves :data:`LAST_SHARE` of the limit from now, whichever is later.
        """
        return max(self, self.after(LAST_SHARE * time_limit))

    def within(self, seconds: float) -> Self:
        """Return this deadline, or one some seconds from now if that is earlier.

        Parameters
        ----------
        seconds
            Seconds from now.

        Returns
        -------
        Deadline
            The earlier of the two.
        """
        return replace(self, at=min(self.at, CLOCK.now() + seconds))

    def earlier(self, seconds: float) -> Self:
        """Return an earlier deadline, which leaves time for work after it.

        Parameters
        ----------
        seconds
            Seconds before this deadline.

        Returns
        -------
        Deadline
            The earlier deadline.
        """
        return replace(self, at=self.at - seconds)
