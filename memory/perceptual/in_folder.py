"""What is done to the perceptual memory in the folder of a memory as a whole: what ``deixis memory …`` calls.

A memory in which nothing was ever taught has no perceptual memory, and that is no error here.

>>> import tempfile
>>> folder = Path(tempfile.mkdtemp())
>>> stats_of(folder) is None, verify_views(folder)
(True, ())
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from pathlib import Path

from deixis.errors import DeixisError
from deixis.memory.errors import DamagedMemoryError, MemoryWriteError
from deixis.memory.folder import inspect
from deixis.memory.perceptual.exchange import Archive, Imported, export_views, import_views, is_archive
from deixis.memory.perceptual.layout import FOLDER, version_in
from deixis.memory.perceptual.level import LevelMemory, UndamagedMemory
from deixis.memory.perceptual.protocol import Finding, PerceptualMemory, PerceptualStats, Progress
from deixis.memory.perceptual.records import Batch, CategoryRecord, View

__all__ = [
    "export_all",
    "has_views",
    "import_all",
    "is_archive",
    "open_in",
    "open_undamaged",
    "restored_on_failure",
    "stats_of",
    "verify_views",
]


def open_in(memory: Path, create: bool = False) -> LevelMemory:
    """Open the perceptual memory in the folder of a memory; raises as ``LevelMemory.open``, and for what is none."""
    return LevelMemory.open(_place_in(memory), create)


def open_undamaged(memory: Path) -> UndamagedMemory:
    """Open the perceptual memory such that what is damaged in it is left out."""
    return UndamagedMemory.open(_place_in(memory))


def has_views(memory: Path) -> bool:
    """Return whether anything was ever taught, by looking only; raises MemoryFormatError for what is no memory."""
    return version_in(_place_in(memory)) is not None


def _place_in(memory: Path) -> Path:
    inspect(memory)
    return memory / FOLDER


def stats_of(memory: Path) -> PerceptualStats | None:
    """Return how much is kept, or None where nothing was taught."""
    if not has_views(memory):
        return None
    with open_in(memory) as views:
        return views.stats()


def verify_views(memory: Path, progress: Progress | None = None) -> tuple[Finding, ...]:
    """Return what is not as it was written; raises DamagedMemoryError where the memory cannot be opened."""
    if not has_views(memory):
        return ()
    with open_in(memory) as views:
        return views.verify(progress)


def export_all(memory: Path, file: Path, progress: Progress | None = None) -> None:
    """Write all views and categories into one file; raises MemoryFormatError where nothing was taught."""
    with open_in(memory) as views:
        try:
            export_views(views, file, progress)
        except DamagedMemoryError as error:
            raise DamagedMemoryError(
                f"{error}; nothing was exported: 'deixis memory verify' lists what is damaged, and what is taught or "
                "learned from the same scene again is mended"
            ) from error


def import_all(file: Path, memory: Path, progress: Progress | None = None) -> Imported:
    """Take in what :func:`export_all` wrote, for files of which :func:`is_archive` is true."""
    with Archive(file):
        pass  # what is no archive of views makes no memory
    with open_in(memory, create=True) as views:
        return import_views(file, views, progress)


@contextlib.contextmanager
def restored_on_failure(memory: PerceptualMemory, views: Sequence[View]) -> Iterator[None]:
    """Put views that are kept within, and their categories, back as they were where something within fails.

    Other threads cannot write meanwhile. A view that was damaged before is gone then. Raises MemoryWriteError, with
    what had failed, where the memory cannot be put back.
    """
    with memory.exclusive():
        there = set(memory.categories())
        ids = dict.fromkeys(view.id for view in views)
        before = [view for view in (_view(memory, id) for id in ids) if view is not None]
        names = {view.category for view in (*views, *before)} & there
        records = [record for record in (_record(memory, name) for name in sorted(names)) if record is not None]
        try:
            yield
        except BaseException as failure:
            old = {view.id for view in before}
            new = [id for id in ids if id not in old and _view(memory, id) is not None]
            try:
                memory.write(Batch(before, records, new))
                for name in {view.category for view in views} & set(memory.categories()) - there:
                    memory.forget(name)
            except DeixisError as error:
                told = f"{failure}; what the things look like stays kept all the same: {error}"
                raise MemoryWriteError(told) from failure
            raise


def _view(memory: PerceptualMemory, view_id: str) -> View | None:
    with contextlib.suppress(DeixisError):
        return memory.view(view_id)
    return None


def _record(memory: PerceptualMemory, name: str) -> CategoryRecord | None:
    with contextlib.suppress(DeixisError):
        return memory.category(name)
    return None
