"""Views as sets of descriptors, many of them in one piece of memory, or mapped into memory from a folder.

>>> views = PackedViews.of([("a", np.zeros((2, 3), np.float32)), ("b", np.ones((1, 3), np.float32))])
>>> len(views), views.size, views[1].tolist()
(2, 3, [[1.0, 1.0, 1.0]])

In a folder ``descriptors.npy`` holds the descriptors one after the other, ``lengths.npy`` how many each view has,
``squares.npy`` their squared lengths, ``ids.json`` the names. Only what a search compares exactly is read from the
first, so that there may be more views than memory holds.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory, gettempdir

import numpy as np
from numpy.lib import format as npy_format
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError

MAX_COMPONENT = 1e15
"""Numbers in a descriptor are below this, so that no square overflows in single precision."""


@dataclass(frozen=True, eq=False)
class PackedViews:
    """m views; view i has the descriptors from ``starts[i]`` to ``starts[i + 1]``, one at least.

    ``descriptors`` may be mapped from a file (:mod:`deixis.perception.recognition.views`).
    """

    ids: tuple[str, ...]
    descriptors: NDArray[np.float32]  # (n, d)
    starts: NDArray[np.int64]  # (m + 1,)

    @classmethod
    def of(cls, views: Iterable[tuple[str, NDArray[np.float32]]]) -> PackedViews:
        """Return views by id, each with its descriptors (k, d); raises RecognitionError for what :func:`checked`
        refuses."""
        named = list(views)
        ids = tuple(name for name, _ in named)
        if not named:
            return cls((), np.empty((0, 0), np.float32), np.zeros(1, np.int64))
        _require_distinct(ids)
        size = named[0][1].shape[-1]
        arrays = [checked(f"view '{name}'", array, size) for name, array in named]
        if not all(map(len, arrays)):
            empty = next(name for name, array in named if not len(array))
            raise RecognitionError(f"view '{empty}' has no descriptor: there is nothing to compare")
        return cls(
            ids,
            np.concatenate(arrays),
            np.concatenate([[0], np.cumsum([len(array) for array in arrays])]).astype(np.int64),
        )

    def __len__(self) -> int:
        return len(self.ids)

    def __getitem__(self, place: int) -> NDArray[np.float32]:
        """Return the descriptors (k, d) of the view in that place."""
        return self.descriptors[self.starts[place] : self.starts[place + 1]]

    @property
    def size(self) -> int:
        """Numbers in a descriptor; 0 where there is no view."""
        return int(self.descriptors.shape[1])

    @cached_property
    def squares(self) -> NDArray[np.float32]:
        """Squared lengths (n,) of the descriptors."""
        return squared_lengths(self.descriptors).astype(np.float32)

    def joined(self, others: PackedViews) -> PackedViews:
        """Return these views and then the others."""
        if not len(self) or not len(others):
            return self if len(self) else others
        _require_distinct((*self.ids, *others.ids))
        if self.size != others.size:
            raise RecognitionError(f"descriptors of {others.size} numbers do not fit those of {self.size}")
        starts = np.concatenate([self.starts, others.starts[1:] + self.starts[-1]])
        return PackedViews((*self.ids, *others.ids), np.concatenate([self.descriptors, others.descriptors]), starts)

    def without(self, place: int) -> PackedViews:
        """Return all views but the one in that place."""
        rest = [(name, self[i]) for i, name in enumerate(self.ids) if i != place]
        return PackedViews.of(rest)


def checked(what: str, descriptors: NDArray[np.float32], size: int) -> NDArray[np.float32]:
    """Return descriptors (k, size) as they are compared: float32, in one piece, and finite; k may be 0."""
    if not isinstance(descriptors, np.ndarray) or descriptors.ndim != 2 or descriptors.shape[1] != size:
        found = getattr(descriptors, "shape", type(descriptors).__name__)
        raise RecognitionError(f"{what}: descriptors of shape (k, {size}) are wanted, not {found}")
    if size < 1 or descriptors.dtype.kind not in "fiu":
        raise RecognitionError(f"{what}: descriptors are rows of one number or more, not {descriptors.dtype} ({size})")
    if not (np.abs(descriptors) < MAX_COMPONENT).all():
        raise RecognitionError(f"{what}: a descriptor holds a number that is not finite, or above {MAX_COMPONENT:g}")
    return np.ascontiguousarray(descriptors, np.float32)


def squared_lengths(descriptors: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return squared lengths (n,), summed in double precision."""
    result: NDArray[np.float64] = np.einsum("ij,ij->i", descriptors, descriptors, dtype=np.float64)
    return result


