"""The folder of a memory: recognise it, make it, migrate it, and finish what a crash interrupted.

``memory.json`` makes a folder a memory; ``semantic/`` is its store. A new store is made in ``semantic.new`` and then
renamed, so that after a crash at any moment the next opening can finish or undo the change.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from enum import Enum, auto
from pathlib import Path
from typing import Any

import pyoxigraph as ox

from deixis.errors import DeixisError
from deixis.memory import owner as disk
from deixis.memory.errors import DamagedMemoryError, MemoryFormatError, MemoryWriteError
from deixis.memory.owner import LOCK_FILE

VERSION = 3
"""Format that this program writes; ``memory.semantic.migrations`` reads all earlier ones, from 0 on."""

FORMAT = "deixis-memory"
MARK, STORE, NEW, OLD = "memory.json", "semantic", "semantic.new", "semantic.old"
NEW_MARK = MARK + ".new"
SNAPSHOT = "semantic.snapshot"
"""Folder of the snapshot that queries run on; see ``memory.semantic.queries.snapshot``."""

PERCEPTUAL = "perceptual"
"""Folder of the perceptual memory, which may exist before the semantic store."""

EPISODES = "episodes"
"""Folder of the blackboard, which may exist before the semantic store."""

Migration = Callable[[ox.Store, ox.Store], None]
"""A function that fills a new store from one of an older format."""


class FolderState(Enum):
    """State of the folder at a path."""

    ABSENT = auto()
    EMPTY = auto()
    UNFINISHED = auto()
    MEMORY = auto()


def inspect(folder: Path) -> FolderState:
    """Return the state of a folder, without opening its store.

    Parameters
    ----------
    folder
        Folder that may hold a memory; it may be missing.

    Returns
    -------
    FolderState
        Absent, empty, an unfinished memory, or a memory.

    Raises
    ------
    MemoryFormatError
        If it is something else, or a damaged memory.
    """
    try:
        present = folder.exists()
    except OSError as error:  # such as a name that is too long
        raise MemoryFormatError(f"{folder} cannot be a folder: {error.strerror}; name another path") from error
    if not present:
        if folder.is_symlink():
            raise MemoryFormatError(f"{folder} is a broken link; remove or repair it")
        nearest = next(parent for parent in folder.absolute().parents if parent.exists())
        if not nearest.is_dir():
            raise MemoryFormatError(f"{folder} cannot exist: {nearest} is a file; name another path")
        return FolderState.ABSENT
    if not folder.is_dir():
        raise MemoryFormatError(f"{folder} is a file: a memory is a folder; name another path")
    names = {entry.name for entry in folder.iterdir()}
    if MARK in names:
        read_mark(folder)
        return FolderState.MEMORY
    if STORE in names and NEW_MARK in names:
        return FolderState.UNFINISHED
    if names <= {LOCK_FILE, NEW, NEW_MARK, SNAPSHOT, PERCEPTUAL, EPISODES}:
        return FolderState.EMPTY
    if STORE in names and (folder / STORE / "CURRENT").is_file():
        raise MemoryFormatError(
            f"the memory at {folder} is damaged: {MARK} is missing; put it back from a copy of the folder"
        )
    raise MemoryFormatError(
        f"{folder} is not a memory: it has other files ({', '.join(sorted(names)[:3])}) and no {MARK}; "
        "name an empty or a new folder"
    )


def read_mark(folder: Path) -> dict[str, Any]:
    """Return the content of ``memory.json``.

    Parameters
    ----------
    folder
        The folder of the memory.

    Returns
    -------
    dict
        Parsed JSON.

    Raises
    ------
    MemoryFormatError
        If it is invalid.
    """
    file = folder / MARK
    try:
        mark = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise MemoryFormatError(f"the memory at {folder} is damaged: {MARK} cannot be read ({error})") from error
    if not isinstance(mark, dict) or mark.get("format") != FORMAT:
        raise MemoryFormatError(f'the memory at {folder} is damaged or foreign: {MARK} does not say "{FORMAT}"')
    version = mark.get("version")
    if not isinstance(version, int) or isinstance(version, bool):
        raise MemoryFormatError(f"the memory at {folder} is damaged: {MARK} has no version number")
    if version > VERSION:
        raise MemoryFormatError(
            f"the memory at {folder} was written by a newer version (format {version}, this program knows {VERSION}); "
            "upgrade deixis to open it"
        )
    if not 0 <= version <= VERSION:
        raise MemoryFormatError(f"the memory at {folder} has the unknown format version {version}")
    return mark


def store_in(folder: Path) -> Path:
    """Return the path of the store.

    After an interrupted swap the store is beside its place, until :func:`finish` moves it back.

    Parameters
    ----------
    folder
        The folder of the memory.

    Returns
    -------
    Path
        The path.
    """
    aside = not (folder / STORE).is_dir() and (folder / OLD).is_dir()
    return folder / (OLD if aside else STORE)


def check_store_opens(folder: Path) -> None:
    """Open the store for reading and close it, which changes nothing.

    The caller must own the folder, as another process could replace the files.

    Parameters
    ----------
    folder
        The folder of the memory.

    Raises
    ------
    MemoryFormatError
        If it cannot be opened.
    """
    store = store_in(folder)
    current = store / "CURRENT"
    try:
        manifest = current.read_text(encoding="ascii").strip()
    except (OSError, ValueError):
        raise MemoryFormatError(
            f"the memory at {folder} is damaged: {STORE}/CURRENT is missing; restore the folder from a copy"
        ) from None
    if not manifest.startswith("MANIFEST-") or not (store / manifest).is_file():
        raise MemoryFormatError(
            f"the memory at {folder} is damaged: {STORE}/{manifest[:40]} is missing; restore the folder from a copy"
        )
    if not (folder / STORE).is_dir():
        return
    try:
        ox.Store.read_only(str(folder / STORE))
    except (OSError, RuntimeError) as error:
        raise MemoryFormatError(
            f"the memory at {folder} is damaged: its store does not open ({one_line(error)}); "
            "restore the folder from a copy"
        ) from error


def create(folder: Path, fill: Callable[[ox.Store], None], digest: str) -> None:
    """Make a memory in an empty folder.

    Parameters
    ----------
    folder
        Empty folder of the new memory.
    fill
        Function that fills the new store.
    digest
        Digest of the package's ontology, for ``memory.json``.
    """
    disk.remove(folder / NEW)
    (folder / NEW_MARK).unlink(missing_ok=True)
    try:
        store = ox.Store(folder / NEW)
        fill(store)
        store.flush()
        del store
    except BaseException:
        disk.remove(folder / NEW)
        raise
    _write(folder / NEW_MARK, {"format": FORMAT, "version": VERSION, "package": digest})
    disk.rename(folder / NEW, folder / STORE)
    disk.rename(folder / NEW_MARK, folder / MARK)


def finish(folder: Path) -> None:
    """Finish or undo what a crash interrupted.

    Parameters
    ----------
    folder
        The folder of the memory.
    """
    if not (folder / MARK).exists():
        disk.rename(folder / NEW_MARK, folder / MARK)
    if (folder / OLD).is_dir():
        if (folder / STORE).is_dir() and not (folder / NEW_MARK).exists():
            disk.remove(folder / OLD)  # the swap was completed
        else:
            disk.remove(folder / STORE)
            disk.rename(folder / OLD, folder / STORE)
    disk.remove(folder / NEW)
    disk.remove(folder / SNAPSHOT)
    (folder / NEW_MARK).unlink(missing_ok=True)


def swap(folder: Path, mark: dict[str, Any]) -> None:
    """Replace ``semantic`` with ``semantic.new``, and ``memory.json``; neither store may be open.

    Parameters
    ----------
    folder
        The folder of the memory.
    mark
        New content of ``memory.json``.
    """
    _write(folder / NEW_MARK, mark)
    disk.rename(folder / STORE, folder / OLD)
    disk.rename(folder / NEW, folder / STORE)
    disk.rename(folder / NEW_MARK, folder / MARK)
    disk.remove(folder / OLD)


def migrate(folder: Path, steps: Mapping[int, Migration]) -> None:
    """Migrate an older memory to this version, one step at a time, each on a copy that is then swapped in.

    Parameters
    ----------
    folder
        The folder of the memory.
    steps
        Function by the version that it migrates from.
    """
    mark = read_mark(folder)
    while mark["version"] != VERSION:
        step = steps[mark["version"]]
        disk.remove(folder / NEW)
        old, new = ox.Store.read_only(str(folder / STORE)), ox.Store(folder / NEW)
        step(old, new)
        new.flush()
        del old, new
        mark = {**mark, "version": mark["version"] + 1}
        swap(folder, mark)


def write_mark(folder: Path, mark: dict[str, Any]) -> None:
    """Replace ``memory.json`` in one step.

    Parameters
    ----------
    folder
        The folder of the memory.
    mark
        New content.
    """
    _write(folder / NEW_MARK, mark)
    disk.rename(folder / NEW_MARK, folder / MARK)


def size(folder: Path) -> int:
    """Return the bytes of all files under a folder, except the snapshot, whose files are those of the store.

    Parameters
    ----------
    folder
        The folder of the memory.

    Returns
    -------
    int
        The number of bytes.
    """
    files = (file for file in folder.rglob("*") if folder / SNAPSHOT not in file.parents)
    return sum(file.stat().st_size for file in files if file.is_file())


def one_line(error: BaseException) -> str:
    """Return an error's text without line ends.

    Parameters
    ----------
    error
        Error whose text may have several lines.

    Returns
    -------
    str
        Text with single spaces instead of line ends.
    """
    return " ".join(str(error).split())


def _write(file: Path, mark: dict[str, Any]) -> None:
    with file.open("w", encoding="utf-8") as out:
        out.write(json.dumps(mark, indent=2, sort_keys=True) + "\n")
        out.flush()
        os.fsync(out.fileno())


@contextmanager
def committed(folder: Path) -> Iterator[None]:
    """Raise the errors of a write in the block as MemoryWriteError.

    Parameters
    ----------
    folder
        The folder of the memory.

    Yields
    ------
    None
        Nothing.
    """
    advice = "check that the disk has room and the folder is writable, then try again: earlier content is unchanged"
    with wrap_storage_errors(folder, "written", advice):
        yield


@contextmanager
def reading(folder: Path) -> Iterator[None]:
    """Turn errors of a read into MemoryWriteError.

    Parameters
    ----------
    folder
        The folder of the memory.

    Yields
    ------
    None
        Nothing.
    """
    with wrap_storage_errors(folder, "read", "restore the folder from a copy"):
        yield


@contextmanager
def wrap_storage_errors(folder: Path, done: str, advice: str) -> Iterator[None]:
    """Turn errors of the store or the system into MemoryWriteError, or DamagedMemoryError for a corrupt store.

    Parameters
    ----------
    folder
        The folder of the memory.
    done
        Participle for the message: ``written`` or ``read``.
    advice
        What to do, for the message.

    Yields
    ------
    None
        Nothing.

    Raises
    ------
    DamagedMemoryError
        If the store is corrupt.
    MemoryWriteError
        For any other error of the store or the system.
    """
    try:
        yield
    except (OSError, RuntimeError) as error:
        if isinstance(error, DeixisError):
            raise
        if "Corruption" in str(error):
            raise DamagedMemoryError(
                f"the memory at {folder} is damaged ({one_line(error)}); restore the folder from a copy"
            ) from error
        raise MemoryWriteError(f"the memory at {folder} could not be {done} ({one_line(error)}); {advice}") from error
