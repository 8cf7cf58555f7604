"""Operations on the perceptual memory in the folder of a memory, as ``deixis memory …`` calls them.

A memory without views has no perceptual memory, which is not an error here.

>>> import tempfile
>>> folder = Path(tempfile.mkdtemp())
>>> stats_of(folder) is None, has_views(folder)
(True, False)
"""

from __future__ import annotations

from pathlib import Path

from deixis.memory.errors import DamagedMemoryError
from deixis.memory.folder import inspect
from deixis.memory.perceptual.database.layout import FOLDER, version_in
from deixis.memory.perceptual.exchange import Archive, Imported, export_views, import_views, is_archive
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
    """Open the perceptual memory in the folder of a memory.

    Parameters
    ----------
    memory
        Folder of the whole memory.
    create
        If True, make the perceptual memory if there is none.

    Returns
    -------
    LevelMemory
        The open memory.

    Raises
    ------
    MemoryBusyError
        If another process has the memory open.
    MemoryFormatError
        If the folder is not that of a memory, or has no perceptual memory.
    MemoryWriteError
        If the folder cannot be written.
    """
    return LevelMemory.open(_place_in(memory), create)


def open_undamaged(memory: Path) -> UndamagedMemory:
    """Open the perceptual memory without its damaged views.

    Parameters
    ----------
    memory
        Folder of the whole memory.

    Returns
    -------
    UndamagedMemory
        The open memory, whose ``left_out`` lists the damage.

    Raises
    ------
    MemoryFormatError
        If the folder is not that of a memory, or has no perceptual memory.
    """
    return UndamagedMemory.open(_place_in(memory))


def has_views(memory: Path) -> bool:
    """Return whether a memory has a perceptual memory, without opening it.

    Parameters
    ----------
    memory
        Folder of the whole memory.

    Returns
    -------
    bool
        True also if all views were forgotten.

    Raises
    ------
    MemoryFormatError
        If the folder is not that of a memory.
    """
    return version_in(_place_in(memory)) is not None


def _place_in(memory: Path) -> Path:
    inspect(memory)
    return memory / FOLDER


def stats_of(memory: Path) -> PerceptualStats | None:
    """Return the size of the perceptual memory, or None where a memory has no views.

    Parameters
    ----------
    memory
        Folder of the whole memory.

    Returns
    -------
    PerceptualStats or None
        Numbers of views and categories, and the bytes on the disk.
    """
    if not has_views(memory):
        return None
    with open_in(memory) as views:
        return views.stats()


def export_all(memory: Path, file: Path, progress: Progress | None = None) -> None:
    """Write all views and categories into one file.

    Parameters
    ----------
    memory
        Folder of the whole memory.
    file
        File to write.
    progress
        Called with the number of views done, and the number of all views.

    Raises
    ------
    MemoryFormatError
        If there are no views.
    DamagedMemoryError
        If a view or a record is damaged; nothing is exported then.
    MemoryWriteError
        If the file cannot be written.
    """
    with open_in(memory) as views:
        try:
            export_views(views, file, progress)
        except DamagedMemoryError as error:
            raise DamagedMemoryError(
                f"{error}; nothing was exported: 'deixis memory verify' lists the damage; teach or learn from the same "
                "scene again to repair it"
            ) from error


def import_all(file: Path, memory: Path, progress: Progress | None = None) -> Imported:
    """Import a file that :func:`export_all` wrote, one for which :func:`is_archive` is True.

    Parameters
    ----------
    file
        Archive of views.
    memory
        Folder of the whole memory, in which a perceptual memory is made if needed.
    progress
        Called with the number of views done, and twice the number of views.

    Returns
    -------
    Imported
        Numbers of new views and records, and the categories whose state is left out.

    Raises
    ------
    ImportFormatError
        If the file is invalid.
    RejectedWriteError
        If the file has a view with a known id and other content.
    """
    with Archive(file):
        pass  # raises for an invalid archive before a memory is made
    with open_in(memory, create=True) as views:
        return import_views(file, views, progress)
