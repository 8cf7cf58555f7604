"""Views as sets of descriptors, in one contiguous array, or mapped into memory from a folder.

>>> views = PackedViews.of([("a", np.zeros((2, 3), np.float32)), ("b", np.ones((1, 3), np.float32))])
>>> len(views), views.size, views[1].tolist()
(2, 3, [[1.0, 1.0, 1.0]])

In a folder, ``descriptors.npy`` holds the descriptors of all views in order, ``lengths.npy`` the number of descriptors
of each view, ``squares.npy`` their squared lengths, and ``ids.json`` the ids of the views. A search reads from
``descriptors.npy`` only the views that it compares exactly, so that there may be more views than memory holds.
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
"""Upper bound of the numbers in a descriptor, so that no square overflows in single precision."""


@dataclass(frozen=True, eq=False)
class PackedViews:
    """Set of m views; view i has the descriptors from ``starts[i]`` to ``starts[i + 1]``, at least one.

    ``descriptors`` may be mapped from a file.
    """

    ids: tuple[str, ...]
    descriptors: NDArray[np.float32]  # (n, d)
    starts: NDArray[np.int64]  # (m + 1,)

    @classmethod
    def of(cls, views: Iterable[tuple[str, NDArray[np.float32]]]) -> PackedViews:
        """Return a set of views.

        Parameters
        ----------
        views
            Pairs of an id and descriptors of shape (k, d).

        Returns
        -------
        PackedViews
            Views in the given order.

        Raises
        ------
        RecognitionError
            If an id is repeated, a view has no descriptor, or :func:`checked` rejects descriptors.
        """
        named = list(views)
        ids = tuple(name for name, _ in named)
        if not named:
            return cls((), np.empty((0, 0), np.float32), np.zeros(1, np.int64))
        _require_distinct(ids)
        size = named[0][1].shape[-1]
        arrays = [checked(f"view '{name}'", array, size) for name, array in named]
        if not all(map(len, arrays)):
            empty = next(name for name, array in named if not len(array))
            raise RecognitionError(f"view '{empty}' must have at least one descriptor, got none")
        return cls(
            ids,
            np.concatenate(arrays),
            np.concatenate([[0], np.cumsum([len(array) for array in arrays])]).astype(np.int64),
        )

    def __len__(self) -> int:
        return len(self.ids)

    def __getitem__(self, place: int) -> NDArray[np.float32]:
        """Return the descriptors (k, d) of the view with an index."""
        return self.descriptors[self.starts[place] : self.starts[place + 1]]

    @property
    def size(self) -> int:
        """Length of a descriptor; 0 if there is no view."""
        return int(self.descriptors.shape[1])

    @cached_property
    def squares(self) -> NDArray[np.float32]:
        """Squared lengths (n,) of the descriptors."""
        return squared_lengths(self.descriptors).astype(np.float32)

    def joined(self, others: PackedViews) -> PackedViews:
        """Return these views, followed by the others.

        Parameters
        ----------
        others
            Views with other ids.

        Returns
        -------
        PackedViews
            Views in both orders, one after the other.

        Raises
        ------
        RecognitionError
            If an id is repeated, or descriptors differ in length.
        """
        if not len(self) or not len(others):
            return self if len(self) else others
        _require_distinct((*self.ids, *others.ids))
        if self.size != others.size:
            raise RecognitionError(f"descriptors must have {self.size} numbers, got {others.size}")
        starts = np.concatenate([self.starts, others.starts[1:] + self.starts[-1]])
        return PackedViews((*self.ids, *others.ids), np.concatenate([self.descriptors, others.descriptors]), starts)

    def without(self, place: int) -> PackedViews:
        """Return all views except the one with an index.

        Parameters
        ----------
        place
            Index of the view.

        Returns
        -------
        PackedViews
            Views in the given order.
        """
        rest = [(name, self[i]) for i, name in enumerate(self.ids) if i != place]
        return PackedViews.of(rest)


def checked(what: str, descriptors: NDArray[np.float32], size: int) -> NDArray[np.float32]:
    """Return descriptors as a contiguous float32 array if they are valid.

    Parameters
    ----------
    what
        Name of the descriptors in errors.
    descriptors
        Descriptors of shape (k, size); k may be 0.
    size
        Length of a descriptor.

    Returns
    -------
    ndarray
        Descriptors of shape (k, size).

    Raises
    ------
    RecognitionError
        If the shape is another one, or numbers are not finite or not below ``MAX_COMPONENT``.
    """
    if not isinstance(descriptors, np.ndarray) or descriptors.ndim != 2 or descriptors.shape[1] != size:
        found = getattr(descriptors, "shape", type(descriptors).__name__)
        raise RecognitionError(f"{what}: descriptors must have shape (k, {size}), got {found}")
    if size < 1 or descriptors.dtype.kind not in "fiu":
        raise RecognitionError(
            f"{what}: descriptors must be rows of at least one number, got {descriptors.dtype} ({size})"
        )
    if not (np.abs(descriptors) < MAX_COMPONENT).all():
        raise RecognitionError(f"{what}: the numbers in a descriptor must be finite and below {MAX_COMPONENT:g}")
    return np.ascontiguousarray(descriptors, np.float32)


def squared_lengths(descriptors: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the squared lengths of descriptors, summed in double precision.

    Parameters
    ----------
    descriptors
        Descriptors of shape (n, d).

    Returns
    -------
    ndarray
        Squared lengths of shape (n,).
    """
    result: NDArray[np.float64] = np.einsum("ij,ij->i", descriptors, descriptors, dtype=np.float64)
    return result


