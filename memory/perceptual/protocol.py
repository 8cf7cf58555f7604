"""What every perceptual memory can do, whatever keeps it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from datetime import datetime
from types import TracebackType
from typing import NamedTuple, Protocol, Self

from deixis.memory.perceptual.records import Batch, CategoryRecord, View

Progress = Callable[[int, int], None]
"""Is told how many views are done, and how many there are."""


class ViewKey(NamedTuple):
    """Where a view stands in the order of a memory: by category, then id (both by code points), then time."""

    category: str
    id: str
    time: datetime


@dataclass(frozen=True)
class PerceptualStats:
    """How much a memory keeps; ``lost`` counts batches that were acknowledged and are not there."""

    views: int
    categories: int
    batches: int
    lost: int
    bytes: int
    version: int


@dataclass(frozen=True)
class Finding:
    """Something in a memory that is not as it was written."""

    where: str
    what: str

    def __str__(self) -> str:
        return f"{self.where}: {self.what}"


class PerceptualReading(Protocol):
    """Reading a memory. What is listed comes in order of category, then view; arrays are read one view at a time."""

    def view(self, id: str) -> View:
        """Return one view. Raises UnknownViewError; DamagedMemoryError where it is not what was written."""

    def views(self, category: str | None = None) -> Iterator[View]:
        """Return all views, or those of a category, as they were when this was called.

        Raises UnknownCategoryError; DamagedMemoryError at the view that is not what was written.
        """

    def listing(self, category: str | None = None) -> Iterator[ViewKey]:
        """Iterate over category, id and time of the views that :meth:`views` gives, without reading arrays."""

    def categories(self) -> tuple[str, ...]:
        """Return the names of all categories that have a view or a record, in order."""

    def category(self, name: str) -> CategoryRecord:
        """Return what a learner left about a category, without arrays where nothing. Raises UnknownCategoryError."""

    def lessons_of_views(self) -> dict[str, str]:
        """Return the lesson of each view that belongs to one, by the view's id."""

    def stats(self) -> PerceptualStats:
        """Return how much the memory keeps."""

    def verify(self, progress: Progress | None = None) -> tuple[Finding, ...]:
        """Read everything, and return what is not as it was written; nothing where all is well."""

    def close(self) -> None:
        """Release the memory; whatever is asked afterwards raises MemoryFormatError."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


class PerceptualMemory(PerceptualReading, Protocol):
    """A memory that can be written too: each call is one step, all or nothing. Threads may share it."""

    def write(self, batch: Batch, sync: bool = False) -> None:
        """Write a batch, and return once it is safe from the death of this process; with ``sync``, of the machine.

        Raises UnknownViewError where a view to forget is not there, MemoryWriteError where it cannot be written;
        nothing is changed then.
        """

    def write_all(self, batches: Iterable[Batch], new: Sequence[str]) -> None:
        """Write batches that bring new views, with the ids ``new``: all of them, or none, whatever happens.

        Only one of the batches is held at a time. Raises as :meth:`write`, and whatever ``batches`` raises.
        """

    def rename(self, old: str, new: str) -> None:
        """Give a category another name. Raises UnknownCategoryError; RejectedWriteError for a name that is taken."""

    def merge(self, source: str, into: str, record: CategoryRecord | None = None) -> None:
        """Move the views of one category to another, and give that ``record``.

        Without one the category is left without a learned state, as neither old one describes these views. Raises
        UnknownCategoryError; RecordError where the record is another category's.
        """

    def forget(self, category: str) -> None:
        """Forget a category with all its views. Raises UnknownCategoryError."""

    def exclusive(self) -> AbstractContextManager[object]:
        """Keep other threads from writing between reading categories and writing them back."""

    def snapshot(self) -> PerceptualReading:
        """Return the memory as it is now, whatever is written later, until closed."""
