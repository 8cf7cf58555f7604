"""Perceptual memory in a LevelDB on disk.

>>> import tempfile
>>> from datetime import UTC, datetime
>>> import numpy as np
>>> view = View("v1", "mug", datetime(2026, 5, 1, tzinfo=UTC), {"spin": np.ones((100, 153), np.float32)})
>>> folder = Path(tempfile.mkdtemp())
>>> with LevelMemory.open(folder, create=True) as memory:
...     memory.write(Batch([view]))
>>> with LevelMemory.open(folder) as memory:
...     memory.categories(), memory.view("v1").descriptors["spin"].shape
(('mug',), (100, 153))

:class:`UndamagedMemory` reads the same folder without the damaged views:

>>> with UndamagedMemory.open(folder) as memory:
...     [view.id for view in memory.views()], memory.left_out
(['v1'], [])
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from functools import cached_property
from pathlib import Path
from typing import Self

from deixis.memory.errors import DamagedMemoryError, UnknownViewError
from deixis.memory.owner import Closing
from deixis.memory.perceptual.database import keys
from deixis.memory.perceptual.database.codec import ViewHeader, read_about, read_name, write_category, write_name
from deixis.memory.perceptual.database.handle import Handle, WriteBatch, acquire, closed, release
from deixis.memory.perceptual.protocol import (
    Finding,
    PerceptualMemory,
    PerceptualStats,
    Progress,
    ViewKey,
)
from deixis.memory.perceptual.reading import Snapshot, glance, unknown_view
from deixis.memory.perceptual.records import Batch, CategoryRecord, Json, View, check_merging, check_name, name_taken


class LevelMemory(Closing, PerceptualMemory):
    """The perceptual memory in one folder, owned by this process until its last user closes it.

    Its methods are those of :class:`deixis.memory.perceptual.protocol.PerceptualMemory`.

    Examples
    --------
    >>> import tempfile
    >>> from datetime import UTC, datetime
    >>> import numpy as np
    >>> spin = {"spin": np.ones((100, 153), np.float32)}
    >>> folder = tempfile.TemporaryDirectory()
    >>> memory = LevelMemory.open(folder.name, create=True)
    >>> day = datetime(2026, 5, 1, tzinfo=UTC)
    >>> memory.write(Batch([View("v1", "mug", day, spin), View("v2", "beaker", day, spin)]))
    >>> memory.write_all([Batch([View("v3", "mug", day, spin)])], new=["v3"])
    >>> memory.categories(), [view.id for view in memory.views("mug")], [key.id for key in memory.listing()]
    (('beaker', 'mug'), ['v1', 'v3'], ['v2', 'v1', 'v3'])
    >>> memory.category("mug").name, memory.stats().views, memory.verify()
    ('mug', 3, ())
    >>> memory.view("v1").category, memory.lesson_of("v1"), memory.taught_by_lessons("mug")
    ('mug', None, ())
    >>> memory.path == Path(folder.name).resolve() == memory.handle.folder
    True

    A write over both stores makes its changes first; each is the change of the method that writes at once:

    >>> changes = [memory.renaming("mug", "cup"), memory.merging("mug", "beaker"), memory.forgetting("mug")]
    >>> changes.append(memory.writing(Batch([View("v0", "mug", day, spin)])))
    >>> memory.rename("mug", "cup")
    >>> memory.merge("beaker", "cup")
    >>> memory.forget("cup")
    >>> memory.categories()
    ()

    Views are read from a snapshot, which later writes do not change, and with their teachings:

    >>> memory.write(Batch([View("v4", "bowl", day, spin)]))
    >>> with memory.exclusive(), memory.snapshot() as now:
    ...     memory.forget("bowl")
    ...     now.categories(), memory.categories()
    (('bowl',), ())
    >>> list(memory.headers()), memory.teachings(), memory.lessons_of_views()
    ([], {}, {})
    >>> memory.close()
    >>> folder.cleanup()
    """

    def __init__(self, handle: Handle) -> None:
        self._open: Handle | None = handle

    @classmethod
    def open(cls, path: str | Path, create: bool = False) -> Self:
        """Open a memory, or make one; a folder that this process has open is shared.

        Parameters
        ----------
        path
            Folder of the perceptual memory.
        create
            If True, make a memory if there is none.

        Returns
        -------
        Self
            The open memory; close it after use.

        Raises
        ------
        MemoryBusyError
            If another process has the memory open.
        MemoryFormatError
            If there is no memory, or its files are invalid.
        MemoryWriteError
            If the folder cannot be written.
        """
        return cls(acquire(Path(path), create))

    def close(self) -> None:
        """Release the folder once the calls under way are done."""
        handle, self._open = self._open, None
        if handle is not None:
            release(handle)

    @property
    def handle(self) -> Handle:
        """The handle that all users of this folder in this process share."""
        if self._open is None:
            raise closed()
        return self._open

    @property
    def path(self) -> Path:
        """The real path of the folder."""
        return self.handle.folder

    def view(self, id: str) -> View:
        """Return one view."""
        place = self.handle.place_of(check_name("a view's id", id))
        if place is not None:
            with self.handle as db:
                found = glance(db, place)
            if found is not None:
                return found
        elif self.handle.lacks(id):
            raise unknown_view(id)
        with self.snapshot() as now:
            return now.view(id)

    def views(self, category: str | None = None) -> Iterator[View]:
        """Iterate over views, as they are at the time of the call."""
        return self.snapshot().views(category)

    def listing(self, category: str | None = None) -> Iterator[ViewKey]:
        """Iterate over category, id and time of views, without reading arrays."""
        return self.snapshot().listing(category)

    def categories(self) -> tuple[str, ...]:
        """Return the names of all categories."""
        with self.snapshot() as now:
            return now.categories()

    def category(self, name: str) -> CategoryRecord:
        """Return the record of a category."""
        with self.snapshot() as now:
            return now.category(name)

    def lessons_of_views(self) -> dict[str, str]:
        """Return the lesson of each view that belongs to one, by the view's id."""
        with self.snapshot() as now:
            return now.lessons_of_views()

    def lesson_of(self, view_id: str) -> str | None:
        """Return the lesson that a view belongs to, or None.

        Parameters
        ----------
        view_id
            Id of the view.

        Returns
        -------
        str or None
            Id of the lesson.

        Raises
        ------
        RecordError
            If the id of the view is not valid.
        """
        key = keys.name_key(keys.LESSON, check_name("a view's id", view_id))
        with self.snapshot() as now:
            sealed = now.get(key)
        return None if sealed is None else read_name(key, sealed)

    def teachings(self) -> dict[str, tuple[Json, ...]]:
        """Return all teachings of each view that was taught more than once, by the view's id."""
        with self.snapshot() as now:
            return now.teachings()

    def headers(self) -> Iterator[ViewHeader]:
        """Iterate over the headers of all views, without reading arrays.

        Yields
        ------
        ViewHeader
            Headers in the order of :meth:`views`.

        Raises
        ------
        DamagedMemoryError
            At a damaged header.
        """
        return self.snapshot().headers()

    def taught_by_lessons(self, category: str) -> tuple[str, ...]:
        """Return the ids of the views of a category that belong to lessons.

        Parameters
        ----------
        category
            Name of the category.

        Returns
        -------
        tuple of str
            Ids in order; empty for an unknown category.
        """
        with self.snapshot() as now:
            views = [keys.split_view_key(key)[1] for key in now.bare_keys(keys.category_prefix(category))]
            return tuple(view for view in views if now.get(keys.name_key(keys.LESSON, view)) is not None)

    def stats(self) -> PerceptualStats:
        """Return the size of the memory."""
        with self.snapshot() as now:
            return now.stats()

    def verify(self, progress: Progress | None = None) -> tuple[Finding, ...]:
        """Return what differs from what was written."""
        with self.snapshot() as now:
            return now.verify(progress)

    def snapshot(self) -> Snapshot:
        """Return a snapshot of the memory, unchanged by later writes."""
        return Snapshot(self.handle)

    def exclusive(self) -> AbstractContextManager[object]:
        """Return a lock that keeps other threads from writing."""
        return self.handle.writing

    def write(self, batch: Batch, sync: bool = False) -> None:
        """Write a batch in one step."""
        with self.exclusive():
            self.handle.write(self.writing(batch), sync)

    def write_all(self, batches: Iterable[Batch], new: Sequence[str]) -> None:
        """Write batches of new views, all or none."""
        with self.exclusive():
            self.handle.write_all(map(self.writing, batches), new)

    def rename(self, old: str, new: str) -> None:
        """Rename a category."""
        with self.exclusive():
            self.handle.write(self.renaming(old, new), sync=True)

    def merge(self, source: str, into: str, record: CategoryRecord | None = None) -> None:
        """Move the views of one category to another."""
        with self.exclusive():
            self.handle.write(self.merging(source, into, record), sync=True)

    def forget(self, category: str) -> None:
        """Forget a category with its views."""
        with self.exclusive():
            self.handle.write(self.forgetting(category), sync=True)

    # ---- the changes of these methods, to be computed and written under :meth:`exclusive`

    def writing(self, batch: Batch) -> WriteBatch:
        """Return the change that writes a batch.

        Parameters
        ----------
        batch
            Views and records to write, and those to remove.

        Returns
        -------
        WriteBatch
            Change for ``Handle.write``; hold :meth:`exclusive` until it is written.

        Raises
        ------
        UnknownViewError
            If a view to forget does not exist.
        """
        handle, change = self.handle, WriteBatch()
        there = handle.places()
        for view_id in batch.forgotten:
            if check_name("a view's id", view_id) not in there:
                raise UnknownViewError(f"no view '{view_id}' to forget; nothing was written")
            change.drop(view_id, there[view_id], _arrays_of(handle, view_id, there[view_id]))
        for view in batch.views:
            if view.id in there:
                change.drop(view.id, there[view.id], _arrays_of(handle, view.id, there[view.id]))
            change.add(view)
        change.pairs += [write_category(record) for record in batch.categories]
        change.pairs += [(keys.name_key(keys.CATEGORY, name), None) for name in batch.dropped]
        for view_id, lesson in batch.lessons.items():
            key = keys.name_key(keys.LESSON, check_name("a view's id", view_id))
            change.pairs.append((key, None) if lesson is None else write_name(keys.LESSON, view_id, lesson))
        for view_id, teachings in batch.teachings.items():
            key = keys.name_key(keys.TEACHINGS, check_name("a view's id", view_id))
            written = json.dumps([dict(each) for each in teachings], separators=(",", ":"))
            change.pairs.append(write_name(keys.TEACHINGS, view_id, written) if teachings else (key, None))
        return change

    def renaming(self, old: str, new: str) -> WriteBatch:
        """Return the change that renames a category.

        Parameters
        ----------
        old
            Name of the category.
        new
            New name of it.

        Returns
        -------
        WriteBatch
            Change for ``Handle.write``; hold :meth:`exclusive` until it is written.

        Raises
        ------
        UnknownCategoryError
            If there is no such category.
        RejectedWriteError
            If the new name is in use.
        """
        check_name("a category's name", new)
        with self.snapshot() as now:
            record = now.category(old)
            if now.has(new):
                raise name_taken(old, new)
            return _of_moving(now, old, CategoryRecord(new, record.state, record.metadata))

    def merging(self, source: str, into: str, record: CategoryRecord | None = None) -> WriteBatch:
        """Return the change that moves the views of a category to another.

        Parameters
        ----------
        source
            Category whose views are moved; it ceases to exist.
        into
            Category that receives them.
        record
            New record of ``into``; it has no learned state by default.

        Returns
        -------
        WriteBatch
            Change for ``Handle.write``; hold :meth:`exclusive` until it is written.

        Raises
        ------
        UnknownCategoryError
            If one of the categories is unknown.
        RecordError
            If the categories are equal, or the record is of another one.
        """
        check_merging(source, into, record)
        with self.snapshot() as now:
            now.require(into)
            now.require(source)
            return _of_moving(now, source, record or CategoryRecord(into))

    def forgetting(self, category: str) -> WriteBatch:
        """Return the change that forgets a category with its views.

        Parameters
        ----------
        category
            Name of the category.

        Returns
        -------
        WriteBatch
            Change for ``Handle.write``; hold :meth:`exclusive` until it is written.

        Raises
        ------
        UnknownCategoryError
            If there is no such category.
        """
        with self.snapshot() as now:
            now.require(category)
            change = WriteBatch()
            for key in [key for key in self.handle.places().values() if key.startswith(keys.category_prefix(category))]:
                view_id = keys.split_view_key(key)[1]
                change.drop(view_id, key, _arrays_of(self.handle, view_id, key))
            change.pairs.append((keys.name_key(keys.CATEGORY, category), None))
            return change


