"""The folder of a perceptual memory: what lies in it, which version that is, and bringing older ones up to date.

``store-2/`` is a LevelDB of version 2, and the name is what says so. A new store is made as ``store-3.new/`` and
renamed when it is whole, so that a crash at any moment leaves one whole store with the greatest number. Beside it lie
``owner.lock``, ``calibration.json`` (see :mod:`deixis.memory.perceptual.calibrated`), ``journal`` while a write over
both stores is under way (see :mod:`deixis.memory.journal`), and two files that show what LevelDB leaves out in silence:

- ``acknowledged`` holds the counts of the last batch. A database that finds the end of its log broken takes it for a
  write that was under way, and forgets it.
- ``seal.json`` is there while nobody has the memory open, if it was closed in good order. LevelDB mends what it finds
  broken in its log and manifest by leaving it out, and deletes files that the manifest does not name. The seal has size
  and CRC-32 of the small files, and the sizes of the tables, whose content is checked when it is read. After a crash
  there is none: then mending is what is wanted.

To change how things are kept: raise :data:`VERSION`, and add the step from the version before to
:data:`deixis.memory.perceptual.migrations.MIGRATIONS`. A step reads the old database and fills a new one.
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
from deixis.memory.perceptual.codec import StoreCounts, read_counts
from deixis.memory.perceptual.migrations import MIGRATIONS

FOLDER = "perceptual"
"""Where a perceptual memory lies in the folder of a memory."""

VERSION = 2
"""The version of the database that this program reads and writes."""

TALLY, SEAL, CALIBRATION = "acknowledged", "seal.json", "calibration.json"
_STORE = re.compile(r"store-(\d+)(\.new)?")
_UNSEALED_FILES = {"LOCK", "LOG", "LOG.old"}
_TABLE = ".ldb"


def store(folder: Path, version: int | None = None) -> Path:
    """Return where the database of a version is; of this program's version unless said otherwise."""
    return folder / f"store-{VERSION if version is None else version}"


def version_in(folder: Path) -> int | None:
    """Return the version of what is in a folder, by looking only; None where there is no memory yet.

    Raises MemoryFormatError for a folder of other things, and for a version that this program does not know;
    DamagedMemoryError where a store was closed and is not there.
    """
    if folder.is_symlink() and not folder.exists():
        raise MemoryFormatError(f"{folder} is a link that leads nowhere; remove it or mend it")
    if not folder.exists():
        return None
    if not folder.is_dir():
        raise MemoryFormatError(f"{folder} is a file: a memory is a folder; name another path")
    ours = {LOCK_FILE, TALLY, *(name + end for name in (SEAL, CALIBRATION, JOURNAL) for end in ("", ".new"))}
    names = set(os.listdir(folder)) - ours
    foreign = sorted(name for name in names if not _STORE.fullmatch(name))
    if foreign:
        raise MemoryFormatError(
            f"{folder} is no perceptual memory: it holds other things ({', '.join(foreign[:3])}); name another folder"
        )
    versions = [int(name.removeprefix("store-")) for name in names if not name.endswith(".new")]
    if not versions and (folder / SEAL).exists():
        raise DamagedMemoryError(
            f"the views at {folder} are gone: {SEAL} says what the store held, and there is none; restore the folder "
            "from a copy, or remove it to begin anew"
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
    """Make a store where there is none, else check its seal and bring it up to date."""
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
    """Fill an empty folder with a copy of a perceptual memory that may be written, without copying its tables.

    They are linked, as LevelDB never changes a table.
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
    """Make a store beside what is there, and give it its name when it is whole."""
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
    """Seal a closed database."""
    new = folder / (SEAL + ".new")
    with new.open("w", encoding="ascii") as out:
        out.write(json.dumps({"store": store(folder).name, "files": _files(store(folder))}, indent=1) + "\n")
        out.flush()
        os.fsync(out.fileno())
    disk.rename(new, folder / SEAL)


def _check_seal(folder: Path, store: Path) -> None:
    """Break the seal where there is one; raise DamagedMemoryError, and leave all as it is, where it does not fit."""
    file = folder / SEAL
    if not file.exists():
        return
    restore, open_rest = "restore the folder from a copy", f"or delete {SEAL} to open what is left"
    try:
        said = json.loads(file.read_text(encoding="ascii"))
        files, name = dict(said["files"]), said["store"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise DamagedMemoryError(
            f"the memory at {folder} is damaged: {SEAL} cannot be read; {restore}, {open_rest}"
        ) from error
    found = _files(store)
    wrong = sorted(name for name in {*files, *found} if files.get(name) != found.get(name))
    if wrong or name != store.name:
        # LevelDB leaves out what is broken of a log; where others of its files are not as they were, it opens nothing
        advice = f"{restore}, {open_rest}" if all(name.endswith(".log") for name in wrong) else restore
        raise DamagedMemoryError(
            f"the memory at {folder} is damaged: {store.name}/{[*wrong, SEAL][0]} is not as it was when it was closed; "
            f"{advice}"
        )
    file.unlink()


def _files(store: Path) -> dict[str, list[int]]:
    """Return the size of each file by its name, and the CRC-32 of all but tables."""
    looks = {}
    for file in sorted(store.iterdir()):
        if file.name not in _UNSEALED_FILES:
            size = file.stat().st_size
            looks[file.name] = [size] if file.suffix == _TABLE else [size, zlib.crc32(file.read_bytes())]
    return looks


class AcknowledgedCounts:
    """The file ``acknowledged``, open for writing.

    The counts, as the database has them too, are written here after each batch, before its writer is told that it is
    done: 32 bytes into the cache of the system, where they outlive this process, though not the machine.
    """

    def __init__(self, folder: Path) -> None:
        self._descriptor = os.open(folder / TALLY, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        self.found = StoreCounts()  # promises nothing, where the file is new or not what was written
        with contextlib.suppress(DamagedMemoryError):
            self.found = read_counts(os.pread(self._descriptor, 64, 0))

    def write(self, counts: bytes) -> None:
        """Write the counts, as ``write_counts`` gives them."""
        os.pwrite(self._descriptor, counts, 0)

    def close(self) -> None:
        """Close the file."""
        with contextlib.suppress(OSError):
            os.close(self._descriptor)
