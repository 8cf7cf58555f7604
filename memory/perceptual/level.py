"""Perceptual memory in a LevelDB, which outlives the process.

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
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Self

from deixis.memory.owner import Closing
from deixis.memory.perceptual.changes import of_batch, of_forgetting, of_moving
from deixis.memory.perceptual.handle import Handle, acquire, closed, release
from deixis.memory.perceptual.protocol import Finding, PerceptualStats, Progress, ViewKey
from deixis.memory.perceptual.reading import Snapshot, glance
from deixis.memory.perceptual.records import Batch, CategoryRecord, View, check_merging, check_name, name_taken


class LevelMemory(Closing):
    """The perceptual memory in one folder, owned by this process until the last who opened it closes it.

    The methods are those of :class:`deixis.memory.perceptual.protocol.PerceptualMemory`.
    """

    def __init__(self, handle: Handle) -> None:
        self._open: Handle | None = handle

    @classmethod
    def open(cls, path: str | Path, create: bool = False) -> Self:
        """Opens a memory, or makes one with ``create``; a folder that this process has open is shared.

        Raises MemoryBusyError where another process has it, MemoryFormatError where there is none or it cannot be
        believed, MemoryWriteError where the folder cannot be written.
        """
        return cls(acquire(Path(path), create))

    def close(self) -> None:
        """Lets go of the folder, once calls under way are done."""
        handle, self._open = self._open, None
        if handle is not None:
            release(handle)

    @property
    def handle(self) -> Handle:
        """What all who have this folder open in this process share."""
        if self._open is None:
            raise closed()
        return self._open

    @property
    def path(self) -> Path:
        """The folder, without links."""
        return self.handle.folder

    def view(self, id: str) -> View:
        """One view."""
        place = self.handle.place_of(check_name("a view's id", id))
        if place is not None:
            with self.handle as db:
                found = glance(db, place)
            if found is not None:
                return found
        with self.snapshot() as now:
            return now.view(id)

    def views(self, category: str | None = None) -> Iterator[View]:
        """Views, as they were when this was called."""
        return self.snapshot().views(category)

    def listing(self, category: str | None = None) -> Iterator[ViewKey]:
        """The same without arrays."""
        return self.snapshot().listing(category)

    def categories(self) -> tuple[str, ...]:
        """Names."""
        with self.snapshot() as now:
            return now.categories()

    def category(self, name: str) -> CategoryRecord:
        """What a learner left."""
        with self.snapshot() as now:
            return now.category(name)

    def stats(self) -> PerceptualStats:
        """Counts."""
        with self.snapshot() as now:
            return now.stats()

    def verify(self, progress: Progress | None = None) -> tuple[Finding, ...]:
        """What is not as it was written."""
        with self.snapshot() as now:
            return now.verify(progress)

    def snapshot(self) -> Snapshot:
        """All as it is now."""
        return Snapshot(self.handle)

    def exclusive(self) -> AbstractContextManager[object]:
        """Keeps other threads from writing."""
        return self.handle.writing

    def write(self, batch: Batch, sync: bool = False) -> None:
        """Writes a batch in one step."""
        handle = self.handle
        with handle.writing:
            handle.write(of_batch(handle, batch), sync)

    def rename(self, old: str, new: str) -> None:
        """Gives a category another name."""
        check_name("a category's name", new)
        with self.exclusive(), self.snapshot() as now:
            record = now.category(old)
            if now.has(new):
                raise name_taken(old, new)
            self.handle.write(of_moving(now, old, CategoryRecord(new, record.state, record.metadata)), sync=True)

    def merge(self, source: str, into: str, record: CategoryRecord | None = None) -> None:
        """Moves the views of one category to another."""
        check_merging(source, into, record)
        with self.exclusive(), self.snapshot() as now:
            now.require(into)
            now.require(source)
            self.handle.write(of_moving(now, source, record or CategoryRecord(into)), sync=True)

    def forget(self, category: str) -> None:
        """Forgets a category."""
        with self.exclusive(), self.snapshot() as now:
            now.require(category)
            self.handle.write(of_forgetting(self.handle, category), sync=True)
