"""Bytes of a file, read in one piece and with bounds; every reader of clouds and meshes starts from them."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import CloudError
from deixis.text_files import no_such_file

MAX_BYTES = 2 * 2**30
"""Size of the largest file that is read, in bytes."""
MAX_LINE = 8192
"""Length of the longest line of a header, comments included, in bytes."""
MAX_HEADER = 2**16
"""Length of the longest header, in bytes."""


@dataclass(frozen=True, eq=False)
class Content:
    """Bytes of a file, and its name for error messages."""

    name: str
    data: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.data)

    def line_of(self, at: int) -> int:
        """Return the number of the line that contains a byte.

        Parameters
        ----------
        at
            Position of the byte.

        Returns
        -------
        int
            The number of the line, from 1.
        """
        return int(np.count_nonzero(self.data[:at] == ord("\n"))) + 1

    def header_lines(self) -> Iterator[tuple[int, str, int]]:
        """Yield the lines of a header.

        Yields
        ------
        tuple
            Number of the line, its stripped text, and its end in bytes.

        Raises
        ------
        CloudError
            If a line or the header is too long, or if the file ends before the caller stops.
        """
        if not len(self.data):
            raise CloudError(f"{self.name}: the file is empty; get it again")
        at = number = 0
        while True:
            number += 1
            if at >= len(self.data):
                raise CloudError(f"{self.name}:{number}: the file ends within its header; get the whole file")
            line, newline, _ = self.data[at : at + MAX_LINE].tobytes().partition(b"\n")
            if len(line) == MAX_LINE:
                raise CloudError(
                    f"{self.name}:{number}: a header line must have at most {MAX_LINE} bytes, got more; shorten it"
                )
            at += len(line) + len(newline)
            if at > MAX_HEADER:
                raise CloudError(
                    f"{self.name}:{number}: a header must have at most {MAX_HEADER} bytes, got more; shorten it"
                )
            yield number, line.decode("latin-1").strip(), at

    def refuse_rest(self, at: int) -> None:
        """Raise CloudError if anything but padding (zeros or white space) follows.

        PCL pads binary files with zeros to a whole page.

        Parameters
        ----------
        at
            Byte at which the padding may begin.

        Raises
        ------
        CloudError
            If anything else follows.
        """
        more = len(self.data[at:].tobytes().lstrip(b"\0 \t\r\n\v\f"))
        if more:
            raise CloudError(
                f"{self.name}: byte {len(self) - more}: more data than the header declares; correct its counts"
            )


def content_of(path: str | Path) -> Content:
    """Read a file.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Content
        Its bytes and its name.

    Raises
    ------
    CloudError
        If the file cannot be read, is not a regular file or is too large.
    """
    name = str(path)
    try:
        with open(path, "rb", opener=_without_waiting) as file:  # Path.open takes no opener
            status = os.fstat(file.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise CloudError(f"{name}: not a regular file; give a point cloud or mesh file")
            if status.st_size > MAX_BYTES:
                raise CloudError(f"{name}: the file is larger than {MAX_BYTES // 2**20} MiB; split or subsample it")
            return Content(name, np.frombuffer(file.read(status.st_size), np.uint8))
    except IsADirectoryError:
        raise CloudError(f"{name}: this is a folder; give a point cloud or mesh file") from None
    except FileNotFoundError:
        raise CloudError(no_such_file(path)) from None
    except OSError as error:
        raise CloudError(f"{name}: cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise error if isinstance(error, CloudError) else CloudError(f"{name!r}: cannot be read: {error}") from error


def _without_waiting(path: str, flags: int) -> int:
    """Open a file without blocking, even if it is a pipe that no program writes to."""
    return os.open(path, flags | os.O_NONBLOCK)