def _require_distinct(ids: Sequence[str]) -> None:
    if len(set(ids)) < len(ids):
        twice = next(name for name in ids if list(ids).count(name) > 1)
        raise RecognitionError(f"the ids of views must be distinct, got '{twice}' twice")


_NAMES = ("descriptors.npy", "lengths.npy", "squares.npy", "ids.json")


def write_views(folder: Path, views: Iterable[tuple[str, NDArray[np.float32]]]) -> None:
    """Write views one at a time into a folder.

    Parameters
    ----------
    folder
        Folder, which is created if needed.
    views
        Pairs of an id and descriptors of shape (k, d).

    Raises
    ------
    RecognitionError
        If a view has no or unfitting descriptors, an id is repeated, or the folder holds views.
    """
    folder.mkdir(parents=True, exist_ok=True)
    places = [folder / name for name in _NAMES]
    taken = next((place for place in places if place.exists()), None)
    if taken is not None:
        raise RecognitionError(f"{taken} exists already; choose another folder")
    ids: dict[str, int] = {}
    squares: list[NDArray[np.float32]] = []
    size = 0
    with places[0].open("wb") as file:
        _write_header(file, (0, 0))
        for name, descriptors in views:
            size = size or descriptors.shape[-1]
            rows = checked(f"view '{name}'", descriptors, size)
            if not len(rows) or name in ids:
                raise RecognitionError(f"view '{name}' {'occurs twice' if name in ids else 'has no descriptor'}")
            ids[name] = len(rows)
            squares.append(squared_lengths(rows).astype(np.float32))
            file.write(rows.astype("<f4", copy=False).tobytes())
        file.seek(0)
        _write_header(file, (sum(ids.values()), size))
    np.save(places[1], np.array(list(ids.values()), np.int64))
    np.save(places[2], np.concatenate(squares) if squares else np.empty(0, np.float32))
    places[3].write_text(json.dumps(list(ids), ensure_ascii=False), encoding="utf-8")


def open_views(folder: Path) -> PackedViews:
    """Return the views of a folder, with descriptors mapped from the file.

    Parameters
    ----------
    folder
        Folder that :func:`write_views` wrote.

    Returns
    -------
    PackedViews
        Views whose descriptors are read when they are used.

    Raises
    ------
    RecognitionError
        If the folder holds no views, or they are damaged.
    """
    try:
        descriptors = np.load(folder / _NAMES[0], mmap_mode="r", allow_pickle=False)
        lengths, squares = (np.load(folder / name, allow_pickle=False) for name in _NAMES[1:3])
        ids = json.loads((folder / _NAMES[3]).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise RecognitionError(f"{folder} holds no readable views: {error}") from error
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
    views.__dict__["squares"] = squares  # fills the cached property, which would read the whole file
    return views


def mapped(views: Iterable[tuple[str, NDArray[np.float32]]]) -> PackedViews:
    """Return views that are kept on disk instead of in memory.

    The file is an unnamed one in the folder for temporary files (``TMPDIR``), and is freed with the returned object.

    Parameters
    ----------
    views
        Pairs of an id and descriptors of shape (k, d), which are written one at a time.

    Returns
    -------
    PackedViews
        Views whose descriptors are read when they are used.

    Raises
    ------
    RecognitionError
        If the file cannot be written, or :func:`write_views` rejects a view.
    """
    rest = iter(views)
    first = next(rest, None)
    if first is None:
        return PackedViews.of(())
    try:
        with TemporaryDirectory(prefix="deixis-", ignore_cleanup_errors=True) as folder:
            write_views(Path(folder) / "views", chain([first], rest))
            return open_views(Path(folder) / "views")  # the mapped file stays until nothing maps it
    except OSError as error:
        raise RecognitionError(
            f"{gettempdir()}: views cannot be written: {error.strerror or error}; set TMPDIR to a folder with room"
        ) from error


def _write_header(file: object, shape: tuple[int, int]) -> None:
    """Write a header of fixed length, which is overwritten when the number of rows is known."""
    npy_format.write_array_header_1_0(file, {"descr": "<f4", "fortran_order": False, "shape": shape})  # type: ignore[arg-type]
