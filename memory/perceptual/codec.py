"""Records as keys and values, and back. What comes back wrong raises DamagedMemoryError."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Mapping
from datetime import datetime
from types import MappingProxyType
from typing import Any, NamedTuple

from numpy.typing import NDArray

from deixis.memory.perceptual import keys
from deixis.memory.perceptual.checksum import open_small, open_wide, seal_small, seal_wide
from deixis.memory.perceptual.errors import DamagedMemoryError
from deixis.memory.perceptual.records import CategoryRecord, View
from deixis.memory.perceptual.tensors import pack, unpack

_COUNTS = struct.Struct("<3Q")
_DESCRIPTOR, _POINTS = "descriptor/", "points"

_encode = json.JSONEncoder(allow_nan=False, separators=(",", ":")).encode
_decode = json.JSONDecoder().decode


class About(NamedTuple):
    """All of a view but its arrays; ``place`` is the category under which the arrays were first written."""

    category: str
    id: str
    time: int
    place: str
    metadata: Mapping[str, Any]

    @property
    def key(self) -> bytes:
        """Its own key."""
        return keys.name_key(keys.ABOUT, self.id)

    @property
    def order_key(self) -> bytes:
        """Its place in the order of all views."""
        return keys.view_key(keys.VIEW, self.category, self.id, self.time)

    @property
    def arrays_key(self) -> bytes:
        """Where its arrays are: a category that is renamed leaves them in place."""
        return keys.view_key(keys.ARRAYS, self.place, self.id, self.time)


def about(view: View) -> About:
    """A new view, to be written where it belongs."""
    return About(view.category, view.id, keys.microseconds(view.time), view.category, view.metadata)


def write_about(said: About) -> bytes:
    """The value of :attr:`About.key`."""
    return seal_small(said.key, _encode([said.category, said.time, said.place, dict(said.metadata)]).encode())


def read_about(id: str, sealed: bytes) -> About:
    """The same again."""
    value = open_small(keys.name_key(keys.ABOUT, id), sealed)
    if value is None:
        raise DamagedMemoryError(f"view '{id}': what is said of it is not what was written")
    category, time, place, metadata = _decode(value.decode())
    return About(category, id, time, place, metadata)


def write_order(key: bytes) -> bytes:
    """The value of :attr:`About.order_key`: a checksum of the key alone."""
    return seal_small(key, b"")


def read_order(key: bytes, sealed: bytes) -> tuple[str, str, int]:
    """Category, id and time of a view."""
    try:
        if open_small(key, sealed) is not None:
            return keys.split_view_key(key)
    except ValueError:
        pass
    raise DamagedMemoryError(f"an entry of the order of views is not what was written: {key[:60]!r}")


def write_arrays(key: bytes, view: View) -> bytearray:
    """The value of :attr:`About.arrays_key`."""
    return seal_wide(key, *pack(arrays_of_view(view)))


def arrays_of_view(view: View) -> dict[str, NDArray[Any]]:
    """A view's arrays by the names under which they are kept."""
    arrays: dict[str, NDArray[Any]] = {_DESCRIPTOR + name: array for name, array in view.descriptors.items()}
    if view.points is not None:
        arrays[_POINTS] = view.points
    return arrays


def read_view(said: About, key: bytes, sealed: bytes | None) -> View:
    """A view again, of what is said of it, and its arrays with their key."""
    if sealed is None:
        raise DamagedMemoryError(f"view '{said.id}' of '{said.category}': its arrays are missing")
    value = open_wide(key, sealed)
    if value is None:
        raise DamagedMemoryError(f"view '{said.id}' of '{said.category}': its arrays are not what was written")
    time = keys.moment(said.time)
    return view_of_arrays(said.id, said.category, time, said.metadata, unpack(value)[0], View.stored)


def view_of_arrays(
    id: str,
    category: str,
    time: datetime,
    metadata: Mapping[str, Any],
    arrays: dict[str, NDArray[Any]],
    make: Callable[..., View] = View,
) -> View:
    """A view whose arrays go by the names under which they are kept. Raises ValueError for another name."""
    points = arrays.pop(_POINTS, None)
    start = len(_DESCRIPTOR)
    descriptors = {name[start:]: array for name, array in arrays.items() if name.startswith(_DESCRIPTOR)}
    if len(descriptors) < len(arrays):
        raise ValueError(f"a view has {_POINTS} and {_DESCRIPTOR}…, and no other arrays")
    return make(
        id=id,
        category=category,
        time=time,
        descriptors=MappingProxyType(descriptors),
        points=points,
        metadata=MappingProxyType(metadata),
    )


def write_category(record: CategoryRecord) -> tuple[bytes, bytearray]:
    """Key and value of a category's record."""
    key = keys.name_key(keys.CATEGORY, record.name)
    return key, seal_wide(key, *pack(record.state, _encode(dict(record.metadata))))


def read_category(name: str, sealed: bytes) -> CategoryRecord:
    """The same again."""
    value = open_wide(keys.name_key(keys.CATEGORY, name), sealed)
    if value is None:
        raise DamagedMemoryError(f"what is known of category '{name}' is not what was written")
    state, note = unpack(value)
    return CategoryRecord(name, state, _decode(note))


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
    if value is None:
        raise DamagedMemoryError("the counts are not what was written")
    return Counts(*_COUNTS.unpack(value))
