"""The shared handle on a database: opened once per real path in a process, and closed by its last user.

``plyvel.DB`` on a path that this process has open fails, and its failure drops the lock that excludes other processes;
closing it while another thread reads ends the process. So users are counted, and closing waits for calls in progress.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import threading
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple

import plyvel

from deixis.errors import DeixisError
from deixis.memory import owner as disk
from deixis.memory.errors import DamagedMemoryError, MemoryFormatError, MemoryWriteError, ReadOnlyMemoryError
from deixis.memory.folder import PERCEPTUAL, one_line
from deixis.memory.journal import (
    JournalEntry,
    Part,
    clear_journal,
    has_committed,
    new_id,
    read_journal,
    write_journal,
)
from deixis.memory.owner import LOCK_FILE, OwnerLock, ReaderLock, forked
from deixis.memory.perceptual.database import keys, layout
from deixis.memory.perceptual.database.codec import (
    StoreCounts,
    ViewHeader,
    read_counts,
    read_name,
    seal,
    write_about,
    write_counts,
    write_view,
)
from deixis.memory.perceptual.records import View
from deixis.scratch import ScratchFolder, remove_stale

OPTIONS = {
    "paranoid_checks": True,  # indices and logs are checked too, and compaction does not copy damaged data
    "compression": None,  # descriptors would shrink, but reading them back would take several times as long
    "write_buffer_size": 32 << 20,
    "max_file_size": 32 << 20,
}

MAX_REUSED_BATCH = 64
"""Maximum number of keys of a batch that reuses the memory of the previous batch.

