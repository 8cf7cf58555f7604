"""What is round as seen from above: the circle around points, and what of it is seen."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import corners_of

SECTORS = 36
"""Into so many a circle is divided."""

EDGE = 0.05
"""How far the edge of what is round may be off a circle, in its radius."""

SMALLEST, LARGEST = 0.015, 0.2
"""Metres: radii of what is taken to be round."""

LEAST_SEEN = 12
"""Sectors of an edge, one beside the other but for two, that show where the rest of a circle is."""

INSET, CELL, OPEN = 0.01, 0.005, 0.03
"""Nothing of the table may be seen within a circle, but for a strip (metres) at its edge, and such a share of its area,
which is counted in cells (metres)."""


@dataclass(frozen=True, eq=False)
class Circle:
    """A circle in the plan, metres."""

    centre: NDArray[np.float64]  # (2,)
    radius: float

    def off(self, plan: NDArray[np.float64]) -> NDArray[np.float64]:
        """How far places (n, 2) are beyond it, in its radius; within it below 0, shape (n,)."""
        out: NDArray[np.float64] = np.linalg.norm(plan - self.centre, axis=1) / self.radius - 1.0
        return out

    def sectors(self, plan: NDArray[np.float64], edge: float) -> NDArray[np.int64]:
        """The sectors in which there are places (n, 2) at its edge, in order."""
        x, y = (plan[self.off(plan) > -edge] - self.centre).T
        turn = np.arctan2(y, x) / (2 * np.pi) % 1.0
        return np.unique(np.minimum(turn * SECTORS, SECTORS - 1).astype(np.int64))

    def turned(self, axes: NDArray[np.float64]) -> Circle:
        """The same along other axes, in rows, (2, 2)."""
        return Circle(axes @ self.centre, self.radius)


def circle_around(plan: NDArray[np.float64], edge: float = EDGE) -> Circle | None:
    """The circle on which all corners of the convex outline of places (n, 2) lie, as well as ``edge`` has it.

    By algebraic least squares (Kasa, A circle fitting procedure and its error analysis, 1976). None where there is
    none, or fewer than five corners.
    """
    corners = corners_of(plan)
    if corners is None or len(corners) < 5:
        return None
    terms = np.column_stack([2 * corners, np.ones(len(corners))])
    x, y, rest = np.linalg.lstsq(terms, (corners**2).sum(axis=1))[0].tolist()
    circle = Circle(np.array([x, y]), math.sqrt(max(rest + x * x + y * y, 1e-12)))
    return circle if np.abs(circle.off(corners)).max() <= edge else None


def rim_of(plan: NDArray[np.float64], table: NDArray[np.float64]) -> Circle | None:
    """The whole rim of a round thing of which places (n, 2) are seen, the rest being hidden by itself or by others.

    None where what is seen is not round, where too little of its edge is, or where the table is seen at places (m, 2)
    within what would be its rim.
    """
    circle = circle_around(plan)
    if circle is None or not SMALLEST <= circle.radius <= LARGEST:
        return None
    seen = circle.sectors(plan, EDGE)
    gaps = np.sort(np.diff(np.append(seen, seen[0] + SECTORS)) - 1)
    if SECTORS - gaps[-1] < LEAST_SEEN or gaps[:-1].max(initial=0) > 2:
        return None
    within = table[circle.off(table) * circle.radius < -INSET]
    open_cells = len(np.unique(np.floor(within / CELL), axis=0))
    return circle if open_cells * CELL**2 < OPEN * np.pi * circle.radius**2 else None
