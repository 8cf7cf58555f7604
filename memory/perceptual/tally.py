"""How many batches were acknowledged, kept beside the database, so that losing the last ones is noticed.

A database that finds the end of its log broken takes it for a write that was under way, and forgets it in silence. The
counts, as the database has them too, are written here after each batch, before its writer is told that it is done: 28
bytes into the cache of the system, where they outlive this process, though not the machine.
"""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from deixis.memory.errors import DamagedMemoryError
from deixis.memory.perceptual.codec import Counts, read_counts
from deixis.memory.perceptual.layout import TALLY


class Tally:
    """The file ``acknowledged``, open for writing."""

    def __init__(self, folder: Path) -> None:
        self._descriptor = os.open(folder / TALLY, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        self.found = _parsed(os.pread(self._descriptor, 64, 0))

    def write(self, counts: bytes) -> None:
        """Says how many batches are there, in what ``write_counts`` gives."""
        os.pwrite(self._descriptor, counts, 0)

    def close(self) -> None:
        """Lets go of the file."""
        with contextlib.suppress(OSError):
            os.close(self._descriptor)


def _parsed(content: bytes) -> Counts:
    """The counts; none, which promises nothing, where the file is new or not what was written."""
    try:
        return read_counts(content)
    except DamagedMemoryError:
        return Counts()
