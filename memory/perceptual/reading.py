"""Snapshots of a perceptual database, and its verification."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from deixis.memory.errors import (
    DamagedMemoryError,
    MemoryFormatError,
    MemoryWriteError,
    UnknownCategoryError,
    UnknownViewError,
)
from deixis.memory.folder import size
from deixis.memory.owner import Closing
from deixis.memory.perceptual.database import keys
from deixis.memory.perceptual.database.codec import (
    StoreCounts,
    ViewHeader,
    named,
    read_about,
    read_category,
    read_counts,
    read_name,
    read_view,
)
from deixis.memory.perceptual.database.handle import Handle, Places, closed, read_places
from deixis.memory.perceptual.database.layout import VERSION
from deixis.memory.perceptual.protocol import (
    Finding,
    PerceptualReading,
    PerceptualStats,
    Progress,
    ViewKey,
)
from deixis.memory.perceptual.records import CategoryRecord, Json, View, check_name
from deixis.spelling import nearest

MAX_LISTED = 5
"""Maximum number of categories that a message lists."""

_WRONG = (MemoryFormatError, MemoryWriteError, ValueError)


class Snapshot(Closing, PerceptualReading):
    """A snapshot of a database, until it is closed.

    Every value is verified: all have a checksum of this program, and all except arrays are also read with LevelDB's.
    """

    def __init__(self, handle: Handle) -> None:
        self._handle = handle
        self._then: Places | None = None
        with handle as db:
            self._source: Any = handle.keep(db.snapshot())

    def close(self) -> None:
        """Release the snapshot."""
        source, self._source = self._source, None
        if source is not None:
            self._handle.let_go(source)

    def __del__(self) -> None:
        if hasattr(self, "_source"):
            self.close()

    @property
    def _open(self) -> Any:
        if self._source is None:
            raise closed()
        return self._source

    def get(self, key: bytes) -> bytes | None:
        """Return a value, or None.

        Parameters
        ----------
        key
            Key of the value.

        Returns
        -------
        bytes or None
            Value with its checksum.
        """
        with self._handle:
            value: bytes | None = self._open.get(key, verify_checksums=True)
            return value

    def pairs(self, begin: bytes) -> Iterator[tuple[bytes, bytes]]:
        """Iterate over the keys with a prefix, with their values, in order.

        Parameters
        ----------
        begin
            Prefix of the keys.

        Yields
        ------
        tuple
            Key and value, which has its checksum.
        """
        return self._walk(_same, prefix=begin)

    def bare_keys(self, begin: bytes) -> Iterator[bytes]:
        """Iterate over the keys with a prefix, in order.

        Parameters
        ----------
        begin
            Prefix of the keys.

        Yields
        ------
        bytes
            Keys, without reading the values.
        """
        return self._walk(_same, prefix=begin, include_value=False)

    def _walk(self, made: Callable[[Any], Any], **what: Any) -> Iterator[Any]:
        """Iterate over ``made(item)`` of each item, with one call in progress at a time."""
        with self._handle:
            found = self._handle.keep(self._open.iterator(verify_checksums=True, **what))
        try:
            while True:
                with self._handle:
                    item = next(found, None)
                    if item is None:
                        return
                    result = made(item)
                yield result
        finally:
            self._handle.let_go(found)

    def first_after(self, key: bytes, kind: bytes) -> tuple[bytes, bytes] | None:
        """Return the first key of a kind at or after a key, with its value.

        Parameters
        ----------
        key
            Key to start from.
        kind
            First byte of the keys.

        Returns
        -------
        tuple or None
            Key and value; None if there is no such key.
        """
        with (
            self._handle,
            self._open.iterator(start=key, stop=keys.after(kind), verify_checksums=True) as found,
        ):
            pair: tuple[bytes, bytes] | None = next(found, None)
            return pair

    def about(self, view_id: str) -> ViewHeader | None:
        """Return the header of a view, or None.

        Parameters
        ----------
        view_id
            Id of the view.

        Returns
        -------
        ViewHeader or None
            Header at the time of the snapshot.

        Raises
        ------
        RecordError
            If the id is not valid.
        DamagedMemoryError
            If the header is damaged.
        """
        place = self._handle.place_of(check_name("a view's id", view_id))
        header = None if place is None else self.about_at(place)
        if header is None:  # at the time of the snapshot it was elsewhere, or did not exist
            place = self._places().get(view_id)
            header = None if place is None else self.about_at(place)
        return header

    def about_at(self, key: bytes) -> ViewHeader | None:
        """Return the header of the view with this key, or None.

        Parameters
        ----------
        key
            Key of the header.

        Returns
        -------
        ViewHeader or None
            Header at the time of the snapshot.

        Raises
        ------
        DamagedMemoryError
            If the header is damaged.
        """
        sealed = self.get(key)
        return None if sealed is None else read_about(key, sealed)

    def _places(self) -> dict[str, bytes]:
        """Return the key of each view in the snapshot; raise DamagedMemoryError where not all can be read."""
        with self._handle:
            if self._then is None:
                self._then = read_places(self._open)
            if self._then.damage is not None:
                raise self._then.damage
            return self._then.by_id

    def view(self, id: str) -> View:
        """Return one view."""
        header = self.about(id)
        if header is None:
            raise unknown_view(id)
        return self.view_of(header)

    def view_of(self, header: ViewHeader) -> View:
        """Return a view from its header.

        Parameters
        ----------
        header
            Header of the view.

        Returns
        -------
        View
            View with its arrays.

        Raises
        ------
        DamagedMemoryError
            If the arrays are missing or damaged.
        """
        with self._handle:
            return stored_arrays(self._open, header)

    def views(self, category: str | None = None) -> Iterator[View]:
        """Iterate over the views, reading them one by one."""
        return self._views(self._beginning(category))

    def _views(self, begin: bytes) -> Iterator[View]:
        with self._handle:
            arrays = self._handle.keep(self._open.iterator(prefix=keys.ARRAYS, fill_cache=False))
        try:
            yield from self._walk(partial(self._listed, arrays), prefix=begin)
        finally:
            self._handle.let_go(arrays)

    def _listed(self, walk: Any, pair: tuple[bytes, bytes]) -> View:
        """Return a view by its place in the order, near which its arrays usually are."""
        header = read_about(*pair)
        key = header.arrays_key
        found, arrays = next(walk, (b"", None))
        if found != key:  # after renaming and merging
            walk.seek(key)
            found, arrays = next(walk, (b"", None))
        return read_view(header, arrays if found == key else None)

    def listing(self, category: str | None = None) -> Iterator[ViewKey]:
        """Iterate over category, id and time of views, without reading arrays."""
        found = (read_about(*pair) for pair in self.pairs(self._beginning(category)))
        return (ViewKey(header.category, header.id, keys.moment(header.time)) for header in found)

    def _beginning(self, category: str | None) -> bytes:
        if category is None:
            return keys.VIEW
        self.require(category)
        return keys.category_prefix(category)

    def categories(self) -> tuple[str, ...]:
        """Return the names of the categories, with one look-up each, however many views they have."""
        names = {key[1:].decode() for key, _ in self.pairs(keys.CATEGORY)}
        pair = self.first_after(keys.VIEW, keys.VIEW)
        while pair is not None:
            name = read_about(*pair).category
            names.add(name)
            pair = self.first_after(keys.after(keys.category_prefix(name)), keys.VIEW)
        return tuple(sorted(names))

    def category(self, name: str) -> CategoryRecord:
        """Return the record of a category."""
        self.require(name)
        sealed = self.get(keys.name_key(keys.CATEGORY, name))
        return CategoryRecord(name) if sealed is None else read_category(name, sealed)

    def has(self, category: str) -> bool:
        """Return whether a category has a view or a record.

        Parameters
        ----------
        category
            Name of the category.

        Returns
        -------
        bool
            False for a category that was never taught.

        Raises
        ------
        RecordError
            If the name is not valid.
        """
        check_name("a category's name", category)
        if self.get(keys.name_key(keys.CATEGORY, category)) is not None:
            return True
        begin = keys.category_prefix(category)
        pair = self.first_after(begin, keys.VIEW)
        return pair is not None and pair[0].startswith(begin)

    def require(self, category: str) -> None:
        """Raise UnknownCategoryError, naming the nearest category, if a category is unknown.

        Parameters
        ----------
        category
            Name of the category.

        Raises
        ------
        UnknownCategoryError
            If the category has no view and no record.
        """
        if not self.has(category):
            raise unknown_category(category, self.categories())

    def lessons_of_views(self) -> dict[str, str]:
        """Return the lesson of each view that belongs to one, by the view's id."""
        return {key[1:].decode(): read_name(key, sealed) for key, sealed in self.pairs(keys.LESSON)}

    def teachings(self) -> dict[str, tuple[Json, ...]]:
        """Return all teachings of each view that was taught more than once, by the view's id."""
        found = ((key, read_name(key, sealed)) for key, sealed in self.pairs(keys.TEACHINGS))
        return {key[1:].decode(): tuple(json.loads(turns)) for key, turns in found}

    def headers(self) -> Iterator[ViewHeader]:
        """Iterate over the headers of all views, without reading arrays.

        Yields
        ------
        ViewHeader
            Headers in the order of :meth:`views`.

        Raises
        ------
        DamagedMemoryError
            At a damaged header.
        """
        return (read_about(*pair) for pair in self.pairs(keys.VIEW))

    def counts(self) -> StoreCounts:
        """Return the counts in the snapshot.

        Returns
        -------
        StoreCounts
            Counts of batches and views.

        Raises
        ------
        DamagedMemoryError
            If the counts are damaged.
        """
        return read_counts(self.get(keys.COUNT))

    def stats(self) -> PerceptualStats:
        """Return the counts, and the bytes on the disk."""
        counts = self.counts()
        return PerceptualStats(
            views=counts.views,
            categories=len(self.categories()),
            batches=counts.batches,
            lost=counts.lost,
            bytes=size(self._handle.folder),
            version=VERSION,
        )

    def verify(self, progress: Progress | None = None) -> tuple[Finding, ...]:
        """Return everything that differs from what was written."""
        return tuple(_findings(self, progress))


