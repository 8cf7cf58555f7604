"""Record that the user pressed Ctrl-C, even where a library turns it into another error."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event
from types import FrameType

INTERRUPTED = 130
"""Exit code of an interrupted program."""


@contextmanager
def noting_interrupts() -> Iterator[Event]:
    """Yield an event that Ctrl-C sets; KeyboardInterrupt is raised as usual.

    A native library that is being loaded turns KeyboardInterrupt into an ImportError of its own, which need not show
    its cause. Where the program has another handler for the signal, or outside of the main thread, the event is
    never set.
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
