"""A perceptual memory as one file: a zip archive of safetensors files, which other programs can read too.

``memory.json`` says format, version and numbers; then each record is a safetensors file of its own, in whose header,
under ``deixis``, stands in JSON what is not an array. Nothing is compressed, and the same content gives the same bytes.
"""

from __future__ import annotations

import json
import os
import re
import zipfile
from collections.abc import Iterable, Iterator
from datetime import datetime
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from deixis.memory.errors import ImportFormatError, MemoryWriteError, RecordError
from deixis.memory.owner import Closing
from deixis.memory.perceptual.protocol import PerceptualReading, Progress
from deixis.memory.perceptual.records import CategoryRecord, View, arrays_by_name, arrays_by_use
from deixis.memory.perceptual.tensors import pack

FORMAT, VERSION = "deixis-perceptual-memory", 1
_HEAD = "memory.json"
_ENTRY = re.compile(r"(categories|views)/\d{9}\.safetensors")
_BEGINNING = b"PK\x03\x04"  # of a zip archive with something in it
_LONG_AGO = (1980, 1, 1, 0, 0, 0)  # the earliest that a zip archive can say


def is_archive(file: Path) -> bool:
    """Whether a file is one, by looking at its beginning only."""
    try:
        with file.open("rb") as opened:
            return opened.read(len(_BEGINNING)) == _BEGINNING
    except OSError:
        return False


def write_archive(memory: PerceptualReading, file: Path, progress: Progress | None = None) -> None:
    """Writes all that a memory keeps; the file is there whole, or not at all. Raises MemoryWriteError."""
    new = file.with_name(file.name + ".new")
    try:
        with new.open("wb") as out, zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as archive:
            _fill(archive, memory, progress)
        os.replace(new, file)
    except OSError as error:
        if isinstance(error, MemoryWriteError):
            raise
        raise MemoryWriteError(f"{file}: cannot be written: {error.strerror or error}") from error
    finally:
        new.unlink(missing_ok=True)


def _fill(archive: zipfile.ZipFile, memory: PerceptualReading, progress: Progress | None) -> None:
    names = memory.categories()
    views = sum(1 for _ in memory.listing())
    head = {"format": FORMAT, "version": VERSION, "categories": len(names), "views": views}
    _add(archive, _HEAD, json.dumps(head, indent=2).encode() + b"\n")
    for number, name in enumerate(names):
        _add(archive, f"categories/{number:09}.safetensors", category_file(memory.category(name)))
    for number, view in enumerate(counted(memory.views(), views, progress)):
        _add(archive, f"views/{number:09}.safetensors", view_file(view))


def counted(views: Iterable[View], total: int, progress: Progress | None, before: int = 0) -> Iterator[View]:
    """The same views; ``progress`` is told of each, ``before`` so many having been seen to, of ``total``."""
    for done, view in enumerate(views, start=before + 1):
        yield view
        if progress is not None:
            progress(done, total)


def _add(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    archive.writestr(zipfile.ZipInfo(name, _LONG_AGO), content)


def view_file(view: View) -> bytes:
    """A view as a safetensors file."""
    said = {"id": view.id, "category": view.category, "time": view.time.isoformat(), "metadata": dict(view.metadata)}
    return b"".join(pack(arrays_by_name(view.descriptors, view.points), json.dumps(said, sort_keys=True)))


def category_file(record: CategoryRecord) -> bytes:
    """A category's record as a safetensors file."""
    said = {"name": record.name, "metadata": dict(record.metadata)}
    return b"".join(pack(record.state, json.dumps(said, sort_keys=True)))


class Archive(Closing):
    """An archive open for reading; believed in nothing. Use it as a context manager.

    Raises ImportFormatError, here and in every method, for what is not as :func:`write_archive` writes it.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        try:
            self._zip = zipfile.ZipFile(file)
        except zipfile.BadZipFile as error:
            raise ImportFormatError(
                f"{file}: no archive of views can be read: {error}; if it was cut short, get the whole file"
            ) from error
        except (OSError, ValueError, NotImplementedError) as error:
            raise ImportFormatError(f"{file}: no archive of views can be read: {error}") from error
        try:
            self._check_head()
        except BaseException:
            self._zip.close()
            raise

    def close(self) -> None:
        """Lets go of the file."""
        self._zip.close()

    def __len__(self) -> int:
        """How many views there are."""
        return self._views

    def records(self) -> Iterator[CategoryRecord]:
        """What learners left, one by one."""
        for name, said, arrays in self._entries("categories/"):
            with _told(self.file, name):
                yield CategoryRecord(said["name"], arrays, said["metadata"])

    def views(self) -> Iterator[View]:
        """The views, one by one."""
        for name, said, arrays in self._entries("views/"):
            with _told(self.file, name):
                time = datetime.fromisoformat(said["time"])
                yield View(said["id"], said["category"], time, *arrays_by_use(arrays), said["metadata"])

    def _check_head(self) -> None:
        if _HEAD not in self._zip.namelist():
            raise ImportFormatError(f"{self.file}: this is no export of a memory: it has no '{_HEAD}'")
        with _told(self.file, _HEAD):
            head = json.loads(self._read(_HEAD))
            if head["format"] != FORMAT:
                raise ValueError(f"it does not say {FORMAT}")
            if head["version"] > VERSION:
                raise ValueError(f"it was written by a newer version (format {head['version']}); upgrade deixis")
            names = [name for name in self._zip.namelist() if name != _HEAD]
            if len(names) != head["views"] + head["categories"] or len(set(names)) < len(names):
                raise ValueError(f"it says {head['views']} views and {head['categories']} categories; others are there")
            self._views: int = head["views"]
            foreign = [name for name in names if not _ENTRY.fullmatch(name)]
            if foreign:
                raise ValueError(f"{foreign[0][:60]!r} has no place in an archive of views")

    def _entries(self, folder: str) -> Iterator[tuple[str, dict[str, Any], dict[str, NDArray[Any]]]]:
        from safetensors.numpy import load

        for name in sorted(name for name in self._zip.namelist() if name.startswith(folder)):
            with _told(self.file, name):
                content = self._read(name)
                arrays = load(content)
                header = json.loads(content[8 : 8 + int.from_bytes(content[:8], "little")])
                said = json.loads(header["__metadata__"]["deixis"])
            yield name, said, arrays

    def _read(self, name: str) -> bytes:
        info = self._zip.getinfo(name)
        if info.compress_type != zipfile.ZIP_STORED or info.flag_bits & 1:
            raise ValueError("it is compressed or encrypted, as no archive of views is")
        return self._zip.read(info)


class _told:
    """Turns whatever goes wrong with an entry into ImportFormatError."""

    def __init__(self, file: Path, entry: str) -> None:
        self._where = f"{file}, {entry}"

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: object) -> None:
        from safetensors import SafetensorError

        wrong = (OSError, ValueError, KeyError, TypeError, AttributeError, zipfile.BadZipFile, SafetensorError)
        if isinstance(error, (RecordError, *wrong, RecursionError, OverflowError)):
            text = f"{error} is missing" if type(error) is KeyError else " ".join(str(error).split())
            raise ImportFormatError(f"{self._where}: {text}") from error
