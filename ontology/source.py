"""Where a statement was written."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class Source:
    """A span of a file, lines and columns counted from 1, the end exclusive.

    >>> str(Source("dinner.layout", 3, 1, 3, 23))
    'dinner.layout:3:1'
    """

    file: str
    line: int
    column: int
    end_line: int
    end_column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"