The system provides new memory page by page, which for 60 KB takes as long as all other work of a write.
"""

_handles: dict[Path, Handle] = {}
_opening = threading.Lock()


class Places(NamedTuple):
    """Key of each view's header, by id, and the damage that kept the rest from being read, if any.

    Headers are ordered by category and id, so a view can be found by its id alone only after all keys were read once,
    which takes about 2 µs a view. The keys are then held in memory, as only the owner changes them.
    """

    by_id: dict[str, bytes]
    damage: plyvel.Error | None


def read_places(source: Any) -> Places:
    """Read the key of each view from a database or a snapshot of one.

    Parameters
    ----------
    source
        ``plyvel.DB``, or a snapshot of one.

    Returns
    -------
    Places
        Keys by the ids of the views, and the error that ended the reading, if any.
    """
    found: dict[str, bytes] = {}
    try:
        for key in source.iterator(prefix=keys.VIEW, include_value=False, verify_checksums=True):
            found[keys.split_view_key(key)[1]] = key
    except plyvel.CorruptionError as error:
        return Places(found, error)
    return Places(found, None)


@dataclass(slots=True)
class WriteBatch:
    """Keys with their new values, None to delete, to be written in one step.

    ``places`` has the new key of each changed view by id, None for a removed view; ``views`` is the change in the
    number of views.
    """

    pairs: list[tuple[bytes, bytes | None]] = field(default_factory=list)
    places: dict[str, bytes | None] = field(default_factory=dict)
    views: int = 0

    def add(self, view: View) -> None:
        """Add a view that does not exist, or was dropped before.

        Parameters
        ----------
        view
            View to write.
        """
        header, arrays = write_view(view)
        self.pairs += (header, arrays)
        self.places[view.id] = header[0]
        self.views += 1

    def move(self, header: ViewHeader, category: str) -> None:
        """Move an existing view to another category; its arrays stay where they are.

        Parameters
        ----------
        header
            Header of the view.
        category
            Name of the new category.
        """
        moved = write_about(header.moved(category))
        self.pairs += ((header.key, None), moved)
        self.places[header.id] = moved[0]

    def drop(self, view_id: str, key: bytes, arrays: Sequence[bytes]) -> None:
        """Drop an existing view, the keys of its arrays, and those of its lesson and its teachings.

        Parameters
        ----------
        view_id
            Id of the view.
        key
            Key of its header.
        arrays
            Keys of its arrays.
        """
        beside = (keys.name_key(kind, view_id) for kind in (keys.LESSON, keys.TEACHINGS))
        self.pairs += [(each, None) for each in (key, *arrays, *beside)]
        self.places[view_id] = None
        self.views -= 1


def _with_journal_id(change: WriteBatch, id: str) -> WriteBatch:
    """Return a change that also stores the id of its journal."""
    pairs = [*change.pairs, (keys.JOURNAL, seal(keys.JOURNAL, id.encode()))]
    return WriteBatch(pairs, change.places, change.views)


class ViewsPart(Part):
    """The part that a change of views takes in a write over several stores. Hold the handle's :attr:`writing`.

    Parameters
    ----------
    handle
        The open database.
    change
        Keys with their new values.
    """

    store = PERCEPTUAL

    def __init__(self, handle: Handle, change: WriteBatch) -> None:
        self._handle, self._change, self._id = handle, change, ""

    def prepare(self, id: str) -> None:
        """Write the journal."""
        self._handle.require_sound()
        self._id = id
        with wrap_level_errors(self._handle.folder):
            write_journal(self._handle.folder, JournalEntry(id, tuple(self._change.pairs), self._change.views))

    def complete(self) -> None:
        """Write the change, and remove the journal."""
        self._handle.finish(self._change, self._id)

    def settle(self) -> None:
        """Write the change if the semantic store has committed, and else only remove the journal."""
        folder = self._handle.folder
        if has_committed(folder.parent, self.store, self._id):
            self.complete()
        else:
            clear_journal(folder)


class Handle:
    """An open database. As a context manager it marks a call in progress, and returns the ``plyvel.DB``.

    Errors of LevelDB within become MemoryWriteError or DamagedMemoryError; a closed handle raises MemoryFormatError.
    """

    def __init__(
        self, folder: Path, lock: OwnerLock | ReaderLock, tally: layout.AcknowledgedCounts, db: Any, counts: StoreCounts
    ) -> None:
        self.folder, self.counts = folder, counts
        self.inherited = False
        self.writing = threading.RLock()
        self.users = 1
        self._lock, self._tally, self._db = lock, tally, db
        self._batch = db.write_batch()
        self._guard, self._calls = threading.RLock(), 0
        self._idle = threading.Condition(self._guard)
        self._failed: str | None = None
        self._read_only: str | None = None
        self._scratch: ScratchFolder | None = None
        self._places: Places | None = None
        self._sources: set[Any] = set()

    def __enter__(self) -> Any:
        with self._guard:
            if self._db is None:
                raise forked(self.folder) if self.inherited else closed()
            self._calls += 1
            return self._db

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._guard:
            self._calls -= 1
            if self._db is None and not self._calls:
                self._idle.notify_all()
        if error is not None:
            raise_level_error(self.folder, error)

    def keep(self, source: Any) -> Any:
        """Register a snapshot or an iterator that outlives a call, and return it; :meth:`let_go` frees it.

        If LevelDB frees one while it is being closed, the process ends: so a source without users is freed after the
        closing.

        Parameters
        ----------
        source
            Snapshot or iterator of the database.

        Returns
        -------
        object
            The given source.
        """
        self._sources.add(source)
        return source

    def let_go(self, source: Any) -> None:
        """Free a source that :meth:`keep` registered; a closed database frees its own.

        Parameters
        ----------
        source
            Snapshot or iterator that :meth:`keep` returned.
        """
        with contextlib.suppress(MemoryFormatError), self:
            source.close()
            self._sources.discard(source)

    def places(self) -> dict[str, bytes]:
        """Return the key of each view by its id.

        Hold :attr:`writing`, and do not change the result.

        Returns
        -------
        dict
            Keys of headers by the ids of the views.

        Raises
        ------
        DamagedMemoryError
            If not all keys can be read, as the view that a new one replaces may then be unknown.
        """
        found = self._places or self._read_places()
        if found.damage is not None:
            raise_level_error(self.folder, found.damage)
        return found.by_id

    def place_of(self, view_id: str) -> bytes | None:
        """Return the key of a view, or None; unreadable keys count as missing.

        Parameters
        ----------
        view_id
            Id of the view.

        Returns
        -------
        bytes or None
            Key of its header.
        """
        return (self._places or self._read_places()).by_id.get(view_id)

    def lacks(self, id: str) -> bool:
        """Return True if there is certainly no view with this id now.

        Parameters
        ----------
        id
            Id of the view.

        Returns
        -------
        bool
            False if the view exists, or keys cannot be read.
        """
        found = self._places or self._read_places()
        return found.damage is None and id not in found.by_id

    def _read_places(self) -> Places:
        with self.writing, self as db:
            if self._places is None:
                self._places = read_places(db)
            return self._places

    def write(self, change: WriteBatch, sync: bool) -> None:
        """Write a change in one step. Hold :attr:`writing`.

        After a failure the log may end in half a batch, and later entries could not be found: so nothing more is
        written until the memory is opened again.

        Parameters
        ----------
        change
            Keys with their new values.
        sync
            If True, the change also survives a crash of the machine.

        Raises
        ------
        ReadOnlyMemoryError
            If the folder cannot be written.
        MemoryWriteError
            If this write fails, or one before it failed.
        """
        there, before = self.places(), self.counts
        counts = StoreCounts(before.batches + 1, before.views + change.views, before.lost)
        sealed = write_counts(counts)
        with self as db:
            self.require_sound()
            try:
                batch = db.write_batch(sync=sync) if sync or len(change.pairs) > MAX_REUSED_BATCH else self._batch
                batch.clear()
                batch.put(keys.COUNT, sealed)  # first: after the arrays, it would cause another copy of them
                for key, value in change.pairs:
                    batch.delete(key) if value is None else batch.put(key, value)
                batch.write()
                self._tally.write(sealed)
            except (plyvel.Error, OSError) as error:
                self._failed = f"an earlier write to the memory at {self.folder} failed ({one_line(error)})"
                raise
        self.counts = counts
        for view_id, place in change.places.items():
            if place is None:
                there.pop(view_id, None)
            else:
                there[view_id] = place

    def part(self, change: WriteBatch) -> ViewsPart:
        """Return a change as a part of a write over several stores (:func:`deixis.memory.journal.write_together`).

        Parameters
        ----------
        change
            Keys with their new values.

        Returns
        -------
        ViewsPart
            The part; hold :attr:`writing` until it is completed or settled.
        """
        return ViewsPart(self, change)

    def finish(self, change: WriteBatch, id: str) -> None:
        """Write a change that is decided, and remove its journal. Hold :attr:`writing`.

        Parameters
        ----------
        change
            Keys with their new values.
        id
            Id of the journal.

        Raises
        ------
        MemoryWriteError
            If the change cannot be written now.
        """
        try:
            self.write(_with_journal_id(change, id), sync=True)
        except MemoryWriteError as error:
            raise MemoryWriteError(
                f"{error}; the lessons are stored, and their views will be when the memory is next opened and can be "
                "written"
            ) from error
        clear_journal(self.folder)

    def settle(self, where: Path) -> None:
        """Complete or roll back an interrupted write, if there is a journal of one.

        Parameters
        ----------
        where
            Folder of the journal: that of the memory, or of its copy.
        """
        entry = read_journal(where)
        if entry is not None:
            with self as db:
                sealed = db.get(keys.JOURNAL, verify_checksums=True)
            applied = sealed is not None and read_name(keys.JOURNAL, sealed) == entry.id
            if entry.undo and not applied:
                self.write(self._undoing(entry.undo), sync=True)
            elif entry.pairs and not applied and has_committed(self.folder.parent, PERCEPTUAL, entry.id):
                self.write(_with_journal_id(WriteBatch(list(entry.pairs), {}, entry.views), entry.id), sync=True)
                self._places = None  # the batch may have moved views
        clear_journal(where)

    def _undoing(self, new: Sequence[str]) -> WriteBatch:
        """Return the change that forgets the views of an interrupted import; their arrays are at their own keys."""
        change, there = WriteBatch(), self.places()
        for view_id in new:
            if view_id in there:
                change.drop(view_id, there[view_id], [keys.ARRAYS + there[view_id][1:]])
        return change

    def write_all(self, changes: Iterable[WriteBatch], new: Sequence[str]) -> None:
        """Write changes with new views, each in one step: all of them or none, also after a crash.

        Hold :attr:`writing`.

        Parameters
        ----------
        changes
            Changes, of which at most two are held at a time.
        new
            Ids of the views in all changes.

        Raises
        ------
        ReadOnlyMemoryError
            If the folder cannot be written.
        MemoryWriteError
            If a change cannot be written.
        """
        id, waiting = None, None
        try:
            for change in changes:
                if waiting is not None:
                    id = id or self._begin_import(new)
                    self.write(waiting, sync=False)
                waiting = change
            if waiting is not None and id is None:
                self.write(waiting, sync=True)
            elif waiting is not None and id is not None:
                self.finish(waiting, id)
        except BaseException:
            if id is not None:
                with contextlib.suppress(DeixisError):  # if it fails, the next opening does it
                    self.write(self._undoing(new), sync=True)
                    clear_journal(self.folder)
            raise

    def _begin_import(self, new: Sequence[str]) -> str:
        self.require_sound()
        entry = JournalEntry(new_id(), undo=tuple(new))
        with wrap_level_errors(self.folder):
            write_journal(self.folder, entry)
        return entry.id

    def require_sound(self) -> None:
        """Raise an error if the memory cannot be written.

        Raises
        ------
        ReadOnlyMemoryError
            If the folder cannot be written.
        MemoryWriteError
            If a write before failed.
        """
        if self._read_only is not None:
            raise ReadOnlyMemoryError(self._read_only)
        if self._failed is not None:
            raise MemoryWriteError(f"{self._failed}; close the memory, remove the cause, and open it again")

    def disowned(self) -> Any:
        """Remove the database from a forked child without closing it, and renew the locks: other threads are gone.

        Returns
        -------
        plyvel.DB
            The open database, which must never be freed: that would close it.
        """
        db, self._db = self._db, None
        self.inherited = True
        self.writing, self._guard = threading.RLock(), threading.RLock()
        self._idle = threading.Condition(self._guard)
        return db

    def shut(self) -> None:
        """Close the database after all calls in progress, and seal it."""
        with self._idle:
            db, self._db = self._db, None
            self._idle.wait_for(lambda: not self._calls)
        if db is None:
            return
        sealed = self._failed is None and self._scratch is None
        with contextlib.suppress(plyvel.Error, OSError):  # all acknowledged batches are in the log already
            if sealed:
                db.compact_range(start=b"\xfe", stop=b"\xff")  # moves the log into a table, and changes no other
        db.close()
        self._sources.clear()
        self._tally.close()
        with contextlib.suppress(OSError):
            if sealed:
                layout.write_seal(self.folder)
        self._lock.release()
        if self._scratch is not None:
            self._scratch.remove()

    def only_read(self, scratch: ScratchFolder, reason: str) -> None:
        """Refuse all writes from now on, because this is a copy of a folder that cannot be written.

        Parameters
        ----------
        scratch
            Folder of the copy, which is removed with the handle.
        reason
            Message of the errors.
        """
        self._scratch, self._read_only = scratch, reason


def _drop_in_child() -> None:
    """Remove the databases from a forked child, which must not touch those of its parent, without freeing them."""
    global _opening
    _opening = threading.Lock()
    for handle in _handles.values():
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(handle.disowned()))
    _handles.clear()


os.register_at_fork(after_in_child=_drop_in_child)


def closed() -> MemoryFormatError:
    """Return the error for a memory that was closed.

    Returns
    -------
    MemoryFormatError
        Error that says to open the memory again.
    """
    return MemoryFormatError("this memory is closed: open it again")


@contextlib.contextmanager
def wrap_level_errors(folder: Path) -> Iterator[None]:
    """Turn errors of LevelDB or the system into errors of Deixis.

    Parameters
    ----------
    folder
        Folder of the memory, which the errors name.

    Yields
    ------
    None
        None, once.

    Raises
    ------
    DamagedMemoryError
        If LevelDB reports corruption.
    MemoryWriteError
        For any other error of LevelDB or the system.
    """
    try:
        yield
    except (plyvel.Error, OSError) as error:
        raise_level_error(folder, error)
        raise


def raise_level_error(folder: Path, error: BaseException) -> None:
    """Raise an error of LevelDB or the system as an error of Deixis; return for other errors.

    Parameters
    ----------
    folder
        Folder of the memory, which the error names.
    error
        Error to translate.

    Raises
    ------
    DamagedMemoryError
        If LevelDB reports corruption.
    MemoryWriteError
        For any other error of LevelDB or the system.
    """
    if isinstance(error, DeixisError) or not isinstance(error, plyvel.Error | OSError):
        return
    if isinstance(error, OSError) and error.strerror:
        text = error.strerror
    else:
        text = one_line(error).removeprefix("b'").removesuffix("'")  # plyvel's messages are bytes
    if "orruption" in text or "create_if_missing" in text:
        raise DamagedMemoryError(
            f"the memory at {folder} is damaged ({text}); restore the folder from a copy"
        ) from error
    raise MemoryWriteError(
        f"the memory at {folder} could not be read or written ({text}); check that the disk has room and the folder is "
        "writable, then try again: earlier content is unchanged"
    ) from error


def acquire(folder: Path, create: bool) -> Handle:
    """Return the handle on a folder, and open it on first use in this process.

    Parameters
    ----------
    folder
        Folder of the perceptual memory.
    create
        If True, make a memory if there is none.

    Returns
    -------
    Handle
        Handle with one more user, who must :func:`release` it.

    Raises
    ------
    MemoryBusyError
        If another process has the memory open.
    MemoryFormatError
        If there is no memory, or its files are invalid.
    MemoryWriteError
        If the folder cannot be created or written.
    """
    real = Path(os.path.realpath(folder))
    with _opening:
        if real in _handles:
            _handles[real].users += 1
            return _handles[real]
        handle = _opened(folder, real, create)
        _handles[real] = handle
        return handle


def release(handle: Handle) -> None:
    """Release a handle; the last release closes it.

    Parameters
    ----------
    handle
        Handle that :func:`acquire` returned.
    """
    with _opening:
        handle.users -= 1
        if handle.users == 0 and not handle.inherited:
            _handles.pop(handle.folder, None)
            handle.shut()


def _opened(folder: Path, real: Path, create: bool) -> Handle:
    if layout.version_in(folder) is None and not create:
        raise MemoryFormatError(
            f"there is no perceptual memory at {folder}; teach something first, or name another folder"
        )
    made = not real.exists()
    try:
        real.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise MemoryWriteError(f"the folder {folder} cannot be created: {error.strerror}") from error
    try:
        with contextlib.ExitStack() as undo, wrap_level_errors(real):
            try:
                lock = OwnerLock.acquire(real)
            except ReadOnlyMemoryError as error:
                if layout.version_in(folder) is None:
                    raise
                return _opened_for_reading(real, str(error))
            undo.callback(lock.release, undo=True)
            if made and layout.version_in(real) is None:  # only now, as two processes may have found no folder
                undo.callback(_emptied, real)
            lock.sign()
            return _opened_in(real, real, lock, undo)
    except BaseException:
        if made:
            with contextlib.suppress(OSError):  # not empty: another process uses it by now
                real.rmdir()
        raise


def _opened_for_reading(real: Path, reason: str) -> Handle:
    """Open a copy of a folder that cannot be written."""
    with contextlib.ExitStack() as undo:
        lock, scratch = copied_for_reading(real, undo)
        handle = _opened_in(real, scratch.path, lock, undo)
    handle.only_read(scratch, reason)
    return handle


def copied_for_reading(real: Path, undo: contextlib.ExitStack) -> tuple[ReaderLock, ScratchFolder]:
    """Copy a folder that cannot be written, as LevelDB writes in any folder that it opens.

    Tables are linked, not copied.

    Parameters
    ----------
    real
        Folder of the database.
    undo
        Stack that gets the callbacks which release the lock and remove the copy.

    Returns
    -------
    tuple
        Lock of a reader on the folder, and the copy.
    """
    lock = ReaderLock.acquire(real)
    undo.callback(lock.release)
    remove_stale()
    scratch = ScratchFolder()
    undo.callback(scratch.remove)
    layout.mirror(real, scratch.path)
    return lock, scratch


def _opened_in(real: Path, where: Path, lock: OwnerLock | ReaderLock, undo: contextlib.ExitStack) -> Handle:
    """Open the database of ``real`` at ``where``; cancel the callbacks of ``undo`` if that succeeds."""
    disk.begin_opening(real)
    layout.prepare(where)
    tally = layout.AcknowledgedCounts(where)
    undo.callback(tally.close)
    db = plyvel.DB(str(layout.store(where)), **OPTIONS)
    undo.callback(db.close)
    handle = Handle(real, lock, tally, db, _counted(real, db, tally))
    handle.settle(where)
    undo.pop_all()
    return handle


def _emptied(folder: Path) -> None:
    """Remove the files of a failed opening except the lock, which is removed last."""
    for entry in folder.iterdir():
        if entry.is_dir():
            disk.remove(entry)
        elif entry.name != LOCK_FILE:
            entry.unlink()


def _counted(folder: Path, db: Any, tally: layout.AcknowledgedCounts) -> StoreCounts:
    """Return the counts, with acknowledged batches that are missing counted as lost."""
    try:
        counts = read_counts(db.get(keys.COUNT, verify_checksums=True))
    except DamagedMemoryError as error:
        raise DamagedMemoryError(f"the memory at {folder} is damaged: {error}; restore it from a copy") from error
    missing = tally.found.batches - counts.batches
    if missing > 0:
        views = sum(1 for _ in db.iterator(prefix=keys.VIEW, include_value=False, verify_checksums=True))
        counts = StoreCounts(tally.found.batches, views, counts.lost + missing)
        db.put(keys.COUNT, write_counts(counts), sync=True)
    tally.write(write_counts(counts))
    return counts
