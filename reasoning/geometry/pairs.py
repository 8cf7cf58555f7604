"""Scale-free geometry of all ordered pairs of boxes: what graded models look at.

Lengths are measured against the sizes of the two boxes, never against a unit, so that nothing changes where a scene is
moved or scaled. An *offset* of 1 on an axis is about where two boxes touch: centres apart by half the sum of the two
extents, plus a tenth of the pair's mean size, so that thin boxes have a width too. Everything is finite, boxes without
an extent included.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.geometry.rectangle import require_boxes

Array = NDArray[np.float64]

SLACK = 0.1
"""What is added to half the sum of two extents before offsets are divided by it, as a share of the pair's mean size."""


@dataclass(frozen=True, eq=False)
class PairGeometry:
    """All ordered pairs of n boxes in the plan (and in height, where d is 3); row: subject, column: object.

    Built by :func:`pair_geometry`. Arrays of pairs have shape (n, n), or (n, n, 2) with x and y last; what holds for
    one axis lies together in memory, since that is how it is read.
    """

    boxes: Array  # (n, 2, d)

    def __len__(self) -> int:
        return len(self.boxes)

    @cached_property
    def _corners(self) -> tuple[Array, Array]:
        """Least and greatest corner in the plan, each of shape (2, n)."""
        return self.boxes[:, 0, :2].T.copy(), self.boxes[:, 1, :2].T.copy()

    @cached_property
    def size(self) -> Array:
        """Mean extent in the plan, shape (n,)."""
        extents: Array = (self.boxes[:, 1, :2] - self.boxes[:, 0, :2]).mean(axis=1)
        return extents

    @cached_property
    def pair_size(self) -> Array:
        """Mean size of the two, shape (n, n)."""
        mean: Array = (self.size[:, None] + self.size[None, :]) / 2
        return mean

    @cached_property
    def offset(self) -> Array:
        """Subject's centre less object's, shape (n, n, 2), 1 about where the boxes touch; odd under exchange.

        Between two points, the direction alone: length 1, or 0 where both are one.
        """
        low, high = self._corners
        centres, extents = (low + high) / 2, high - low
        apart = centres[:, :, None] - centres[:, None, :]
        unit = (extents[:, :, None] + extents[:, None, :]) / 2 + SLACK * self.pair_size
        if not self.pair_size.all():
            unit = np.where(self.pair_size > 0, unit, np.hypot(*apart))
        return _axes_last(_ratio(apart, unit))

    @cached_property
    def distance(self) -> Array:
        """Length of the offset, shape (n, n)."""
        length: Array = np.hypot(self.offset[:, :, 0], self.offset[:, :, 1])
        return length

    @cached_property
    def gap(self) -> Array:
        """Distance between the boxes, as g / (1 + g) with g in mean sizes of the pair: 0 touching, towards 1 afar."""
        low, high = self._corners
        before = low[:, :, None] - high[:, None, :]
        apart = np.hypot(*np.maximum(np.maximum(before, before.transpose(0, 2, 1)), 0.0))
        return _ratio(apart, apart + self.pair_size)

    @cached_property
    def inside(self) -> Array:
        """Share of the subject's extent on each axis that lies within the object's, shape (n, n, 2)."""
        return _axes_last(_share_inside(*self._corners))

    @cached_property
    def smaller(self) -> Array:
        """How much smaller the subject is: (b - a) / (a + b) of the sizes, -1 to 1; odd under exchange."""
        a, b = self.size[:, None], self.size[None, :]
        return _ratio(b - a, a + b)

    @cached_property
    def edges(self) -> Array:
        """Signed distances of edges in mean sizes, each as v / (1 + |v|), shape (3, n, n, 2).

        Subject's lower edge less object's upper one; the two upper edges; the two lower edges.
        """
        return _axes_last(_edges(*self._corners, self.pair_size))

    @cached_property
    def foot(self) -> Array:
        """Height of the subject's lower edge on y within the object: 0 at its lower edge, 1 at its upper one.

        Clipped to -1 and 2; beside an object without an extent on y, 0.5 at its place and -1 or 2 off it.
        """
        return _level(self.boxes[:, 0, 1], self.boxes[:, 1, 1])

    @cached_property
    def rise(self) -> Array | None:
        """How far the subject reaches higher at both ends on z, in mean heights, as v / (1 + |v|); None in 2-D."""
        if self.boxes.shape[2] < 3:
            return None
        low, high = self.boxes[:, 0, 2], self.boxes[:, 1, 2]
        height = high - low
        edges = _edges(low[None], high[None], (height[:, None] + height[None, :]) / 2)
        rise: Array = np.minimum(edges[1, 0], edges[2, 0])
        return rise

    @cached_property
    def crowd(self) -> Array:
        """Share of the other things that are nearer to one of the two than its partner is; mean over both, 0 to 1."""
        n = len(self)
        if n < 3:
            return np.zeros((n, n))
        distance = np.round(self.distance, 9)  # what is as far, as any two points are, is not nearer by rounding
        np.fill_diagonal(distance, np.inf)
        ordered = np.sort(distance, axis=1)
        nearer = np.stack([np.searchsorted(ordered[i], distance[i], side="left") for i in range(n)]) / (n - 2)
        crowd: Array = (nearer + nearer.T) / 2
        np.fill_diagonal(crowd, 0.0)
        return crowd


