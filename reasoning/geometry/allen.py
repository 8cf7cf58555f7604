"""Allen's interval algebra: the relations of arrays of intervals, and convex sets as orders of end points.

Intervals are closed and may be of any length, including single points. Touching counts as meeting before anything else,
so a point at either end of an interval meets it or is met by it. Exactly one of the thirteen relations holds of every
ordered pair, and the relation of (b, a) is the converse of that of (a, b).

A set of relations is convex if it equals a conjunction of <, <=, =, >= and > between end points of the two intervals
(Nökel 1989; an interval in the lattice of Ligozat 1996). There are 82 non-empty convex sets. Path consistency decides
networks of them and gives all implied relations (van Beek 1992). Any other set is a union of convex ones.
"""

from __future__ import annotations

from functools import cache, lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relations.allen import ALL_ALLEN, Allen


def allen_relations(
    low_a: NDArray[np.float64],
    high_a: NDArray[np.float64],
    low_b: NDArray[np.float64],
    high_b: NDArray[np.float64],
    tolerance: float = 0.0,
) -> NDArray[np.int8]:
    """Return the Allen code of interval a to interval b, elementwise.

    Parameters
    ----------
    low_a, high_a, low_b, high_b
        End points of the intervals; the four arrays broadcast.
    tolerance
        Distance up to which two end points count as equal, in the unit of the intervals.

    Returns
    -------
    Codes of :class:`deixis.ontology.relations.allen.Allen`, in the broadcast shape.

    Examples
    --------
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
    """Return 0 where a < b, 1 where they are equal, and 2 where a > b."""
    difference = a - b
    return (1 + (difference > tolerance).astype(np.int8) - (difference < -tolerance).astype(np.int8)).astype(np.int8)


@lru_cache(maxsize=1)
def _table() -> NDArray[np.int8]:
    """Return the Allen codes by the signs of begins, of ends, of a's end to b's begin, and of a's begin to b's end."""
    table = np.empty((3, 3, 3, 3), dtype=np.int8)
    for index in np.ndindex(3, 3, 3, 3):
        table[index] = _code(*(order - 1 for order in index))
    return table


def _code(begins: int, ends: int, left: int, right: int) -> Allen:
    """Return the relation with these signs of four differences of end points (a minus b)."""
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
    """The statement that one end point is before another (``strict``), or not after it."""

    lesser: int
    greater: int
    strict: bool


class ConvexSet(NamedTuple):
    """A convex set as a 13-bit mask, and as the fewest orders of end points that define it."""

    mask: int
    orders: tuple[EndOrder, ...]


@cache
def convex_sets() -> tuple[ConvexSet, ...]:
    """Return all non-empty convex sets, those of the fewest orders first.

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
    """Return the possible constraints between two end points: none, <, <=, >, >= and =."""
    before, after = EndOrder(a, b, False), EndOrder(b, a, False)
    strictly = (before._replace(strict=True),), (after._replace(strict=True),)
    return ((), *strictly, (before,), (after,), (before, after))


@cache
def convex_hull(mask: int) -> ConvexSet:
    """Return the smallest convex set that contains a non-empty set; it is unique, since convex sets have convex meets.

    >>> from deixis.ontology.relations.allen import allen_mask, members
    >>> [relation.symbol for relation in members(convex_hull(allen_mask([Allen.BEFORE, Allen.OVERLAPS])).mask)]
    ['<', 'm', 'o']
    """
    return min((found for found in convex_sets() if mask & ~found.mask == 0), key=lambda found: found.mask.bit_count())


@cache
def convex_pieces(mask: int) -> tuple[ConvexSet, ...]:
    """Return a small union of convex sets that equals a set of Allen relations, found greedily, the largest first.

    >>> from deixis.ontology.relations.allen import allen_mask, members
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
"""One interval in each relation to the interval from 2 to 5, by code."""


def admitted(orders: tuple[EndOrder, ...]) -> int:
    """Return the mask of the Allen relations in which all orders hold.

    Parameters
    ----------
    orders
        Orders of the ends of two intervals.

    Returns
    -------
    int
        Bit mask over the 13 relations.

    Examples
    --------
    >>> admitted((EndOrder(HIGH_A, LOW_B, strict=True),)) == 1 << Allen.BEFORE
    True
    """
    mask = ALL_ALLEN
    for order in orders:
        mask &= _admitted(order)
    return mask


@cache
def _admitted(order: EndOrder) -> int:
    """Return the Allen relations in which one order holds, as a mask."""
    mask = 0
    for relation, example in enumerate(_EXAMPLES):
        points = (*example, 2, 5)
        lesser, greater = points[order.lesser], points[order.greater]
        if lesser < greater or (lesser == greater and not order.strict):
            mask |= 1 << relation
    return mask
