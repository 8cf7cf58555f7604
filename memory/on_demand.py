"""A memory that is opened by the first call that needs it, and held until it is closed."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Generic, Protocol, TypeVar

from deixis.memory.errors import MemoryFormatError


class Closable(Protocol):
    """A memory that can be closed."""

    def close(self) -> None:
        """Release the memory."""


Held = TypeVar("Held", bound=Closable)


class OnDemand(Generic[Held]):
    """A memory at a path, opened by ``open_at(path, create)`` on first use."""

    def __init__(self, path: Path, open_at: Callable[[Path, bool], Held]) -> None:
        self.path = path
        self._open_at = open_at
        self._held: Held | None = None
        self._closed = False

    @property
    def is_open(self) -> bool:
        """True while the memory is open."""
        return self._held is not None

    def get(self, create: bool = False) -> Held:
        """Return the open memory.

        Parameters
        ----------
        create
            True to make a memory where there is none.

        Returns
        -------
        Held
            The store.

        Raises
        ------
        DeixisError
            If there is no memory and ``create`` is False.
        """
        self.require_usable()
        if self._held is None:
            self._held = self._open_at(self.path, create)
        return self._held

    def release(self) -> None:
        """Close the memory, if it is open, until the next use."""
        if self._held is not None:
            held, self._held = self._held, None
            held.close()

    def close(self) -> None:
        """Close the memory for good: a later use raises MemoryFormatError."""
        self._closed = True
        self.release()

    def require_usable(self) -> None:
        """Raise MemoryFormatError if this is closed.

        Raises
        ------
        MemoryFormatError
            If this session is closed.
        """
        if self._closed:
            raise MemoryFormatError(f"{self.path}: this session is closed; open a new one")


def default_memory() -> Path:
    """Return ``$DEIXIS_MEMORY``, or the default folder for the user's data.

    Returns
    -------
    Path
        The path, which need not exist.
    """
    named = os.environ.get("DEIXIS_MEMORY")
    if named:
        return Path(named)
    data = os.environ.get("XDG_DATA_HOME")
    return (Path(data) if data else Path.home() / ".local" / "share") / "deixis" / "memory"
