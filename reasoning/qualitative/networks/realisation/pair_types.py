"""Classify pairs of boxes in the plane, as finely as all the calculi of boxes together.

On each axis a type gives the order of the four end points and of the two centres; there are 17 of these. With the range
of the distance between the centres there are 849 types in all. Each type has one atom in every calculus, so that the
constraints of several calculi on a pair are one set of types, and a part of this set that linear constraints describe
can be given to linear programming.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.qualitative.calculi.bridges import (
    Bridge,
    boxes_to_regions,
    joint_to_directions,
    joint_to_distances,
    names_to_boxes,
)
from deixis.reasoning.qualitative.calculi.distance import DEFAULT_RANGES

LESS, EQUAL, GREATER, ANY = 1, 2, 4, 7
"""Orders of two numbers as bits, and all of them together."""
COMPARED = np.array([[2, 0, -2, 0], [2, 0, 0, -2], [0, 2, -2, 0], [0, 2, 0, -2], [1, 1, -1, -1]], dtype=np.float64) / 2
"""Differences whose signs make a type, of (low a, high a, low b, high b): shape (5, 4); the last is of the centres."""
REACHES = 1 + len(DEFAULT_RANGES.names)
"""Number of distance codes: ``same`` and the ranges."""
BOUNDS = np.array([0.0, 0.0, *DEFAULT_RANGES.bounds, np.inf])
"""Bounds of the ranges in units of the reference length: range r reaches from ``BOUNDS[r]`` to ``BOUNDS[r + 1]``."""
_WIDER = {LESS: (ANY, LESS | EQUAL), GREATER: (ANY, GREATER | EQUAL), EQUAL: (ANY, LESS | EQUAL, GREATER | EQUAL)}

_REACHES_AROUND = tuple(
    sorted(
        ((low, high) for low in range(reach + 1) for high in range(reach, REACHES)), key=lambda span: span[0] - span[1]
    )
    for reach in range(REACHES)
)


@dataclass(frozen=True, eq=False)
class PairTypes:
    """All types, and the atom of each in every calculus."""

    orders: NDArray[np.int8]  # (17, 5): bits of the order of each difference, on one axis
    axes: NDArray[np.int64]  # (types, 2): the orders on x and on y
    reaches: NDArray[np.int64]  # (types,): the code of the distance
    atoms: Mapping[str, NDArray[np.int64]]  # by calculus (types,): the code of the atom

    def permitted(self, relations: Mapping[str, int]) -> NDArray[np.bool_]:
        """Return True for each type that has an atom of every given relation.

        Parameters
        ----------
        relations
            Relation of the pair as a bit mask, by the name of the calculus.

        Returns
        -------
        ndarray
            Mask of shape (types,).
        """
        left = np.ones(len(self.reaches), dtype=np.bool_)
        for name, relation in relations.items():
            codes = self.atoms[name]
            left &= np.array([relation >> code & 1 for code in range(codes.max() + 1)], dtype=np.bool_)[codes]
        return left


@cache
def pair_types() -> PairTypes:
    """Return the types of pairs of boxes.

    Returns
    -------
    PairTypes
        Orders on the axes and distances of all types, with the atom of each calculus; computed once.

    Examples
    --------
    >>> types = pair_types()
    >>> len(types.orders), len(types.reaches), sorted(types.atoms)
    (17, 849, ['cd', 'direction-distance', 'distance', 'ra', 'rcc8', 'ten'])
    """
    ends = np.array(list(combinations(range(6), 2)), dtype=np.float64)
    a, b = (part.reshape(-1, 2) for part in np.broadcast_arrays(ends[:, None], ends[None, :]))
    signs = np.sign(np.concatenate([a, b], axis=1) @ COMPARED.T).astype(np.int8)
    orders, first = np.unique(signs, axis=0, return_index=True)
    intervals = allen_relations(a[first, 0], a[first, 1], b[first, 0], b[first, 1]).astype(np.int64)
    centres = orders[:, 4].astype(np.int64)
    found = [
        (x, y, reach)
        for x, y, reach in product(range(len(orders)), range(len(orders)), range(REACHES))
        if (reach == 0) == (centres[x] == centres[y] == 0)
    ]
    axes, reaches = np.array(found)[:, :2], np.array(found)[:, 2]
    boxes = intervals[axes[:, 0]] * 13 + intervals[axes[:, 1]]
    tiles = (1 + centres[axes[:, 0]]) * 3 + 1 + centres[axes[:, 1]]
    of_tile, of_reach = _one_each(joint_to_directions()), _one_each(joint_to_distances())
    joint = {(tile, reach): code for code, (tile, reach) in enumerate(zip(of_tile, of_reach, strict=True))}
    atoms = {
        "ra": boxes,
        "ten": np.array(_one_each(names_to_boxes().inverse))[boxes],
        "rcc8": np.array(_one_each(boxes_to_regions()))[boxes],
        "cd": tiles,
        "distance": reaches,
        "direction-distance": np.array([joint[pair] for pair in zip(tiles.tolist(), reaches.tolist(), strict=True)]),
    }
    return PairTypes((np.int8(1) << (1 + orders)).astype(np.int8), axes, reaches, atoms)


def _one_each(bridge: Bridge) -> list[int]:
    """Return the one atom that each atom of the source admits."""
    return [admitted.bit_length() - 1 for admitted in bridge.admits]


@dataclass(frozen=True, eq=False)
class Piece:
    """A set of types described by linear constraints, except that distance is round.

    ``signs`` has shape (2, 5): for each axis, bits of the permitted orders of each difference of COMPARED, never LESS
    and GREATER without EQUAL. ``nearest`` and ``farthest`` are codes of distance.
    """

    signs: NDArray[np.int8]
    nearest: int
    farthest: int


def piece_around(permitted: NDArray[np.bool_], kept: int, order: NDArray[np.int64]) -> Piece:
    """Return a large piece of the permitted types that contains a given type.

    The eleven constraints that single out the type, ten orders and the distance, are widened one by one as long as no
    forbidden type enters.

    Parameters
    ----------
    permitted
        Mask of the permitted types, shape (types,).
    kept
        Position of the type to contain, which must be permitted.
    order
        Order in which the constraints are widened, shape (11,).

    Returns
    -------
    Piece
        Constraints that no forbidden type satisfies.

    Examples
    --------
    >>> types = pair_types()
    >>> apart = types.permitted({"rcc8": 1})  # DC
    >>> piece = piece_around(apart, int(np.flatnonzero(apart)[0]), np.arange(11))
    >>> int((piece.signs != ANY).sum()), piece.nearest, piece.farthest
    (1, 0, 3)
    """
    types = pair_types()
    forbidden = np.flatnonzero(~permitted)
    signs = types.orders[types.axes[kept]].reshape(10)
    reach = int(types.reaches[kept])
    nearest, farthest = reach, reach
    stated, distances = types.orders[types.axes[forbidden]].reshape(-1, 10), types.reaches[forbidden]
    outside = np.concatenate([(stated & signs) == 0, (distances != reach)[:, None]], axis=1)
    keeping = outside.sum(axis=1)  # constraints that keep each forbidden type out

    def widened(place: int, kept_out: NDArray[np.bool_]) -> bool:
        left = keeping - outside[:, place] + kept_out
        if not left.all():
            return False
        keeping[:], outside[:, place] = left, kept_out
        return True

    for place in order.tolist():
        if place < 10:
            for wider in _WIDER[int(signs[place])]:
                if widened(place, (stated[:, place] & wider) == 0):
                    signs[place] = wider
                    break
        else:
            for low, high in _REACHES_AROUND[reach]:
                if widened(place, (distances < low) | (distances > high)):
                    nearest, farthest = low, high
                    break
    signs = signs.reshape(2, 5)
    if farthest == 0:
        signs[:, -1] = EQUAL
    return Piece(signs, nearest, farthest)
