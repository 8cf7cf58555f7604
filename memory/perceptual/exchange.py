"""Export a perceptual memory to a file, and import such a file.

The file is a zip archive of safetensors files, which other programs can read too. ``memory.json`` has the format, its
version and the numbers of records; then each record is a safetensors file of its own, whose header has in JSON, under
``deixis``, what is not an array. Nothing is compressed, and the same content gives the same bytes.

>>> import tempfile
>>> from deixis.memory.perceptual.transient import TransientMemory
>>> file = Path(tempfile.mkdtemp()) / "views.zip"
>>> export_views(TransientMemory(), file)
>>> import_views(file, TransientMemory())
Imported(views=0, categories=0, relearn=())
"""

from __future__ import annotations

import json
import re
import zipfile
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from numpy.typing import NDArray
from safetensors import SafetensorError

from deixis.memory.errors import ImportFormatError, MemoryWriteError, RecordError, RejectedWriteError
from deixis.memory.owner import Closing
from deixis.memory.perceptual.database.codec import pack, unpack
from deixis.memory.perceptual.protocol import PerceptualMemory, Progress
from deixis.memory.perceptual.records import Batch, CategoryRecord, View, arrays_by_name, arrays_by_use

FORMAT, VERSION = "deixis-perceptual-memory", 1
_HEAD = "memory.json"
_ENTRY = re.compile(r"(categories|views)/\d{9}\.safetensors")
_BEGINNING = b"PK\x03\x04"  # of a zip archive with at least one entry
_LONG_AGO = (1980, 1, 1, 0, 0, 0)  # the earliest time of an entry in a zip archive
_STEP = 64 << 20  # bytes of arrays in one batch


@dataclass(frozen=True)
class Imported:
    """Result of an import: numbers of new views and records, and the categories whose state must be relearned."""

    views: int
    categories: int
    relearn: tuple[str, ...]


def export_views(memory: PerceptualMemory, file: str | Path, progress: Progress | None = None) -> None:
    """Write the content of a memory into one file; the same content gives the same bytes.

    Parameters
    ----------
    memory
        Memory to export, as it is at the time of the call.
    file
        File to write; it is replaced only once all is written.
    progress
        Called with the number of views done, and the number of all views.

    Raises
    ------
    MemoryWriteError
        If the file cannot be written.
    DamagedMemoryError
        If a view or a record is damaged.
    """
    with memory.snapshot() as now:
        path = Path(file)
        new = path.with_name(path.name + ".new")
        try:
            with new.open("wb") as out, zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as archive:
                names = now.categories()
                views = sum(1 for _ in now.listing())
                head = {"format": FORMAT, "version": VERSION, "categories": len(names), "views": views}
                _add(archive, _HEAD, json.dumps(head, indent=2).encode() + b"\n")
                for number, name in enumerate(names):
                    _add(archive, f"categories/{number:09}.safetensors", category_file(now.category(name)))
                for number, view in enumerate(counted(now.views(), views, progress)):
                    _add(archive, f"views/{number:09}.safetensors", view_file(view))
            new.replace(path)
        except OSError as error:
            if isinstance(error, MemoryWriteError):
                raise
            raise MemoryWriteError(f"{path}: cannot be written: {error.strerror or error}") from error
        finally:
            new.unlink(missing_ok=True)


