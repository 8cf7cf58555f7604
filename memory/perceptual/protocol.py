"""Protocol of perceptual memories: the types that hold views of objects share these methods."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from datetime import datetime
from types import TracebackType
from typing import NamedTuple, Protocol, Self

from deixis.memory.perceptual.records import Batch, CategoryRecord, View

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
        """Return one view. Raises UnknownViewError; DamagedMemoryError where the view is damaged."""
        ...

    def views(self, category: str | None = None) -> Iterator[View]:
        """Return all views, or those of a category, as they are at the time of the call.

        Raises UnknownCategoryError; DamagedMemoryError at a damaged view.
        """
        ...

    def listing(self, category: str | None = None) -> Iterator[ViewKey]:
        """Iterate over category, id and time of the views that :meth:`views` returns, without reading arrays."""
        ...

    def categories(self) -> tuple[str, ...]:
        """Return the names of all categories that have a view or a record, in order."""
        ...

    def category(self, name: str) -> CategoryRecord:
        """Return the record of a category, with no arrays where nothing was learned. Raises UnknownCategoryError."""
        ...

    def lessons_of_views(self) -> dict[str, str]:
        """Return the lesson of each view that belongs to one, by the view's id."""
        ...

    def stats(self) -> PerceptualStats:
        """Return the size of the memory."""
        ...

    def verify(self, progress: Progress | None = None) -> tuple[Finding, ...]:
        """Read everything, and return what differs from what was written; an empty tuple where nothing does."""
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
        """Write a batch, so that it survives the end of this process; with ``sync``, also that of the machine.

        Raises UnknownViewError where a view to forget does not exist, MemoryWriteError where the batch cannot be
        written; nothing is changed then.
        """
        ...

    def write_all(self, batches: Iterable[Batch], new: Sequence[str]) -> None:
        """Write batches of new views with the ids ``new``: all of them or none.

        Only one of the batches is held at a time. Raises as :meth:`write`, and whatever ``batches`` raises.
        """
        ...

    def rename(self, old: str, new: str) -> None:
        """Rename a category. Raises UnknownCategoryError; RejectedWriteError where the new name is in use."""
        ...

    def merge(self, source: str, into: str, record: CategoryRecord | None = None) -> None:
        """Move the views of one category to another, and replace the record of that with ``record``.

        Without a record the category has no learned state, as neither old one describes these views. Raises
        UnknownCategoryError; RecordError where the record is of another category.
        """
        ...

    def forget(self, category: str) -> None:
        """Forget a category with all its views. Raises UnknownCategoryError."""
        ...

    def exclusive(self) -> AbstractContextManager[object]:
        """Return a lock that keeps other threads from writing, for a read followed by a write."""
        ...

    def snapshot(self) -> PerceptualReading:
        """Return a snapshot of the memory, unchanged by later writes, until it is closed."""
        ...
