"""Keys and values of the episodes in a LevelDB on disk, which one process owns.

A write is in the file cache of the system when it returns, so that it survives a kill of the process; a synchronised
write also survives a power cut. Values have a checksum of their own, as LevelDB returns some damaged blocks silently.
The file ``acknowledged`` has the number of the last write, because LevelDB drops a broken end of its log without an
error.

>>> import tempfile
>>> folder = Path(tempfile.mkdtemp()) / "episodes"
>>> keys = DiskKeys.open(folder, create=True)
>>> keys.write({b"b": b"2", b"a": b"1"})
>>> keys.close()
>>> DiskKeys.open(folder).get(b"a")
b'1'
"""

from __future__ import annotations

import contextlib
import os
import struct
from collections.abc import Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import Any

import plyvel

from deixis.memory import owner as disk
from deixis.memory.episodes.store.keys import Keys
from deixis.memory.errors import DamagedMemoryError, MemoryFormatError, MemoryWriteError, ReadOnlyMemoryError
from deixis.memory.folder import one_line
from deixis.memory.owner import LOCK_FILE, OwnerLock, ReaderLock, forked
from deixis.memory.perceptual.database.codec import seal, unseal
from deixis.memory.perceptual.database.handle import copied_for_reading, wrap_level_errors
from deixis.scratch import ScratchFolder

STORE, TALLY = "store-1", "acknowledged"
"""Folder of the database with the version of its format, and file with the number of the last write."""

OPTIONS = {
    "paranoid_checks": True,
    "write_buffer_size": 16 << 20,
    "max_file_size": 16 << 20,
    "lru_cache_size": 32 << 20,
    "bloom_filter_bits": 10,  # an addition first looks for a fluent with its id, which is nearly never there
}

_WRITES = b"#writes"
_NUMBER = struct.Struct(">Q")
_PROBE = 1 << 18  # bytes that must fit on the disk before the database is opened again after a failed write