def _require_distinct(ids: Sequence[str]) -> None:
    if len(set(ids)) < len(ids):
        twice = next(name for name in ids if list(ids).count(name) > 1)
        raise RecognitionError(f"the view '{twice}' comes twice")


_NAMES = ("descriptors.npy", "lengths.npy", "squares.npy", "ids.json")


def write_views(folder: Path, views: Iterable[tuple[str, NDArray[np.float32]]]) -> None:
    """Write views (id, descriptors (k, d)), one at a time, into a folder of their own, which is made.

    Raises RecognitionError where a view is empty or does not fit, a name comes twice, or the folder holds views.
    """
    folder.mkdir(parents=True, exist_ok=True)
    places = [folder / name for name in _NAMES]
    taken = next((place for place in places if place.exists()), None)
    if taken is not None:
        raise RecognitionError(f"{taken} is there already; choose another folder")
    ids: dict[str, int] = {}
    squares: list[NDArray[np.float32]] = []
    size = 0
    with places[0].open("wb") as file:
        _write_header(file, (0, 0))
        for name, descriptors in views:
            size = size or descriptors.shape[-1]
            rows = checked(f"view '{name}'", descriptors, size)
            if not len(rows) or name in ids:
                raise RecognitionError(f"view '{name}' {'comes twice' if name in ids else 'has no descriptor'}")
            ids[name] = len(rows)
            squares.append(squared_lengths(rows).astype(np.float32))
            file.write(rows.astype("<f4", copy=False).tobytes())
        file.seek(0)
        _write_header(file, (sum(ids.values()), size))
    np.save(places[1], np.array(list(ids.values()), np.int64))
    np.save(places[2], np.concatenate(squares) if squares else np.empty(0, np.float32))
    places[3].write_text(json.dumps(list(ids), ensure_ascii=False), encoding="utf-8")


def open_views(folder: Path) -> PackedViews:
    """Return the views of a folder, their descriptors mapped from the file; raises RecognitionError where it holds
    none."""
    try:
        descriptors = np.load(folder / _NAMES[0], mmap_mode="r", allow_pickle=False)
        lengths, squares = (np.load(folder / name, allow_pickle=False) for name in _NAMES[1:3])
        ids = json.loads((folder / _NAMES[3]).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RecognitionError(f"{folder} holds no views that can be read: {error}") from error
    fit = (
        descriptors.ndim == 2
        and descriptors.dtype == np.float32
        and squares.shape == (len(descriptors),)
        and lengths.shape == (len(ids),)
        and (lengths > 0).all()
        and lengths.sum() == len(descriptors)
    )
    if not fit:
        raise RecognitionError(f"the files in {folder} do not belong together; write the views again")
    starts = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
    views = PackedViews(tuple(ids), np.asarray(descriptors), starts)
    views.__dict__["squares"] = squares  # what the cached property would read the whole file for
    return views


def mapped(views: Iterable[tuple[str, NDArray[np.float32]]]) -> PackedViews:
    """Return views (id, descriptors (k, d)) on the disk alone, read one at a time; their file ends with what is
    returned.

    It is in the folder for temporary files (``TMPDIR``), without a name there. Raises RecognitionError where it cannot
    be written, and as :func:`write_views` does.
    """
    rest = iter(views)
    first = next(rest, None)
    if first is None:
        return PackedViews.of(())
    try:
        with TemporaryDirectory(prefix="deixis-", ignore_cleanup_errors=True) as folder:
            write_views(Path(folder) / "views", chain([first], rest))
            return open_views(Path(folder) / "views")  # what is mapped stays until nothing maps it
    except OSError as error:
        raise RecognitionError(
            f"{gettempdir()}: views cannot be written: {error.strerror or error}; set TMPDIR to a folder with room"
        ) from error


def _write_header(file: object, shape: tuple[int, int]) -> None:
    """Write a header of fixed length, so that it can be written again when the number of rows is known."""
    npy_format.write_array_header_1_0(file, {"descr": "<f4", "fortran_order": False, "shape": shape})  # type: ignore[arg-type]
