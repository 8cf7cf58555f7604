"""What a write comes to: keys with their values, to be written in one step."""

from __future__ import annotations

from dataclasses import dataclass, field

from deixis.memory.errors import DamagedMemoryError, UnknownViewError
from deixis.memory.perceptual import keys
from deixis.memory.perceptual.codec import About, read_about, write_about, write_category, write_view
from deixis.memory.perceptual.handle import Handle
from deixis.memory.perceptual.reading import Snapshot
from deixis.memory.perceptual.records import Batch, CategoryRecord, View, check_name


@dataclass(slots=True)
class Change:
    """Keys with their values, None to delete.

    ``places`` is where views are then, by id, None for a view that is gone; ``views``, how many more there are.
    """

    pairs: list[tuple[bytes, bytes | bytearray | None]] = field(default_factory=list)
    places: dict[str, bytes | None] = field(default_factory=dict)
    views: int = 0

    def add(self, view: View) -> None:
        """A view that is not there, or was dropped."""
        key, said, arrays_key, arrays = write_view(view)
        self.pairs += ((key, said), (arrays_key, arrays))
        self.places[view.id] = key
        self.views += 1

    def move(self, said: About, category: str) -> None:
        """A view that is there to another category; its arrays stay where they are."""
        moved = write_about(said.moved(category))
        self.pairs += ((said.key, None), moved)
        self.places[said.id] = moved[0]

    def drop(self, handle: Handle, id: str, key: bytes) -> None:
        """A view that is there, even a damaged one."""
        self.pairs += [(each, None) for each in (key, *_arrays_of(handle, id, key))]
        self.places[id] = None
        self.views -= 1


def _arrays_of(handle: Handle, id: str, key: bytes) -> list[bytes]:
    """The keys of a view's arrays; all that can be its, where what says so is damaged."""
    with Snapshot(handle) as now:
        try:
            said = now.about_at(key)
            return [] if said is None else [said.arrays_key]
        except DamagedMemoryError:
            return [other for other in now.bare_keys(keys.ARRAYS) if keys.split_view_key(other)[1] == id]


def of_batch(handle: Handle, batch: Batch) -> Change:
    """Views and records written, and views forgotten. Raises UnknownViewError for a view that is not there."""
    there, change = handle.places(), Change()
    for id in batch.forgotten:
        if check_name("a view's id", id) not in there:
            raise UnknownViewError(f"no view '{id}' to forget; nothing was written")
        change.drop(handle, id, there[id])
    for view in batch.views:
        if view.id in there:
            change.drop(handle, view.id, there[view.id])
        change.add(view)
    change.pairs += [write_category(record) for record in batch.categories]
    return change


def of_moving(now: Snapshot, category: str, record: CategoryRecord) -> Change:
    """All views of a category given to the one that the record is of; their arrays stay where they are.

    Raises DamagedMemoryError where something is said of a view that was not written.
    """
    change = Change()
    try:
        for key, sealed in now.pairs(keys.category_prefix(category)):
            change.move(read_about(key, sealed), record.name)
    except DamagedMemoryError as error:
        raise DamagedMemoryError(f"{error}; teach it again, or forget the category; nothing was changed") from error
    change.pairs += [(keys.name_key(keys.CATEGORY, category), None), write_category(record)]
    return change


def of_forgetting(handle: Handle, category: str) -> Change:
    """A category without its views and its record."""
    change = Change()
    for key in [key for key in handle.places().values() if key.startswith(keys.category_prefix(category))]:
        change.drop(handle, keys.split_view_key(key)[1], key)
    change.pairs.append((keys.name_key(keys.CATEGORY, category), None))
    return change
