"""Reading all of a database, and saying what is not as it was written."""

from __future__ import annotations

from collections.abc import Iterator

from deixis.memory.errors import MemoryFormatError, MemoryWriteError
from deixis.memory.perceptual import keys
from deixis.memory.perceptual.codec import Counts, named, read_about, read_category
from deixis.memory.perceptual.protocol import Finding, Progress
from deixis.memory.perceptual.reading import Snapshot

_WRONG = (MemoryFormatError, MemoryWriteError, ValueError)


def findings(now: Snapshot, progress: Progress | None = None) -> Iterator[Finding]:
    """What is wrong: in the counts, the categories, the views one by one, and in what belongs to no view."""
    counts = Counts(views=-1)
    try:
        counts = now.counts()
    except _WRONG as error:
        yield Finding("counts", _line(error))
    if counts.lost:
        yield Finding("counts", f"{counts.lost} batches that were acknowledged are not there")
    yield from _categories(now)
    found = 0
    try:
        for found, (key, sealed) in enumerate(now.pairs(keys.VIEW), start=1):
            yield from _view(now, key, sealed)
            if progress is not None:
                progress(found, max(counts.views, found))
    except _WRONG as error:
        yield Finding("order of views", f"it cannot be read to its end: {_line(error)}")
    if found != counts.views >= 0:
        yield Finding("counts", f"{counts.views} views were written, and {found} are there")
    yield from _strays(now)


def _categories(now: Snapshot) -> Iterator[Finding]:
    try:
        for key, sealed in now.pairs(keys.CATEGORY):
            name = key[1:].decode(errors="replace")
            try:
                read_category(name, sealed)
            except _WRONG as error:
                yield Finding(f"category '{name}'", _line(error))
    except _WRONG as error:
        yield Finding("categories", f"they cannot be read to their end: {_line(error)}")


def _view(now: Snapshot, key: bytes, sealed: bytes) -> Iterator[Finding]:
    where = named(key)
    try:
        said = read_about(key, sealed)
        found = now.about(said.id)
        if found is None or found.key != key:
            yield Finding(where, "there is another view with this id")
        now.view_of(said)
    except _WRONG as error:
        yield Finding(where, _line(error).removeprefix(f"{where}: "))


def _strays(now: Snapshot) -> Iterator[Finding]:
    """Arrays that belong to no view."""
    try:
        for key in now.bare_keys(keys.ARRAYS):
            try:
                said = now.about(keys.split_view_key(key)[1])
                if said is not None and said.arrays_key == key:
                    continue
            except _WRONG:
                continue  # told of with its view
            yield Finding(f"arrays at {key[1:60]!r}", "no view owns them")
    except _WRONG as error:
        yield Finding("arrays", f"they cannot be read to their end: {_line(error)}")


def _line(error: BaseException) -> str:
    return " ".join(str(error).split())
