"""Records of perceptual memory: views, learned state of categories, and batches of both.

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
"""A JSON object: keys are strings; values are None, booleans, numbers, strings, lists, and JSON objects."""

DTYPES = frozenset(
    ("bool", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "float16", "float32", "float64")
)
"""Names of the array types that the state of a learner may have."""

_LONGEST = 1000  # bytes of a name in UTF-8
_DESCRIPTOR, _POINTS = "descriptor/", "points"


class JsonObject(Mapping[str, Any]):
    """A JSON object that is stored as text, and parsed on first use."""

    def __init__(self, text: str) -> None:
        self.text = text

    @cached_property
    def _values(self) -> dict[str, Any]:
        parsed: dict[str, Any] = json.loads(self.text)
        return parsed

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __repr__(self) -> str:
        return repr(self._values)


@dataclass(frozen=True, eq=False)
class View:
    """One view of an object of a category, with read-only copies of its arrays.

    Parameters
    ----------
    id
        Name of the view, unique in the memory.
    category
        Name of the category.
    time
        Time with a time zone; stored in UTC, to the microsecond.
    descriptors
        Descriptors by name: k descriptors of length d, float32 of shape (k, d).
    points
        Points in metres, float32 of shape (n, 3).
    metadata
        JSON: scene, object, teacher, source.

    Raises
    ------
    RecordError
        A value is of another type or shape.
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
                raise RecordError(f"the points of view '{self.id}' must have shape (n, 3), got {self.points.shape}")
            object.__setattr__(self, "points", frozen(self.points))
        object.__setattr__(self, "descriptors", MappingProxyType(descriptors))
        object.__setattr__(self, "time", _utc(self.id, self.time))
        object.__setattr__(self, "metadata", _json(f"the metadata of view '{self.id}'", self.metadata))

    @classmethod
    def stored(cls, **values: Any) -> View:
        """Return a view without checks, from values that were checked when they were written.

        Parameters
        ----------
        values
            Value of each attribute, by its name. Arrays must be read-only.

        Returns
        -------
        View
            View that shares its arrays with ``values``.
        """
        view = object.__new__(cls)
        object.__setattr__(view, "__dict__", values)
        return view


@dataclass(frozen=True, eq=False)
class CategoryRecord:
    """Learned state of a category, from which learning continues.

    ``state`` maps names to arrays of any shape, of the types in :data:`DTYPES`; ``metadata`` is JSON. Raises
    RecordError.
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
                raise RecordError(f"the state '{name}' of category '{self.name}' must be an array of numbers")
            held[name] = frozen(array)
        object.__setattr__(self, "state", MappingProxyType(held))
        object.__setattr__(self, "metadata", _json(f"the metadata of category '{self.name}'", self.metadata))


@dataclass(frozen=True)
class Batch:
    """Changes that are written in one step: all or nothing.

    A view with a known id replaces the stored one, whatever its category was, and belongs to no lesson. A record of a
    category replaces the stored record. ``forgotten`` are ids of views, ``dropped`` names of categories whose records
    are removed. ``lessons`` maps ids of views to their lessons; None means no lesson. ``teachings`` maps ids of views
    to all their teachings in turn, as JSON; an empty list where the view itself says all. Raises RecordError where an
    id or a name occurs twice.
    """

    views: Sequence[View] = ()
    categories: Sequence[CategoryRecord] = ()
    forgotten: Sequence[str] = ()
    dropped: Sequence[str] = ()
    lessons: Mapping[str, str | None] = field(default_factory=dict)
    teachings: Mapping[str, Sequence[Json]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        ids = [*(view.id for view in self.views), *self.forgotten]
        categories = [*(record.name for record in self.categories), *self.dropped]
        for what, names in (("view", ids), ("category", categories)):
            if len(set(names)) < len(names):
                twice = next(name for name in names if names.count(name) > 1)
                raise RecordError(f"the {what} '{twice}' must occur only once in a batch")


def arrays_by_name(
    descriptors: Mapping[str, NDArray[np.float32]], points: NDArray[np.float32] | None
) -> dict[str, NDArray[np.float32]]:
    """Return the arrays of a view by their storage names.

    Parameters
    ----------
    descriptors
        Descriptors of shape (k, d), by name.
    points
        Points of shape (n, 3), in metres; None if there are none.

    Returns
    -------
    dict
        Descriptors and points in one dictionary.
    """
    arrays = {_DESCRIPTOR + name: array for name, array in descriptors.items()}
    return arrays if points is None else {**arrays, _POINTS: points}


def arrays_by_use(arrays: dict[str, NDArray[Any]]) -> tuple[dict[str, NDArray[Any]], NDArray[Any] | None]:
    """Return descriptors and points from arrays by their storage names.

    Parameters
    ----------
    arrays
        Arrays as :func:`arrays_by_name` returned them.

    Returns
    -------
    tuple
        Descriptors by name, and points or None.

    Raises
    ------
    ValueError
        If an array has another name.
    """
    names = _uses(tuple(arrays))
    descriptors = {name: array for name, array in zip(names, arrays.values(), strict=True) if name}
    return descriptors, None if len(descriptors) == len(names) else arrays[_POINTS]


@lru_cache(256)
def _uses(names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the names of the descriptors and an empty name for the points; views of one layout share the result."""
    if any(name != _POINTS and not name.startswith(_DESCRIPTOR) for name in names):
        raise ValueError(f"a view has {_POINTS} and {_DESCRIPTOR}…, and no other arrays")
    return tuple("" if name == _POINTS else name.removeprefix(_DESCRIPTOR) for name in names)


