"""Place boxes by linear programming: as little as possible out of given pieces, then exactly on the equations.

A linear program moves all boxes at once. Orders of end points and centres are linear. Distances are round: an upper
bound becomes a polygon within the circle, and a lower bound the half-plane beyond a tangent, in the direction in which
the centres lie already. Where the program leaves no slack, coordinates are rounded to binary fractions for which the
equations hold exactly, and whose pairwise sums are exact in floating point.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.networks.realisation.pair_types import (
    ANY,
    BOUNDS,
    COMPARED,
    EQUAL,
    GREATER,
    LESS,
    Piece,
)

Boxes = NDArray[np.float64]  # (n, 2, 2): minimum and maximum corner, x and y
Equation = dict[int, int]  # factor by coordinate; the sum is zero

POLYGON = 12
"""Number of sides of the polygon within the circle of an upper bound on distance."""
PRECISION = 24
"""Number of binary places of coordinates."""
FEASIBLE = 1e-6
"""Maximum slack of a constraint that counts as met; smaller than any margin."""
MAX_COORDINATE = 1000.0
"""Maximum coordinate per box."""
COMPACTNESS = 1e-4
"""Cost of one unit of a coordinate (one unit of slack costs 1 or more), so that boxes do not spread without need."""


@dataclass(frozen=True, eq=False)
class Placement:
    """Boxes moved by a linear program.

    ``slack`` is the worst violation of each pair's piece, shape (pairs,). ``equations`` hold exactly where there is no
    slack; their coordinates are counted as in ``boxes`` by axis, box and end.
    """

    boxes: Boxes
    slack: NDArray[np.float64]
    equations: tuple[Equation, ...]

    @property
    def fits(self) -> bool:
        """True if every pair is in its piece."""
        return bool(self.slack.sum() <= FEASIBLE)


class _Rows:
    """The rows of a linear program, each a weighted sum with an upper bound."""

    def __init__(self) -> None:
        self._rows: list[NDArray[np.int64]] = []
        self._columns: list[NDArray[np.int64]] = []
        self._values: list[NDArray[np.float64]] = []
        self._bounds: list[NDArray[np.float64]] = []
        self._count = 0

    def add(self, columns: NDArray[np.int64], values: NDArray[np.float64], bounds: NDArray[np.float64]) -> None:
        """Add rows with factors ``values`` (m, k) at ``columns`` (m, k)."""
        rows = self._count + np.arange(len(bounds))
        self._rows.append(np.repeat(rows, columns.shape[1]))
        self._columns.append(columns.ravel())
        self._values.append(values.ravel())
        self._bounds.append(bounds)
        self._count += len(bounds)

    def minimised(
        self, cost: NDArray[np.float64], most: NDArray[np.float64], deadline: Deadline
    ) -> NDArray[np.float64] | None:
        """Return the variables, from 0 to ``most``, of least cost; None if time ran out."""
        from scipy.optimize import linprog
        from scipy.sparse import csr_array

        where = np.concatenate(self._rows), np.concatenate(self._columns)
        matrix = csr_array((np.concatenate(self._values), where), shape=(self._count, len(cost)))
        limits = np.stack([np.zeros(len(cost)), most], axis=1)
        options = {} if math.isinf(deadline.left) else {"time_limit": deadline.left}
        found = linprog(cost, A_ub=matrix, b_ub=np.concatenate(self._bounds), bounds=limits, options=options)
        variables: NDArray[np.float64] | None = found.x
        return variables


def place(
    boxes: Boxes,
    pairs: NDArray[np.int64],
    pieces: Sequence[Piece],
    weights: NDArray[np.float64],
    margin: float,
    deadline: Deadline = Deadline.never(),
) -> Placement | None:
    """Move boxes so that pairs are in their pieces, or out of them by the least weighted sum.

    Parameters
    ----------
    boxes
        Boxes of shape (n, 2, 2), which give the directions in which to keep far things apart.
    pairs
        Pairs of boxes, shape (pairs, 2).
    pieces
        The piece for each pair.
    weights
        The cost of one unit of slack by pair, shape (pairs,).
    margin
        The least difference where one coordinate must be less than another.
    deadline
        When to stop.

    Returns
    -------
    Placement or None
        None where the deadline came first.
    """
    count, n = len(pairs), len(boxes)
    signs = np.array([piece.signs for piece in pieces], dtype=np.int8).reshape(count, 2, len(COMPARED))
    ends = np.concatenate([2 * pairs[:, :1] + [0, 1], 2 * pairs[:, 1:] + [0, 1]], axis=1)  # (pairs, 4), on x
    rows = _Rows()
    rows.add(np.arange(4 * n).reshape(-1, 2), np.tile([1.0, -1.0], (2 * n, 1)), np.full(2 * n, -margin))

    def add(
        chosen: NDArray[np.int64], columns: NDArray[np.int64], values: NDArray[np.float64], bounds: NDArray[np.float64]
    ) -> None:
        slack = np.full((len(chosen), 1), -1.0)
        rows.add(np.hstack([columns, 4 * n + chosen[:, None]]), np.hstack([values, slack]), bounds)

    for side, strict, other in ((1.0, LESS, GREATER), (-1.0, GREATER, LESS)):
        chosen, axis, row = np.nonzero(signs & other == 0)
        bounds = np.where(signs[chosen, axis, row] == strict, -margin, 0.0)
        add(chosen, 2 * n * axis[:, None] + ends[chosen], side * COMPARED[row], bounds)
    for chosen, directions, bounds in _round(boxes, pairs, pieces, margin / 4):
        both = np.concatenate([ends[chosen], 2 * n + ends[chosen]], axis=1)
        add(chosen, both, (directions[:, :, None] * COMPARED[-1]).reshape(-1, 8), bounds)
    cost = np.concatenate([np.full(4 * n, COMPACTNESS), weights])
    most = np.concatenate([np.full(4 * n, MAX_COORDINATE * n), np.full(count, np.inf)])
    variables = rows.minimised(cost, most, deadline)
    if variables is None:
        return None
    moved = variables[: 4 * n].reshape(2, n, 2).transpose(1, 2, 0)
    equations = []
    chosen, axis, row = np.nonzero((signs & EQUAL != 0) & (signs != ANY))
    columns = 2 * n * axis[:, None] + ends[chosen]
    level = np.abs((COMPARED[row] * variables[columns]).sum(axis=1)) < FEASIBLE
    exact = level | (signs[chosen, axis, row] == EQUAL)
    for coordinates, factors in zip(columns[exact].tolist(), (2 * COMPARED[row[exact]]).tolist(), strict=True):
        equations.append({k: int(factor) for k, factor in zip(coordinates, factors, strict=True) if factor})
    return Placement(moved, variables[4 * n :], tuple(equations))


def _round(
    boxes: Boxes, pairs: NDArray[np.int64], pieces: Sequence[Piece], margin: float
) -> Iterable[tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]]:
    """Yield bounds on the distance of centres in a direction: pairs (m,), directions (m, 2) and bounds (m,)."""
    nearest = np.array([piece.nearest for piece in pieces], dtype=np.int64)
    farthest = np.array([piece.farthest for piece in pieces], dtype=np.int64)
    centres = boxes.mean(axis=1)
    offsets = centres[pairs[:, 0]] - centres[pairs[:, 1]]
    # Send centres at the same place apart, each pair in another direction.
    together = (np.abs(offsets) < FEASIBLE).all(axis=1)
    angles = np.where(together, np.arange(len(pairs)) * 2.4, np.arctan2(offsets[:, 1], offsets[:, 0]))

    def directions(turned: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.stack([np.cos(turned), np.sin(turned)], axis=1)

    apart = np.flatnonzero(nearest > 0)
    yield apart, -directions(angles[apart]), -(BOUNDS[nearest[apart]] + margin)
    near = np.flatnonzero((farthest > 0) & np.isfinite(BOUNDS[farthest + 1]))
    within = (BOUNDS[farthest[near] + 1] - margin) * np.cos(np.pi / POLYGON)
    for side in range(POLYGON):  # a corner of the polygon, where it reaches farthest, lies in the present direction
        yield near, directions(angles[near] + (2 * side + 1) * np.pi / POLYGON), within


def rounded(placement: Placement, whole: bool) -> Boxes | None:
    """Return the boxes of a placement that fits, with coordinates for which the equations hold exactly.

    Coordinates are binary fractions whose pairwise sums are exact in floating point.

    Parameters
    ----------
    placement
        Boxes that satisfy the constraints up to rounding, with the equations that must hold exactly.
    whole
        Whether the coordinates must be whole numbers, at any scale.

    Returns
    -------
    ndarray or None
        Boxes of shape (n, 2, 2), or None if there are no such coordinates.
    """
    solved = _solved(placement.equations)
    common = math.lcm(1, *(part.denominator for parts in solved.values() for part in parts.values()))
    scale, n = 1 << PRECISION, len(placement.boxes)
    stated = (placement.boxes * scale).transpose(2, 0, 1).ravel().tolist()
    units = {k: common * round(value / common) for k, value in enumerate(stated) if k not in solved}
    units |= {
        k: int(sum((part * units[free] for free, part in parts.items()), Fraction(0))) for k, parts in solved.items()
    }
    if whole:
        scale = 1
        shared = math.gcd(*units.values()) or 1
        units = {k: value // shared for k, value in units.items()}
    if max(map(abs, units.values())) >= 1 << 52:
        return None
    exact = np.array([units[k] for k in range(4 * n)], dtype=np.float64) / scale
    return exact.reshape(2, n, 2).transpose(1, 2, 0)


def _solved(equations: Iterable[Equation]) -> dict[int, dict[int, Fraction]]:
    """Solve equations of zero: return coordinates as sums of free ones, factor by free coordinate."""
    solved: dict[int, dict[int, Fraction]] = {}

    def inserted(parts: dict[int, Fraction]) -> dict[int, Fraction]:
        sums: dict[int, Fraction] = {}
        for coordinate, factor in parts.items():
            for free, part in solved.get(coordinate, {coordinate: Fraction(1)}).items():
                sums[free] = sums.get(free, Fraction(0)) + factor * part
        return {free: part for free, part in sums.items() if part}

    for equation in equations:
        left = inserted({coordinate: Fraction(factor) for coordinate, factor in equation.items()})
        if not left:
            continue
        pivot = max(left, key=lambda free: abs(left[free]))
        head = left.pop(pivot)
        solved[pivot] = {free: -part / head for free, part in left.items()}
        for coordinate in [k for k, parts in solved.items() if pivot in parts]:
            solved[coordinate] = inserted(solved[coordinate])
    return solved
