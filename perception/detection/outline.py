"""Outlines as seen from above: the corners of a convex one, and what is within that of a table."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

CELL = 0.03
"""Metres of the grid on which the points of a table are connected."""

ENOUGH = 30_000
"""Points of a table that its outline is drawn from."""

SLACK = 0.02
"""Metres by which a thing's point may lie beyond the outline."""


def above_outline(table: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which of the points (n, 3) are above or below the convex hull of the table's points (m, 3), shape (n,).

    Only the largest connected piece of the table counts, so that what is level elsewhere in the room is left out.
    """
    from scipy.spatial import ConvexHull, QhullError

    plan = table[:: max(1, len(table) // ENOUGH), :2]
    piece = plan[in_largest_piece(plan)]
    if len(piece) < 3:
        return np.zeros(len(points), dtype=np.bool_)
    try:
        sides = ConvexHull(piece).equations
    except QhullError:
        return np.zeros(len(points), dtype=np.bool_)
    inside = np.ones(len(points), dtype=np.bool_)
    for a, b, c in sides.tolist():  # all at once would be tens of numbers for each point of the cloud
        inside &= a * points[:, 0] + b * points[:, 1] + c <= SLACK
    return inside


def in_largest_piece(plan: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which of points (n, 2) are in the connected piece that has most of them, shape (n,)."""
    from scipy.ndimage import label

    if not len(plan):
        return np.zeros(0, dtype=np.bool_)
    cell = np.floor((plan - plan.min(axis=0)) / max(CELL, float(np.ptp(plan, axis=0).max()) / 1000)).astype(np.int64)
    grid = np.zeros(cell.max(axis=0) + 1, dtype=np.bool_)
    grid[cell[:, 0], cell[:, 1]] = True
    pieces, _ = label(grid, np.ones((3, 3)))
    of = pieces[cell[:, 0], cell[:, 1]]
    largest: NDArray[np.bool_] = of == np.bincount(of).argmax()
    return largest


def corners_of(plan: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """The corners (k, 2) of the convex outline of places (n, 2), in turn; None of too few, or of places in a line."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        corners: NDArray[np.float64] = plan[ConvexHull(plan).vertices]
    except (QhullError, ValueError):
        return None
    return corners
