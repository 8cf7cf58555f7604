"""Allen's relations as orders of end points, and which of them given distances admit.

Of two proper intervals a and b four pairs of end points say everything: (a.start, b.start), (a.finish, b.finish),
(a.finish, b.start) and (a.start, b.finish). A set of Allen relations is *convex* where it is just what an order of
each pair out of <, <=, =, >=, > or nothing says: then it is a few difference constraints (Vilain & Kautz 1986;
Nökel 1989). Any other set is a union of convex ones.
"""

from __future__ import annotations

from functools import cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.allen import Allen, members
from deixis.reasoning.temporal.bounds import UNBOUNDED, ZERO, Bounds, add_arrays

START_A, FINISH_A, START_B, FINISH_B = range(4)
"""The four points of two fluents, in the order of all arrays here."""

PAIRS = ((START_A, START_B), (FINISH_A, FINISH_B), (FINISH_A, START_B), (START_A, FINISH_B))
_BEFORE, _SAME, _AFTER = 1, 2, 4
_STRICT = ZERO - 1

Constraint = tuple[int, int, int]
"""Tail, head, code: head minus tail is bounded."""


@cache
def _signs() -> NDArray[np.uint8]:
    """For each Allen relation and each of PAIRS, the order as one of three bits; shape (13, 4)."""
    from deixis.reasoning.allen import allen_relations

    ends = np.array([(a, b, c, d) for a, b in combinations(range(4), 2) for c, d in combinations(range(4), 2)])
    codes = allen_relations(*ends.T.astype(np.float64))
    signs = np.zeros((13, 4), dtype=np.uint8)
    for column, (p, q) in enumerate(PAIRS):
        signs[codes, column] = 1 << (1 + np.sign(ends[:, p] - ends[:, q]))
    return signs


def _satisfying(orders: tuple[int, ...]) -> int:
    """The mask of the Allen relations whose every order is among the bits allowed to its pair."""
    fits = (_signs() & np.array(orders, dtype=np.uint8) != 0).all(axis=1)
    return sum(1 << int(relation) for relation in np.flatnonzero(fits))


@cache
def _orders(mask: int) -> tuple[int, ...]:
    """The weakest order of each of PAIRS that every relation of a mask keeps; *< or >* is no convex one."""
    bits = np.bitwise_or.reduce(_signs()[[int(relation) for relation in members(mask)]], axis=0)
    return tuple(7 if order == _BEFORE | _AFTER else int(order) for order in bits)


def convex_hull(mask: int) -> int:
    """The smallest convex set of Allen relations around a set that is not empty.

    >>> from deixis.ontology.allen import allen_mask
    >>> [r.symbol for r in members(convex_hull(allen_mask([Allen.BEFORE, Allen.OVERLAPS])))]
    ['<', 'm', 'o']
    """
    return _satisfying(_orders(mask))


@cache
def convex_pieces(mask: int) -> tuple[int, ...]:
    """A set of Allen relations as a union of convex sets, greedily few of them, the largest first.

    >>> from deixis.ontology.allen import allen_mask
    >>> convex_pieces(allen_mask([Allen.BEFORE, Allen.MEETS])) == (0b11,)
    True
    >>> [[r.symbol for r in members(piece)] for piece in convex_pieces(allen_mask([Allen.AFTER, Allen.BEFORE]))]
    [['<'], ['>']]
    """
    inside = [convex for convex in _convex_sets() if convex & ~mask == 0]
    pieces: list[int] = []
    missing = mask
    while missing:
        best = max(inside, key=lambda convex: ((convex & missing).bit_count(), convex.bit_count(), -convex))
        pieces.append(best)
        missing &= ~best
    return tuple(pieces)


@cache
def _convex_sets() -> tuple[int, ...]:
    orders = (1, 2, 4, 3, 6, 7)
    sets = {_satisfying((a, b, c, d)) for a in orders for b in orders for c in orders for d in orders}
    return tuple(sorted(sets - {0}))


@cache
def necessary_orders(mask: int) -> tuple[Constraint, ...]:
    """As few orders of end points as say the convex hull of a mask, as difference constraints.

    >>> necessary_orders(1 << Allen.BEFORE) == ((START_B, FINISH_A, 0),)  # a.finish - b.start < 0
    True
    """
    orders, hull = _orders(mask), convex_hull(mask)
    for size in range(5):
        for kept in combinations(range(4), size):
            weakened = tuple(order if pair in kept else 7 for pair, order in enumerate(orders))
            if _satisfying(weakened) == hull:
                return tuple(c for pair in kept for c in _order_constraints(PAIRS[pair], orders[pair]))
    raise AssertionError("all four orders give the hull")


