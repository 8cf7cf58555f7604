"""Open a memory: inspect it, lock it, inspect it again, finish what a crash interrupted, migrate it, open its store.

A memory in a folder that cannot be written is opened for reading only.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import os
import weakref
from collections.abc import Callable
from pathlib import Path

import pyoxigraph as ox

from deixis.memory import folder as files
from deixis.memory.errors import MemoryBusyError, MemoryFormatError, MemoryWriteError, ReadOnlyMemoryError
from deixis.memory.folder import EPISODES, FolderState, committed
from deixis.memory.owner import OwnerLock, ReaderLock, begin_opening
from deixis.memory.semantic.migrations import MIGRATIONS
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.package import package_digest, packaged, packaged_quads
from deixis.scratch import remove_stale


class Opened:
    """An open store with its folder and the lock on it.

    ``read_only`` is the reason why it cannot be written, or None. A forked child must neither use nor free a store.
    """

    def __init__(self, folder: Path, lock: OwnerLock | ReaderLock, read_only: str | None = None) -> None:
        self.folder, self.read_only, self._lock = folder, read_only, lock
        self._store: ox.Store | None = open_store(folder) if read_only is None else open_for_reading(folder)
        self.inherited = False
        _opened.add(self)

    @property
    def store(self) -> ox.Store:
        """The store; after :meth:`shut` it is opened again."""
        if self._store is None:
            self._store = open_store(self.folder)
        return self._store

    def close(self) -> None:
        """Close the store, then release the lock; in a forked child do neither."""
        if not self.inherited:
            self.shut()
            self._lock.release()

    def shut(self) -> None:
        """Close the store and keep the lock."""
        self._store = None

    def shut_to_replace(self) -> None:
        """Close the store before its files are replaced.

        Raises
        ------
        MemoryBusyError
            If an iterator of this process still reads the store.
        """
        self.shut()
        open_store(self.folder)  # fails while an iterator holds the lock of the store that was closed

    def require_writable(self) -> None:
        """Raise ReadOnlyMemoryError if this is open for reading only.

        Raises
        ------
        ReadOnlyMemoryError
            If the folder cannot be written.
        """
        if self.read_only is not None:
            raise ReadOnlyMemoryError(self.read_only)


_opened: weakref.WeakSet[Opened] = weakref.WeakSet()


def _leave_to_parent() -> None:
    """Keep a forked child from freeing its parent's stores, which would wait for threads that it does not have."""
    for opened in _opened:
        opened.inherited = True
        store = opened._store
        if store is not None:
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(store))


os.register_at_fork(after_in_child=_leave_to_parent)

READABLE = 1
"""Oldest format that can be read without migration."""


def open_for_reading(folder: Path) -> ox.Store:
    """Open the store of a folder that cannot be written, without repairs and migrations.

    Parameters
    ----------
    folder
        The folder of the memory.

    Returns
    -------
    ox.Store
        The store.

    Raises
    ------
    MemoryFormatError
        If its format must be migrated first.
    """
    if files.read_mark(folder)["version"] < READABLE:
        raise MemoryFormatError(
            f"the memory at {folder} was written by an older version; open it once where the folder can be written"
        )
    try:
        return ox.Store.read_only(str(files.store_in(folder)))
    except (OSError, RuntimeError) as error:
        raise MemoryFormatError(
            f"the memory at {folder} is damaged: its store does not open ({files.one_line(error)}); restore the folder "
            "from a copy"
        ) from error


def open_store(folder: Path) -> ox.Store:
    """Open ``semantic/`` for reading and writing.

    Parameters
    ----------
    folder
        The folder of the memory.

    Returns
    -------
    ox.Store
        The store.

    Raises
    ------
    MemoryBusyError
        If an iterator of this process still reads the store.
    MemoryWriteError
        If the store cannot be opened for another reason, or an interrupted replacement has left none.
    """
    if not (folder / files.STORE).is_dir():
        raise MemoryWriteError(
            f"a change of the memory at {folder} was interrupted: open the memory again to repair it"
        )
    try:
        return _store_without_iterators(folder / files.STORE)
    except (OSError, RuntimeError) as error:
        if _HELD_HERE in str(error):
            raise MemoryBusyError(
                f"the memory at {folder} is still read by this process: release the iterators over it, then try again"
            ) from error
        raise MemoryWriteError(f"the memory at {folder} could not be opened: {files.one_line(error)}") from error


