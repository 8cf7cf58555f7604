"""Files and folders that are renamed and removed so that a crash leaves one state or the other."""

from __future__ import annotations

import os
import shutil
from pathlib import Path


def rename(old: Path, new: Path) -> None:
    """Gives a file or folder another name, safely on the disk."""
    os.replace(old, new)
    descriptor = os.open(new.parent, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def remove(path: Path) -> None:
    """Removes a folder with all in it, where there is one."""
    if path.is_dir():
        shutil.rmtree(path)
