"""Named arrays as bytes in the safetensors format, fast for many values of one layout.

A file of that format is a header, which gives names, types, shapes and places, and then the arrays. The header of a
layout is made, or read, by the library once, and found again by a look-up.

>>> packed = b"".join(pack({"a": np.zeros((2, 3), np.float32)}))
>>> unpack(memoryview(packed))[0]["a"].shape
(2, 3)
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

_NOTE = "deixis"
TYPES = {
    "BOOL": np.dtype("bool"), "F16": np.dtype("<f2"), "F32": np.dtype("<f4"), "F64": np.dtype("<f8"),
    "I8": np.dtype("i1"), "I16": np.dtype("<i2"), "I32": np.dtype("<i4"), "I64": np.dtype("<i8"),
    "U8": np.dtype("u1"), "U16": np.dtype("<u2"), "U32": np.dtype("<u4"), "U64": np.dtype("<u8"),
}  # fmt: skip
"""The types of numbers, by their names in the format."""


class _Part(NamedTuple):
    name: str
    dtype: np.dtype[Any]
    shape: tuple[int, ...]
    offset: int  # from the beginning of the header


class _Layout(NamedTuple):
    header: bytes
    parts: tuple[_Part, ...]  # in the order in which they lie
    end: int
    note: str


def pack(arrays: Mapping[str, NDArray[Any]], note: str = "") -> list[bytes | memoryview]:
    """The pieces of a safetensors file: joined, they are it. ``note`` is a text kept in its header."""
    layout = _layout_of(tuple([(name, array.dtype, array.shape) for name, array in arrays.items()]), note)
    return [layout.header, *[arrays[part.name].data for part in layout.parts]]


def lay_out(arrays: Mapping[str, NDArray[Any]], spare: int) -> tuple[bytearray, dict[str, NDArray[Any]]]:
    """A safetensors file of copies of arrays, with spare bytes at its end; and the copies, which cannot be written."""
    layout = _layout_of(tuple([(name, array.dtype, array.shape) for name, array in arrays.items()]), "")
    data = bytearray(layout.end + spare)
    data[: len(layout.header)] = layout.header
    copies = {}
    for part in layout.parts:
        copy = np.ndarray(part.shape, part.dtype, data, part.offset)
        copy[...] = arrays[part.name]
        copy.flags.writeable = False
        copies[part.name] = copy
    return data, copies


def unpack(data: bytes | memoryview) -> tuple[dict[str, NDArray[Any]], str]:
    """The arrays, which lie in the data itself and cannot be written, and the note; whatever comes after is not read.

    For data that is known to be whole; raises ValueError, at least, for other data.
    """
    layout = _layout_in(bytes(data[: 8 + int.from_bytes(data[:8], "little")]))
    return {name: np.ndarray(shape, dtype, data, offset) for name, dtype, shape, offset in layout.parts}, layout.note


@lru_cache(256)
def _layout_of(named: tuple[tuple[str, np.dtype[Any], tuple[int, ...]], ...], note: str) -> _Layout:
    from safetensors.numpy import save

    example = {name: np.zeros(shape, dtype) for name, dtype, shape in named}
    data = save(example, {_NOTE: note} if note else None)
    return _layout_in(data[: 8 + int.from_bytes(data[:8], "little")])


@lru_cache(256)
def _layout_in(header: bytes) -> _Layout:
    said = json.loads(header[8:])
    note = said.pop("__metadata__", {}).get(_NOTE, "")
    parts, end = [], len(header)
    for name, entry in sorted(said.items(), key=lambda item: item[1]["data_offsets"]):
        offset, end = (len(header) + place for place in entry["data_offsets"])
        parts.append(_Part(name, TYPES[entry["dtype"]], tuple(entry["shape"]), offset))
    return _Layout(header, tuple(parts), end, note)