def glance(db: Any, place: bytes) -> View | None:
    """Return a view by the key of its header, without a snapshot.

    Parameters
    ----------
    db
        ``plyvel.DB`` of the memory.
    place
        Key of the header.

    Returns
    -------
    View or None
        View; None if it does not exist, is damaged, or was written by another thread in between, so that the checksum
        of the arrays differs from the one in the header.
    """
    sealed = db.get(place, verify_checksums=True)
    if sealed is None:
        return None
    try:
        header = read_about(place, sealed)
        return stored_arrays(db, header)
    except DamagedMemoryError:
        return None


def stored_arrays(source: Any, header: ViewHeader) -> View:
    """Return a view from its header and a database or a snapshot.

    Only arrays are read without LevelDB's checksums: the checksum in the header is stronger and covers the key.

    Parameters
    ----------
    source
        ``plyvel.DB``, or a snapshot of one.
    header
        Header of the view.

    Returns
    -------
    View
        View with its arrays.

    Raises
    ------
    DamagedMemoryError
        If the arrays are missing or damaged.
    """
    return read_view(header, source.get(header.arrays_key, fill_cache=False))


def _same(item: Any) -> Any:
    return item


def unknown_view(id: str) -> UnknownViewError:
    """Return the error for an unknown view.

    Parameters
    ----------
    id
        Id of the view.

    Returns
    -------
    UnknownViewError
        Error to raise.
    """
    return UnknownViewError(f"no view '{id}' in this memory")


