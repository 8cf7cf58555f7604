"""The folder of a perceptual memory: its files and their versions, and the migration of older versions.

``store-2/`` is a LevelDB of version 2; the version is in the name only. A new store is made as ``store-3.new/`` and
renamed when it is complete, so that a crash at any moment leaves one complete store with the greatest number. Beside it
are ``owner.lock``, ``calibration.json`` (see :mod:`deixis.memory.perceptual.calibrated`), ``journal`` during a write
over several stores (see :mod:`deixis.memory.journal`), and two files that reveal losses that LevelDB does not report:

- ``acknowledged`` has the counts of the last batch. A database whose log has a broken end treats it as an unfinished
  write, and drops it.
- ``seal.json`` exists while no process has the memory open, if it was closed in good order. LevelDB repairs damage in
  its log and manifest by leaving out entries, and deletes files that the manifest does not name. The seal has size and
  CRC-32 of the small files, and the sizes of the tables, whose content is checked when it is read. After a crash there
  the seal is missing: then LevelDB may repair its files.

To change the format: raise :data:`VERSION`, and add the step from the version before to
:data:`deixis.memory.perceptual.database.migrations.MIGRATIONS`. A step reads the old database and fills a new one.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import zlib
from collections.abc import Callable
from pathlib import Path

import plyvel

from deixis.memory import owner as disk
from deixis.memory.errors import DamagedMemoryError, MemoryFormatError
from deixis.memory.journal import JOURNAL
from deixis.memory.owner import LOCK_FILE
from deixis.memory.perceptual.database.codec import StoreCounts, read_counts
from deixis.memory.perceptual.database.migrations import MIGRATIONS

FOLDER = "perceptual"
"""Folder of the perceptual memory within the folder of a memory."""

VERSION = 2
"""Version of the database that this program reads and writes."""

TALLY, SEAL, CALIBRATION = "acknowledged", "seal.json", "calibration.json"
_STORE = re.compile(r"store-(\d+)(\.new)?")
_UNSEALED_FILES = {"LOCK", "LOG", "LOG.old"}
_TABLE = ".ldb"


def store(folder: Path, version: int | None = None) -> Path:
    """Return the path of the database of a version; by default this program's version.

    Parameters
    ----------
    folder
        Folder of the perceptual memory.
    version
        Version of the format.

    Returns
    -------
    Path
        Path, which may not exist.
    """
    return folder / f"store-{VERSION if version is None else version}"


def version_in(folder: Path) -> int | None:
    """Return the version of the memory in a folder, without opening it; None for a folder without one.

    Parameters
    ----------
    folder
        Folder of the perceptual memory, which may be missing.

    Returns
    -------
    int or None
        Version of the newest store.

    Raises
    ------
    MemoryFormatError
        If the folder has other files, or the version is unknown.
    DamagedMemoryError
        If a closed store is missing.
    """
    if folder.is_symlink() and not folder.exists():
        raise MemoryFormatError(f"{folder} is a broken link; remove or repair it")
    if not folder.exists():
        return None
    if not folder.is_dir():
        raise MemoryFormatError(f"{folder} is a file: a memory is a folder; name another path")
    ours = {LOCK_FILE, TALLY, *(name + end for name in (SEAL, CALIBRATION, JOURNAL) for end in ("", ".new"))}
    names = {entry.name for entry in folder.iterdir()} - ours
    foreign = sorted(name for name in names if not _STORE.fullmatch(name))
    if foreign:
        raise MemoryFormatError(
            f"{folder} is not a perceptual memory: it has other files ({', '.join(foreign[:3])}); name another folder"
        )
    versions = [int(name.removeprefix("store-")) for name in names if not name.endswith(".new")]
    if not versions and (folder / SEAL).exists():
        raise DamagedMemoryError(
            f"the views at {folder} are lost: {SEAL} describes a store that is missing; restore the folder from a "
            "copy, or remove it to start over"
        )
    if not versions:
        return None
    version = max(versions)
    if version > VERSION:
        raise MemoryFormatError(
            f"the memory at {folder} was written by a newer version (format {version}, this program knows {VERSION}); "
            "upgrade deixis to open it"
        )
    if any(step not in MIGRATIONS for step in range(version, VERSION)):
        raise MemoryFormatError(f"the memory at {folder} has the unknown format version {version}")
    return version


def prepare(folder: Path) -> None:
    """Make a store if there is no store yet; otherwise check its seal and migrate it to this version.

    Parameters
    ----------
    folder
        Folder of the perceptual memory. Stores of other versions are removed from it.

    Raises
    ------
    MemoryFormatError
        If the version is unknown.
    DamagedMemoryError
        If the store has changed since it was closed.
    """
    version = version_in(folder)
    if version is None:
        _make(folder, VERSION, lambda new: None)
    else:
        _check_seal(folder, store(folder, version))
        for step in range(version, VERSION):
            old = plyvel.DB(str(store(folder, step)), paranoid_checks=True)
            try:
                _make(folder, step + 1, lambda new, old=old, step=step: MIGRATIONS[step](old, new))  # type: ignore[misc]
            finally:
                old.close()
    for other in folder.glob("store-*"):
        if other != store(folder):
            disk.remove(other)


def mirror(folder: Path, scratch: Path) -> None:
    """Fill an empty folder with a writable copy of a perceptual memory.

    Tables are linked, not copied, as LevelDB never changes a table.

    Parameters
    ----------
    folder
        Folder of the perceptual memory.
    scratch
        Empty folder.
    """
    for file in folder.iterdir():
        if file.is_dir():
            (scratch / file.name).mkdir()
            for part in file.iterdir():
                there = scratch / file.name / part.name
                if part.suffix == _TABLE:
                    there.symlink_to(part)
                elif part.is_file():
                    shutil.copyfile(part, there)
        elif file.name != LOCK_FILE:
            shutil.copyfile(file, scratch / file.name)


def _make(folder: Path, version: int, fill: Callable[[plyvel.DB], None]) -> None:
    """Make a store under a temporary name, and rename it when it is complete."""
    new = folder / f"store-{version}.new"
    disk.remove(new)
    db = plyvel.DB(str(new), create_if_missing=True, error_if_exists=True, compression=None, paranoid_checks=True)
    try:
        fill(db)
        db.write_batch(sync=True).write()
    finally:
        db.close()
    disk.rename(new, store(folder, version))


def write_seal(folder: Path) -> None:
    """Seal a closed database.

    Parameters
    ----------
    folder
        Folder of the perceptual memory. The seal has the names and checks of the store's files.
    """
    new = folder / (SEAL + ".new")
    with new.open("w", encoding="ascii") as out:
        out.write(json.dumps({"store": store(folder).name, "files": _files(store(folder))}, indent=1) + "\n")
        out.flush()
        os.fsync(out.fileno())
    disk.rename(new, folder / SEAL)


def _check_seal(folder: Path, store: Path) -> None:
    """Check the seal and remove it; raise DamagedMemoryError, and change nothing, where it does not match."""
    file = folder / SEAL
    if not file.exists():
        return
    restore, open_rest = "restore the folder from a copy", f"or delete {SEAL} to open what is left"
    try:
        seal = json.loads(file.read_text(encoding="ascii"))
        files, name = dict(seal["files"]), seal["store"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise DamagedMemoryError(
            f"the memory at {folder} is damaged: {SEAL} cannot be read; {restore}, {open_rest}"
        ) from error
    found = _files(store)
    wrong = sorted(name for name in {*files, *found} if files.get(name) != found.get(name))
    if wrong or name != store.name:
        # LevelDB drops broken entries of a log; where its other files are damaged, it does not open
        advice = f"{restore}, {open_rest}" if all(name.endswith(".log") for name in wrong) else restore
        raise DamagedMemoryError(
            f"the memory at {folder} is damaged: {store.name}/{[*wrong, SEAL][0]} has changed since it was closed; "
            f"{advice}"
        )
    file.unlink()


def _files(store: Path) -> dict[str, list[int]]:
    """Return the size of each file by its name, and the CRC-32 of all except tables."""
    looks = {}
    for file in sorted(store.iterdir()):
        if file.name not in _UNSEALED_FILES:
            size = file.stat().st_size
            looks[file.name] = [size] if file.suffix == _TABLE else [size, zlib.crc32(file.read_bytes())]
    return looks


class AcknowledgedCounts:
    """The file ``acknowledged``, open for writing.

    The counts of the database are also written here after each batch, before the write returns: 32 bytes into the file
    cache of the system, where they survive this process, though not the machine.
    """

    def __init__(self, folder: Path) -> None:
        self._descriptor = os.open(folder / TALLY, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        self.found = StoreCounts()  # zero where the file is new or damaged
        with contextlib.suppress(DamagedMemoryError):
            self.found = read_counts(os.pread(self._descriptor, 64, 0))

    def write(self, counts: bytes) -> None:
        """Write the counts.

        Parameters
        ----------
        counts
            Counts, as ``write_counts`` returns them.
        """
        os.pwrite(self._descriptor, counts, 0)

    def close(self) -> None:
        """Close the file."""
        with contextlib.suppress(OSError):
            os.close(self._descriptor)
