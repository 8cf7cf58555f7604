"""What the files of a closed database look like, so that what happens to them until it is opened is noticed.

LevelDB mends what it finds broken in its log and manifest by leaving it out, and deletes files that the manifest does
not name. A memory that was closed in good order therefore leaves a seal: size and CRC-32 of the small files, sizes of
the tables, whose content is checked when it is read. After a crash there is none: then mending is what is wanted.
"""

from __future__ import annotations

import json
import os
import zlib
from pathlib import Path

from deixis.memory.errors import DamagedMemoryError
from deixis.memory.owner import rename
from deixis.memory.perceptual.layout import SEAL

_IGNORED = {"LOCK", "LOG", "LOG.old"}
_TABLE = ".ldb"


def write_seal(folder: Path, store: Path) -> None:
    """Seals a closed database."""
    new = folder / (SEAL + ".new")
    with new.open("w", encoding="ascii") as out:
        out.write(json.dumps({"store": store.name, "files": _files(store)}, indent=1) + "\n")
        out.flush()
        os.fsync(out.fileno())
    rename(new, folder / SEAL)


def check_seal(folder: Path, store: Path) -> None:
    """Breaks the seal where there is one; raises DamagedMemoryError, and leaves all as it is, where it does not fit."""
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
    """By name: size, and CRC-32 but of tables."""
    return {file.name: _look(file) for file in sorted(store.iterdir()) if file.name not in _IGNORED}


def _look(file: Path) -> list[int]:
    size = file.stat().st_size
    return [size] if file.suffix == _TABLE else [size, zlib.crc32(file.read_bytes())]