def pair_geometry(boxes: NDArray[np.float64]) -> PairGeometry:
    """Looks at boxes of shape (n, 2, d), least and greatest corner, d = 2 or 3; raises GraphError for any other.

    >>> fork, plate = [[0.0, 0.0], [0.02, 0.2]], [[0.05, -0.02], [0.32, 0.25]]
    >>> pairs = pair_geometry(np.array([fork, plate]))
    >>> pairs.offset[0, 1].round(2).tolist(), pairs.gap[0, 1].round(2).tolist()
    ([-1.07, -0.06], 0.14)
    """
    boxes = np.asarray(boxes, dtype=np.float64)
    require_boxes(boxes)
    return PairGeometry(boxes)


def _ratio(part: Array, whole: Array) -> Array:
    """part / whole, 0 where the whole is 0."""
    if whole.all():  # as nearly always; twice as fast
        plain: Array = part / whole
        return plain
    result: Array = np.divide(part, whole, out=np.zeros(np.broadcast(part, whole).shape), where=whole > 0)
    return result


def _axes_last(pairs: Array) -> Array:
    """(…, axes, n, n) as (…, n, n, axes), without moving a number."""
    return np.moveaxis(pairs, -3, -1)


def _share_inside(low: Array, high: Array) -> Array:
    """Shape (axes, n, n), of corners (axes, n); of a subject without an extent: 1 where the object holds it, else 0."""
    shared = np.minimum(high[:, :, None], high[:, None, :]) - np.maximum(low[:, :, None], low[:, None, :])
    extent = np.broadcast_to((high - low)[:, :, None], shared.shape)
    share = np.minimum(_ratio(np.maximum(shared, 0.0), extent), 1.0)
    if extent.all():
        return share
    result: Array = np.where(extent > 0, share, (shared >= 0).astype(np.float64))
    return result


def _edges(low: Array, high: Array, unit: Array) -> Array:
    """Shape (3, axes, n, n), of corners (axes, n)."""
    found = np.empty((3, len(low), *unit.shape))
    for edges, subject, object in zip(found, (low, high, low), (high, high, low), strict=True):
        apart = subject[:, :, None] - object[:, None, :]
        edges[:] = _ratio(apart, np.abs(apart) + unit)
    return found


def _level(low: Array, high: Array) -> Array:
    """Where each lower edge lies between two other edges, shape (n, n), clipped to -1 and 2."""
    above = low[:, None] - low[None, :]
    extent = np.broadcast_to((high - low)[None, :], above.shape)
    flat = np.where(above == 0, 0.5, np.where(above > 0, 2.0, -1.0))
    bounded = np.clip(above, -extent, 2 * extent)
    level: Array = np.divide(bounded, extent, out=flat, where=extent > 0)
    return level