def import_views(file: str | Path, memory: PerceptualMemory, progress: Progress | None = None) -> Imported:
    """Import a file that :func:`export_views` wrote, and keep what the memory has; all of it is imported or nothing.

    The learned state of a category is imported where it describes exactly the views that the category has afterwards;
    elsewhere it is left out, and the category is named in the result.

    Parameters
    ----------
    file
        Archive of views.
    memory
        Memory that receives the views.
    progress
        Called with the number of views done, and twice the number of views, since they are checked first.

    Returns
    -------
    Imported
        Numbers of new views and records, and the categories whose state is left out.

    Raises
    ------
    ImportFormatError
        The file is invalid.
    RejectedWriteError
        The file has a view with a known id and other content.
    """
    with Archive(Path(file)) as archive, memory.exclusive():
        there = {key.id: key.category for key in memory.listing()}
        coming: dict[str, set[str]] = defaultdict(set)
        for view in counted(archive.views(), 2 * len(archive), progress):
            if view.id in there and view_file(memory.view(view.id)) != view_file(view):
                raise RejectedWriteError(
                    f"{file}: its view '{view.id}' differs from the one in the memory; forget that one first, or "
                    "import into another memory"
                )
            coming[view.category].add(view.id)
        records, relearn = _records(archive, memory, there, coming)
        new = [id for ids in coming.values() for id in sorted(ids - set(there))]
        views = counted(archive.views(), 2 * len(archive), progress, len(archive))
        memory.write_all(_batches((view for view in views if view.id not in there), records), new)
    return Imported(len(new), len(records), relearn)


def _batches(views: Iterable[View], records: Sequence[CategoryRecord]) -> Iterator[Batch]:
    """Yield new views in batches of limited size; the last batch has the records of their categories."""
    waiting: list[View] = []
    size = 0
    for view in views:
        if size >= _STEP:
            yield Batch(waiting)
            waiting, size = [], 0
        waiting.append(view)
        size += sum(array.nbytes for array in view.descriptors.values())
        size += 0 if view.points is None else view.points.nbytes
    if waiting or records:
        yield Batch(waiting, records)


def _records(
    archive: Archive, memory: PerceptualMemory, there: dict[str, str], coming: dict[str, set[str]]
) -> tuple[list[CategoryRecord], tuple[str, ...]]:
    """Return the records to write, and the names of the categories that lose their state."""
    imported = {record.name: record for record in archive.records()}
    held: dict[str, set[str]] = defaultdict(set)
    for view_id, category in there.items():
        held[category].add(view_id)
    records, relearn = [], []
    for name in sorted({*imported, *coming}):
        if name not in memory.categories():
            records.append(imported.get(name, CategoryRecord(name)))
        elif coming[name] <= held[name]:
            continue  # the stored record covers more views
        elif held[name] <= coming[name]:
            records.append(imported.get(name, CategoryRecord(name)))
        else:
            records.append(CategoryRecord(name, {}, memory.category(name).metadata))
            relearn.append(name)
    return records, tuple(relearn)


def is_archive(file: Path) -> bool:
    """Return whether a file is an archive of views, judging by its first bytes.

    Parameters
    ----------
    file
        File, which may be missing.

    Returns
    -------
    bool
        False also for a file that cannot be read.
    """
    try:
        if not file.is_file():
            return False  # also for a pipe, which would be waited for
        with file.open("rb") as opened:
            return opened.read(len(_BEGINNING)) == _BEGINNING
    except OSError:
        return False


def counted(views: Iterable[View], total: int, progress: Progress | None, before: int = 0) -> Iterator[View]:
    """Iterate over views, and report the progress after each.

    Parameters
    ----------
    views
        Views to pass on.
    total
        Number of all views.
    progress
        Called with the number of views done, and ``total``.
    before
        Number of views done before the first.

    Yields
    ------
    View
        The views in order.
    """
    for done, view in enumerate(views, start=before + 1):
        yield view
        if progress is not None:
            progress(done, total)


