"""Ordered stores of keys and values: the protocol, and one in memory that ends with the process.

>>> keys = TransientKeys()
>>> keys.write({b"b": b"2", b"a": b"1", b"c": None})
>>> list(keys.between(b"a", b"c")), keys.get(b"b")
([b'a', b'b'], b'2')
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping
from typing import Protocol


class Keys(Protocol):
    """An ordered store. A write is atomic, and what it wrote survives the end of the process unless it is transient."""

    def get(self, key: bytes) -> bytes | None:
        """Return the value of a key.

        Parameters
        ----------
        key
            The key.

        Returns
        -------
        bytes or None
            Its value; None if there is none.
        """
        ...

    def between(self, first: bytes, stop: bytes, most: int | None = None) -> Iterator[bytes]:
        """Iterate over keys in order.

        Parameters
        ----------
        first
            Smallest key.
        stop
            Smallest key that does not belong to the range.
        most
            Maximum number of keys; no limit by default.

        Returns
        -------
        iterator of bytes
            The keys.
        """
        ...

    def items(self, first: bytes, stop: bytes) -> Iterator[tuple[bytes, bytes]]:
        """Iterate over keys and values in order.

        Parameters
        ----------
        first
            Smallest key.
        stop
            Smallest key that does not belong to the range.

        Returns
        -------
        iterator of tuple
            Pairs of key and value.
        """
        ...

    def restored(self) -> bool:
        """Return False: a write in memory does not fail.

        Returns
        -------
        bool
            False.
        """
        ...

    def write(self, pairs: Mapping[bytes, bytes | None]) -> None:
        """Write keys with their values, and delete those without.

        Parameters
        ----------
        pairs
            Values by key; None to delete.
        """
        ...

    def close(self) -> None:
        """Do nothing: the content ends with the object."""
        ...


class TransientKeys(Keys):
    """Keys and values in memory. Keys are sorted when they are first read after a write."""

    def __init__(self) -> None:
        self._values: dict[bytes, bytes] = {}
        self._sorted: list[bytes] = []
        self._new: list[bytes] = []
        self._deleted = False

    def get(self, key: bytes) -> bytes | None:
        """Return the value of a key."""
        return self._values.get(key)

    def between(self, first: bytes, stop: bytes, most: int | None = None) -> Iterator[bytes]:
        """Iterate over keys in order."""
        keys = self._in_order()
        return iter(keys[bisect_left(keys, first) : bisect_left(keys, stop)][:most])

    def items(self, first: bytes, stop: bytes) -> Iterator[tuple[bytes, bytes]]:
        """Iterate over keys and values in order."""
        return iter([(key, self._values[key]) for key in self.between(first, stop)])

    def write(self, pairs: Mapping[bytes, bytes | None]) -> None:
        """Write keys with their values, and delete those without."""
        for key, value in pairs.items():
            if value is None:
                self._deleted |= self._values.pop(key, None) is not None
            else:
                if key not in self._values:
                    self._new.append(key)
                self._values[key] = value

    def restored(self) -> bool:
        """Return False: a write in memory does not fail."""
        return False

    def close(self) -> None:
        """Do nothing: the content ends with the object."""

    def _in_order(self) -> list[bytes]:
        if self._deleted:
            self._sorted, self._new, self._deleted = sorted(self._values), [], False
        elif self._new:
            self._sorted = sorted(self._sorted + sorted(self._new))
            self._new = []
        return self._sorted