class UndamagedMemory(LevelMemory):
    """A perceptual memory without its damaged views; ``left_out`` lists them. Listing reads arrays too."""

    @cached_property
    def left_out(self) -> list[str]:
        """Lines about the damaged views that were met so far."""
        return []

    def views(self, category: str | None = None) -> Iterator[View]:
        """Iterate over the undamaged views."""
        return self._each(self.snapshot(), keys.VIEW if category is None else keys.category_prefix(category))

    def _each(self, now: Snapshot, begin: bytes) -> Iterator[View]:
        with now:
            try:
                for key, sealed in now.pairs(begin):
                    try:
                        view = now.view_of(read_about(key, sealed))
                    except DamagedMemoryError as error:
                        self._leave_out(error)
                    else:
                        yield view
            except DamagedMemoryError as error:  # in the keys themselves: views after it cannot be found
                self._leave_out(error)

    def listing(self, category: str | None = None) -> Iterator[ViewKey]:
        """Iterate over category, id and time of the undamaged views."""
        return (ViewKey(view.category, view.id, view.time) for view in self.views(category))

    def categories(self) -> tuple[str, ...]:
        """Return the categories of the undamaged views."""
        return tuple(dict.fromkeys(key.category for key in self.listing()))

    def category(self, name: str) -> CategoryRecord:
        """Return the record of a category, with no arrays where these are damaged."""
        try:
            return super().category(name)
        except DamagedMemoryError as error:
            self._leave_out(error)
            return CategoryRecord(name)

    def _leave_out(self, error: DamagedMemoryError) -> None:
        if str(error) not in self.left_out:
            self.left_out.append(str(error))


def _arrays_of(handle: Handle, view_id: str, key: bytes) -> list[bytes]:
    """Return the keys of a view's arrays, or all keys that can be its own where its header is damaged."""
    with Snapshot(handle) as now:
        try:
            header = now.about_at(key)
            return [] if header is None else [header.arrays_key]
        except DamagedMemoryError:
            return [other for other in now.bare_keys(keys.ARRAYS) if keys.split_view_key(other)[1] == view_id]


def _of_moving(now: Snapshot, category: str, record: CategoryRecord) -> WriteBatch:
    """Return the change that moves all views of a category to that of the record; their arrays stay where they are.

    Raises DamagedMemoryError where the header of a view is damaged.
    """
    change = WriteBatch()
    try:
        for key, sealed in now.pairs(keys.category_prefix(category)):
            change.move(read_about(key, sealed), record.name)
    except DamagedMemoryError as error:
        raise DamagedMemoryError(f"{error}; teach it again, or forget the category; nothing was changed") from error
    change.pairs += [(keys.name_key(keys.CATEGORY, category), None), write_category(record)]
    return change