_HELD_HERE = "lock hold by current process"


def _store_without_iterators(folder: Path) -> ox.Store:
    """Open a store; if this process still has it open, first free iterators that only wait to be collected.

    A query result of rdflib is a reference cycle, which holds an iterator of the store until it is collected.
    """
    try:
        return ox.Store(folder)
    except OSError as error:
        if _HELD_HERE not in str(error):
            raise
    gc.collect()
    return ox.Store(folder)


def _fill(store: ox.Store) -> None:
    """Fill a new store with the packaged ontology and shapes, before it becomes part of a memory."""
    store.bulk_extend(packaged_quads())


def open_memory(folder: Path, create: bool, fill: Callable[[ox.Store], None] = _fill) -> Opened:
    """Open a memory, or make one.

    Parameters
    ----------
    folder
        The folder of the memory.
    create
        True to make a memory where there is none.
    fill
        Function that fills a new store.

    Returns
    -------
    Opened
        The store with its lock.

    Raises
    ------
    MemoryBusyError
        If another process has the memory open.
    MemoryFormatError
        If there is no memory, or its files are invalid.
    MemoryWriteError
        If the folder cannot be created or written.
    """
    begin_opening(folder)
    remove_stale()
    state = files.inspect(folder)
    if state in (FolderState.ABSENT, FolderState.EMPTY) and not create:
        raise MemoryFormatError(f"{_why_none(folder, state)}; learn or teach something first, or name another folder")
    made = state is FolderState.ABSENT
    if made:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise MemoryWriteError(f"the folder {folder} cannot be created: {error.strerror}") from error
    try:
        try:
            lock = OwnerLock.acquire(folder)
        except ReadOnlyMemoryError as error:
            if state is not FolderState.MEMORY:
                raise
            return _open_for_reading(folder, str(error))
        try:
            lock.sign()
            _prepare(folder, fill)
            opened = Opened(folder, lock)
        except BaseException:
            lock.release(undo=True)
            raise
        try:
            for log in (folder / files.STORE).glob("LOG.old.*"):  # the store makes one at every opening
                with contextlib.suppress(OSError):
                    log.unlink()
            _update_package(opened)
        except BaseException:
            opened.close()
            raise
        return opened
    except BaseException:
        if made and not any(folder.iterdir()):
            folder.rmdir()
        raise


def _open_for_reading(folder: Path, reason: str) -> Opened:
    reader = ReaderLock.acquire(folder)
    try:
        return Opened(folder, reader, reason)
    except BaseException:
        reader.release()
        raise


def _why_none(folder: Path, state: FolderState) -> str:
    """Return the part of a message that says why there is no memory in a folder."""
    from deixis.memory.perceptual.in_folder import has_views

    if state is FolderState.ABSENT:
        return f"there is no memory at {folder}"
    if has_views(folder):
        return f"the memory at {folder} has views, but no lessons yet"
    if (folder / EPISODES).is_dir():
        return f"the memory at {folder} has episodes, but no lessons yet"
    return f"there is no memory yet in the empty folder {folder}"


def _prepare(folder: Path, fill: Callable[[ox.Store], None]) -> None:
    """Create, finish or migrate the folder after locking it; check for damage before any change."""
    state = files.inspect(folder)
    if state is FolderState.EMPTY:
        with committed(folder):
            files.create(folder, fill, package_digest())
        return
    files.check_store_opens(folder)
    with committed(folder):
        files.finish(folder)
        files.migrate(folder, MIGRATIONS)


def _update_package(opened: Opened) -> None:
    """Update the ontology and the shapes to the packaged version, if they are of another one."""
    mark, digest = files.read_mark(opened.folder), package_digest()
    if mark.get("package") == digest:
        return
    with committed(opened.folder):
        operations = list(ledger.package_update(opened.store, packaged()))
        if operations:
            ledger.update(opened.store, [*operations, *ledger.keeping_up(opened.store, None)])
            opened.store.flush()
        files.write_mark(opened.folder, {**mark, "package": digest})
