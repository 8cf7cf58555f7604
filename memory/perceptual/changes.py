"""What a write comes to: keys with their values, to be written in one step."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from deixis.memory.perceptual import keys
from deixis.memory.perceptual.codec import About, write_about, write_category, write_order, write_view
from deixis.memory.perceptual.errors import DamagedMemoryError, UnknownViewError
from deixis.memory.perceptual.reading import Snapshot, stored_about
from deixis.memory.perceptual.records import Batch, CategoryRecord, View, check_name


@dataclass
class Change:
    """Keys with their values, None to delete; and how many more views there are then."""

    pairs: list[tuple[bytes, bytes | bytearray | None]] = field(default_factory=list)
    views: int = 0

    def add(self, view: View) -> None:
        """A view that was not there."""
        said, key, sealed = write_view(view)
        self.say(said)
        self.pairs.append((key, sealed))
        self.views += 1

    def say(self, said: About) -> None:
        """All of a view but its arrays."""
        self.pairs += [write_about(said), write_order(said)]

    def drop(self, said: About) -> None:
        """A view that is there."""
        self.pairs += [(said.key, None), (said.order_key, None), (said.arrays_key, None)]
        self.views -= 1


def of_batch(now: Any, batch: Batch) -> Change:
    """Views and records written and views forgotten, in a database or a snapshot of one.

    Raises UnknownViewError for a view that is not there.
    """
    change = Change()
    for id in batch.forgotten:
        said = stored_about(now, check_name("a view's id", id))
        if said is None:
            raise UnknownViewError(f"no view '{id}' to forget; nothing was written")
        change.drop(said)
    for view in batch.views:
        old = stored_about(now, view.id)
        if old is not None:
            change.drop(old)
        change.add(view)
    change.pairs += map(write_category, batch.categories)
    return change


def of_moving(now: Snapshot, category: str, record: CategoryRecord) -> Change:
    """All views of a category given to the one that the record is of; their arrays stay where they are."""
    change = Change()
    for said in _views_of(now, category):
        change.pairs.append((said.order_key, None))
        change.say(said._replace(category=record.name))
    change.pairs += [(keys.name_key(keys.CATEGORY, category), None), write_category(record)]
    return change


def of_forgetting(now: Snapshot, category: str) -> Change:
    """A category without its views and its record."""
    change = Change()
    for said in _views_of(now, category):
        change.drop(said)
    change.pairs.append((keys.name_key(keys.CATEGORY, category), None))
    return change


def _views_of(now: Snapshot, category: str) -> list[About]:
    found = []
    for _, id, _ in now.places(category):
        said = now.about(id)
        if said is None or said.category != category:
            raise DamagedMemoryError(f"view '{id}' of '{category}': what is said of it does not fit its place")
        found.append(said)
    return found
