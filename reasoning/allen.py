"""Allen's interval algebra on arrays: the relation between every pair of intervals (Allen 1983).

Intervals are closed and of any length, a single point included. Touching counts as meeting before anything else, so
that a point at either end of an interval meets it or is met by it. Of the thirteen exactly one holds of every ordered
pair, and the relation of (b, a) is the converse of that of (a, b).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.allen import Allen


def allen_relations(
    low_a: NDArray[np.float64],
    high_a: NDArray[np.float64],
    low_b: NDArray[np.float64],
    high_b: NDArray[np.float64],
    tolerance: float = 0.0,
) -> NDArray[np.int8]:
    """The Allen code of interval a to interval b, elementwise; the four arrays broadcast.

    End points that differ by at most ``tolerance`` (in the unit of the intervals) count as equal.

    >>> a, b = np.array([0.0]), np.array([2.0])
    >>> Allen(allen_relations(a, a + 2, b, b + 1)[0]).symbol
    'm'
    """
    begins = _sign(low_a, low_b, tolerance)
    ends = _sign(high_a, high_b, tolerance)
    left = _sign(high_a, low_b, tolerance)
    right = _sign(low_a, high_b, tolerance)
    return _table()[begins, ends, left, right]


def _sign(a: NDArray[np.float64], b: NDArray[np.float64], tolerance: float) -> NDArray[np.int8]:
    """0 where a < b, 1 where equal, 2 where a > b."""
    difference = a - b
    return (1 + (difference > tolerance).astype(np.int8) - (difference < -tolerance).astype(np.int8)).astype(np.int8)


@lru_cache(maxsize=1)
def _table() -> NDArray[np.int8]:
    """Allen code by the order of begins, of ends, of a's end to b's begin, and of a's begin to b's end."""
    table = np.empty((3, 3, 3, 3), dtype=np.int8)
    for index in np.ndindex(3, 3, 3, 3):
        table[index] = _code(*(order - 1 for order in index))
    return table


def _code(begins: int, ends: int, left: int, right: int) -> Allen:
    """The relation from the signs of four end-point differences (a minus b)."""
    if begins == 0 and ends == 0:
        return Allen.EQUALS
    if left < 0:
        return Allen.BEFORE
    if right > 0:
        return Allen.AFTER
    if left == 0:
        return Allen.MEETS
    if right == 0:
        return Allen.MET_BY
    inner = {
        (-1, -1): Allen.OVERLAPS,
        (-1, 0): Allen.FINISHED_BY,
        (-1, 1): Allen.CONTAINS,
        (0, -1): Allen.STARTS,
        (0, 1): Allen.STARTED_BY,
        (1, -1): Allen.DURING,
        (1, 0): Allen.FINISHES,
        (1, 1): Allen.OVERLAPPED_BY,
    }
    return inner[begins, ends]
