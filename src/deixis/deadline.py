"""Deadlines: the moment at which work must stop, as one type on one clock."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from typing import Self


@dataclass(frozen=True, order=True)
class Deadline:
    """A moment at which work must stop.

    Work that is split into phases gives each a share of the time that is left, so that one time limit holds for all
    of them. The clock is ``time.monotonic``, which does not jump when the system's clock is set.

    Parameters
    ----------
    at
        The moment in seconds of ``time.monotonic``; infinity means that the work is not limited.

    Examples
    --------
    >>> deadline = Deadline.after(10.0)
    >>> deadline.passed, deadline.share(0.5).left <= 5.0
    (False, True)
    >>> Deadline.never().left
    inf
    """

    at: float

    @classmethod
    def after(cls, seconds: float | None) -> Self:
        """Return the deadline that many seconds from now; None means no limit."""
        return cls(math.inf if seconds is None else time.monotonic() + seconds)

    @classmethod
    def never(cls) -> Self:
        """Return a deadline that never passes."""
        return cls(math.inf)

    @property
    def left(self) -> float:
        """Seconds left, at least 0."""
        return max(0.0, self.at - time.monotonic())

    @property
    def passed(self) -> bool:
        """Whether no time is left."""
        return time.monotonic() >= self.at

    def share(self, fraction: float) -> Self:
        """Return an earlier deadline, by which ``fraction`` (0 to 1) of the time left is used up."""
        if math.isinf(self.at):
            return self
        return type(self)(min(self.at, time.monotonic() + fraction * self.left))

    def delayed(self, seconds: float) -> Self:
        """Return the deadline so many seconds later: those that something took which does not count."""
        return type(self)(self.at + seconds)

    def within(self, seconds: float) -> Self:
        """Return the earlier of this deadline and the one ``seconds`` from now."""
        return type(self)(min(self.at, time.monotonic() + seconds))
