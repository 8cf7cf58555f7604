"""What perceptual memory raises on purpose, beside the errors of the room."""

from __future__ import annotations

from deixis.memory.errors import MemoryFormatError
from deixis.ontology.errors import DeixisError


class RecordError(DeixisError, ValueError):
    """A view, a category or a batch that cannot be kept: wrong arrays, names or metadata."""


class DamagedMemoryError(MemoryFormatError):
    """What is stored is not what was written: bytes have changed, or some are missing."""


class UnknownViewError(DeixisError, KeyError):
    """A view that the memory does not hold."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else "unknown view"


class UnknownCategoryError(DeixisError, KeyError):
    """A category that the memory does not hold."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else "unknown category"
