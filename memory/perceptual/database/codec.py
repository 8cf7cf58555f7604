"""Encode records as keys and values of the database, and decode them.

Arrays are safetensors files. Each value has a checksum: its 64-bit XXH3, seeded with that of its key, so that a value
at the wrong key is noticed too. XXH3 protects against accidents, not against forgery. A value that does not match its
checksum raises DamagedMemoryError.

>>> sealed = seal(b"key", b"some value")
>>> unseal(b"key", sealed)
b'some value'
>>> unseal(b"yek", sealed) is None
True
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from numpy.typing import NDArray
from safetensors.numpy import load, save
from xxhash import xxh3_64_digest, xxh3_64_intdigest

from deixis.memory.errors import DamagedMemoryError
from deixis.memory.perceptual.database import keys
from deixis.memory.perceptual.records import (
    CategoryRecord,
    JsonObject,
    View,
    arrays_by_name,
    arrays_by_use,
    json_text,
)

_COUNTS = struct.Struct("<3Q")
_CHECKSUM = 8  # bytes
_NOTE = "deixis"


def checksum(key: bytes, value: bytes) -> bytes:
    """Return the 8-byte checksum of a value and its key.

    Parameters
    ----------
    key
        Key of the value, which the checksum covers.
    value
        Value without a checksum.

    Returns
    -------
    bytes
        Digest by XXH3 with 64 bits.
    """
    return xxh3_64_digest(value, xxh3_64_intdigest(key))


def seal(key: bytes, value: bytes) -> bytes:
    """Return a value followed by its checksum.

    Parameters
    ----------
    key
        Key of the value.
    value
        Value without a checksum.

    Returns
    -------
    bytes
        Value as it is stored.
    """
    return value + checksum(key, value)


def unseal(key: bytes, sealed: bytes) -> bytes | None:
    """Return the value without its checksum, or None where they do not match.

    Parameters
    ----------
    key
        Key of the value.
    sealed
        Value as it is stored.

    Returns
    -------
    bytes or None
        Value; None also if it is too short for a checksum.
    """
    value = sealed[:-_CHECKSUM]
    return value if len(sealed) >= _CHECKSUM and checksum(key, value) == sealed[-_CHECKSUM:] else None


def pack(arrays: Mapping[str, NDArray[Any]], note: str) -> bytes:
    """Return arrays as a safetensors file, with a text in its header.

    Parameters
    ----------
    arrays
        Arrays by name.
    note
        Text.

    Returns
    -------
    bytes
        Content of the file.
    """
    return save(dict(arrays), {_NOTE: note})


def unpack(data: bytes) -> tuple[dict[str, NDArray[Any]], str]:
    """Return the arrays and the text of a safetensors file.

    Parameters
    ----------
    data
        Content of the file, as :func:`pack` returns it.

    Returns
    -------
    tuple
        Arrays by name, and the text.

    Raises
    ------
    SafetensorError
        If the data are not a safetensors file.
    ValueError
        If the header is not JSON.
    KeyError
        If the header has no text.
    """
    arrays = load(data)
    header = json.loads(data[8 : 8 + int.from_bytes(data[:8], "little")])
    return arrays, header["__metadata__"][_NOTE]


class ViewHeader(NamedTuple):
    """A view without its arrays.

    ``key`` is its place in the order of all views. Its arrays have a key of their own, in the category under which they
    were first written. ``sum`` is their checksum, so that older arrays at the same key are not mistaken for them.
    """

    category: str
    id: str
    time: int
    key: bytes
    arrays_key: bytes
    sum: bytes
    metadata: str  # JSON

    def moved(self, category: str) -> ViewHeader:
        """Return the header of the view in another category; its arrays stay where they are.

        Parameters
        ----------
        category
            Name of the new category.

        Returns
        -------
        ViewHeader
            Header with another key and an unchanged key of the arrays.
        """
        return self._replace(category=category, key=keys.view_key(keys.VIEW, category, self.id, self.time))


def write_view(view: View) -> tuple[tuple[bytes, bytes], tuple[bytes, bytes]]:
    """Return key and value of a view's header, and those of its arrays.

    Parameters
    ----------
    view
        View to store.

    Returns
    -------
    tuple
        Two pairs of key and value.
    """
    arrays = save(arrays_by_name(view.descriptors, view.points))
    key = keys.view_key(keys.VIEW, view.category, view.id, keys.microseconds(view.time))
    arrays_key = keys.ARRAYS + key[1:]
    metadata = b"%b\0\0%b" % (checksum(arrays_key, arrays), json_text(view.metadata).encode())
    return (key, seal(key, metadata)), (arrays_key, arrays)


def write_about(header: ViewHeader) -> tuple[bytes, bytes]:
    """Return key and value of a view's header.

    The value holds the checksum of the arrays, their category if it is another one, and the metadata as JSON.

    Parameters
    ----------
    header
        Header of the view.

    Returns
    -------
    tuple
        Key and sealed value.
    """
    place = keys.split_view_key(header.arrays_key)[0]
    ended = keys.ended("" if place == header.category else place)
    return header.key, seal(header.key, header.sum + ended + header.metadata.encode())


def read_about(key: bytes, sealed: bytes) -> ViewHeader:
    """Return the header of a view from its key and value.

    Parameters
    ----------
    key
        Key of the header.
    sealed
        Value as it is stored.

    Returns
    -------
    ViewHeader
        Header.

    Raises
    ------
    DamagedMemoryError
        If the value does not match its checksum, or has an unknown format.
    """
    value = unseal(key, sealed)
    if value is None:
        raise DamagedMemoryError(f"{named(key)}: its header differs from what was written")
    try:
        return parse_about(key, value)
    except ValueError as error:
        raise DamagedMemoryError(f"{named(key)}: its header is of no known format") from error


def parse_about(key: bytes, value: bytes) -> ViewHeader:
    """Return the header of a view from an unsealed value.

    Parameters
    ----------
    key
        Key of the header.
    value
        Value without its checksum.

    Returns
    -------
    ViewHeader
        Header.

    Raises
    ------
    ValueError
        If the key or the value has another format.
    """
    category, view_id, time = keys.split_view_key(key)
    place, metadata = keys.split_ended(value[_CHECKSUM:])
    arrays_key = keys.view_key(keys.ARRAYS, place, view_id, time) if place else keys.ARRAYS + key[1:]
    return ViewHeader(category, view_id, time, key, arrays_key, value[:_CHECKSUM], metadata.decode())


def named(key: bytes) -> str:
    """Return the name of a view for messages, from any key.

    Parameters
    ----------
    key
        Key of the view's header or of its arrays; any other key is quoted.

    Returns
    -------
    str
        Words such as ``view 'v1' of 'mug'``.
    """
    try:
        category, view_id, _ = keys.split_view_key(key)
    except ValueError:
        return f"a view with the key {key[:60]!r}"
    return f"view '{view_id}' of '{category}'"


def read_view(header: ViewHeader, arrays: bytes | None) -> View:
    """Return a view from its header and the value of its arrays.

    Parameters
    ----------
    header
        Header of the view.
    arrays
        Value of its arrays; None if it is missing.

    Returns
    -------
    View
        View with read-only arrays.

    Raises
    ------
    DamagedMemoryError
        If the arrays are missing, or differ from what was written.
    """
    if arrays is None:
        raise DamagedMemoryError(f"view '{header.id}' of '{header.category}': its arrays are missing")
    if checksum(header.arrays_key, arrays) != header.sum:
        raise DamagedMemoryError(f"view '{header.id}' of '{header.category}': its arrays differ from what was written")
    loaded = load(arrays)
    for array in loaded.values():
        array.flags.writeable = False
    descriptors, points = arrays_by_use(loaded)
    return View.stored(
        id=header.id,
        category=header.category,
        time=keys.moment(header.time),
        descriptors=MappingProxyType(descriptors),
        points=points,
        metadata=JsonObject(header.metadata),
    )


def write_category(record: CategoryRecord) -> tuple[bytes, bytes]:
    """Return key and value of a category's record.

    Parameters
    ----------
    record
        Record to store.

    Returns
    -------
    tuple
        Key and sealed value.
    """
    key = keys.name_key(keys.CATEGORY, record.name)
    return key, seal(key, pack(record.state, json_text(record.metadata)))


def read_category(name: str, sealed: bytes) -> CategoryRecord:
    """Return the record of a category from its value.

    Parameters
    ----------
    name
        Name of the category.
    sealed
        Value as it is stored.

    Returns
    -------
    CategoryRecord
        Record with its state and metadata.

    Raises
    ------
    DamagedMemoryError
        If the value does not match its checksum.
    """
    value = unseal(keys.name_key(keys.CATEGORY, name), sealed)
    if value is None:
        raise DamagedMemoryError(f"the record of category '{name}' differs from what was written")
    state, note = unpack(value)
    return CategoryRecord(name, state, json.loads(note))


def write_name(kind: bytes, name: str, value: str) -> tuple[bytes, bytes]:
    """Return key and value of a text stored under a name, such as the lesson of a view.

    Parameters
    ----------
    kind
        First byte of the key.
    name
        Name, which is the rest of the key.
    value
        Text to store.

    Returns
    -------
    tuple
        Key and sealed value.
    """
    key = keys.name_key(kind, name)
    return key, seal(key, value.encode())


def read_name(key: bytes, sealed: bytes) -> str:
    """Return the text from a key and its value.

    Parameters
    ----------
    key
        Key of the text.
    sealed
        Value as it is stored.

    Returns
    -------
    str
        The text.

    Raises
    ------
    DamagedMemoryError
        If the value does not match its checksum.
    """
    value = unseal(key, sealed)
    if value is None:
        raise DamagedMemoryError(f"the value of {key[:60]!r} differs from what was written")
    return value.decode()


class StoreCounts(NamedTuple):
    """Numbers updated by each batch: batches written, views present, and batches lost."""

    batches: int = 0
    views: int = 0
    lost: int = 0


def write_counts(counts: StoreCounts) -> bytes:
    """Return the value of the key :data:`deixis.memory.perceptual.database.keys.COUNT`.

    Parameters
    ----------
    counts
        Counts of the memory.

    Returns
    -------
    bytes
        Sealed value.
    """
    return seal(keys.COUNT, _COUNTS.pack(counts.batches, counts.views, counts.lost))


def read_counts(sealed: bytes | None) -> StoreCounts:
    """Return the counts from their value.

    Parameters
    ----------
    sealed
        Value as it is stored; None if there is none.

    Returns
    -------
    StoreCounts
        Counts; all are 0 without a value.

    Raises
    ------
    DamagedMemoryError
        If the value does not match its checksum.
    """
    if sealed is None:
        return StoreCounts()
    value = unseal(keys.COUNT, sealed)
    if value is None or len(value) != _COUNTS.size:
        raise DamagedMemoryError("the counts differ from what was written")
    return StoreCounts(*_COUNTS.unpack(value))
