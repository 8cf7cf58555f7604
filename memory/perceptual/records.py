"""What perceptual memory keeps: views, what a learner knows of a category, and batches of both.

>>> from datetime import UTC, datetime
>>> spin = np.zeros((2, 153), np.float32)
>>> view = View("v1", "mug", datetime(2026, 5, 1, tzinfo=UTC), {"spin": spin}, metadata={"teacher": "Ada"})
>>> view.descriptors["spin"].flags.writeable
False
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cached_property, lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.memory.errors import RecordError, RejectedWriteError

Json = Mapping[str, Any]
"""An object of JSON: keys are strings; values are None, bools, numbers, strings, lists, and objects again."""

DTYPES = frozenset(
    ("bool", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "float16", "float32", "float64")
)
"""Names of the types that the arrays of a learner's state may have."""

_LONGEST = 1000  # bytes of a name in UTF-8
_DESCRIPTOR, _POINTS = "descriptor/", "points"


class JsonObject(Mapping[str, Any]):
    """An object of JSON, kept as its text, which is read when something in it is first asked for."""

    def __init__(self, text: str) -> None:
        self.text = text

    @cached_property
    def _said(self) -> dict[str, Any]:
        said: dict[str, Any] = json.loads(self.text)
        return said

    def __getitem__(self, name: str) -> Any:
        return self._said[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._said)

    def __len__(self) -> int:
        return len(self._said)

    def __repr__(self) -> str:
        return repr(self._said)


@dataclass(frozen=True, eq=False)
class View:
    """One look at an object of a category. Arrays are kept as they are at this moment and cannot be written.

    ``id`` is the view's own in the whole memory. ``time`` has a time zone, and is kept in UTC, to the microsecond.
    ``descriptors`` leads from a descriptor's name to k descriptors of length d, float32 (k, d); ``points`` are metres,
    float32 (n, 3). ``metadata`` is JSON: scene, object, teacher, source. Raises RecordError for anything else.
    """

    id: str
    category: str
    time: datetime
    descriptors: Mapping[str, NDArray[np.float32]]
    points: NDArray[np.float32] | None = None
    metadata: Json = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_name("a view's id", self.id)
        check_name("a category's name", self.category)
        descriptors = {}
        for name, array in self.descriptors.items():
            check_name("a descriptor's name", name)
            _check_floats(f"descriptor '{name}' of view '{self.id}'", array)
            descriptors[name] = frozen(array)
        if self.points is not None:
            _check_floats(f"the points of view '{self.id}'", self.points)
            if self.points.shape[1] != 3:
                raise RecordError(f"the points of view '{self.id}' have shape {self.points.shape}, not (n, 3)")
            object.__setattr__(self, "points", frozen(self.points))
        object.__setattr__(self, "descriptors", MappingProxyType(descriptors))
        object.__setattr__(self, "time", _utc(self.id, self.time))
        object.__setattr__(self, "metadata", _json(f"the metadata of view '{self.id}'", self.metadata))

    @classmethod
    def stored(cls, **values: Any) -> View:
        """Return a view of values that were checked when they were written."""
        view = object.__new__(cls)
        object.__setattr__(view, "__dict__", values)
        return view


@dataclass(frozen=True, eq=False)
class CategoryRecord:
    """What a learner knows of a category between two lessons, so that it goes on where it stopped.

    ``state`` leads from names to arrays of any shape, of :data:`DTYPES`; ``metadata`` is JSON. Raises RecordError.
    """

    name: str
    state: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    metadata: Json = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_name("a category's name", self.name)
        held = {}
        for name, array in self.state.items():
            check_name("the name of a state", name)
            if not isinstance(array, np.ndarray) or array.dtype.name not in DTYPES:
                raise RecordError(f"the state '{name}' of category '{self.name}' is no array of numbers")
            held[name] = frozen(array)
        object.__setattr__(self, "state", MappingProxyType(held))
        object.__setattr__(self, "metadata", _json(f"the metadata of category '{self.name}'", self.metadata))


@dataclass(frozen=True)
class Batch:
    """What is written in one step: all of it, or, whatever happens, nothing.

    A view whose id is known takes the place of the old one, in whatever category that was, and belongs to no lesson; a
    category's record takes the place of the old record. ``forgotten`` are ids of views, ``dropped`` names of categories
    whose records go. ``lessons`` says which lesson a view belongs to from now on, by the view's id; None for no lesson.
    Raises RecordError where an id or a name comes twice.
    """

    views: Sequence[View] = ()
    categories: Sequence[CategoryRecord] = ()
    forgotten: Sequence[str] = ()
    dropped: Sequence[str] = ()
    lessons: Mapping[str, str | None] = field(default_factory=dict)

    def __post_init__(self) -> None:
        ids = [*(view.id for view in self.views), *self.forgotten]
        categories = [*(record.name for record in self.categories), *self.dropped]
        for what, names in (("view", ids), ("category", categories)):
            if len(set(names)) < len(names):
                twice = next(name for name in names if names.count(name) > 1)
                raise RecordError(f"the {what} '{twice}' comes twice in one batch")


