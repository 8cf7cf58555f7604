"""A perceptual memory as a file, and a file as a memory: the user's data is the user's.

>>> import tempfile
>>> from deixis.memory.perceptual.transient import TransientMemory
>>> file = Path(tempfile.mkdtemp()) / "views.zip"
>>> export_views(TransientMemory(), file)
>>> import_views(file, TransientMemory())
Imported(views=0, categories=0, relearn=())
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from deixis.memory.errors import RejectedWriteError
from deixis.memory.perceptual.archive import Archive, counted, view_file, write_archive
from deixis.memory.perceptual.protocol import PerceptualMemory, Progress
from deixis.memory.perceptual.records import Batch, CategoryRecord, View

_STEP = 64 << 20  # bytes of arrays that are written in one step


@dataclass(frozen=True)
class Imported:
    """What an import brought: new views, records of categories, and the categories whose state must be learned anew."""

    views: int
    categories: int
    relearn: tuple[str, ...]


def export_views(memory: PerceptualMemory, file: str | Path, progress: Progress | None = None) -> None:
    """Writes everything as it is now into one file, the same bytes for the same content. Raises MemoryWriteError."""
    with memory.snapshot() as now:
        write_archive(now, Path(file), progress)


def import_views(file: str | Path, memory: PerceptualMemory, progress: Progress | None = None) -> Imported:
    """Takes in what :func:`export_views` wrote; what is there stays.

    All is read and compared before anything is written. Up to 64 MB go in in one step; a larger file in several, and
    if the disk is full before the last one, importing again goes on from there. A category's learned state is kept
    where it describes just the views that the category then has; elsewhere it is left out, and named in the result.
    Raises ImportFormatError for a file that cannot be believed, RejectedWriteError where it has another view of a
    known id.
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
        views = counted(archive.views(), 2 * len(archive), progress, len(archive))
        new = _write(views, memory, set(there), records)
    return Imported(new, len(records), relearn)


def _records(
    archive: Archive, memory: PerceptualMemory, there: dict[str, str], coming: dict[str, set[str]]
) -> tuple[list[CategoryRecord], tuple[str, ...]]:
    """The records to write, and the names of those that lose their state."""
    theirs = {record.name: record for record in archive.records()}
    held: dict[str, set[str]] = defaultdict(set)
    for id, category in there.items():
        held[category].add(id)
    records, relearn = [], []
    for name in sorted({*theirs, *coming}):
        if name not in memory.categories():
            records.append(theirs.get(name, CategoryRecord(name)))
        elif coming[name] <= held[name]:
            continue  # what is there knows more views
        elif held[name] <= coming[name]:
            records.append(theirs.get(name, CategoryRecord(name)))
        else:
            records.append(CategoryRecord(name, {}, memory.category(name).metadata))
            relearn.append(name)
    return records, tuple(relearn)


def _write(views: Iterable[View], memory: PerceptualMemory, known: set[str], records: list[CategoryRecord]) -> int:
    """Writes the views that are new, and the records with the last of them."""
    waiting: list[View] = []
    size = written = 0
    for view in views:
        if view.id in known:
            continue
        waiting.append(view)
        size += sum(array.nbytes for array in view.descriptors.values()) + (
            0 if view.points is None else view.points.nbytes
        )
        if size >= _STEP:
            memory.write(Batch(waiting))
            waiting, size, written = [], 0, written + len(waiting)
    if waiting or records:
        memory.write(Batch(waiting, records), sync=True)
    return written + len(waiting)
