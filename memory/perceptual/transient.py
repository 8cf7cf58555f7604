"""Perceptual memory in dictionaries, for trials and tests, which ends with the process.

>>> from datetime import UTC, datetime
>>> with TransientMemory() as memory:
...     memory.write(Batch([View("v1", "mug", datetime(2026, 5, 1, tzinfo=UTC), {})]))
...     memory.rename("mug", "cup")
...     [key.category for key in memory.listing()]
['cup']
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace

from deixis.memory.errors import UnknownViewError
from deixis.memory.owner import Closing
from deixis.memory.perceptual.database.handle import closed
from deixis.memory.perceptual.database.layout import VERSION
from deixis.memory.perceptual.protocol import (
    Finding,
    PerceptualMemory,
    PerceptualReading,
    PerceptualStats,
    Progress,
    ViewKey,
)
from deixis.memory.perceptual.reading import unknown_category, unknown_view
from deixis.memory.perceptual.records import Batch, CategoryRecord, Json, View, check_merging, check_name, name_taken


@dataclass(frozen=True)
class _StoredViews:
    """Content of the memory. A write replaces it as a whole, so that readers keep the one they have."""

    views: dict[str, View]
    records: dict[str, CategoryRecord]
    batches: int
    lessons: dict[str, str] = field(default_factory=dict)
    teachings: dict[str, tuple[Json, ...]] = field(default_factory=dict)


class TransientReading(Closing, PerceptualReading):
    """Read access to one content; the methods are those of ``PerceptualReading``."""

    def __init__(self, content: _StoredViews) -> None:
        self._kept: _StoredViews | None = content

    def close(self) -> None:
        """Release the content."""
        self._kept = None

    @property
    def _content(self) -> _StoredViews:
        if self._kept is None:
            raise closed()
        return self._kept

    def view(self, id: str) -> View:
        """Return one view."""
        check_name("a view's id", id)
        if id not in self._content.views:
            raise unknown_view(id)
        return self._content.views[id]

    def views(self, category: str | None = None) -> Iterator[View]:
        """Iterate over views in order."""
        found = [view for view in self._content.views.values() if category is None or view.category == category]
        if category is not None and not found:
            self._require(category)
        return self._each(sorted(found, key=lambda view: (view.category, view.id)))

    def _each(self, views: list[View]) -> Iterator[View]:
        for view in views:
            _ = self._content  # raises if this was closed meanwhile
            yield view

    def listing(self, category: str | None = None) -> Iterator[ViewKey]:
        """Iterate over category, id and time of views, without reading arrays."""
        return (ViewKey(view.category, view.id, view.time) for view in self.views(category))

    def categories(self) -> tuple[str, ...]:
        """Return the names of all categories."""
        return tuple(sorted({view.category for view in self._content.views.values()} | set(self._content.records)))

    def category(self, name: str) -> CategoryRecord:
        """Return the record of a category."""
        self._require(name)
        return self._content.records.get(name, CategoryRecord(name))

    def _require(self, category: str) -> None:
        check_name("a category's name", category)
        if category not in self.categories():
            raise unknown_category(category, self.categories())

    def lessons_of_views(self) -> dict[str, str]:
        """Return the lesson of each view that belongs to one, by the view's id."""
        return dict(self._content.lessons)

    def teachings(self) -> dict[str, tuple[Json, ...]]:
        """Return all teachings of each view that was taught more than once, by the view's id."""
        return dict(self._content.teachings)

    def stats(self) -> PerceptualStats:
        """Return the size of the memory."""
        arrays = [array for view in self._content.views.values() for array in view.descriptors.values()]
        return PerceptualStats(
            views=len(self._content.views),
            categories=len(self.categories()),
            batches=self._content.batches,
            lost=0,
            bytes=sum(array.nbytes for array in arrays),
            version=VERSION,
        )

    def verify(self, progress: Progress | None = None) -> tuple[Finding, ...]:
        """Return no findings, because dictionaries are never damaged."""
        _ = self._content
        return ()


class TransientMemory(TransientReading, PerceptualMemory):
    """A memory that ends with the process; the methods are those of ``PerceptualMemory``."""

    def __init__(self) -> None:
        super().__init__(_StoredViews({}, {}, 0))
        self._writing = threading.RLock()

    def snapshot(self) -> TransientReading:
        """Return a snapshot of the memory, unchanged by later writes."""
        return TransientReading(self._content)

    def exclusive(self) -> AbstractContextManager[object]:
        """Return a lock that keeps other threads from writing."""
        return self._writing

    def write(self, batch: Batch, sync: bool = False) -> None:
        """Write a batch in one step."""
        with self._writing:
            views, records = dict(self._content.views), dict(self._content.records)
            for view_id in batch.forgotten:
                if view_id not in views:
                    raise UnknownViewError(f"no view '{view_id}' to forget; nothing was written")
                del views[view_id]
            views.update({view.id: view for view in batch.views})
            records.update({record.name: record for record in batch.categories})
            records = {name: record for name, record in records.items() if name not in batch.dropped}
            replaced = {*batch.forgotten, *(view.id for view in batch.views)}
            lessons = {view_id: lesson for view_id, lesson in self._content.lessons.items() if view_id not in replaced}
            for view_id, lesson in batch.lessons.items():
                lessons.pop(view_id, None)
                if lesson is not None:
                    lessons[view_id] = lesson
            kept = self._content.teachings.items()
            teachings = {view_id: turns for view_id, turns in kept if view_id not in replaced}
            teachings |= {view_id: tuple(turns) for view_id, turns in batch.teachings.items()}
            teachings = {view_id: turns for view_id, turns in teachings.items() if turns}
            self._kept = _StoredViews(views, records, self._content.batches + 1, lessons, teachings)

    def write_all(self, batches: Iterable[Batch], new: Sequence[str]) -> None:
        """Write batches of new views, all or none."""
        with self._writing:
            before = self._content
            try:
                for batch in batches:
                    self.write(batch)
            except BaseException:
                self._kept = before
                raise

    def rename(self, old: str, new: str) -> None:
        """Rename a category."""
        check_name("a category's name", new)
        with self._writing:
            record = self.category(old)
            if new in self.categories():
                raise name_taken(old, new)
            self._move(old, CategoryRecord(new, record.state, record.metadata))

    def merge(self, source: str, into: str, record: CategoryRecord | None = None) -> None:
        """Move the views of one category to another."""
        check_merging(source, into, record)
        with self._writing:
            self._require(into)
            self._require(source)
            self._move(source, record or CategoryRecord(into))

    def forget(self, category: str) -> None:
        """Forget a category with its views."""
        with self._writing:
            self._require(category)
            views = {view_id: view for view_id, view in self._content.views.items() if view.category != category}
            records = {name: kept for name, kept in self._content.records.items() if name != category}
            lessons = {view_id: lesson for view_id, lesson in self._content.lessons.items() if view_id in views}
            teachings = {view_id: turns for view_id, turns in self._content.teachings.items() if view_id in views}
            self._kept = _StoredViews(views, records, self._content.batches + 1, lessons, teachings)

    def _move(self, category: str, record: CategoryRecord) -> None:
        views = {
            view_id: replace(view, category=record.name) if view.category == category else view
            for view_id, view in self._content.views.items()
        }
        records = {name: kept for name, kept in self._content.records.items() if name != category}
        records[record.name] = record
        self._kept = replace(self._content, views=views, records=records, batches=self._content.batches + 1)
