"""Read tables of numbers from text, as in ascii clouds; errors name the line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.checks import shown
from deixis.perception.clouds.content import Content
from deixis.perception.errors import CloudError

MAX_DIGITS = 1000
"""Length of the longest number, in characters."""

_ROOM, _CHUNK = 1024, 2**14


@dataclass(frozen=True, eq=False)
class TextTable:
    """Result of reading a table.

    ``columns`` has shape (rows, wanted). ``lengths``, of shape (rows,), and ``values`` belong to the wanted list, whose
    values are concatenated. ``end`` is the byte after the table.
    """

    columns: NDArray[np.float64]
    lengths: NDArray[np.int64]
    values: NDArray[np.float64]
    end: int


def read_table(
    content: Content,
    at: int,
    rows: int | None,
    width: int,
    wanted: Sequence[int],
    lists: Sequence[int] = (),
    kept: int = -1,
) -> TextTable:
    """Read a table of numbers from the text that starts at byte ``at``.

    Parameters
    ----------
    content
        Bytes of the file.
    at
        Byte at which the table begins.
    rows
        Number of lines that the file declares, or None to read all lines to the end.
    width
        Number of columns; a list counts as one.
    wanted
        Columns of single numbers to return.
    lists
        Columns that hold lists, each preceded by its length.
    kept
        The one of ``lists`` whose values are returned, or -1.

    Returns
    -------
    TextTable
        The columns and the kept lists.

    Raises
    ------
    CloudError
        If the file is too short for that many values (before anything is allocated), a line has too few or too many
        values, or a value is not a number.
    """
    from deixis.perception.clouds.tables.table_kernels import DONE, KEPT, LISTED, SKIPPED, count_rows, parse_rows

    room = (len(content) - at + 1) // 2  # a value takes at least a digit and a blank
    declared = rows is not None
    if rows is None:
        rows = min(count_rows(content.data, at), room // width + 1)  # a file with more rows has one that is too short
    elif rows * width > room:
        raise CloudError(
            f"{content.name}:{content.line_of(at)}: the header declares {rows} rows of {width} values, but the file has"
            f" room for {room} values; correct the count, or get the whole file"
        )
    roles = np.full(width, SKIPPED, np.int64)
    roles[list(wanted)] = np.arange(len(wanted))
    roles[list(lists)] = LISTED
    if kept >= 0:
        roles[kept] = KEPT
    out = np.empty((len(wanted), rows)).T  # column-major, because callers read it by columns
    lengths = np.zeros(rows if kept >= 0 else 0, np.int64)
    many, filled = _ROOM, 4 * len(lengths)
    again = True
    while again:  # a second pass runs if the first one finds that it needs more room
        inexact, values = np.empty((many, 4), np.int64), np.empty(filled)
        status, end, row, column, many, filled = parse_rows(content.data, at, roles, out, inexact, lengths, values)
        if status != DONE:
            raise _error(content, status, end, row, rows, column, width, declared)
        again = many > len(inexact) or filled > len(values)
    _settle(content, out, inexact[:many])
    return TextTable(out, lengths, values[:filled], end)


def _settle(content: Content, out: NDArray[np.float64], inexact: NDArray[np.int64]) -> None:
    """Fill in the values that the kernel could not round, given by ``inexact`` (k, 4): row, column, begin, end."""
    if not len(inexact):
        return
    longest = int(np.argmax(inexact[:, 3] - inexact[:, 2]))
    begin, end = inexact[longest, 2:].tolist()
    if end - begin > MAX_DIGITS:
        raise CloudError(
            f"{content.name}:{content.line_of(begin)}: a number must have at most {MAX_DIGITS} characters, got"
            f" {end - begin}; shorten it"
        )
    raw = content.data.data
    for some in np.split(inexact, range(_CHUNK, len(inexact), _CHUNK)):
        out[some[:, 0], some[:, 1]] = [float(bytes(raw[begin:end])) for begin, end in some[:, 2:].tolist()]


def _error(
    content: Content, status: int, at: int, row: int, rows: int, column: int, width: int, declared: bool
) -> CloudError:
    """Return the error for a status of the kernel."""
    from deixis.perception.clouds.tables.table_kernels import BAD_LENGTH, TOO_FEW, TOO_MANY

    where = f"{content.name}:{content.line_of(at)}"
    values = f"{width} values {'that the header declares' if declared else 'of the first line'}"
    if status == TOO_FEW and not content.data[at:].size and not column:
        return CloudError(f"{where}: the file ends after {row} of {rows} rows; get the whole file")
    if status == TOO_FEW:
        return CloudError(f"{where}: this line has {column} of the {values}; add the others")
    if status == TOO_MANY:
        return CloudError(f"{where}: this line has more than the {values}; take the extra ones out")
    if status == BAD_LENGTH:
        return CloudError(f"{where}: the length of a list must be a whole number that fits the file; correct it")
    word = content.data[at : at + 64].tobytes().split(maxsplit=1)[0].decode("latin-1")
    return CloudError(f"{where}: expected a number, got '{shown(word)}'; correct it, or write nan for a missing value")
