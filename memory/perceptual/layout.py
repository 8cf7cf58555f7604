"""The folder of a perceptual memory: what lies in it, which version that is, and bringing older ones up to date.

``store-1/`` is a LevelDB of version 1, and the name is what says so. A new store is made as ``store-2.new/`` and
renamed when it is whole, so that a crash at any moment leaves one whole store with the greatest number. Beside it lie
``owner.lock``, ``acknowledged`` (see :mod:`deixis.memory.perceptual.tally`), ``calibration.json`` (see
:mod:`deixis.memory.perceptual.calibrated`) and, while nobody has the memory open, ``seal.json`` (see
:mod:`deixis.memory.perceptual.seal`).

To change how things are kept: raise :data:`VERSION`, and add the step from the version before to :data:`MIGRATIONS`. A
step reads the old database and fills a new one.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

import plyvel

from deixis.memory import owner as disk
from deixis.memory.errors import DamagedMemoryError, MemoryFormatError
from deixis.memory.owner import LOCK_FILE

FOLDER = "perceptual"
"""Where a perceptual memory lies in the folder of a memory."""

VERSION = 1
MIGRATIONS: dict[int, Callable[[plyvel.DB, plyvel.DB], None]] = {}
"""From a version to the step that leads to the next."""

TALLY, SEAL, CALIBRATION = "acknowledged", "seal.json", "calibration.json"
_STORE = re.compile(r"store-(\d+)(\.new)?")


def store(folder: Path, version: int | None = None) -> Path:
    """Where the database of a version is; of this program's, unless said otherwise."""
    return folder / f"store-{VERSION if version is None else version}"


def version_in(folder: Path) -> int | None:
    """The version of what is in a folder, by looking only; None where there is no memory yet.

    Raises MemoryFormatError for a folder of other things, and for a version that this program does not know;
    DamagedMemoryError where a store was closed and is not there.
    """
    if folder.is_symlink() and not folder.exists():
        raise MemoryFormatError(f"{folder} is a link that leads nowhere; remove it or mend it")
    if not folder.exists():
        return None
    if not folder.is_dir():
        raise MemoryFormatError(f"{folder} is a file: a memory is a folder; name another path")
    ours = {LOCK_FILE, TALLY, *(name + end for name in (SEAL, CALIBRATION) for end in ("", ".new"))}
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
    return _known(folder, max(versions)) if versions else None


def _known(folder: Path, version: int) -> int:
    if version > VERSION:
        raise MemoryFormatError(
            f"the memory at {folder} was written by a newer version (format {version}, this program knows {VERSION}); "
            "upgrade deixis to open it"
        )
    if any(step not in MIGRATIONS for step in range(version, VERSION)):
        raise MemoryFormatError(f"the memory at {folder} has the unknown format version {version}")
    return version


def prepare(folder: Path, check: Callable[[Path, Path], None]) -> None:
    """Makes a store where there is none, and brings an older one up to date, after ``check`` of folder and store."""
    version = version_in(folder)
    if version is None:
        _make(folder, VERSION, lambda new: None)
    else:
        check(folder, store(folder, version))
        for step in range(version, VERSION):
            old = plyvel.DB(str(store(folder, step)), paranoid_checks=True)
            try:
                _make(folder, step + 1, lambda new, old=old, step=step: MIGRATIONS[step](old, new))  # type: ignore[misc]
            finally:
                old.close()
    for other in folder.glob("store-*"):
        if other != store(folder):
            disk.remove(other)


def _make(folder: Path, version: int, fill: Callable[[plyvel.DB], None]) -> None:
    """Makes a store beside what is there, and gives it its name when it is whole."""
    new = folder / f"store-{version}.new"
    disk.remove(new)
    db = plyvel.DB(str(new), create_if_missing=True, error_if_exists=True, compression=None, paranoid_checks=True)
    try:
        fill(db)
        db.write_batch(sync=True).write()
    finally:
        db.close()
    disk.rename(new, store(folder, version))