def _order_constraints(pair: tuple[int, int], order: int) -> tuple[Constraint, ...]:
    """One order, given as bits, of two points: at most two difference constraints."""
    p, q = pair
    found = []
    if not order & _AFTER:
        found.append((q, p, ZERO if order & _SAME else _STRICT))
    if not order & _BEFORE:
        found.append((p, q, ZERO if order & _SAME else _STRICT))
    return tuple(found)


@cache
def _definitions() -> NDArray[np.int64]:
    """The constraints that define each Allen relation, shape (13, k, 3), padded with unbounded ones."""
    rows = [necessary_orders(1 << relation) for relation in Allen]
    table = np.full((13, max(map(len, rows)), 3), UNBOUNDED, dtype=np.int64)
    for relation, row in enumerate(rows):
        table[relation, : len(row)] = row
    return table


def masks_of_pairs(distances: NDArray[np.int64], pairs: NDArray[np.int64]) -> NDArray[np.uint16]:
    """The Allen relations that pairs of fluents may bear to each other, by minimal distances between points.

    ``distances`` (m, m) must be closed; ``pairs`` (p, 4) holds the indices of START_A, FINISH_A, START_B, FINISH_B.
    Returns 13-bit masks, shape (p,). A relation is in the mask just where some choice of times within the distances
    realises it: minimal distances among four points are all that a network says of them (Dechter, Meiri & Pearl 1991),
    so each relation is tried on these four.
    """
    from deixis.reasoning.temporal.kernels import admitted

    masks: NDArray[np.uint16] = admitted(distances, pairs, _definitions())
    return masks


def allen_masks(
    distances: NDArray[np.int64], starts: NDArray[np.int64], finishes: NDArray[np.int64]
) -> NDArray[np.uint16]:
    """The same for all ordered pairs of n fluents, given the points of their ends: shape (n, n)."""
    n = len(starts)
    first, second = np.triu_indices(n, 1)
    pairs = np.stack([starts[first], finishes[first], starts[second], finishes[second]], axis=1).astype(np.int64)
    masks = np.full((n, n), 1 << Allen.EQUALS, dtype=np.uint16)
    masks[first, second] = masks_of_pairs(distances, pairs)
    masks[second, first] = converse_masks(masks[first, second])
    return masks


def converse_masks(masks: NDArray[np.uint16]) -> NDArray[np.uint16]:
    """The converse of each mask: bit i goes to bit 12 - i."""
    found = np.zeros_like(masks)
    for code in range(13):
        found |= ((masks >> code) & 1) << (12 - code)
    return found


def masks_from_bounds(starts: list[Bounds], finishes: list[Bounds]) -> NDArray[np.uint16]:
    """The Allen relations that n fluents admit by the bounds of their starts and finishes alone: shape (n, n).

    Exact: a relation is in the mask just where some times within the bounds, each start before its finish, realise it.

    >>> masks = masks_from_bounds([Bounds(0, 1), Bounds(2, 3)], [Bounds(1, 2), Bounds(5, 5)])
    >>> [relation.symbol for relation in members(int(masks[0, 1]))]
    ['<', 'm']
    """
    n = len(starts)
    distances = distances_from_bounds(starts, finishes)
    points = np.arange(n, dtype=np.int64)
    return allen_masks(distances, 1 + points, 1 + n + points)


def distances_from_bounds(starts: list[Bounds], finishes: list[Bounds]) -> NDArray[np.int64]:
    """Closed distances among the origin (0), n starts (1 to n) and n finishes: shape (2 n + 1, 2 n + 1)."""
    n = len(starts)
    upper = np.array([ZERO, *(b.at_most for b in (*starts, *finishes))], dtype=np.int64)
    lower = np.array([ZERO, *(b.at_least for b in (*starts, *finishes))], dtype=np.int64)
    s, f = slice(1, n + 1), slice(n + 1, 2 * n + 1)
    upper[s] = np.minimum(upper[s], add_arrays(upper[f], _STRICT))
    lower[f] = np.minimum(lower[f], add_arrays(lower[s], _STRICT))
    distances = add_arrays(lower[:, None], upper[None, :])
    own = np.arange(1, n + 1)
    distances[own + n, own] = np.minimum(distances[own + n, own], _STRICT)
    np.fill_diagonal(distances, ZERO)
    return distances
