"""What the store raises, as errors that say what to do."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from deixis.memory.errors import MemoryWriteError
from deixis.memory.folder import one_line
from deixis.ontology.errors import DeixisError


@contextmanager
def committed(folder: Path) -> Iterator[None]:
    """Turns what a failed write raises into MemoryWriteError."""
    advice = (
        "see that the disk has room and the folder is writable, then try again: what was kept before is still there"
    )
    with _told(folder, "written", advice):
        yield


@contextmanager
def reading(folder: Path) -> Iterator[None]:
    """Turns what a failed read raises into MemoryWriteError."""
    with _told(folder, "read", "restore the folder from a copy"):
        yield


@contextmanager
def _told(folder: Path, done: str, advice: str) -> Iterator[None]:
    try:
        yield
    except (OSError, RuntimeError) as error:
        if isinstance(error, DeixisError):
            raise
        raise MemoryWriteError(f"the memory at {folder} could not be {done} ({one_line(error)}); {advice}") from error
