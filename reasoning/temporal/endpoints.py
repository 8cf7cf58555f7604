"""Allen's relations as orders of end points, and the relations that given distances admit.

A convex set of Allen relations (:mod:`deixis.reasoning.geometry.allen`) is a conjunction of a few orders of end points,
each of them a difference constraint. Any other set is a union of convex ones.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relations.allen import Allen
from deixis.reasoning.constraints.difference import STRICT, UNBOUNDED, ZERO, add_arrays
from deixis.reasoning.geometry.allen import HIGH_A, HIGH_B, LOW_A, LOW_B, convex_hull
from deixis.reasoning.temporal.bounds import Bounds

START_A, FINISH_A, START_B, FINISH_B = LOW_A, HIGH_A, LOW_B, HIGH_B
"""Numbers of the four end points of two fluents, in the order of all arrays here."""

Constraint = tuple[int, int, int]
"""Tail, head and code: an upper bound of head minus tail."""


@cache
def necessary_orders(mask: int) -> tuple[Constraint, ...]:
    """Return the fewest orders of end points that define the convex hull of a mask, as difference constraints.

    >>> necessary_orders(1 << Allen.BEFORE) == ((START_B, FINISH_A, 0),)  # a.finish - b.start < 0
    True
    """
    return tuple((order.greater, order.lesser, STRICT if order.strict else ZERO) for order in convex_hull(mask).orders)


@cache
def _definitions() -> NDArray[np.int64]:
    """Return the constraints that define each Allen relation, shape (13, k, 3), padded with unbounded ones."""
    rows = [necessary_orders(1 << relation) for relation in Allen]
    table = np.full((13, max(map(len, rows)), 3), UNBOUNDED, dtype=np.int64)
    for relation, row in enumerate(rows):
        table[relation, : len(row)] = row
    return table


def masks_of_pairs(distances: NDArray[np.int64], pairs: NDArray[np.int64]) -> NDArray[np.uint16]:
    """Return the Allen relations that pairs of fluents may have, by the minimal distances between points.

    Parameters
    ----------
    distances
        Closed distances between points, shape (m, m).
    pairs
        Indices of START_A, FINISH_A, START_B and FINISH_B, shape (p, 4).

    Returns
    -------
    13-bit masks, shape (p,). A relation is in the mask exactly if some choice of times within the distances realises
    it. The minimal distances among four points hold all that a network implies of them (Dechter, Meiri & Pearl 1991),
    so each relation is tested on these four.
    """
    from deixis.reasoning.temporal.kernels import admitted

    masks: NDArray[np.uint16] = admitted(distances, pairs, _definitions())
    return masks


def allen_masks(
    distances: NDArray[np.int64], starts: NDArray[np.int64], finishes: NDArray[np.int64]
) -> NDArray[np.uint16]:
    """Return the Allen relations of all ordered pairs of fluents.

    Parameters
    ----------
    distances
        Codes of the tightest bounds between points, a square array.
    starts, finishes
        Points of the ends of n fluents, shape (n,) each.

    Returns
    -------
    ndarray
        Masks of the possible relations, shape (n, n).
    """
    n = len(starts)
    first, second = np.triu_indices(n, 1)
    pairs = np.stack([starts[first], finishes[first], starts[second], finishes[second]], axis=1).astype(np.int64)
    masks = np.full((n, n), 1 << Allen.EQUALS, dtype=np.uint16)
    masks[first, second] = masks_of_pairs(distances, pairs)
    masks[second, first] = converse_masks(masks[first, second])
    return masks


def converse_masks(masks: NDArray[np.uint16]) -> NDArray[np.uint16]:
    """Return the converse of each mask, which moves bit i to bit 12 - i.

    Parameters
    ----------
    masks
        Masks over the 13 relations.

    Returns
    -------
    ndarray
        Masks of the same shape.
    """
    found = np.zeros_like(masks)
    for code in range(13):
        found |= ((masks >> code) & 1) << (12 - code)
    return found


def distances_from_bounds(starts: list[Bounds], finishes: list[Bounds]) -> NDArray[np.int64]:
    """Return closed distances among the origin (0), n starts (1 to n) and n finishes.

    Parameters
    ----------
    starts, finishes
        Bounds of the n fluents.

    Returns
    -------
    ndarray
        Codes of bounds, shape (2 n + 1, 2 n + 1).
    """
    n = len(starts)
    upper = np.array([ZERO, *(b.at_most for b in (*starts, *finishes))], dtype=np.int64)
    lower = np.array([ZERO, *(b.at_least for b in (*starts, *finishes))], dtype=np.int64)
    s, f = slice(1, n + 1), slice(n + 1, 2 * n + 1)
    upper[s] = np.minimum(upper[s], add_arrays(upper[f], STRICT))
    lower[f] = np.minimum(lower[f], add_arrays(lower[s], STRICT))
    distances = add_arrays(lower[:, None], upper[None, :])
    own = np.arange(1, n + 1)
    distances[own + n, own] = np.minimum(distances[own + n, own], STRICT)
    np.fill_diagonal(distances, ZERO)
    return distances
