"""Tables of numbers in text, as ascii clouds have them; errors name the line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.checks import shown
from deixis.perception.clouds.content import Content
from deixis.perception.errors import CloudError

MAX_DIGITS = 1000
"""The longest number, in characters."""

_ROOM, _CHUNK = 1024, 2**14


@dataclass(frozen=True, eq=False)
class TextTable:
    """What was read: the wanted columns (rows, wanted), the wanted list's lengths (rows,) and values, and the end."""

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
    """Read ``rows`` lines of ``width`` columns from byte ``at`` on, of which ``lists`` are lists, their length first.

    None for ``rows`` stands for all there are, in a file that declares nothing: as wide as the first. Raises
    CloudError, before anything is allocated, where the file is too short for so many values; and at a line with too few
    or too many, or with something that is no number.
    """
    from deixis.perception.clouds.table_kernels import DONE, KEPT, LISTED, SKIPPED, count_rows, parse_rows

    room = (len(content) - at + 1) // 2  # a value is a digit and a blank
    declared = rows is not None
    if rows is None:
        rows = min(count_rows(content.data, at), room // width + 1)  # for more, one of these is too short
    elif rows * width > room:
        raise CloudError(
            f"{content.name}:{content.line_of(at)}: {rows} rows of {width} values are declared, and the file has room"
            f" for {room} values; correct the count, or get the whole file"
        )
    roles = np.full(width, SKIPPED, np.int64)
    roles[list(wanted)] = np.arange(len(wanted))
    roles[list(lists)] = LISTED
    if kept >= 0:
        roles[kept] = KEPT
    out = np.empty((len(wanted), rows)).T  # columns are what is looked at next
    lengths = np.zeros(rows if kept >= 0 else 0, np.int64)
    many, filled = _ROOM, 4 * len(lengths)
    again = True
    while again:  # once, or a second time with as much room as the first found to be needed
        inexact, values = np.empty((many, 4), np.int64), np.empty(filled)
        status, end, row, column, many, filled = parse_rows(content.data, at, roles, out, inexact, lengths, values)
        if status != DONE:
            raise _error(content, status, end, row, rows, column, width, declared)
        again = many > len(inexact) or filled > len(values)
    _settle(content, out, inexact[:many])
    return TextTable(out, lengths, values[:filled], end)


def _settle(content: Content, out: NDArray[np.float64], inexact: NDArray[np.int64]) -> None:
    """Put the correctly rounded values where the kernel had none: ``inexact`` (k, 4) row, column, begin, end."""
    if not len(inexact):
        return
    longest = int(np.argmax(inexact[:, 3] - inexact[:, 2]))
    begin, end = inexact[longest, 2:].tolist()
    if end - begin > MAX_DIGITS:
        raise CloudError(f"{content.name}:{content.line_of(begin)}: a number of {end - begin} characters; shorten it")
    raw = content.data.data
    for some in np.split(inexact, range(_CHUNK, len(inexact), _CHUNK)):
        out[some[:, 0], some[:, 1]] = [float(bytes(raw[begin:end])) for begin, end in some[:, 2:].tolist()]


def _error(
    content: Content, status: int, at: int, row: int, rows: int, column: int, width: int, declared: bool
) -> CloudError:
    """Return what a kernel found, in words."""
    from deixis.perception.clouds.table_kernels import BAD_LENGTH, TOO_FEW, TOO_MANY

    where = f"{content.name}:{content.line_of(at)}"
    values = f"{width} values {'declared' if declared else 'of the first line'}"
    if status == TOO_FEW and not content.data[at:].size and not column:
        return CloudError(f"{where}: the file ends after {row} of {rows} rows; get the whole file")
    if status == TOO_FEW:
        return CloudError(f"{where}: this line has {column} of the {values}; add what is missing")
    if status == TOO_MANY:
        return CloudError(f"{where}: this line has more than the {values}; take the others out")
    if status == BAD_LENGTH:
        return CloudError(f"{where}: the length of a list is a whole number of 0 or more that fits; correct it")
    word = content.data[at : at + 64].tobytes().split(maxsplit=1)[0].decode("latin-1")
    return CloudError(f"{where}: '{shown(word)}' is no number; put one there, or nan where there is none")