def json_text(metadata: Json) -> str:
    """Return metadata as JSON.

    Parameters
    ----------
    metadata
        Object of JSON values.

    Returns
    -------
    str
        JSON; the stored text if the metadata come from the memory.
    """
    return metadata.text if isinstance(metadata, JsonObject) else json.dumps(dict(metadata))


def check_name(what: str, name: object) -> str:
    """Return the name if it is a text of one or more characters that UTF-8 can encode.

    Parameters
    ----------
    what
        Noun for errors, such as ``a view's id``.
    name
        Name to check.

    Returns
    -------
    str
        The given name.

    Raises
    ------
    RecordError
        If the name is not a text, is empty or too long, or has half a character.
    """
    if not isinstance(name, str) or not name:
        raise RecordError(f"{what} must be a string of one or more characters, got {name!r}")
    try:
        length = len(name.encode())
    except UnicodeEncodeError as error:
        raise RecordError(f"{what}, {name!r}, has a lone surrogate (half a character) at {error.start}") from error
    if length > _LONGEST:
        raise RecordError(f"{what} is too long: {length} bytes, at most {_LONGEST} ({name[:40]}…)")
    return name


def check_merging(source: str, into: str, record: CategoryRecord | None) -> None:
    """Raise RecordError if a category is merged into itself, or with a record of another category.

    Parameters
    ----------
    source
        Category whose views are moved.
    into
        Category that receives them.
    record
        New record of ``into``.

    Raises
    ------
    RecordError
        If the categories are equal, or the record has another name.
    """
    if source == into:
        raise RecordError(f"'{source}' cannot be merged into itself; name two categories")
    if record is not None and record.name != into:
        raise RecordError(f"'{source}' cannot be merged into '{into}' with a record of '{record.name}'")


def name_taken(old: str, new: str) -> RejectedWriteError:
    """Return the error for a new name that another category has.

    Parameters
    ----------
    old
        Name of the category.
    new
        Name that it should get.

    Returns
    -------
    RejectedWriteError
        Error that says to merge the two.
    """
    if old == new:
        return RejectedWriteError(f"the category already has the name '{old}'")
    return RejectedWriteError(f"there is already a category '{new}': merge '{old}' into it")


def frozen(array: NDArray[Any]) -> NDArray[Any]:
    """Return a contiguous, little-endian, read-only copy of an array.

    Parameters
    ----------
    array
        Array of any shape and type.

    Returns
    -------
    ndarray
        Copy of an equal shape.
    """
    copy = np.array(array, array.dtype.newbyteorder("<"), order="C")
    copy.flags.writeable = False
    return copy


def _check_floats(what: str, array: object) -> None:
    if not isinstance(array, np.ndarray) or array.dtype.name != "float32" or array.ndim != 2:
        shape = f"{array.dtype} {array.shape}" if isinstance(array, np.ndarray) else type(array).__name__
        raise RecordError(f"{what} must be a float32 array with two dimensions, got {shape}")


def _utc(view: str, time: object) -> datetime:
    if not isinstance(time, datetime) or time.utcoffset() is None:
        raise RecordError(f"the time of view '{view}' must be a datetime with a time zone, got {time!r}")
    try:
        return time.astimezone(UTC)
    except OverflowError as error:
        raise RecordError(f"the time of view '{view}', {time}, must be in the years 1 to 9999 of UTC") from error


def _json(what: str, data: object) -> JsonObject:
    try:
        text = json.dumps(dict(data), allow_nan=False, separators=(",", ":"))  # type: ignore[call-overload]
        copy = json.loads(text)
    except (TypeError, ValueError, RecursionError) as error:
        raise RecordError(f"{what} cannot be written as JSON: {error}") from error
    if copy != data:
        raise RecordError(f"{what} would change when read back from JSON: use lists, and strings as keys")
    return JsonObject(text)
