"""Ownership of a memory folder by one process: a lock file that the kernel frees, and crash-safe renames.

>>> import tempfile
>>> folder = Path(tempfile.mkdtemp())
>>> lock = OwnerLock.acquire(folder)
>>> try:
...     OwnerLock.acquire(folder)
... except MemoryBusyError as error:
...     "this process has it open already" in str(error)
True
>>> lock.release()
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import json
import os
import shutil
import sys
import threading
import weakref
from abc import ABC, abstractmethod
from datetime import UTC, datetime
from pathlib import Path
from typing import ClassVar, NoReturn, Self

from deixis.memory.errors import MemoryBusyError, MemoryWriteError, ReadOnlyMemoryError


class Closing(ABC):
    """Base class of objects that are closed when their ``with`` block ends."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    def __reduce__(self) -> NoReturn:
        name = type(self).__name__
        raise TypeError(f"a {name} cannot be copied or pickled, because it may hold open files; make another {name}")

    @abstractmethod
    def close(self) -> None:
        """Release all resources; a second call does nothing."""


def rename(old: Path, new: Path) -> None:
    """Rename a file or folder, and sync the directory so that the new name survives a crash.

    Parameters
    ----------
    old, new
        Its present path and its new one.
    """
    old.replace(new)
    descriptor = os.open(new.parent, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def remove(path: Path) -> None:
    """Remove a folder and its content, if it exists.

    Parameters
    ----------
    path
        The folder.
    """
    if path.is_dir():
        shutil.rmtree(path)


LOCK_FILE = "owner.lock"

_held: dict[Path, OwnerLock] = {}
_guard = threading.Lock()


class OwnerLock:
    """Exclusive lock on one folder, held until it is released or the process ends. A forked child does not have it."""

    def __init__(self, folder: Path, descriptor: int, made: bool) -> None:
        self._folder, self._descriptor, self._made = folder, descriptor, made
        self._before = os.pread(descriptor, 4096, 0)  # restored if the opening fails

    @classmethod
    def acquire(cls, folder: Path) -> OwnerLock:
        """Take the lock; :meth:`sign` then writes the owner into the file.

        Parameters
        ----------
        folder
            The folder of the memory.

        Returns
        -------
        OwnerLock
            The lock.

        Raises
        ------
        MemoryBusyError
            If another process has the lock; the message names it.
        ReadOnlyMemoryError
            If the folder cannot be written.
        MemoryWriteError
            If the lock file cannot be created for another reason.
        """
        real = Path(os.path.realpath(folder))
        with _guard:
            if real in _held:
                raise _already_open(folder)
            lock = _held[real] = cls(real, *_locked(folder, real / LOCK_FILE))
        return lock

    def sign(self) -> None:
        """Write the owner's process, command and starting time into the lock file.

        Raises
        ------
        MemoryWriteError
            If the lock file cannot be written.
        """
        command = " ".join([Path(sys.argv[0]).name, *sys.argv[1:]])[:200]
        owner = {"pid": os.getpid(), "command": command, "since": datetime.now(UTC).isoformat(timespec="seconds")}
        try:
            os.ftruncate(self._descriptor, 0)
            os.pwrite(self._descriptor, (json.dumps(owner) + "\n").encode(), 0)
        except OSError as error:
            raise MemoryWriteError(f"{self._folder / LOCK_FILE}: cannot be written: {error.strerror}") from error

    def release(self, undo: bool = False) -> None:
        """Release the lock and erase the owner's name.

        Parameters
        ----------
        undo
            True to restore the folder as it was found.
        """
        with _guard:
            if _held.get(self._folder) is not self:
                return  # the lock is the parent's, or was released
            with contextlib.suppress(OSError):
                if undo and self._made:
                    (self._folder / LOCK_FILE).unlink()
                else:
                    os.ftruncate(self._descriptor, 0)
                    os.pwrite(self._descriptor, self._before if undo else b"", 0)
            os.close(self._descriptor)
            del _held[self._folder]


class ReaderLock:
    """Shared lock of readers on a folder that cannot be written; it records no owner.

    A reader and a writer that reaches the folder by another path exclude each other if the folder has a lock file.
    """

    def __init__(self, descriptor: int | None) -> None:
        self._descriptor = descriptor

    @classmethod
    def acquire(cls, folder: Path) -> ReaderLock:
        """Take the lock if the folder has a lock file.

        Parameters
        ----------
        folder
            The folder of the memory.

        Returns
        -------
        ReaderLock
            The lock.

        Raises
        ------
        MemoryBusyError
            If a writer has it.
        """
        real = Path(os.path.realpath(folder))
        with _guard:
            if real in _held:
                raise _already_open(folder)
        try:
            descriptor = os.open(real / LOCK_FILE, os.O_RDONLY | os.O_CLOEXEC)
        except OSError:
            return cls(None)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except OSError as error:
            message = _busy(folder, descriptor)
            os.close(descriptor)
            raise MemoryBusyError(message) from error
        return cls(descriptor)

    def release(self, undo: bool = False) -> None:
        """Release the lock.

        Parameters
        ----------
        undo
            Has no effect.
        """
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None


_has_opened = False  # True once this process has opened a store on disk, which starts threads of the library
_threads_left_behind = False  # True if this process was forked from one that had opened a store


def begin_opening(folder: Path) -> None:
    """Record that a store on disk is about to be opened.

    Parameters
    ----------
    folder
        The folder of the memory.

    Raises
    ------
    MemoryBusyError
        In a process that was forked from one that had opened a store: the libraries' threads stayed in the parent, and
        opening would wait for them forever.
    """
    global _has_opened
    if _threads_left_behind:
        raise MemoryBusyError(
            f"the memory at {folder} cannot be opened by a process that was forked from one which had opened a memory; "
            "start a new process instead (multiprocessing: 'spawn'), or fork before the first memory is opened"
        )
    _has_opened = True


def leave_to_parent() -> None:
    """Drop all locks in a forked child: they belong to its parent, which must not lose them."""
    global _guard, _threads_left_behind
    _threads_left_behind = _has_opened
    _guard = threading.Lock()
    for lock in _held.values():
        os.close(lock._descriptor)
    _held.clear()


os.register_at_fork(after_in_child=leave_to_parent)


def forked(folder: Path) -> MemoryBusyError:
    """Return the error for a memory that was open when this process was forked from its owner.

    Parameters
    ----------
    folder
        The folder of the memory.

    Returns
    -------
    MemoryBusyError
        The error, which is not raised.
    """
    return MemoryBusyError(
        f"the memory at {folder} is held by the process from which this one was forked; open a memory in the process "
        "that uses it, or close it before forking"
    )


def _already_open(folder: Path) -> MemoryBusyError:
    return MemoryBusyError(f"the memory at {folder} is in use: this process has it open already; close it there first")


class ThreadLock:
    """Re-entrant lock for the threads of one process.

    A forked child finds it free, as the thread that had it does not exist there.

    >>> lock = ThreadLock()
    >>> with lock, lock:
    ...     pass
    """

    _all: ClassVar[weakref.WeakSet[ThreadLock]] = weakref.WeakSet()

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._all.add(self)

    def __enter__(self) -> Self:
        self._lock.acquire()
        return self

    def __exit__(self, *raised: object) -> None:
        self._lock.release()

    @classmethod
    def renew_all(cls) -> None:
        """Free all thread locks in a forked child."""
        for lock in cls._all:
            lock._lock = threading.RLock()


os.register_at_fork(after_in_child=ThreadLock.renew_all)

READ_ONLY = {errno.EROFS, errno.EACCES, errno.EPERM}
"""Error codes of the system for a folder that cannot be written."""


def _locked(folder: Path, file: Path) -> tuple[int, bool]:
    while True:
        made = not file.exists()
        try:
            descriptor = os.open(file, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        except OSError as error:
            kind = ReadOnlyMemoryError if error.errno in READ_ONLY else MemoryWriteError
            raise kind(
                f"the memory at {folder} cannot be opened for writing: {error.strerror}; make the folder writable"
            ) from error
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            message = _busy(folder, descriptor)
            os.close(descriptor)
            raise MemoryBusyError(message) from error
        if _same_file(descriptor, file):
            return descriptor, made
        os.close(descriptor)  # its maker removed it after it was opened here and before it was locked


def _busy(folder: Path, descriptor: int) -> str:
    try:
        owner = json.loads(os.pread(descriptor, 4096, 0))
        who = f"process {owner['pid']} ({owner['command']}) since {owner['since']}"
    except (ValueError, KeyError, TypeError):
        who = "another process"
    return f"the memory at {folder} is in use by {who}; wait until it is done, or close it there"


def _same_file(descriptor: int, file: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), file.stat())
    except FileNotFoundError:
        return False