def _add(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    archive.writestr(zipfile.ZipInfo(name, _LONG_AGO), content)


def view_file(view: View) -> bytes:
    """Return a view as a safetensors file.

    Parameters
    ----------
    view
        View to write.

    Returns
    -------
    bytes
        Content of the file; equal views give equal bytes.
    """
    entry = {"id": view.id, "category": view.category, "time": view.time.isoformat(), "metadata": dict(view.metadata)}
    return pack(arrays_by_name(view.descriptors, view.points), json.dumps(entry, sort_keys=True))


def category_file(record: CategoryRecord) -> bytes:
    """Return a category's record as a safetensors file.

    Parameters
    ----------
    record
        Record to write.

    Returns
    -------
    bytes
        Content of the file; equal records give equal bytes.
    """
    entry = {"name": record.name, "metadata": dict(record.metadata)}
    return pack(record.state, json.dumps(entry, sort_keys=True))


class Archive(Closing):
    """An archive open for reading, with every entry checked. Use it as a context manager.

    Every method raises ImportFormatError for content that :func:`export_views` does not write.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        try:
            self._zip = zipfile.ZipFile(file)
        except zipfile.BadZipFile as error:
            raise ImportFormatError(
                f"{file}: cannot be read as an archive of views: {error}; if it was cut short, get the whole file"
            ) from error
        except (OSError, ValueError, NotImplementedError) as error:
            raise ImportFormatError(f"{file}: cannot be read as an archive of views: {error}") from error
        try:
            self._check_head()
        except BaseException:
            self._zip.close()
            raise

    def close(self) -> None:
        """Close the file."""
        self._zip.close()

    def __len__(self) -> int:
        """Return the number of views."""
        return self._views

    def records(self) -> Iterator[CategoryRecord]:
        """Iterate over the records of categories.

        Yields
        ------
        CategoryRecord
            Records in the order of the archive.

        Raises
        ------
        ImportFormatError
            If an entry is malformed.
        """
        for name, entry, arrays in self._entries("categories/"):
            with _EntryErrors(self.file, name):
                yield CategoryRecord(entry["name"], arrays, entry["metadata"])

    def views(self) -> Iterator[View]:
        """Iterate over the views.

        Yields
        ------
        View
            Views in the order of the archive, read one by one.

        Raises
        ------
        ImportFormatError
            If an entry is malformed.
        """
        for name, entry, arrays in self._entries("views/"):
            with _EntryErrors(self.file, name):
                time = datetime.fromisoformat(entry["time"])
                yield View(entry["id"], entry["category"], time, *arrays_by_use(arrays), entry["metadata"])

    def _check_head(self) -> None:
        if _HEAD not in self._zip.namelist():
            raise ImportFormatError(f"{self.file}: this is not an export of a memory: it has no '{_HEAD}'")
        with _EntryErrors(self.file, _HEAD):
            head = json.loads(self._read(_HEAD))
            if head["format"] != FORMAT:
                raise ValueError(f"its format must be {FORMAT}")
            if head["version"] > VERSION:
                raise ValueError(f"it was written by a newer version (format {head['version']}); upgrade deixis")
            names = [name for name in self._zip.namelist() if name != _HEAD]
            if len(names) != head["views"] + head["categories"] or len(set(names)) < len(names):
                raise ValueError(
                    f"it lists {head['views']} views and {head['categories']} categories, not those in the file"
                )
            self._views: int = head["views"]
            foreign = [name for name in names if not _ENTRY.fullmatch(name)]
            if foreign:
                raise ValueError(f"{foreign[0][:60]!r} does not belong in an archive of views")

    def _entries(self, folder: str) -> Iterator[tuple[str, dict[str, Any], dict[str, NDArray[Any]]]]:
        for name in sorted(name for name in self._zip.namelist() if name.startswith(folder)):
            with _EntryErrors(self.file, name):
                arrays, note = unpack(self._read(name))
                entry = json.loads(note)
            yield name, entry, arrays

    def _read(self, name: str) -> bytes:
        info = self._zip.getinfo(name)
        if info.compress_type != zipfile.ZIP_STORED or info.flag_bits & 1:
            raise ValueError("it must be neither compressed nor encrypted")
        return self._zip.read(info)


class _EntryErrors:
    """Context manager that turns errors of an entry into ImportFormatError."""

    def __init__(self, file: Path, entry: str) -> None:
        self._where = f"{file}, {entry}"

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: object) -> None:
        wrong = (OSError, ValueError, KeyError, TypeError, AttributeError, zipfile.BadZipFile, SafetensorError)
        if isinstance(error, (RecordError, *wrong, RecursionError, OverflowError)):
            text = f"{error} is missing" if type(error) is KeyError else " ".join(str(error).split())
            raise ImportFormatError(f"{self._where}: {text}") from error