def unknown_category(name: str, known: tuple[str, ...]) -> UnknownCategoryError:
    """Return the error for an unknown category.

    Parameters
    ----------
    name
        Name of the category.
    known
        Names of the known categories.

    Returns
    -------
    UnknownCategoryError
        Error that names the nearest category, or lists some of them.
    """
    near = nearest(name, known)
    listed = ", ".join(known[:MAX_LISTED]) + (", among others" if len(known) > MAX_LISTED else "")
    others = f"the memory has: {listed}" if known else "the memory has no categories yet"
    hint = f"did you mean '{near}'?" if near else others
    return UnknownCategoryError(f"no category '{name}'; {hint}")


def _findings(now: Snapshot, progress: Progress | None = None) -> Iterator[Finding]:
    """Yield the damage in the counts, the categories, the views, and the arrays that belong to no view."""
    counts = StoreCounts(views=-1)
    try:
        counts = now.counts()
    except _WRONG as error:
        yield Finding("counts", _line(error))
    if counts.lost:
        yield Finding("counts", f"{counts.lost} acknowledged batches are missing")
    yield from _categories(now)
    found = 0
    try:
        for found, (key, sealed) in enumerate(now.pairs(keys.VIEW), start=1):
            yield from _view(now, key, sealed)
            if progress is not None:
                progress(found, max(counts.views, found))
    except _WRONG as error:
        yield Finding("order of views", f"it cannot be read completely: {_line(error)}")
    if found != counts.views >= 0:
        yield Finding("counts", f"{counts.views} views were written, but {found} are there")
    yield from _teachings(now)
    yield from _orphaned_arrays(now)


def _teachings(now: Snapshot) -> Iterator[Finding]:
    try:
        for view_id in now.teachings():
            if now.about(view_id) is None:
                yield Finding(f"teachings of view '{view_id}'", "they belong to no view")
    except _WRONG as error:
        yield Finding("teachings", f"they cannot be read completely: {_line(error)}")


def _categories(now: Snapshot) -> Iterator[Finding]:
    try:
        for key, sealed in now.pairs(keys.CATEGORY):
            name = key[1:].decode(errors="replace")
            try:
                read_category(name, sealed)
            except _WRONG as error:
                yield Finding(f"category '{name}'", _line(error))
    except _WRONG as error:
        yield Finding("categories", f"they cannot be read completely: {_line(error)}")


def _view(now: Snapshot, key: bytes, sealed: bytes) -> Iterator[Finding]:
    where = named(key)
    try:
        header = read_about(key, sealed)
        found = now.about(header.id)
        if found is None or found.key != key:
            yield Finding(where, "there is another view with this id")
        now.view_of(header)
    except _WRONG as error:
        yield Finding(where, _line(error).removeprefix(f"{where}: "))


def _orphaned_arrays(now: Snapshot) -> Iterator[Finding]:
    """Find arrays that belong to no view."""
    try:
        for key in now.bare_keys(keys.ARRAYS):
            try:
                header = now.about(keys.split_view_key(key)[1])
                if header is not None and header.arrays_key == key:
                    continue
            except _WRONG:
                continue  # reported with its view
            yield Finding(f"arrays at {key[1:60]!r}", "they belong to no view")
    except _WRONG as error:
        yield Finding("arrays", f"they cannot be read completely: {_line(error)}")


def _line(error: BaseException) -> str:
    return " ".join(str(error).split())
