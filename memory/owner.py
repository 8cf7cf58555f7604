"""One owner of a memory folder: a lock file that the kernel frees when its owner dies, life cycle, and crash-safe
renames.

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
import fcntl
import json
import os
import shutil
import sys
import threading
from abc import ABC, abstractmethod
from datetime import UTC, datetime
from pathlib import Path
from typing import Self

from deixis.memory.errors import MemoryBusyError, MemoryWriteError


class Closing(ABC):
    """As a context manager it gives itself, and is closed at the end."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """Let go of what is held; a second time does nothing."""


def rename(old: Path, new: Path) -> None:
    """Give a file or folder another name, safely on the disk."""
    os.replace(old, new)
    descriptor = os.open(new.parent, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def remove(path: Path) -> None:
    """Remove a folder with all in it, where there is one."""
    if path.is_dir():
        shutil.rmtree(path)


LOCK_FILE = "owner.lock"

_held: set[Path] = set()
_guard = threading.Lock()


class OwnerLock:
    """The lock on one folder, held until it is released or the process ends."""

    def __init__(self, folder: Path, descriptor: int, made: bool) -> None:
        self._folder, self._descriptor, self._made = folder, descriptor, made
        self._before = os.pread(descriptor, 4096, 0)  # what a failed open puts back

    @classmethod
    def acquire(cls, folder: Path) -> OwnerLock:
        """Take the lock, without saying so in the file yet: see :meth:`sign`.

        Raises MemoryBusyError, naming the owner, where somebody has it; MemoryWriteError where no lock can be made.
        """
        real = Path(os.path.realpath(folder))
        with _guard:
            if real in _held:
                raise MemoryBusyError(
                    f"the memory at {folder} is in use: this process has it open already; close it there first"
                )
            descriptor, made = _locked(folder, real / LOCK_FILE)
            _held.add(real)
        return cls(real, descriptor, made)

    def sign(self) -> None:
        """Write who the owner is."""
        command = " ".join([Path(sys.argv[0]).name, *sys.argv[1:]])[:200]
        owner = {"pid": os.getpid(), "command": command, "since": datetime.now(UTC).isoformat(timespec="seconds")}
        try:
            os.ftruncate(self._descriptor, 0)
            os.pwrite(self._descriptor, (json.dumps(owner) + "\n").encode(), 0)
        except OSError as error:
            raise MemoryWriteError(f"{self._folder / LOCK_FILE}: cannot be written: {error.strerror}") from error

    def release(self, undo: bool = False) -> None:
        """Let go and take the owner's name away; with ``undo`` the folder is left as it was found."""
        with _guard:
            with contextlib.suppress(OSError):
                if undo and self._made:
                    os.unlink(self._folder / LOCK_FILE)
                else:
                    os.ftruncate(self._descriptor, 0)
                    os.pwrite(self._descriptor, self._before if undo else b"", 0)
            os.close(self._descriptor)
            _held.discard(self._folder)


def _locked(folder: Path, file: Path) -> tuple[int, bool]:
    while True:
        made = not file.exists()
        try:
            descriptor = os.open(file, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        except OSError as error:
            raise MemoryWriteError(
                f"the memory at {folder} cannot be opened for writing: {error.strerror}; make the folder writable"
            ) from error
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            advice = "wait until it is done, or close it there"
            try:
                owner = json.loads(os.pread(descriptor, 4096, 0))
                who = f"process {owner['pid']} ({owner['command']}) since {owner['since']}"
            except (ValueError, KeyError, TypeError):
                who = "another process"
            message = f"the memory at {folder} is in use by {who}; {advice}"
            os.close(descriptor)
            raise MemoryBusyError(message) from error
        if _same_file(descriptor, file):
            return descriptor, made
        os.close(descriptor)  # its maker took it away between our opening and our locking it


def _same_file(descriptor: int, file: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(descriptor), os.stat(file))
    except FileNotFoundError:
        return False
