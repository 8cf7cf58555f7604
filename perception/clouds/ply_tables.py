"""The elements of a PLY file, in text or binary: wanted columns as arrays, all else passed over but checked for length.

Each reader takes the wanted property names, and gives the columns (rows,), the one wanted list as its lengths (rows,)
and values one after the other, and the byte at which the next element begins.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from deixis.perception.checks import shown
from deixis.perception.clouds.columns import declared
from deixis.perception.clouds.content import Content
from deixis.perception.clouds.number_table import read_table
from deixis.perception.clouds.ply_header import Element
from deixis.perception.errors import CloudError


@dataclass(frozen=True, eq=False)
class Table:
    """What was read of one element, and ``end``, where the next begins."""

    end: int
    columns: dict[str, NDArray[np.generic]] = field(default_factory=dict)
    lengths: NDArray[np.int64] | None = None
    values: NDArray[np.number] | None = None


def text_table(content: Content, at: int, element: Element, wanted: Set[str]) -> Table:
    """An element in ascii, one row a line; raises CloudError, with the line, where it is malformed."""
    properties = list(enumerate(element.properties))
    lists = [place for place, column in properties if column.length is not None]
    kept = next((place for place in lists if element.properties[place].name in wanted), -1)
    scalars = [place for place, column in properties if column.length is None and column.name in wanted]
    read = read_table(content, at, element.rows, len(properties), scalars, lists, kept)
    columns = {}
    for slot, place in enumerate(scalars):
        column = element.properties[place]
        columns[column.name] = declared(read.columns[:, slot], column.dtype, column.name, content.name)
    return Table(read.end, columns, *((read.lengths, read.values) if kept >= 0 else ()))


def binary_table(content: Content, at: int, element: Element, wanted: Set[str]) -> Table:
    """An element in binary; raises CloudError, with the byte, where the file is too short for it."""
    least = element.rows * sum(column.least_bytes for column in element.properties)
    if at + least > len(content):
        raise _too_short(content, at, element, least)
    if element.has_lists:
        return _binary_lists(content, at, element, wanted)
    layout = np.dtype([(f"{place}", column.dtype) for place, column in enumerate(element.properties)])
    rows = content.data[at : at + least].view(layout) if least else np.empty(element.rows, layout)
    names = [column.name for column in element.properties]
    return Table(at + least, {name: rows[f"{place}"] for place, name in enumerate(names) if name in wanted})


def _binary_lists(content: Content, at: int, element: Element, wanted: Set[str]) -> Table:
    from deixis.perception.clouds import list_kernels as kernels

    properties = element.properties
    chosen = [place for place, column in enumerate(properties) if column.name in wanted]
    slots = np.full(len(properties), kernels.SKIPPED, np.int64)
    slots[chosen] = np.arange(len(chosen))
    starts, lengths = np.empty((2, element.rows, len(chosen)), np.int64)
    status, at, row = kernels.walk(
        content.data,
        at,
        np.array([column.dtype.itemsize for column in properties]),
        np.array([0 if column.length is None else column.length.itemsize for column in properties]),
        np.array([column.length is not None and column.length.kind == "i" for column in properties]),
        any((column.length or column.dtype).str[0] == ">" for column in properties),
        slots,
        starts,
        lengths,
    )
    if status == kernels.NEGATIVE:
        raise CloudError(f"{content.name}: byte {at}: {element.name} {row} has a list of negative length; correct it")
    if status == kernels.TOO_SHORT:
        raise _too_short(content, at, element, 0, row)
    table = Table(at)
    for slot, place in enumerate(chosen):
        column = properties[place]
        values = _gathered(content.data, starts[:, slot], lengths[:, slot], column.dtype)
        if column.length is None:
            table.columns[column.name] = values
        else:
            table = Table(at, table.columns, lengths[:, slot], values)
    return table


def _gathered(
    data: NDArray[np.uint8], starts: NDArray[np.int64], lengths: NDArray[np.int64], dtype: np.dtype[np.generic]
) -> NDArray[np.number]:
    """The values of all lists, one after the other, each list at its own place in the bytes."""
    size = dtype.itemsize
    before = np.cumsum(lengths) - lengths
    at = np.repeat(starts - before * size, lengths) + np.arange(lengths.sum()) * size
    values: NDArray[np.number] = data[at[:, None] + np.arange(size)].view(dtype)[:, 0]
    return values


def _too_short(content: Content, at: int, element: Element, least: int, row: int = 0) -> CloudError:
    what = f"row {row} of" if row or not least else f"{least} bytes at the least are declared for"
    return CloudError(
        f"{content.name}: byte {at}: the file ends within element '{shown(element.name)}' ({what} its {element.rows}"
        f" rows), {len(content) - at} bytes on; correct the count, or get the whole file"
    )
