"""Records as keys and values, and back. What comes back wrong raises DamagedMemoryError."""

from __future__ import annotations

import json
import struct
from json.encoder import encode_basestring_ascii as _quoted
from types import MappingProxyType
from typing import Any, NamedTuple

from numpy.typing import NDArray

from deixis.memory.perceptual import keys
from deixis.memory.perceptual.checksum import open_small, open_wide, seal_small, seal_wide, wide_sum
from deixis.memory.perceptual.errors import DamagedMemoryError
from deixis.memory.perceptual.records import CategoryRecord, JsonObject, View, json_text
from deixis.memory.perceptual.tensors import pack, unpack

_COUNTS = struct.Struct("<3Q")
_DESCRIPTOR, _POINTS = "descriptor/", "points"

_decode = json.JSONDecoder().raw_decode


class About(NamedTuple):
    """All of a view but its arrays.

    ``place`` is the category under which the arrays were first written. ``sum`` is their checksum, so that arrays which
    lay under the same key before are not taken for them.
    """

    category: str
    id: str
    time: int
    place: str
    sum: int
    metadata: str  # JSON

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


def write_view(view: View) -> tuple[About, bytes, bytearray]:
    """What is said of a new view, and key and value of its arrays."""
    time = keys.microseconds(view.time)
    key = keys.view_key(keys.ARRAYS, view.category, view.id, time)
    sealed = seal_wide(key, *pack(arrays_of_view(view)))
    return About(view.category, view.id, time, view.category, wide_sum(sealed), json_text(view.metadata)), key, sealed


def write_about(said: About) -> tuple[bytes, bytes]:
    """Key and value of what is said of a view."""
    key = keys.name_key(keys.ABOUT, said.id)
    text = f"[{_quoted(said.category)},{said.time},{_quoted(said.place)},{said.sum}]{said.metadata}"
    return key, seal_small(key, text.encode())


def read_about(id: str, key: bytes, sealed: bytes) -> About:
    """The same again, of its id, key and value."""
    value = open_small(key, sealed)
    if value is None:
        raise DamagedMemoryError(f"view '{id}': what is said of it is not what was written")
    text = value.decode()
    try:
        (category, time, place, sum), end = _decode(text)
    except ValueError as error:
        raise DamagedMemoryError(
            f"view '{id}': what is said of it is written as no version of this program does"
        ) from error
    return About(category, id, time, place, sum, text[end:])


def write_order(said: About) -> tuple[bytes, bytes]:
    """Key and value of its place in the order of all views: the value is a checksum of the key alone."""
    key = said.order_key
    return key, seal_small(key, b"")


def read_order(key: bytes, sealed: bytes) -> tuple[str, str, int]:
    """Category, id and time of a view."""
    try:
        if open_small(key, sealed) is not None:
            return keys.split_view_key(key)
    except ValueError:
        pass
    raise DamagedMemoryError(f"an entry of the order of views is not what was written: {key[:60]!r}")


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
    if value is None or wide_sum(sealed) != said.sum:
        raise DamagedMemoryError(f"view '{said.id}' of '{said.category}': its arrays are not what was written")
    descriptors, points = arrays_by_use(unpack(value)[0])
    return View.stored(
        id=said.id,
        category=said.category,
        time=keys.moment(said.time),
        descriptors=MappingProxyType(descriptors),
        points=points,
        metadata=JsonObject(said.metadata),
    )


def arrays_by_use(arrays: dict[str, NDArray[Any]]) -> tuple[dict[str, NDArray[Any]], NDArray[Any] | None]:
    """Descriptors and points, of arrays by the names under which they are kept. Raises ValueError for another name."""
    points = arrays.pop(_POINTS, None)
    start = len(_DESCRIPTOR)
    descriptors = {name[start:]: array for name, array in arrays.items() if name.startswith(_DESCRIPTOR)}
    if len(descriptors) < len(arrays):
        raise ValueError(f"a view has {_POINTS} and {_DESCRIPTOR}…, and no other arrays")
    return descriptors, points


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
    if value is None:
        raise DamagedMemoryError("the counts are not what was written")
    return Counts(*_COUNTS.unpack(value))
