"""Subscriptions to changes of the blackboard: one thread each, which reads the log at its own pace."""

from __future__ import annotations

import threading
import time
import weakref
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum

from deixis.answers import count
from deixis.memory.episodes.fluents.changes import Logged
from deixis.memory.folder import one_line

Callback = Callable[[Logged], object]
"""Function that is called with each change."""

PATIENCE = 1.0
"""Time in seconds for one call, after which a subscriber is named as slow."""

MAX_PAUSE = 5.0
"""Longest pause in seconds before a call that raised is repeated; the pause starts at 0.05 and doubles."""


_watched: weakref.WeakSet[Subscription] = weakref.WeakSet()
_watching = threading.Lock()
_watcher: threading.Thread | None = None


def _watch(subscription: Subscription) -> None:
    """Have one thread of the process name the subscription if a call takes long, also if nothing more is written."""
    global _watcher
    with _watching:
        _watched.add(subscription)
        if _watcher is None or not _watcher.is_alive():
            _watcher = threading.Thread(target=_keep_watch, name="watch over subscribers", daemon=True)
            _watcher.start()


def _keep_watch() -> None:
    """Check all subscriptions now and then, until the last one has ended."""
    global _watcher
    while True:
        time.sleep(PATIENCE / 2)
        with _watching:
            watched = list(_watched)
            for each in watched:
                if each.state.condition is Condition.ENDED:
                    _watched.discard(each)
            if not _watched:
                _watcher = None
                return
        for each in watched:
            with suppress(Exception):  # of a function that reports troubles
                each.check()


class Condition(Enum):
    """State of a subscriber: waiting, in a call, in a long call, raising, or ended."""

    WAITING = "waiting"
    WORKING = "working"
    SLOW = "slow"
    FAILING = "failing"
    ENDED = "ended"


@dataclass(frozen=True, slots=True)
class SubscriberState:
    """A subscriber at one moment.

    ``position`` is the sequence number up to which it has been notified, ``behind`` the number of changes in the log
    after it, ``error`` the last error of its callback if the present change has failed.
    """

    name: str
    condition: Condition
    position: int
    behind: int
    error: str | None = None

    def __str__(self) -> str:
        cause = "" if self.error is None else f": {self.error}"
        return f"the subscriber '{self.name}' is {self.condition.value}, {count(self.behind, 'change')} behind{cause}"


class Subscription:
    """One subscriber: its callback gets each change that concerns it, in order, until it returns once for each.

    A callback that raises is called again with the same change after a pause, so that no change is lost. Writers never
    wait for it.
    """

    def __init__(
        self,
        name: str,
        concerns: Callable[[Logged], bool],
        callback: Callback,
        position: int,
        read: Callable[[int], Iterator[Logged]],
        last: Callable[[], int],
        trouble: Callable[[str], None],
        moved: Callable[[int], object] = lambda position: None,
    ) -> None:
        self.name = name
        self._concerns, self._callback, self._read, self._last = concerns, callback, read, last
        self._trouble, self._told = trouble, moved
        self._position = position
        self._wake = threading.Event()
        self._ended = threading.Event()
        self._called: float | None = None  # when the present call began
        self._error: str | None = None
        self._named_slow = False
        self._naming = threading.Lock()
        self._moved = threading.Condition()
        self._thread = threading.Thread(target=self._run, name=f"subscriber {name}", daemon=True)

    def begin(self) -> None:
        """Start the thread."""
        self._thread.start()
        _watch(self)

    def notify(self) -> None:
        """Wake the thread after a write."""
        self._wake.set()

    def cancel(self, timeout: float = PATIENCE) -> None:
        """End the subscription after the present call.

        Parameters
        ----------
        timeout
            Time in seconds to wait for the present call. A callback that hangs is left behind in its thread.
        """
        self._ended.set()
        self._wake.set()
        if self._thread.is_alive() and threading.current_thread() is not self._thread:
            self._thread.join(timeout)

    @property
    def position(self) -> int:
        """Sequence number up to which the subscriber has been notified."""
        return self._position

    @property
    def state(self) -> SubscriberState:
        """Position, backlog and trouble of the subscriber at this moment."""
        called, error = self._called, self._error
        if self._ended.is_set():
            condition = Condition.ENDED
        elif called is not None and time.monotonic() - called > PATIENCE:
            condition = Condition.SLOW
        elif error is not None:
            condition = Condition.FAILING
        else:
            condition = Condition.WAITING if called is None else Condition.WORKING
        return SubscriberState(self.name, condition, self._position, max(0, self._last() - self._position), error)

    def check(self) -> None:
        """Name the subscriber once if its present call takes longer than ``PATIENCE``."""
        with self._naming:
            if self._named_slow or self.state.condition is not Condition.SLOW:
                return
            self._named_slow = True
        self._trouble(str(self.state))

    def wait(self, sequence: int, timeout: float | None = None) -> bool:
        """Wait until the subscriber has been notified of all changes up to a sequence number.

        Parameters
        ----------
        sequence
            The sequence number.
        timeout
            Longest time to wait in seconds; no limit by default.

        Returns
        -------
        bool
            True if it has been notified in time.
        """
        with self._moved:
            return self._moved.wait_for(lambda: self._position >= sequence, timeout)

    def _run(self) -> None:
        while not self._ended.is_set():
            self._wake.wait()
            self._wake.clear()
            while self._position < (last := self._last()) and not self._ended.is_set():
                for change in self._read(self._position):
                    if self._ended.is_set() or not self._accepted(change):
                        return
                    self._move(change.sequence)
                self._move(last)  # past changes that a damaged log has lost

    def _move(self, position: int) -> None:
        with self._moved:
            self._position = max(self._position, position)
            self._moved.notify_all()
        self._told(self._position)

    def _accepted(self, change: Logged) -> bool:
        """Call the callback until it returns; return False if the subscription ended before."""
        pause = 0.05
        while not self._ended.is_set():
            self._called, self._named_slow = time.monotonic(), False
            try:
                if self._concerns(change):
                    self._callback(change)
            except BaseException as error:  # whatever a module raises, SystemExit too, must not end the subscription
                first, self._error = self._error is None, f"{type(error).__name__}: {one_line(error)}"
                self._called = None
                if first:
                    self._trouble(str(self.state))
            else:
                self._called = self._error = None
                return True
            self._ended.wait(pause)
            pause = min(2 * pause, MAX_PAUSE)
        return False