def arrays_by_name(
    descriptors: Mapping[str, NDArray[np.float32]], points: NDArray[np.float32] | None
) -> dict[str, NDArray[np.float32]]:
    """Return a view's arrays by the names under which they are kept."""
    arrays = {_DESCRIPTOR + name: array for name, array in descriptors.items()}
    return arrays if points is None else {**arrays, _POINTS: points}


def arrays_by_use(arrays: dict[str, NDArray[Any]]) -> tuple[dict[str, NDArray[Any]], NDArray[Any] | None]:
    """Return descriptors and points, of arrays by the names under which they are kept. Raises ValueError for another
    name."""
    names = _uses(tuple(arrays))
    descriptors = {name: array for name, array in zip(names, arrays.values(), strict=True) if name}
    return descriptors, None if len(descriptors) == len(names) else arrays[_POINTS]


@lru_cache(256)
def _uses(names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the descriptors' names, and nothing for the points; views of one layout have the same."""
    if any(name != _POINTS and not name.startswith(_DESCRIPTOR) for name in names):
        raise ValueError(f"a view has {_POINTS} and {_DESCRIPTOR}…, and no other arrays")
    return tuple("" if name == _POINTS else name.removeprefix(_DESCRIPTOR) for name in names)


def json_text(metadata: Json) -> str:
    """Return the metadata of a view or a category as JSON."""
    return metadata.text if isinstance(metadata, JsonObject) else json.dumps(dict(metadata))


def check_name(what: str, name: object) -> str:
    """Return the name; raises RecordError for what cannot be one: one or more characters that UTF-8 can write."""
    if not isinstance(name, str) or not name:
        raise RecordError(f"{what} is a text of one or more characters, not {name!r}")
    try:
        length = len(name.encode())
    except UnicodeEncodeError as error:
        raise RecordError(f"{what}, {name!r}, holds half a character (a lone surrogate) at {error.start}") from error
    if length > _LONGEST:
        raise RecordError(f"{what} is too long: {length} bytes, at most {_LONGEST} ({name[:40]}…)")
    return name


def check_merging(source: str, into: str, record: CategoryRecord | None) -> None:
    """Raise RecordError for a category and itself, and for a record of another category."""
    if source == into:
        raise RecordError(f"'{source}' cannot be merged into itself; name two categories")
    if record is not None and record.name != into:
        raise RecordError(f"'{source}' cannot be merged into '{into}' with a record of '{record.name}'")


def name_taken(old: str, new: str) -> RejectedWriteError:
    """Return the error for a new name that a category has already."""
    if old == new:
        return RejectedWriteError(f"'{old}' is the category's name already")
    return RejectedWriteError(f"there is a category '{new}' already: merge '{old}' into it")


def frozen(array: NDArray[Any]) -> NDArray[Any]:
    """Return a copy of an array that is contiguous, little-endian and read-only."""
    copy = np.array(array, array.dtype.newbyteorder("<"), order="C")
    copy.flags.writeable = False
    return copy


def _check_floats(what: str, array: object) -> None:
    if not isinstance(array, np.ndarray) or array.dtype.name != "float32" or array.ndim != 2:
        shape = f"{array.dtype} {array.shape}" if isinstance(array, np.ndarray) else type(array).__name__
        raise RecordError(f"{what}: an array of float32 with two dimensions is wanted, not {shape}")


def _utc(view: str, time: object) -> datetime:
    if not isinstance(time, datetime) or time.utcoffset() is None:
        raise RecordError(f"the time of view '{view}' is a datetime with a time zone, not {time!r}")
    try:
        return time.astimezone(UTC)
    except OverflowError as error:
        raise RecordError(f"the time of view '{view}', {time}, is in no year from 1 to 9999 of UTC") from error


def _json(what: str, data: object) -> JsonObject:
    try:
        text = json.dumps(dict(data), allow_nan=False, separators=(",", ":"))  # type: ignore[call-overload]
        copy = json.loads(text)
    except (TypeError, ValueError, RecursionError) as error:
        raise RecordError(f"{what} cannot be written as JSON: {error}") from error
    if copy != data:
        raise RecordError(f"{what} would not come back as it is from JSON: use lists, and strings as keys")
    return JsonObject(text)
