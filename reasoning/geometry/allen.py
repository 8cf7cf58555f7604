"""Allen's interval algebra: the relation of every pair of intervals as an array, and convex sets of relations as orders
of end points.

Intervals are closed and of any length, a single point included. Touching counts as meeting before anything else, so
that a point at either end of an interval meets it or is met by it. Of the thirteen exactly one holds of every ordered
pair, and the relation of (b, a) is the converse of that of (a, b).

A set is convex where it is just what a choice of <, <=, =, >= and > between ends of the one and ends of the other says
(Nökel 1989; an interval in the lattice of Ligozat 1996); there are 82 that are not empty. Closure decides networks of
them and finds all that follows (van Beek 1992). Any other set is a union of convex ones.
"""

from __future__ import annotations

from functools import cache, lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.allen import ALL_ALLEN, Allen


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


LOW_A, HIGH_A, LOW_B, HIGH_B = range(4)
"""The end points of two intervals a and b."""

_COMPARED = ((LOW_A, LOW_B), (HIGH_A, HIGH_B), (HIGH_A, LOW_B), (LOW_A, HIGH_B))


class EndOrder(NamedTuple):
    """One end point is before another (``strict``), or not after it."""

    lesser: int
    greater: int
    strict: bool


class ConvexSet(NamedTuple):
    """A convex set as a 13-bit mask, and as few orders of end points as say the same."""

    mask: int
    orders: tuple[EndOrder, ...]


@cache
def convex_sets() -> tuple[ConvexSet, ...]:
    """All convex sets that are not empty, those of few orders first.

    >>> len(convex_sets())
    82
    """
    options = [_options(a, b) for a, b in _COMPARED]
    found: dict[int, ConvexSet] = {}
    for parts in sorted(product(*options), key=lambda parts: (sum(map(bool, parts)), sum(map(len, parts)))):
        orders = tuple(order for part in parts for order in part)
        mask = admitted(orders)
        if mask:
            found.setdefault(mask, ConvexSet(mask, orders))
    return tuple(found.values())


def _options(a: int, b: int) -> tuple[tuple[EndOrder, ...], ...]:
    """Nothing, <, <=, >, >= and = between two end points."""
    before, after = EndOrder(a, b, False), EndOrder(b, a, False)
    strictly = (before._replace(strict=True),), (after._replace(strict=True),)
    return ((), *strictly, (before,), (after,), (before, after))


@cache
def convex_hull(mask: int) -> ConvexSet:
    """The least convex set around a set that is not empty; convex sets meet in convex sets.

    >>> from deixis.ontology.allen import allen_mask, members
    >>> [relation.symbol for relation in members(convex_hull(allen_mask([Allen.BEFORE, Allen.OVERLAPS])).mask)]
    ['<', 'm', 'o']
    """
    return min((found for found in convex_sets() if mask & ~found.mask == 0), key=lambda found: found.mask.bit_count())


@cache
def convex_pieces(mask: int) -> tuple[ConvexSet, ...]:
    """A set of Allen relations as a union of convex sets, greedily few of them, the largest first.

    >>> from deixis.ontology.allen import allen_mask, members
    >>> pieces = convex_pieces(allen_mask([Allen.AFTER, Allen.BEFORE, Allen.MEETS]))
    >>> [[relation.symbol for relation in members(piece.mask)] for piece in pieces]
    [['<', 'm'], ['>']]
    """
    inside = [found for found in convex_sets() if found.mask & ~mask == 0]
    pieces: list[ConvexSet] = []
    missing = mask
    while missing:
        best = max(inside, key=lambda s: ((s.mask & missing).bit_count(), s.mask.bit_count(), -s.mask))
        pieces.append(best)
        missing &= ~best.mask
    return tuple(pieces)


_EXAMPLES = ((0, 1), (0, 2), (0, 3), (0, 5), (0, 6), (2, 3), (2, 5), (2, 6), (3, 4), (3, 5), (3, 6), (5, 6), (6, 7))
"""An interval in each relation, by code, to the interval from 2 to 5."""


def admitted(orders: tuple[EndOrder, ...]) -> int:
    """The Allen relations in which all orders hold, as a mask.

    >>> admitted((EndOrder(HIGH_A, LOW_B, strict=True),)) == 1 << Allen.BEFORE
    True
    """
    mask = ALL_ALLEN
    for order in orders:
        mask &= _admitted(order)
    return mask


@cache
def _admitted(order: EndOrder) -> int:
    """The Allen relations in which one order holds, as a mask."""
    mask = 0
    for relation, example in enumerate(_EXAMPLES):
        points = (*example, 2, 5)
        lesser, greater = points[order.lesser], points[order.greater]
        if lesser < greater or (lesser == greater and not order.strict):
            mask |= 1 << relation
    return mask
