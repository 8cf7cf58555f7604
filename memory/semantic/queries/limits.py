"""What a query may take: time, memory, length and nesting."""

from __future__ import annotations

from dataclasses import dataclass

from deixis.memory.errors import QueryError, QueryMemoryError

QUERY_TIME_LIMIT = 30.0
"""Seconds."""

QUERY_MEMORY_LIMIT = 2**30
"""Bytes."""

ANSWER_SHARE = 16
"""An answer may take this part of the memory limit as text; read in and printed it takes several times as much."""

ROW_BYTES, CELL_BYTES = 64, 8
"""Bytes that a row of an answer takes without values, and each of its cells; text may say so much of them in three."""

MAX_LENGTH = 1_000_000
"""Maximum number of characters of a query."""

MAX_TOKENS = 50_000
"""Maximum number of words and signs of a query. Each operator of a chain such as ``1 + 1 + 1`` or ``{} UNION {}`` is a
level of recursion in Oxigraph."""

MAX_DEPTH = 100
"""Maximum nesting of brackets and of the prefix operators ``!``, ``-``, ``+`` and ``^``."""


@dataclass(frozen=True)
class QueryLimits:
    """What one query may take. Raises QueryError for what is no limit.

    Parameters
    ----------
    time
        Seconds, from the call to the answer.
    memory
        Bytes for evaluating it, beyond those of the open store. The answer may take a sixteenth of them: as text, and
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
        """Bytes that the answer may take as text."""
        return self.memory // ANSWER_SHARE

    def too_large(self) -> QueryMemoryError:
        """Return the error for an answer that takes more than it may."""
        return QueryMemoryError(
            f"query: the answer is larger than {in_words(self.answer)}, the share of the memory limit that an answer "
            "may take; ask for less with LIMIT, or raise the limit"
        )


def in_words(size: int) -> str:
    """Return a number of bytes as it is said in a message."""
    return f"{size / 2**20:,.0f} MiB" if size >= 2**20 else f"{size:,} bytes"
