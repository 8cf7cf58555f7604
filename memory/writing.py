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
    try:
        yield
    except (OSError, RuntimeError) as error:
        if isinstance(error, DeixisError):
            raise
        raise MemoryWriteError(
            f"the memory at {folder} could not be written ({one_line(error)}); see that the disk has room and the "
            "folder is writable, then try again: what was kept before is still there"
        ) from error


@contextmanager
def reading(folder: Path) -> Iterator[None]:
    """Turns what a failed read raises into MemoryWriteError."""
    try:
        yield
    except (OSError, RuntimeError) as error:
        if isinstance(error, DeixisError):
            raise
        raise MemoryWriteError(
            f"the memory at {folder} could not be read ({one_line(error)}); restore the folder from a copy"
        ) from error
