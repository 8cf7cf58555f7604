"""Views in a folder, mapped into memory when they are needed: more of them than memory holds.

``descriptors.npy`` holds the descriptors one after the other, ``lengths.npy`` how many each view has, ``squares.npy``
their squared lengths, ``ids.json`` the names. Only what a search compares exactly is read from the first.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory, gettempdir

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.views import PackedViews, checked, squared_lengths

_NAMES = ("descriptors.npy", "lengths.npy", "squares.npy", "ids.json")


def write_views(folder: Path, views: Iterable[tuple[str, NDArray[np.float32]]]) -> None:
    """Writes views (id, descriptors (k, d)), one at a time, into a folder of their own, which is made.

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
        _header(file, (0, 0))
        for name, descriptors in views:
            size = size or descriptors.shape[-1]
            rows = checked(f"view '{name}'", descriptors, size)
            if not len(rows) or name in ids:
                raise RecognitionError(f"view '{name}' {'comes twice' if name in ids else 'has no descriptor'}")
            ids[name] = len(rows)
            squares.append(squared_lengths(rows).astype(np.float32))
            file.write(rows.astype("<f4", copy=False).tobytes())
        file.seek(0)
        _header(file, (sum(ids.values()), size))
    np.save(places[1], np.array(list(ids.values()), np.int64))
    np.save(places[2], np.concatenate(squares) if squares else np.empty(0, np.float32))
    places[3].write_text(json.dumps(list(ids), ensure_ascii=False), encoding="utf-8")


def open_views(folder: Path) -> PackedViews:
    """The views of a folder, their descriptors mapped from the file; raises RecognitionError where it holds none."""
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
    """Views (id, descriptors (k, d)) on the disk alone, read one at a time; their file ends with what is returned.

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


def _header(file: object, shape: tuple[int, int]) -> None:
    """A header of fixed length, so that it can be written again when the number of rows is known."""
    npy.write_array_header_1_0(file, {"descr": "<f4", "fortran_order": False, "shape": shape})  # type: ignore[arg-type]
