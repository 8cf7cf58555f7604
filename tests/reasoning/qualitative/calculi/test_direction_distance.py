"""Compare direction with distance with vectors of the plane, exactly, and with each calculus by itself."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.reasoning.errors import SettingError
from deixis.reasoning.qualitative.calculi.bridges import joint_to_directions, joint_to_distances
from deixis.reasoning.qualitative.calculi.distance import Ranges, direction_distance_calculus
from deixis.reasoning.qualitative.calculi.registry import calculus

UNIT = 1000
TILES = ((5, 4, 3), (6, 0, 2), (7, 0, 1))  # eighths of a turn from east, by the signs of x and y


def codes_of(vectors: NDArray[np.int64], bounds: tuple[float, ...]) -> NDArray[np.int64]:
    """Return the atoms of vectors, shape (..., 2), in UNIT-ths of the reference length; exact in whole numbers."""
    x, y = vectors[..., 0], vectors[..., 1]
    squared = x * x + y * y
    reach = sum((squared > int(bound * UNIT) ** 2).astype(np.int64) for bound in bounds)
    tile = np.array(TILES)[np.sign(x) + 1, np.sign(y) + 1]
    ranges = len(bounds) + 1
    return np.where(squared == 0, 8 * ranges, tile * ranges + reach)


def probes(bounds: tuple[float, ...]) -> NDArray[np.int64]:
    """Return vectors of a lattice, and vectors of lengths close to the bounds in many directions."""
    lengths = {bound * part for bound in bounds for part in (0.05, 0.6, 0.9, 0.99, 0.998, 1, 1.002, 1.01, 1.2, 1.6)}
    lengths |= {bounds[-1] * part for part in (1.9, 3, 3.02, 3.2, 4.2)}
    turns = np.radians([90 * quarter + turn for quarter in range(4) for turn in (0, 1, 8, 12, 20, 45, 70, 78, 82, 89)])
    ring = np.multiply.outer(sorted(lengths), np.stack([np.cos(turns), np.sin(turns)], axis=1)).reshape(-1, 2)
    along = np.unique(np.multiply.outer(np.arange(-1.2, 1.3, 0.2), bounds))
    lattice = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
    return np.unique(np.rint(np.concatenate([ring, lattice]) * UNIT).astype(np.int64), axis=0)


def shown(bounds: tuple[float, ...]) -> NDArray[np.bool_]:
    """Return the occurring atoms of p, q and p + q, shape (m, m, m), for probes p, q and for probes p, p + q."""
    vectors = probes(bounds)
    codes = codes_of(vectors, bounds)
    m = 8 * (len(bounds) + 1) + 1
    seen = np.zeros((m, m, m), dtype=bool)
    for vector, code in zip(vectors, codes, strict=True):
        seen[code, codes, codes_of(vectors + vector, bounds)] = True
        seen[code, codes_of(vectors - vector, bounds), codes] = True
        seen[m - 1, code, code] = seen[code, m - 1, code] = True
    seen[m - 1, m - 1, m - 1] = True
    return seen


@pytest.mark.parametrize("bounds", [(1.0, 3.0), (1.0,), (0.5, 1.0, 3.0), (3.0, 4.0, 5.0)])
def test_compositions_agree_with_vectors(bounds: tuple[float, ...]) -> None:
    names = ("a", "b", "c", "d")[: len(bounds) + 1]
    joint = direction_distance_calculus(Ranges(names, bounds))
    table = (joint.composition[:, :, None] >> np.arange(len(joint.atoms), dtype=np.uint64) & 1).astype(bool)
    seen = shown(bounds)
    assert not (seen & ~table).any()
    missed = [[joint.atoms[code] for code in triple] for triple in np.argwhere(table & ~seen)]
    assert missed == []


def test_joint_composition_is_tighter_than_the_two_apart() -> None:
    joint, directions, distances = calculus("direction-distance"), joint_to_directions(), joint_to_distances()
    tighter = 0
    for i, j in product(range(len(joint.atoms)), repeat=2):
        apart = joint.universal
        for bridge in (directions, distances):
            composed = bridge.target.compose(bridge.forward(1 << i), bridge.forward(1 << j))
            apart &= bridge.backward(composed)
        together = joint.compose(1 << i, 1 << j)
        assert together & ~apart == 0
        tighter += together != apart
    assert tighter == 416  # of 625


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        ("W,far", "N,near", {"NW,far"}),  # √(9 + something) is beyond 3
        ("N,near", "E,near", {"NE,near", "NE,medium"}),  # at most √2
        ("N,medium", "E,medium", {"NE,medium", "NE,far"}),  # more than √2, at most √18
        ("N,near", "S,far", {"S,medium", "S,far"}),  # more than 2
        ("N,medium", "SE,near", {"NE,near", "NE,medium", "NE,far"}),  # less far south than it is north
    ],
)  # fmt: skip
def test_compositions_by_hand(first: str, second: str, expected: set[str]) -> None:
    joint = calculus("direction-distance")
    found = set(joint.members(joint.compose(joint.relation([first]), joint.relation([second]))))
    assert found == expected


def test_the_number_of_ranges_is_limited_by_64_bits() -> None:
    names = tuple(f"r{i}" for i in range(8))
    seven = direction_distance_calculus(Ranges(names[:7], tuple(float(2**i) for i in range(6))))
    assert (len(seven.atoms), seven.universal.bit_length()) == (57, 57)
    with pytest.raises(SettingError, match="at most 7 ranges, got 8"):
        direction_distance_calculus(Ranges(names, tuple(float(2**i) for i in range(7))))
