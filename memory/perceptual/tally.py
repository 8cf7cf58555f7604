"""How many batches were acknowledged, kept beside the database, so that losing the last ones is noticed.

A database that finds the end of its log broken takes it for a write that was under way, and forgets it in silence. The
number here is written after each batch, before its writer is told that it is done: 30 bytes into the cache of the
system, where they outlive this process, though not the machine.
"""

from __future__ import annotations

import contextlib
import os
import zlib
from pathlib import Path

from deixis.memory.perceptual.layout import TALLY


class Tally:
    """The file ``acknowledged``, open for writing."""

    def __init__(self, folder: Path) -> None:
        self._descriptor = os.open(folder / TALLY, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        self.found = _parsed(os.pread(self._descriptor, 64, 0))

    def write(self, batches: int) -> None:
        """Says that so many batches are there."""
        number = b"%020d" % batches
        os.pwrite(self._descriptor, b"%b %08x\n" % (number, zlib.crc32(number)), 0)

    def close(self) -> None:
        """Lets go of the file."""
        with contextlib.suppress(OSError):
            os.close(self._descriptor)


def _parsed(content: bytes) -> int:
    """The number; 0, which promises nothing, where the file is new or not what was written."""
    number = content[:20]
    whole = content == b"%b %08x\n" % (number, zlib.crc32(number)) and number.isdigit()
    return int(number) if whole else 0
