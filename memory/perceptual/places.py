"""Where each view lies, by its id: held in memory, as nobody but the owner of a database changes it.

What is stored is in order of category and id, so that a view is found by its id alone only after all keys were read
once, which takes about 2 µs a view, and again never.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import plyvel

from deixis.memory.perceptual import keys


class Places(NamedTuple):
    """The key of what is said of each view, by id; and what kept the rest from being read, if anything did."""

    by_id: dict[str, bytes]
    damage: plyvel.Error | None


def read_places(source: Any) -> Places:
    """Of a database, or a snapshot of one."""
    found: dict[str, bytes] = {}
    try:
        for key in source.iterator(prefix=keys.VIEW, include_value=False, verify_checksums=True):
            found[keys.split_view_key(key)[1]] = key
    except plyvel.CorruptionError as error:
        return Places(found, error)
    return Places(found, None)
