"""Whether the user has interrupted the program, also where a library makes another error of that."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event
from types import FrameType

INTERRUPTED = 130
"""The exit code of a program that was interrupted."""


@contextmanager
def noting_interrupts() -> Iterator[Event]:
    """An event that is set once Ctrl-C was pressed, for as long as this lasts; KeyboardInterrupt is raised as ever.

    A native library that is just being loaded turns KeyboardInterrupt into an ImportError of its own, which need not
    say where it comes from. Where somebody else sees to the signal, or outside the main thread, nothing is noted.
    """
    interrupted = Event()
    ours = threading.current_thread() is threading.main_thread()
    if not ours or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield interrupted
        return

    def note(number: int, frame: FrameType | None) -> None:
        interrupted.set()
        signal.default_int_handler(number, frame)

    signal.signal(signal.SIGINT, note)
    try:
        yield interrupted
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
