"""Temporary folders, and processes that end with the one that started them.

A folder is removed at the end, at a signal that ends the process, or else by the next process.

>>> with scratch_folder() as folder:
...     _ = (folder / "draft").write_text("x")
>>> folder.exists()
False
"""

from __future__ import annotations

import contextlib
import ctypes
import fcntl
import os
import re
import shutil
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

PREFIX = "deixis-"
_NAME = re.compile(PREFIX + r"(\d+)-\w+")

MIN_AGE = 1.0
"""Minimum age in seconds of a folder that counts as stale: a folder is locked only after it was made."""

ENDING_SIGNALS = (signal.SIGTERM, signal.SIGHUP)
"""Signals that end a process; temporary files are removed before it ends."""


class ScratchFolder:
    """A temporary folder, locked as long as its process lives. Use it as a context manager, or remove it.

    Its name has the id of the process. A folder whose process was killed is removed by :func:`remove_stale`.
    """

    def __init__(self) -> None:
        self.path = Path(tempfile.mkdtemp(prefix=f"{PREFIX}{os.getpid()}-"))
        self._descriptor = os.open(self.path, os.O_RDONLY | os.O_CLOEXEC)
        with contextlib.suppress(OSError):  # a file system without locks
            fcntl.flock(self._descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def remove(self) -> None:
        """Remove the folder with all in it."""
        shutil.rmtree(self.path, ignore_errors=True)
        if self._descriptor >= 0:
            os.close(self._descriptor)
            self._descriptor = -1


@contextmanager
def scratch_folder() -> Iterator[Path]:
    """Make a folder for the block, and remove it after it, also where a signal ends the process.

    Yields
    ------
    pathlib.Path
        The folder.
    """
    remove_stale()
    with _ended_by_signals():
        scratch = ScratchFolder()
        try:
            yield scratch.path
        finally:
            scratch.remove()


def remove_stale() -> None:
    """Remove the scratch folders of processes that were killed."""
    with contextlib.suppress(OSError), os.scandir(tempfile.gettempdir()) as entries:
        for entry in entries:
            named = _NAME.fullmatch(entry.name)
            if named and not _is_alive(int(named.group(1))):
                with contextlib.suppress(OSError):
                    _remove_if_stale(entry)


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def _remove_if_stale(entry: os.DirEntry[str]) -> None:
    found = entry.stat(follow_symlinks=False)
    if not entry.is_dir(follow_symlinks=False) or found.st_uid != os.getuid() or time.time() - found.st_mtime < MIN_AGE:
        return
    descriptor = os.open(entry.path, os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)  # refused where the process lives in another container
        shutil.rmtree(entry.path, ignore_errors=True)
    finally:
        os.close(descriptor)


class _EndedError(BaseException):
    """A signal that ends the process has arrived."""


@contextmanager
def _ended_by_signals() -> Iterator[None]:
    """Turn signals that end the process into an exception in the block, so that it cleans up.

    This works in the main thread only, and where the program has no handler of its own for the signal.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    received: list[int] = []

    def end(number: int, frame: FrameType | None) -> None:
        received.append(number)
        raise _EndedError

    ours = [number for number in ENDING_SIGNALS if signal.getsignal(number) is signal.SIG_DFL]
    for number in ours:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)
        if received:
            os.kill(os.getpid(), received[0])


_PR_SET_PDEATHSIG = 1  # <linux/prctl.h>


def tied_to_parent() -> Callable[[], None] | None:
    """Return a function that makes the system kill a new process when this one ends.

    Returns
    -------
    callable or None
        Function to run in the new process; None except on Linux.
    """
    if not sys.platform.startswith("linux"):
        return None
    library, parent = ctypes.CDLL(None), os.getpid()

    def tie() -> None:
        library.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:  # it was gone before
            os._exit(1)

    return tie
