"""Relate points by qualitative distance, alone and with direction (Clementini, Di Felice and Hernández 1997).

An atom of the joint calculus is a tile of the cardinal directions with a range of distance: ``N,near``. Its composition
is tighter than the compositions of direction and distance taken separately: far to the west, followed by near to the
north, gives far to the north-west, and neither nearer nor farther round.

The composition is exact. Three vectors p, q and r = p + q make a triangle. Which of its angles is right, obtuse or flat
leaves ten *shapes*, and each determines, to the quarter turn, how far q and r are turned against p. Tiles are quarter
turns too (open ones, or the half axes between them), so that a shape as a whole fits two tiles or does not. Arcs of at
most a quarter turn that meet in pairs have a common point (Helly): three tiles that fit in pairs fit together. It
remains to test whether a triangle of that shape has its sides in the three ranges; the law of cosines answers this by
inequalities between the bounds or their squares.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from itertools import pairwise, product
from math import inf, isfinite

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.errors import SettingError
from deixis.reasoning.qualitative.calculi.calculus import TableCalculus

Bound = Fraction | float  # exact, or infinite
SAME = "same"


@dataclass(frozen=True)
class Ranges:
    """Ordered ranges of distance, in units of a reference length: range *i* reaches from bound *i* to bound *i + 1*.

    Parameters
    ----------
    names
        The names of the ranges, in order.
    bounds
        The finite bounds between the ranges. The first bound of all is 0 and the last is infinity.

    Raises
    ------
    SettingError
        If the bounds do not rise, or do not fit the names.

    Notes
    -----
    A range contains its upper bound and not its lower one; distance 0 is ``same`` and in no range.

    Examples
    --------
    >>> Ranges(("near", "far"), (2.0,)).intervals
    ((Fraction(0, 1), Fraction(2, 1)), (Fraction(2, 1), inf))
    """

    names: tuple[str, ...]
    bounds: tuple[float, ...]

    def __post_init__(self) -> None:
        if not 0 < len(self.names) < 64:
            raise SettingError(f"the number of distance ranges must be 1 to 63, got {len(self.names)}")
        if len(self.bounds) != len(self.names) - 1:
            raise SettingError(f"{len(self.names)} ranges of distance need {len(self.names) - 1} bounds between them")
        if SAME in self.names or len(set(self.names)) != len(self.names):
            raise SettingError(f"the names of distance ranges must differ from one another and from '{SAME}'")
        if any(not isfinite(bound) for bound in self.bounds) or list(self.bounds) != sorted({0.0, *self.bounds})[1:]:
            raise SettingError(f"bounds of distance must rise from above 0, got {', '.join(map(str, self.bounds))}")

    @property
    def intervals(self) -> tuple[tuple[Bound, Bound], ...]:
        """The lower and the upper bound of each range."""
        ends: list[Bound] = [Fraction(0), *map(Fraction, self.bounds), inf]
        return tuple(pairwise(ends))


DEFAULT_RANGES = Ranges(("near", "medium", "far"), (1.0, 3.0))
"""Default ranges: each is longer than all before it together (required by Clementini and others)."""


def distance_calculus(ranges: Ranges = DEFAULT_RANGES) -> TableCalculus:
    """Return the calculus of distance ranges, composed by the triangle inequality; the plane realises each entry.

    Closure does not decide it: distances that obey the triangle inequality three by three need not fit in the plane.

    Parameters
    ----------
    ranges
        Names of the ranges, and the bounds between them in units of the reference length.

    Returns
    -------
    TableCalculus
        The calculus, with one atom for each range and one for the same place.

    Examples
    --------
    >>> distance = distance_calculus()
    >>> distance.members(distance.compose(distance.relation(["near"]), distance.relation(["near"])))
    ('same', 'near', 'medium')
    """
    atoms = (SAME, *ranges.names)
    spans = (None, *ranges.intervals)
    table = [[_composed(spans, i, j) for j in range(len(atoms))] for i in range(len(atoms))]
    return TableCalculus(
        name="distance",
        atoms=atoms,
        converses=np.arange(len(atoms)),
        composition=np.array(table, dtype=np.uint64),
        identity=0,
        decided_by_closure=False,
        source="Clementini, Di Felice and Hernández 1997",
    )


def _composed(spans: Sequence[tuple[Bound, Bound] | None], i: int, j: int) -> int:
    first, second = spans[i], spans[j]
    if first is None or second is None:
        return 1 << max(i, j)
    mask = 1 if i == j else 0  # back at the start
    for k, third in enumerate(spans):
        if third is not None and _closes_triangle(first, second, third):
            mask |= 1 << k
    return mask


def _closes_triangle(first: tuple[Bound, Bound], second: tuple[Bound, Bound], third: tuple[Bound, Bound]) -> bool:
    """Return True if a triangle, flat ones included, has one side in each range; open below and closed above.

    The third side takes every length between the least difference of the others, which is not reached, and their
    greatest sum, which is.
    """
    least = max(0, first[0] - second[1], second[0] - first[1])
    return least < third[1] and third[0] < first[1] + second[1]


_AROUND = ("E", "NE", "N", "NW", "W", "SW", "S", "SE")
"""Tiles by eighths of a turn: an even index is a half axis, an odd one the open quarter turn between two half axes."""

HERE = f"EQ,{SAME}"
MAX_RANGES = 7
"""Maximum number of ranges, so that every atom fits into a word of 64 bits."""

Range = tuple[Bound, Bound]


class _Shape(Enum):
    """A shape of the triangle p, q, r = p + q: the turns from p to q, p to r and r to q, in eighths to the left.

    An even turn is exact, an odd one lies between its neighbours.
    """

    ACUTE = (3, 1, 1)
    RIGHT_C = (2, 1, 1)  # the right angle is opposite to r
    RIGHT_A = (3, 1, 2)  # opposite to p
    RIGHT_B = (3, 2, 1)  # opposite to q
    OBTUSE_C = (1, 1, 1)
    OBTUSE_A = (3, 1, 3)
    OBTUSE_B = (3, 3, 1)
    FLAT_C = (0, 0, 0)
    FLAT_A = (4, 0, 4)
    FLAT_B = (4, 4, 0)


def direction_distance_calculus(ranges: Ranges = DEFAULT_RANGES) -> TableCalculus:
    """Return the calculus of tiles and ranges, with ``8 len(ranges.names) + 1`` atoms; closure does not decide it.

    Parameters
    ----------
    ranges
        Names of the ranges, and the bounds between them in units of the reference length.

    Returns
    -------
    TableCalculus
        The calculus, with signs such as ``W,far``.

    Raises
    ------
    SettingError
        There are more than seven ranges.

    Examples
    --------
    >>> joint = direction_distance_calculus()
    >>> joint.members(joint.compose(joint.relation(["W,far"]), joint.relation(["N,near"])))
    ('NW,far',)
    """
    reaches = len(ranges.names)
    if reaches > MAX_RANGES:
        raise SettingError(f"direction with distance must have at most {MAX_RANGES} ranges, got {reaches}")
    codes = [(tile, reach) for tile in range(8) for reach in range(reaches)]
    here = len(codes)
    converses = [((tile + 4) % 8) * reaches + reach for tile, reach in codes]
    spans = ranges.intervals
    n = len(spans)
    turned = [[_fits(shape, *tiles) for shape in _Shape] for tiles in product(range(8), repeat=3)]
    sized = [[_has_sides(shape, *sides) for shape in _Shape] for sides in product(spans, repeat=3)]
    both = np.einsum("ts,us->tu", np.array(turned), np.array(sized)).reshape(8, 8, 8, n, n, n)
    closes: NDArray[np.bool_] = both.transpose(0, 3, 1, 4, 2, 5).reshape(8 * n, 8 * n, 8 * n)
    table = np.zeros((here + 1, here + 1), dtype=np.uint64)
    table[:, here] = table[here, :] = np.uint64(1) << np.arange(here + 1, dtype=np.uint64)
    for i, j in product(range(here), repeat=2):
        back = 1 << here if j == converses[i] else 0
        table[i, j] = back | sum(1 << int(k) for k in np.flatnonzero(closes[i, j]))
    return TableCalculus(
        name="direction-distance",
        atoms=(*(f"{_AROUND[tile]},{ranges.names[reach]}" for tile, reach in codes), HERE),
        converses=np.array([*converses, here], dtype=np.int64),
        composition=table,
        identity=here,
        aliases={"EQ": HERE},
        any_case=True,
        decided_by_closure=False,
        source="Clementini, Di Felice and Hernández 1997; the composition is worked out here",
    )


def _fits(shape: _Shape, p: int, q: int, r: int) -> bool:
    """Return True if vectors in these tiles can have the turns of the shape, all to the left or all to the right."""
    to_q, to_r, r_to_q = shape.value
    return any(
        _turns(p, q, side * to_q) and _turns(p, r, side * to_r) and _turns(r, q, side * r_to_q) for side in (1, -1)
    )


def _turns(start: int, end: int, turn: int) -> bool:
    """Return True if a vector in tile ``start`` and one in tile ``end`` can have that turn between them."""
    off = (end - start - turn) % 8
    both_open = start % 2 == 1 and end % 2 == 1
    return off == 0 or (both_open and off in (1, 7))


def _has_sides(shape: _Shape, p: Range, q: Range, r: Range) -> bool:
    """Return True if a triangle of that shape can have its sides in the three ranges."""
    kind, _, opposite = shape.name.partition("_")
    a, b, c = {"A": (q, r, p), "B": (p, r, q)}.get(opposite, (p, q, r))
    # Each condition: a and b in their ranges leave a length for c in its own; ranges are open below and closed above.
    if kind == "FLAT":  # c = a + b
        return a[0] + b[0] < c[1] and c[0] < a[1] + b[1]
    if kind == "OBTUSE":  # a² + b² < c² < (a + b)²
        return a[0] ** 2 + b[0] ** 2 < c[1] ** 2 and c[0] < a[1] + b[1]
    if kind == "RIGHT":  # c² = a² + b²
        return a[0] ** 2 + b[0] ** 2 < c[1] ** 2 and c[0] ** 2 < a[1] ** 2 + b[1] ** 2
    least = max(0, a[0] ** 2 - b[1] ** 2, b[0] ** 2 - a[1] ** 2)  # acute: c² < a² + b², and so for each side
    return least < c[1] ** 2 and c[0] ** 2 < a[1] ** 2 + b[1] ** 2
