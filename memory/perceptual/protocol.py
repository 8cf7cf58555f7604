"""Protocol of perceptual memories: the types that hold views of objects share these methods."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from datetime import datetime
from types import TracebackType
from typing import NamedTuple, Protocol, Self

from deixis.memory.perceptual.records import Batch, CategoryRecord, Json, View

Progress = Callable[[int, int], None]
"""A function called with the number of views done and the number of all views."""


class ViewKey(NamedTuple):
    """Key of a view in the order of a memory: by category, then id (both by code points), then time."""

    category: str
    id: str
    time: datetime


@dataclass(frozen=True)
class PerceptualStats:
    """Size of a memory; ``lost`` is the number of acknowledged batches that are missing, ``bytes`` the size on disk."""

    views: int
    categories: int
    batches: int
    lost: int
    bytes: int
    version: int


@dataclass(frozen=True)
class Finding:
    """A place in a memory that differs from what was written."""

    where: str
    what: str

    def __str__(self) -> str:
        return f"{self.where}: {self.what}"


class PerceptualReading(Protocol):
    """Read access to a memory. Lists are ordered by category, then view; arrays are read one view at a time."""

    def view(self, id: str) -> View:
        """Return one view.

        Parameters
        ----------
        id
            Id of the view.

        Returns
        -------
        View
            View with its arrays.

        Raises
        ------
        UnknownViewError
            If there is no such view.
        DamagedMemoryError
            If the view is damaged.
        """
        ...

    def views(self, category: str | None = None) -> Iterator[View]:
        """Return all views, or those of a category.

        Parameters
        ----------
        category
            Name of a category; all categories by default.

        Yields
        ------
        View
            Views in the order of category and id, as they are at the time of the call.

        Raises
        ------
        UnknownCategoryError
            If the category is unknown.
        DamagedMemoryError
            At a damaged view.
        """
        ...

    def listing(self, category: str | None = None) -> Iterator[ViewKey]:
        """Iterate over category, id and time of the views that :meth:`views` returns, without reading arrays.

        Parameters
        ----------
        category
            Name of a category; all categories by default.

        Yields
        ------
        ViewKey
            Category, id and time of each view, in the order of :meth:`views`.

        Raises
        ------
        UnknownCategoryError
            If the category is unknown.
        """
        ...

    def categories(self) -> tuple[str, ...]:
        """Return the names of all categories that have a view or a record, in order.

        Returns
        -------
        tuple of str
            Names in order, of categories with a view or a record.
        """
        ...

    def category(self, name: str) -> CategoryRecord:
        """Return the record of a category.

        Parameters
        ----------
        name
            Name of the category.

        Returns
        -------
        CategoryRecord
            Record; its state is empty if nothing was learned.

        Raises
        ------
        UnknownCategoryError
            If the category is unknown.
        """
        ...

    def lessons_of_views(self) -> dict[str, str]:
        """Return the lesson of each view that belongs to one, by the view's id.

        Returns
        -------
        dict
            Ids of lessons by the ids of views.
        """
        ...

    def teachings(self) -> dict[str, tuple[Json, ...]]:
        """Return all teachings of each view that was taught more than once, by the view's id.

        Returns
        -------
        dict
            Teachings in turn, as JSON, by the ids of views.
        """
        ...

    def stats(self) -> PerceptualStats:
        """Return the size of the memory.

        Returns
        -------
        PerceptualStats
            Numbers of views, categories and batches, and the size in bytes.
        """
        ...

    def verify(self, progress: Progress | None = None) -> tuple[Finding, ...]:
        """Read everything, and return what differs from what was written; an empty tuple where nothing does.

        Parameters
        ----------
        progress
            Called with the number of views done, and the number of all views.

        Returns
        -------
        tuple of Finding
            One finding for each damaged place; empty for a sound memory.
        """
        ...

    def close(self) -> None:
        """Release the memory; later calls raise MemoryFormatError."""
        ...

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None, /
    ) -> None: ...


class PerceptualMemory(PerceptualReading, Protocol):
    """Read and write access to a memory. Each call is one step, all or nothing. Threads may share a memory."""

    def write(self, batch: Batch, sync: bool = False) -> None:
        """Write a batch, so that it survives the end of this process.

        Parameters
        ----------
        batch
            Views and records to write, and those to remove.
        sync
            If True, the batch also survives a crash of the machine.

        Raises
        ------
        UnknownViewError
            If a view to forget does not exist.
        MemoryWriteError
            If the change cannot be written; nothing is changed then.
        """
        ...

    def write_all(self, batches: Iterable[Batch], new: Sequence[str]) -> None:
        """Write batches of new views: all of them or none.

        Parameters
        ----------
        batches
            Batches of new views, which are read one at a time. Errors that it raises are passed on.
        new
            Ids of all these views.

        Raises
        ------
        MemoryWriteError
            If the change cannot be written; nothing is changed then.
        """
        ...

    def rename(self, old: str, new: str) -> None:
        """Rename a category.

        Parameters
        ----------
        old
            Name of the category.
        new
            New name of it.

        Raises
        ------
        UnknownCategoryError
            If there is no such category.
        RejectedWriteError
            If the new name is in use.
        """
        ...

    def merge(self, source: str, into: str, record: CategoryRecord | None = None) -> None:
        """Move the views of one category to another.

        Parameters
        ----------
        source
            Category whose views are moved; it ceases to exist.
        into
            Category that receives them.
        record
            New record of ``into``. Without it the category has no learned state, as neither old one describes these
            views.

        Raises
        ------
        UnknownCategoryError
            If one of the categories is unknown.
        RecordError
            If the categories are equal, or the record is of another one.
        """
        ...

    def forget(self, category: str) -> None:
        """Forget a category with all its views.

        Parameters
        ----------
        category
            Name of the category.

        Raises
        ------
        UnknownCategoryError
            If there is no such category.
        """
        ...

    def exclusive(self) -> AbstractContextManager[object]:
        """Return a lock that keeps other threads from writing, for a read followed by a write.

        Returns
        -------
        AbstractContextManager[object]
            Context manager that holds the lock; a thread may enter it repeatedly.
        """
        ...

    def snapshot(self) -> PerceptualReading:
        """Return a snapshot of the memory, unchanged by later writes, until it is closed.

        Returns
        -------
        PerceptualReading
            Read access to the content at the time of the call; close it after use.
        """
        ...
