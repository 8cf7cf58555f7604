"""Limits of queries: time, memory, length and nesting."""

from __future__ import annotations

from dataclasses import dataclass

from deixis.memory.errors import QueryError, QueryMemoryError

QUERY_TIME_LIMIT = 30.0
"""Default time limit of a query, in seconds."""

QUERY_MEMORY_LIMIT = 2**30
"""Default memory limit of a query, in bytes."""

ANSWER_SHARE = 16
"""An answer may take this fraction (1/16) of the memory limit as text; in the program it takes several times more."""

ROW_BYTES, CELL_BYTES = 64, 8
"""Bytes that a row without values takes, and those of each of its cells; three bytes of text can stand for a cell."""

MAX_LENGTH = 1_000_000
"""Maximum number of characters of a query."""

MAX_TOKENS = 50_000
"""Maximum number of tokens of a query.

Each operator of a chain such as ``1 + 1 + 1`` or ``{} UNION {}`` is a level of recursion in Oxigraph.
"""

MAX_DEPTH = 100
"""Maximum nesting of brackets and of the prefix operators ``!``, ``-``, ``+`` and ``^``."""


@dataclass(frozen=True)
class QueryLimits:
    """Limits of one query. Raises QueryError for an invalid limit.

    Parameters
    ----------
    time
        Seconds from the call to the answer.
    memory
        Bytes for the evaluation, beyond those of the open store. The answer may take a sixteenth of them: as text, and
        as rows without their values.
    """

    time: float = QUERY_TIME_LIMIT
    memory: int = QUERY_MEMORY_LIMIT

    def __post_init__(self) -> None:
        if not self.time >= 0:
            raise QueryError(f"the time limit of a query must be at least 0 seconds, got {self.time}")
        if self.memory < 1:
            raise QueryError(f"the memory limit of a query must be at least 1 byte, got {self.memory}")

    @property
    def answer(self) -> int:
        """Maximum number of bytes of the answer as text."""
        return self.memory // ANSWER_SHARE

    def too_large(self) -> QueryMemoryError:
        """Return the error for an answer that is too large.

        Returns
        -------
        QueryMemoryError
            The error, which is not raised.
        """
        return QueryMemoryError(
            f"query: the answer is larger than {in_words(self.answer)}, the share of the memory limit that an answer "
            "may take; ask for less with LIMIT, or raise the limit"
        )


def in_words(size: int) -> str:
    """Return a number of bytes as text for a message.

    Parameters
    ----------
    size
        Number of bytes.

    Returns
    -------
    str
        Number and unit.
    """
    return f"{size / 2**20:,.0f} MiB" if size >= 2**20 else f"{size:,} bytes"
