"""What a file holds, read in one piece and with bounds; every reader of clouds and meshes begins here."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import CloudError

MAX_BYTES = 2 * 2**30
"""The largest file that is read."""
MAX_LINE = 8192
"""The longest line of a header, comments included, in bytes."""
MAX_HEADER = 2**16
"""The longest header, in bytes."""


@dataclass(frozen=True, eq=False)
class Content:
    """A file's bytes and the name by which errors call it."""

    name: str
    data: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.data)

    def line_of(self, at: int) -> int:
        """Return the number, from 1, of the line in which byte ``at`` stands."""
        return int(np.count_nonzero(self.data[:at] == ord("\n"))) + 1

    def header_lines(self) -> Iterator[tuple[int, str, int]]:
        """Yield lines of a header: number from 1, text without blanks around it, where the next line begins.

        Raises CloudError at a line or a header too long to be one, and where the file ends before the caller does.
        """
        at = number = 0
        while True:
            number += 1
            if at >= len(self.data):
                raise CloudError(f"{self.name}:{number}: the file ends within its header; get the whole file")
            line, newline, _ = self.data[at : at + MAX_LINE].tobytes().partition(b"\n")
            if len(line) == MAX_LINE:
                raise CloudError(
                    f"{self.name}:{number}: a header line or comment of more than {MAX_LINE} bytes; shorten it"
                )
            at += len(line) + len(newline)
            if at > MAX_HEADER:
                raise CloudError(f"{self.name}:{number}: more than {MAX_HEADER} bytes of header; shorten its comments")
            yield number, line.decode("latin-1").strip(), at

    def refuse_rest(self, at: int) -> None:
        """Raise CloudError where more than padding, that is zeros or blanks, stands from byte ``at`` on.

        PCL fills binary files up to a whole page with zeros.
        """
        more = len(self.data[at:].tobytes().lstrip(b"\0 \t\r\n\v\f"))
        if more:
            raise CloudError(
                f"{self.name}: byte {len(self) - more}: data after all that the header declares; correct its counts"
            )


def content_of(path: str | Path) -> Content:
    """Read a file; raise CloudError where that cannot be done, or where it is no regular file or too large."""
    name = str(path)
    try:
        with open(path, "rb", opener=_without_waiting) as file:
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise CloudError(f"{name}: this is no regular file; give a point cloud or mesh file")
            if status.st_size > MAX_BYTES:
                raise CloudError(f"{name}: the file is larger than {MAX_BYTES // 2**20} MiB; split or thin it")
            return Content(name, np.frombuffer(file.read(status.st_size), np.uint8))
    except IsADirectoryError:
        raise CloudError(f"{name}: this is a folder; give a point cloud or mesh file") from None
    except OSError as error:
        raise CloudError(f"{name}: cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise error if isinstance(error, CloudError) else CloudError(f"{name!r}: cannot be read: {error}") from error


def _without_waiting(path: str, flags: int) -> int:
    """Open without waiting for somebody to write to a pipe."""
    return os.open(path, flags | os.O_NONBLOCK)
