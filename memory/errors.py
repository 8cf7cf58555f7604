"""Errors that the memories raise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deixis.errors import DeixisError


class MemoryBusyError(DeixisError, BlockingIOError):
    """Another process, or this process already, has the memory open."""


class MemoryFormatError(DeixisError, ValueError):
    """A folder that is not a memory, a damaged memory, or one of a version that this program does not know."""


class MemoryWriteError(DeixisError, OSError):
    """The disk is full, the folder is read-only, or the store could not be read or written for another reason."""


class ReadOnlyMemoryError(MemoryWriteError):
    """A memory in a folder that cannot be written; it can only be read."""


class UnknownLessonError(DeixisError, KeyError):
    """A lesson that the memory does not hold."""


class QueryError(DeixisError, ValueError):
    """A query that cannot be run, or a result requested in a form that it does not have."""

    several_lines = True


class QueryTimeoutError(QueryError, TimeoutError):
    """A query that was not answered within its time limit."""


class QueryMemoryError(QueryError, MemoryError):
    """A query, or an answer, that needs more than its memory limit."""


class ImportFormatError(DeixisError, ValueError):
    """A file that cannot be imported: of an unknown format, malformed, too large, or with a DTD."""


class ShapesError(DeixisError, ValueError):
    """SHACL shapes that cannot be checked: malformed, or with a constraint that is refused."""


@dataclass(frozen=True, slots=True)
class ShapeResult:
    """One result of SHACL validation."""

    focus: str
    path: str | None
    message: str
    severity: str
    shape: str
    value: str | None = None

    def __str__(self) -> str:
        where = f"{self.focus}, {self.path}" if self.path else self.focus
        seen = f" (value: {self.value})" if self.value is not None else ""
        return f"{where}: {self.message}{seen} [{self.shape}]"


class RejectedWriteError(DeixisError, ValueError):
    """A write that would break the shapes, or contradicts the memory; nothing was written."""

    several_lines = True

    def __init__(self, message: str, results: Sequence[ShapeResult] = ()) -> None:
        self.results = tuple(results)
        super().__init__("\n".join([message, *map(str, self.results)]))


class RecordError(DeixisError, ValueError):
    """A view, a category or a batch that cannot be stored: wrong arrays, names or metadata."""


class DamagedMemoryError(MemoryFormatError):
    """Stored data that differs from what was written: bytes have changed or are missing."""


class UnknownViewError(DeixisError, KeyError):
    """A view that the memory does not hold."""


class UnknownCategoryError(DeixisError, KeyError):
    """A category that the memory does not hold."""


class EpisodeError(DeixisError, ValueError):
    """A fluent or a change that the blackboard cannot hold."""


class UnknownFluentError(DeixisError, KeyError):
    """A fluent that the blackboard does not hold."""
