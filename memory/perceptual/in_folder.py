"""What is done to the perceptual memory in the folder of a memory as a whole: what ``deixis memory …`` calls.

A memory in which nothing was ever taught has no perceptual memory, and that is no error here.

>>> import tempfile
>>> folder = Path(tempfile.mkdtemp())
>>> stats_of(folder) is None, has_views(folder)
(True, False)
"""

from __future__ import annotations

from pathlib import Path

from deixis.memory.errors import DamagedMemoryError
from deixis.memory.folder import inspect
from deixis.memory.perceptual.exchange import Archive, Imported, export_views, import_views, is_archive
from deixis.memory.perceptual.layout import FOLDER, version_in
from deixis.memory.perceptual.level import LevelMemory, UndamagedMemory
from deixis.memory.perceptual.protocol import PerceptualStats, Progress

__all__ = [
    "export_all",
    "has_views",
    "import_all",
    "is_archive",
    "open_in",
    "open_undamaged",
    "stats_of",
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
