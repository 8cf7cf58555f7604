"""Allen's thirteen relations between two intervals (Allen 1983), as names and codes.

The codes follow the conceptual neighbourhood, so that the converse of code ``i`` is code ``12 - i``. Reasoning with
the relations is in :mod:`deixis.reasoning.geometry.allen`.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    pass


class Allen(IntEnum):
    """One of the thirteen basic relations of interval *a* to interval *b*.

    >>> Allen.BEFORE.converse
    <Allen.AFTER: 12>
    >>> Allen.FINISHED_BY.symbol
    'fi'
    """

    BEFORE = 0  # a ends before b begins
    MEETS = 1  # a ends where b begins
    OVERLAPS = 2  # a begins first and ends within b
    FINISHED_BY = 3  # a begins first, both end together
    CONTAINS = 4  # b lies strictly within a
    STARTS = 5  # both begin together, a ends first
    EQUALS = 6  # both ends are the same
    STARTED_BY = 7  # both begin together, b ends first
    DURING = 8  # a lies strictly within b
    FINISHES = 9  # b begins first, both end together
    OVERLAPPED_BY = 10  # a begins within b and ends after it
    MET_BY = 11  # a begins where b ends
    AFTER = 12  # a begins after b has ended

    @property
    def converse(self) -> Allen:
        """Relation of *b* to *a*."""
        return Allen(12 - self)

    @property
    def symbol(self) -> str:
        """Allen's symbol: ``<``, ``m``, ``o``, …, ``>``."""
        return SYMBOLS[self]


SYMBOLS: tuple[str, ...] = ("<", "m", "o", "fi", "di", "s", "=", "si", "d", "f", "oi", "mi", ">")
ALL_ALLEN = (1 << 13) - 1


def allen_mask(relations: Iterable[Allen]) -> int:
    """Return a set of Allen relations as a 13-bit mask, bit *i* for code *i*.

    Parameters
    ----------
    relations
        The relations.

    Returns
    -------
    int
        The mask.

    Examples
    --------
    >>> allen_mask([Allen.BEFORE, Allen.MEETS])
    3
    """
    mask = 0
    for relation in relations:
        mask |= 1 << relation
    return mask


def members(mask: int) -> tuple[Allen, ...]:
    """Return the relations in a 13-bit mask, in the order of their codes.

    Parameters
    ----------
    mask
        The mask.

    Returns
    -------
    tuple of Allen
        The relations.

    Examples
    --------
    >>> [r.symbol for r in members(0b11)]
    ['<', 'm']
    """
    return tuple(relation for relation in Allen if mask >> relation & 1)