class DiskKeys(Keys):
    """An ordered store on disk. Its user must let only one thread in at a time.

    After a failed write, reading still works. The next write opens the database again, as its log may end in half a
    write. A folder that cannot be written is opened as a copy, which :meth:`protect` makes read-only.
    """

    def __init__(self, folder: Path, lock: OwnerLock | ReaderLock, db: Any, tally: int, sync: bool) -> None:
        self.folder = folder
        self._scratch: ScratchFolder | None = None
        self._read_only, self._protected = "", False
        self._lock, self._db, self._tally, self._sync = lock, db, tally, sync
        self._process = os.getpid()
        self._writes = self._stored_writes()
        self.lost = max(0, _acknowledged(tally) - self._writes)
        """Number of acknowledged writes that were missing when the store was opened."""
        self._failed: str | None = None

    @classmethod
    def open(cls, folder: Path, create: bool = False, sync: bool = False) -> DiskKeys:
        """Open the store of a folder, or make one.

        Parameters
        ----------
        folder
            The folder of the episodes.
        create
            True to make a store where there is none.
        sync
            True to make each write survive a power cut too, which takes some milliseconds.

        Returns
        -------
        DiskKeys
            The store; close it after use.

        Raises
        ------
        MemoryBusyError
            If the store is open already, here or in another process.
        MemoryFormatError
            If there is no store, or it is damaged.
        MemoryWriteError
            If the folder cannot be written.
        """
        real = Path(os.path.realpath(folder))
        if not (real / STORE).is_dir() and not create:
            raise MemoryFormatError(
                f"there are no episodes at {folder}; record something first, or name another folder"
            )
        made = not real.exists()
        try:
            with contextlib.ExitStack() as undo, wrap_level_errors(real):
                real.mkdir(parents=True, exist_ok=True)
                lock = OwnerLock.acquire(real)
                undo.callback(lock.release, undo=True)
                lock.sign()
                disk.begin_opening(real)
                tally = os.open(real / TALLY, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
                undo.callback(os.close, tally)
                db = _opened(real)
                undo.callback(db.close)
                store = cls(real, lock, db, tally, sync)
                undo.pop_all()
                return store
        except ReadOnlyMemoryError as error:
            if not (real / STORE).is_dir():
                raise
            return cls._copied(real, one_line(error))
        except BaseException:
            if made and real.is_dir() and not (real / LOCK_FILE).exists():
                disk.remove(real)
            raise

    @classmethod
    def _copied(cls, real: Path, reason: str) -> DiskKeys:
        """Open a copy of a folder that cannot be written."""
        with contextlib.ExitStack() as undo, wrap_level_errors(real):
            lock, scratch = copied_for_reading(real, undo)
            tally = os.open(scratch.path / TALLY, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
            undo.callback(os.close, tally)
            db = _opened(scratch.path)
            undo.callback(db.close)
            store = cls(real, lock, db, tally, sync=False)
            store._scratch, store._read_only = scratch, reason
            undo.pop_all()
            return store

    @property
    def is_copy(self) -> bool:
        """True for the copy of a folder that cannot be written."""
        return self._scratch is not None

    def protect(self) -> None:
        """Refuse all further writes if this is the copy of a folder that cannot be written."""
        self._protected = self._scratch is not None

    def require_writable(self) -> None:
        """Raise ReadOnlyMemoryError if writes are refused."""
        if self._protected:
            raise ReadOnlyMemoryError(self._read_only)

    def get(self, key: bytes) -> bytes | None:
        """Return the value of a key."""
        with wrap_level_errors(self.folder):
            sealed = self._database().get(key)
        return None if sealed is None else self._unsealed(key, sealed)

    def between(self, first: bytes, stop: bytes, most: int | None = None) -> Iterator[bytes]:
        """Iterate over keys in order."""
        with wrap_level_errors(self.folder), self._iterator(first, stop, False) as found:
            return iter(list(islice(found, most)))

    def items(self, first: bytes, stop: bytes) -> Iterator[tuple[bytes, bytes]]:
        """Iterate over keys and values in order."""
        with wrap_level_errors(self.folder), self._iterator(first, stop, True) as found:
            pairs = list(found)
        return ((key, self._unsealed(key, sealed)) for key, sealed in pairs)

    def restored(self) -> bool:
        """Open the database again after a failed write, if the disk has room now."""
        if self._failed is None:
            return False
        probe = self.folder / "probe"
        try:
            probe.write_bytes(bytes(_PROBE))
        except OSError as error:
            raise MemoryWriteError(f"{self._failed} (the next try: {error.strerror})") from error
        finally:
            with contextlib.suppress(OSError):
                probe.unlink(missing_ok=True)
        with wrap_level_errors(self.folder):
            self._database().close()
            self._db = _opened(self.folder)
        self._failed = None
        self._writes = self._stored_writes()
        return True

    def write(self, pairs: Mapping[bytes, bytes | None]) -> None:
        """Write keys with their values, and delete those without, all or nothing."""
        self.require_writable()
        db = self._database()
        number = _NUMBER.pack(self._writes + 1)
        try:
            with wrap_level_errors(self.folder):
                batch = db.write_batch(sync=self._sync)
                batch.put(_WRITES, seal(_WRITES, number))
                for key, value in pairs.items():
                    if value is None:
                        batch.delete(key)
                    else:
                        batch.put(key, seal(key, value) if value else value)
                batch.write()
        except MemoryWriteError as error:
            self._failed = one_line(error)
            raise
        self._writes += 1
        with contextlib.suppress(OSError):
            os.pwrite(self._tally, number, 0)

    def close(self) -> None:
        """Close the database and release the folder; a second call does nothing."""
        db, self._db = self._db, None
        if db is None or self._process != os.getpid():
            return
        with contextlib.suppress(plyvel.Error, OSError):
            if self._failed is None:
                db.compact_range(start=b"\xfe", stop=b"\xff")  # moves the log into a table, so that opening is fast
        db.close()
        os.close(self._tally)
        self._lock.release()
        if self._scratch is not None:
            self._scratch.remove()

    def _database(self) -> Any:
        if self._process != os.getpid():
            raise forked(self.folder)
        if self._db is None:
            raise MemoryFormatError("this memory is closed: open it again")
        return self._db

    def _iterator(self, first: bytes, stop: bytes, values: bool) -> contextlib.closing[Any]:
        return contextlib.closing(
            self._database().iterator(start=first, stop=stop, include_value=values, verify_checksums=True)
        )

    def _unsealed(self, key: bytes, sealed: bytes) -> bytes:
        value = unseal(key, sealed) if sealed else sealed
        if value is None:
            raise DamagedMemoryError(
                f"the episodes at {self.folder} are damaged: the value of {key[:40]!r} differs from what was written; "
                "restore the folder from a copy"
            )
        return value

    def _stored_writes(self) -> int:
        value = self.get(_WRITES)
        return 0 if value is None else int(_NUMBER.unpack(value)[0])


def _opened(folder: Path) -> Any:
    return plyvel.DB(str(folder / STORE), create_if_missing=True, **OPTIONS)


def _acknowledged(tally: int) -> int:
    found = os.pread(tally, _NUMBER.size, 0)
    return int(_NUMBER.unpack(found)[0]) if len(found) == _NUMBER.size else 0
