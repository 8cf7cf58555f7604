"""Encode records as the keys and values of the database, and decode them.

Arrays are safetensors files. Every value is guarded by the 64-bit XXH3 of it, seeded with that of its key, so that a
value in another's place is noticed too. XXH3 guards against accidents, not against forgers. What comes back wrong
raises DamagedMemoryError.

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
from deixis.memory.perceptual import keys
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
    """Return the 8 bytes that bind a value to its key."""
    return xxh3_64_digest(value, xxh3_64_intdigest(key))


def seal(key: bytes, value: bytes) -> bytes:
    """Return a value followed by its checksum."""
    return value + checksum(key, value)


def unseal(key: bytes, sealed: bytes) -> bytes | None:
    """Return the value again, or None where it is not what was sealed."""
    value = sealed[:-_CHECKSUM]
    return value if len(sealed) >= _CHECKSUM and checksum(key, value) == sealed[-_CHECKSUM:] else None


def pack(arrays: Mapping[str, NDArray[Any]], note: str) -> bytes:
    """Return a safetensors file of arrays, with a text in its header."""
    return save(dict(arrays), {_NOTE: note})


def unpack(data: bytes) -> tuple[dict[str, NDArray[Any]], str]:
    """Return the arrays and the text again. Raises SafetensorError, ValueError or KeyError for other data."""
    arrays = load(data)
    header = json.loads(data[8 : 8 + int.from_bytes(data[:8], "little")])
    return arrays, header["__metadata__"][_NOTE]


class ViewHeader(NamedTuple):
    """All of a view but its arrays.

    ``key`` is its place in the order of all views. The arrays lie under a key of their own, in the category under which
    they were first written. ``sum`` is their checksum, so that arrays which lay under the same key before are not taken
    for them.
    """

    category: str
    id: str
    time: int
    key: bytes
    arrays_key: bytes
    sum: bytes
    metadata: str  # JSON

    def moved(self, category: str) -> ViewHeader:
        """Return the same view in another category; its arrays stay where they are."""
        return self._replace(category=category, key=keys.view_key(keys.VIEW, category, self.id, self.time))


def write_view(view: View) -> tuple[tuple[bytes, bytes], tuple[bytes, bytes]]:
    """Return key and value of what is said of a view, and of its arrays."""
    arrays = save(arrays_by_name(view.descriptors, view.points))
    key = keys.view_key(keys.VIEW, view.category, view.id, keys.microseconds(view.time))
    arrays_key = keys.ARRAYS + key[1:]
    said = b"%b\0\0%b" % (checksum(arrays_key, arrays), json_text(view.metadata).encode())
    return (key, seal(key, said)), (arrays_key, arrays)


def write_about(said: ViewHeader) -> tuple[bytes, bytes]:
    """Return key and value of what is said of a view: checksum of its arrays; their category, if another; JSON."""
    place = keys.split_view_key(said.arrays_key)[0]
    ended = keys.ended("" if place == said.category else place)
    return said.key, seal(said.key, said.sum + ended + said.metadata.encode())


def read_about(key: bytes, sealed: bytes) -> ViewHeader:
    """Return what is said of a view again."""
    value = unseal(key, sealed)
    if value is None:
        raise DamagedMemoryError(f"{named(key)}: what is said of it is not what was written")
    try:
        return parse_about(key, value)
    except ValueError as error:
        raise DamagedMemoryError(
            f"{named(key)}: what is said of it is written as no version of this program does"
        ) from error


def parse_about(key: bytes, value: bytes) -> ViewHeader:
    """Return what an unsealed value says of a view. Raises ValueError for other data."""
    category, view_id, time = keys.split_view_key(key)
    place, metadata = keys.split_ended(value[_CHECKSUM:])
    arrays_key = keys.view_key(keys.ARRAYS, place, view_id, time) if place else keys.ARRAYS + key[1:]
    return ViewHeader(category, view_id, time, key, arrays_key, value[:_CHECKSUM], metadata.decode())


def named(key: bytes) -> str:
    """Name the view that a key is of, whatever the key is like."""
    try:
        category, view_id, _ = keys.split_view_key(key)
    except ValueError:
        return f"a view with the key {key[:60]!r}"
    return f"view '{view_id}' of '{category}'"


def read_view(said: ViewHeader, arrays: bytes | None) -> View:
    """Return a view again, of what is said of it and the value of its arrays."""
    if arrays is None:
        raise DamagedMemoryError(f"view '{said.id}' of '{said.category}': its arrays are missing")
    if checksum(said.arrays_key, arrays) != said.sum:
        raise DamagedMemoryError(f"view '{said.id}' of '{said.category}': its arrays are not what was written")
    loaded = load(arrays)
    for array in loaded.values():
        array.flags.writeable = False
    descriptors, points = arrays_by_use(loaded)
    return View.stored(
        id=said.id,
        category=said.category,
        time=keys.moment(said.time),
        descriptors=MappingProxyType(descriptors),
        points=points,
        metadata=JsonObject(said.metadata),
    )


def write_category(record: CategoryRecord) -> tuple[bytes, bytes]:
    """Return key and value of a category's record."""
    key = keys.name_key(keys.CATEGORY, record.name)
    return key, seal(key, pack(record.state, json_text(record.metadata)))


def read_category(name: str, sealed: bytes) -> CategoryRecord:
    """Return the record again."""
    value = unseal(keys.name_key(keys.CATEGORY, name), sealed)
    if value is None:
        raise DamagedMemoryError(f"what is known of category '{name}' is not what was written")
    state, note = unpack(value)
    return CategoryRecord(name, state, json.loads(note))


def write_name(kind: bytes, name: str, value: str) -> tuple[bytes, bytes]:
    """Return key and value of a text that is kept under a name, such as the lesson of a view."""
    key = keys.name_key(kind, name)
    return key, seal(key, value.encode())


def read_name(key: bytes, sealed: bytes) -> str:
    """Return the text again."""
    value = unseal(key, sealed)
    if value is None:
        raise DamagedMemoryError(f"what is kept under {key[:60]!r} is not what was written")
    return value.decode()


class StoreCounts(NamedTuple):
    """What is counted in every batch: batches so far, views there are, and batches that were lost."""

    batches: int = 0
    views: int = 0
    lost: int = 0


def write_counts(counts: StoreCounts) -> bytes:
    """Return the value of the key :data:`deixis.memory.perceptual.keys.COUNT`."""
    return seal(keys.COUNT, _COUNTS.pack(counts.batches, counts.views, counts.lost))


def read_counts(sealed: bytes | None) -> StoreCounts:
    """Return the counts again."""
    if sealed is None:
        return StoreCounts()
    value = unseal(keys.COUNT, sealed)
    if value is None or len(value) != _COUNTS.size:
        raise DamagedMemoryError("the counts are not what was written")
    return StoreCounts(*_COUNTS.unpack(value))
