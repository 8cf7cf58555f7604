"""A memory of which damaged views are left out, and remembered as left out: a look at what can still be read.

>>> import tempfile
>>> with UndamagedMemory.open(tempfile.mkdtemp(), create=True) as memory:
...     list(memory.views()), memory.left_out
([], [])
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property

from deixis.memory.errors import DamagedMemoryError
from deixis.memory.perceptual import keys
from deixis.memory.perceptual.codec import read_about
from deixis.memory.perceptual.level import LevelMemory
from deixis.memory.perceptual.protocol import ViewKey
from deixis.memory.perceptual.reading import Snapshot
from deixis.memory.perceptual.records import CategoryRecord, View


class UndamagedMemory(LevelMemory):
    """Reads as if damaged views were not there; ``left_out`` says which, a line each. Listing reads arrays too."""

    @cached_property
    def left_out(self) -> list[str]:
        """What was met so far and could not be read."""
        return []

    def views(self, category: str | None = None) -> Iterator[View]:
        """The views that are what was written."""
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
            except DamagedMemoryError as error:  # of the order itself: what comes after it is not found
                self._leave_out(error)

    def listing(self, category: str | None = None) -> Iterator[ViewKey]:
        """Where they stand."""
        return (ViewKey(view.category, view.id, view.time) for view in self.views(category))

    def categories(self) -> tuple[str, ...]:
        """The categories of these views."""
        return tuple(dict.fromkeys(key.category for key in self.listing()))

    def category(self, name: str) -> CategoryRecord:
        """What a learner left, if that is what was written."""
        try:
            return super().category(name)
        except DamagedMemoryError as error:
            self._leave_out(error)
            return CategoryRecord(name)

    def _leave_out(self, error: DamagedMemoryError) -> None:
        if str(error) not in self.left_out:
            self.left_out.append(str(error))
