"""Records as keys and values, and back. What comes back wrong raises DamagedMemoryError."""

from __future__ import annotations

import json
import struct
from types import MappingProxyType
from typing import NamedTuple

from deixis.memory.errors import DamagedMemoryError
from deixis.memory.perceptual import keys
from deixis.memory.perceptual.checksum import (
    WIDE,
    open_small,
    open_wide,
    seal_small,
    seal_wide,
)
from deixis.memory.perceptual.records import (
    CategoryRecord,
    JsonObject,
    View,
    arrays_by_name,
    arrays_by_use,
    json_text,
)
from deixis.memory.perceptual.tensors import pack, unpack
from deixis.memory.perceptual.written import Written, written

_COUNTS = struct.Struct("<3Q")

_decode = json.JSONDecoder().raw_decode


class About(NamedTuple):
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

    def moved(self, category: str) -> About:
        """The same view in another category; its arrays stay where they are."""
        return self._replace(category=category, key=keys.view_key(keys.VIEW, category, self.id, self.time))


def write_view(view: View) -> Written:
    """A view as it is written."""
    if view.written is not None:
        return view.written
    arrays = arrays_by_name(view.descriptors, view.points)
    return written(view.category, view.id, view.time, arrays, json_text(view.metadata))[0]


def write_about(said: About) -> tuple[bytes, bytes]:
    """Key and value of what is said of a view: checksum of its arrays; their category, where it is another; JSON."""
    place = keys.split_view_key(said.arrays_key)[0]
    ended = keys.ended("" if place == said.category else place)
    return said.key, seal_small(said.key, said.sum + ended + said.metadata.encode())


def read_about(key: bytes, sealed: bytes) -> About:
    """What is said of a view again."""
    value = open_small(key, sealed)
    if value is None:
        raise DamagedMemoryError(f"{named(key)}: what is said of it is not what was written")
    try:
        category, id, time = keys.split_view_key(key)
        arrays_key = keys.ARRAYS + key[1:]
        if value[WIDE : WIDE + 2] == b"\0\0":
            metadata = value[WIDE + 2 :]
        else:
            place, metadata = keys.split_ended(value[WIDE:])
            arrays_key = keys.view_key(keys.ARRAYS, place, id, time)
        return About(category, id, time, key, arrays_key, value[:WIDE], metadata.decode())
    except ValueError as error:
        raise DamagedMemoryError(
            f"{named(key)}: what is said of it is written as no version of this program does"
        ) from error


def named(key: bytes) -> str:
    """The view that a key is of, in words, whatever the key is like."""
    try:
        category, id, _ = keys.split_view_key(key)
    except ValueError:
        return f"a view with the key {key[:60]!r}"
    return f"view '{id}' of '{category}'"


def read_view(said: About, key: bytes, sealed: bytes | None) -> View:
    """A view again, of what is said of it, and its arrays with their key."""
    if sealed is None:
        raise DamagedMemoryError(f"view '{said.id}' of '{said.category}': its arrays are missing")
    if open_wide(key, sealed) is None or sealed[-WIDE:] != said.sum:
        raise DamagedMemoryError(f"view '{said.id}' of '{said.category}': its arrays are not what was written")
    descriptors, points = arrays_by_use(unpack(sealed)[0])
    return View.stored(
        id=said.id,
        category=said.category,
        time=keys.moment(said.time),
        descriptors=MappingProxyType(descriptors),
        points=points,
        metadata=JsonObject(said.metadata),
    )


def write_category(record: CategoryRecord) -> tuple[bytes, bytearray]:
    """Key and value of a category's record."""
    key = keys.name_key(keys.CATEGORY, record.name)
    return key, seal_wide(key, *pack(record.state, json_text(record.metadata)))


def read_category(name: str, sealed: bytes) -> CategoryRecord:
    """The same again."""
    value = open_wide(keys.name_key(keys.CATEGORY, name), sealed)
    if value is None:
        raise DamagedMemoryError(f"what is known of category '{name}' is not what was written")
    state, note = unpack(value)
    return CategoryRecord(name, state, _decode(note)[0])


class Counts(NamedTuple):
    """What is counted in every batch: batches so far, views there are, and batches that were lost."""

    batches: int = 0
    views: int = 0
    lost: int = 0


def write_counts(counts: Counts) -> bytes:
    """The value of the key :data:`deixis.memory.perceptual.keys.COUNT`."""
    return seal_small(keys.COUNT, _COUNTS.pack(counts.batches, counts.views, counts.lost))


def read_counts(sealed: bytes | None) -> Counts:
    """The same again."""
    if sealed is None:
        return Counts()
    value = open_small(keys.COUNT, sealed)
    if value is None or len(value) != _COUNTS.size:
        raise DamagedMemoryError("the counts are not what was written")
    return Counts(*_COUNTS.unpack(value))
