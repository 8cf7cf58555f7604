"""Scale-free geometry of all ordered pairs of boxes: the features of graded models.

Lengths are in units of the sizes of the two boxes, so that moving or scaling a scene changes nothing. An *offset* of 1
on an axis is about where two boxes touch: their centres are apart by half the sum of their extents, plus a tenth of the
mean size of the pair, so that thin boxes have a width too. All features are finite, even for boxes without an extent.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.errors import OutOfTimeError
from deixis.reasoning.geometry.poses import Poses
from deixis.reasoning.geometry.rectangle import require_boxes
from deixis.reasoning.kernel import njit

Array = NDArray[np.float64]

ROW_CELLS = 1 << 18
"""Maximum number of pairs whose distances are in memory at a time."""

SLACK = 0.1
"""Share of the mean size of a pair that is added to half the sum of their extents, before dividing offsets by it."""


@dataclass(frozen=True, eq=False)
class PairGeometry:
    """Ordered pairs of boxes seen from above, and their heights if d is 3; row: subject, column: object.

    :func:`pair_geometry` builds it of all pairs of n boxes, :class:`PairBlocks` of a block of them, with n subjects and
    m objects. Arrays of pairs have shape (n, m), or (n, m, 2) with x and y last. The values of one axis are contiguous
    in memory, in the order in which they are read.
    """

    boxes: Array  # (n, 2, d): the subjects
    objects: Array  # (m, 2, d)
    crowd: Array  # (n, m): share of the other things closer to one of the two than its partner is; mean over both
    subject_poses: Poses | None = None  # of the n subjects; None: axes along the sides of the boxes, no fronts
    object_poses: Poses | None = None  # of the m objects

    def __len__(self) -> int:
        return len(self.boxes)

    @cached_property
    def reverse(self) -> PairGeometry:
        """Geometry of the reversed pairs, shape (m, n); this object itself for all pairs of n boxes."""
        if self.objects is self.boxes:
            return self
        other = PairGeometry(self.objects, self.boxes, self.crowd.T, self.object_poses, self.subject_poses)
        other.__dict__["reverse"] = self
        return other

    @cached_property
    def poses(self) -> tuple[Poses, Poses]:
        """Poses of the subjects and of the objects; by the sides of the boxes where they are not known."""
        subjects = Poses.of_boxes(self.boxes) if self.subject_poses is None else self.subject_poses
        return subjects, Poses.of_boxes(self.objects) if self.object_poses is None else self.object_poses

    @cached_property
    def _corners(self) -> tuple[Array, Array, Array, Array]:
        """Minimum and maximum corners seen from above, each of shape (2, n); those of the objects (2, m)."""
        return tuple(side[:, corner, :2].T.copy() for side in (self.boxes, self.objects) for corner in (0, 1))  # type: ignore[return-value]

    @cached_property
    def pair_size(self) -> Array:
        """Mean size of both boxes, shape (n, m); the size of a box is its mean extent on x and y."""
        subjects, objects = _sizes(self.boxes), _sizes(self.objects)
        mean: Array = (subjects[:, None] + objects[None, :]) / 2
        return mean

    @cached_property
    def offset(self) -> Array:
        """Subject's centre minus object's centre, shape (n, m, 2), 1 about where the boxes touch; odd under exchange.

        Between two points, it is only the direction, of length 1, or 0 for equal points.
        """
        low, high, other_low, other_high = self._corners
        apart = ((low + high) / 2)[:, :, None] - ((other_low + other_high) / 2)[:, None, :]
        unit = ((high - low)[:, :, None] + (other_high - other_low)[:, None, :]) / 2 + SLACK * self.pair_size
        if not self.pair_size.all():
            unit = np.where(self.pair_size > 0, unit, np.hypot(*apart))
        return _axes_last(_ratio(apart, unit))

    @cached_property
    def distance(self) -> Array:
        """Length of the offset, shape (n, m)."""
        length: Array = np.hypot(self.offset[:, :, 0], self.offset[:, :, 1])
        return length

    @cached_property
    def gap(self) -> Array:
        """Distance between the boxes as g / (1 + g), g in mean sizes of the pair: 0 if they touch, near 1 far away."""
        low, high, other_low, other_high = self._corners
        before, after = low[:, :, None] - other_high[:, None, :], other_low[:, None, :] - high[:, :, None]
        apart = np.hypot(*np.maximum(np.maximum(before, after), 0.0))
        return _ratio(apart, apart + self.pair_size)

    @cached_property
    def inside(self) -> Array:
        """Share of the subject's extent on each axis that lies within the object's, shape (n, m, 2)."""
        return _axes_last(_share_inside(*self._corners))

    @cached_property
    def smaller(self) -> Array:
        """Relative size difference (b - a) / (a + b), in [-1, 1], above 0 for a smaller subject; odd under exchange."""
        a, b = _sizes(self.boxes)[:, None], _sizes(self.objects)[None, :]
        return _ratio(b - a, a + b)

    @cached_property
    def edges(self) -> Array:
        """Signed distances v of edges in mean sizes, each as v / (1 + |v|), shape (3, n, m, 2).

        They are the subject's lower edge minus the object's upper one, the two upper edges, and the two lower edges.
        """
        return _axes_last(_edges(*self._corners, self.pair_size))

    @cached_property
    def foot(self) -> Array:
        """Position of the subject's lower edge on y within the object: 0 at its lower edge, 1 at its upper one.

        It is clipped to [-1, 2]. If the object has no extent on y, it is 0.5 at the object, and -1 or 2 elsewhere.
        """
        return _level(self.boxes[:, 0, 1], self.objects[:, 0, 1], self.objects[:, 1, 1])

    @cached_property
    def rise(self) -> Array | None:
        """Height by which both ends of the subject are above the object's, as v / (1 + |v|); None in 2-D."""
        if self.boxes.shape[2] < 3:
            return None
        low, high = self.boxes[:, 0, 2], self.boxes[:, 1, 2]
        other_low, other_high = self.objects[:, 0, 2], self.objects[:, 1, 2]
        unit = ((high - low)[:, None] + (other_high - other_low)[None, :]) / 2
        edges = _edges(low[None], high[None], other_low[None], other_high[None], unit)
        rise: Array = np.minimum(edges[1, 0], edges[2, 0])
        return rise


@dataclass(frozen=True, eq=False)
class PairBlocks:
    """All pairs of n boxes (n, 2, d), computed block by block, so that only one block is in memory.

    Only the crowding of a pair depends on the other boxes: ``nearer`` (n, n) counts those nearer to the subject than
    the object is.
    """

    boxes: Array
    nearer: NDArray[np.uint16 | np.uint32]
    poses: Poses | None = None

    @classmethod
    def of(cls, boxes: Array, deadline: Deadline = Deadline.never(), poses: Poses | None = None) -> PairBlocks:
        """Return the blocks of valid boxes.

        Parameters
        ----------
        boxes
            Minimum and maximum corners, shape (n, 2, d).
        deadline
            Time limit.
        poses
            Fronts and long axes of the things, where they are known.

        Returns
        -------
        PairBlocks
            The blocks, none of which is computed yet.

        Raises
        ------
        OutOfTimeError
            If the deadline passes.
        """
        n = len(boxes)
        nearer = np.zeros((n, n), np.uint16 if n < 1 << 16 else np.uint32)
        rows = max(1, ROW_CELLS // max(n, 1))
        for start in range(0, n, rows):
            if start and deadline.passed:
                raise OutOfTimeError(f"time limit reached while comparing {n} objects; raise it, or use fewer objects")
            some = boxes[start : start + rows]
            distance = PairGeometry(some, boxes, np.zeros((0, 0))).distance
            distance = np.round(distance, 9)  # rounding errors make no box nearer than one at an equal distance
            distance[np.arange(len(some)), np.arange(start, start + len(some))] = np.inf
            for row, count in zip(distance, nearer[start : start + rows], strict=True):
                count[:] = np.searchsorted(np.sort(row), row, side="left")
        np.fill_diagonal(nearer, 0)
        return cls(boxes, nearer, poses)

    def block(self, subjects: slice, objects: slice) -> PairGeometry:
        """Return the pairs of these subjects with these objects.

        Parameters
        ----------
        subjects
            Range of the subjects.
        objects
            Range of the objects.

        Returns
        -------
        PairGeometry
            The geometry of these pairs.
        """
        others = max(len(self.boxes) - 2, 1)
        counts = self.nearer[subjects, objects].astype(np.float64) + self.nearer[objects, subjects].T
        known = self.boxes[subjects]
        poses = (None, None) if self.poses is None else (self.poses[subjects], self.poses[objects])
        return PairGeometry(known, known if subjects == objects else self.boxes[objects], counts / (2 * others), *poses)


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Pairs of n boxes (n, 2, d) among many more, one block at a time; their crowding is approximate.

    ``distances`` (n, r), in rising order, are the distances from each box to r others that are spread evenly over the
    scene. The share of these others that is nearer than a distance is an estimate for all boxes. The work grows with n
    r, and not with the square of all.
    """

    boxes: Array
    distances: NDArray[np.float32]
    poses: Poses | None = None

    @classmethod
    def of(
        cls, boxes: Array, everything: Array, deadline: Deadline = Deadline.never(), poses: Poses | None = None
    ) -> Surroundings:
        """Return the surroundings of some boxes of a scene.

        Parameters
        ----------
        boxes
            The boxes, shape (n, 2, d).
        everything
            All boxes of the scene, shape (m, 2, d), with these among them.
        deadline
            Time limit.
        poses
            Fronts and long axes of the boxes, where they are known.

        Returns
        -------
        Surroundings
            The surroundings.

        Raises
        ------
        OutOfTimeError
            If the deadline passes.
        """
        spread = _spread_evenly(everything)
        distances = np.empty((len(boxes), len(spread)), np.float32)
        rows = max(1, ROW_CELLS // max(len(spread), 1))
        for start in range(0, len(boxes), rows):
            if start and deadline.passed:
                raise OutOfTimeError(
                    f"time limit reached while {len(boxes)} things were compared; raise it, or pass fewer things"
                )
            some = PairGeometry(boxes[start : start + rows], spread, np.zeros((0, 0)))
            distances[start : start + rows] = np.sort(some.distance.astype(np.float32), axis=1)
        return cls(boxes, distances, poses)

    def block(self, subjects: slice, objects: slice) -> PairGeometry:
        """Return the pairs of these subjects with these objects.

        Parameters
        ----------
        subjects
            Range of the subjects.
        objects
            Range of the objects.

        Returns
        -------
        PairGeometry
            The geometry of these pairs.
        """
        return self.block_with(subjects, self, objects)

    def block_with(self, subjects: slice, other: Surroundings, objects: slice) -> PairGeometry:
        """Return the pairs of some subjects with objects of another list of boxes of the same scene.

        Parameters
        ----------
        subjects
            Range of the subjects.
        other
            Surroundings of the other list.
        objects
            Range of its objects.

        Returns
        -------
        PairGeometry
            The geometry of these pairs.
        """
        known, others = self.boxes[subjects], other.boxes[objects]
        crowd = np.empty((len(known), len(others)))
        poses = [
            None if side.poses is None else side.poses[some] for side, some in ((self, subjects), (other, objects))
        ]
        pairs = PairGeometry(known, others, crowd, *poses)
        apart = np.ascontiguousarray(pairs.distance, dtype=np.float32)
        shares_nearer(self.distances[subjects], other.distances[objects], apart, crowd)
        return pairs


SPREAD = 256
"""Maximum size of the sample of things from which the crowding of a pair is estimated, with an error below 0.01."""


def _spread_evenly(boxes: Array) -> Array:
    """Return at most ``SPREAD`` of the boxes: of strips along y, sorted along x, at regular intervals."""
    if len(boxes) <= SPREAD:
        return boxes
    centres = boxes.mean(axis=1)
    strips = np.argsort(np.argsort(centres[:, 1], kind="stable"), kind="stable") * math.isqrt(SPREAD) // len(boxes)
    order = np.lexsort([centres[:, 0], strips])
    chosen: Array = boxes[order[np.arange(SPREAD) * len(boxes) // SPREAD]]
    return chosen


@njit(cache=True)
def shares_nearer(subjects, objects, apart, crowd):  # type: ignore[no-untyped-def]
    """Fill in the share of others that are nearer than the partner, the mean over both partners, (n, m).

    The arguments are the distances (n, r) and (m, r) to others in rising order, and those of the pairs (n, m). If those
    of one side are not known (r is 0), the other side's are used for both.
    """
    total = subjects.shape[1] + objects.shape[1]
    for p in range(apart.shape[0]):
        for q in range(apart.shape[1]):
            known = np.searchsorted(subjects[p], apart[p, q]) + np.searchsorted(objects[q], apart[p, q])
            crowd[p, q] = known / max(total, 1)


def pair_geometry(boxes: NDArray[np.float64], poses: Poses | None = None) -> PairGeometry:
    """Compute the geometry of all pairs of boxes.

    Parameters
    ----------
    boxes
        Minimum and maximum corners, shape (n, 2, d), d = 2 or 3.
    poses
        Poses of the n things; None for axes along the sides of the boxes, and no fronts.

    Returns
    -------
    PairGeometry
        Features of all ordered pairs, arrays whose first axes are (n, n).

    Raises
    ------
    GraphError
        If the boxes have another shape, are not finite, or have a greatest corner below the least.

    Examples
    --------
    >>> fork, plate = [[0.0, 0.0], [0.02, 0.2]], [[0.05, -0.02], [0.32, 0.25]]
    >>> pairs = pair_geometry(np.array([fork, plate]))
    >>> pairs.offset[0, 1].round(2).tolist(), pairs.gap[0, 1].round(2).tolist()
    ([-1.07, -0.06], 0.14)
    """
    boxes = np.asarray(boxes, dtype=np.float64)
    require_boxes(boxes)
    return PairBlocks.of(boxes, poses=poses).block(slice(0, len(boxes)), slice(0, len(boxes)))


def _sizes(boxes: Array) -> Array:
    """Return the mean extents on x and y, shape (n,)."""
    sizes: Array = (boxes[:, 1, :2] - boxes[:, 0, :2]).mean(axis=1)
    return sizes


def _ratio(part: Array, whole: Array) -> Array:
    """Return part / whole, or 0 where the whole is 0."""
    if whole.all():  # in nearly all cases; twice as fast
        plain: Array = part / whole
        return plain
    result: Array = np.divide(part, whole, out=np.zeros(np.broadcast(part, whole).shape), where=whole > 0)
    return result


def _axes_last(pairs: Array) -> Array:
    """Return pairs (…, axes, n, n) as a view (…, n, n, axes)."""
    return np.moveaxis(pairs, -3, -1)


def _share_inside(low: Array, high: Array, other_low: Array, other_high: Array) -> Array:
    """Return the shares of extents inside, shape (axes, n, m), of corners (axes, n) and (axes, m).

    For a subject without an extent, the share is 1 if the object contains it, else 0.
    """
    shared = np.minimum(high[:, :, None], other_high[:, None, :]) - np.maximum(low[:, :, None], other_low[:, None, :])
    extent = np.broadcast_to((high - low)[:, :, None], shared.shape)
    share = np.minimum(_ratio(np.maximum(shared, 0.0), extent), 1.0)
    if extent.all():
        return share
    result: Array = np.where(extent > 0, share, (shared >= 0).astype(np.float64))
    return result


def _edges(low: Array, high: Array, other_low: Array, other_high: Array, unit: Array) -> Array:
    """Return the signed edge distances, shape (3, axes, n, m), of corners (axes, n) and (axes, m)."""
    found = np.empty((3, len(low), *unit.shape))
    ends = ((low, other_high), (high, other_high), (low, other_low))
    for edges, (subject, object) in zip(found, ends, strict=True):
        apart = subject[:, :, None] - object[:, None, :]
        edges[:] = _ratio(apart, np.abs(apart) + unit)
    return found


def _level(low: Array, other_low: Array, other_high: Array) -> Array:
    """Return the positions of lower edges between two other edges, shape (n, m), clipped to [-1, 2]."""
    above = low[:, None] - other_low[None, :]
    extent = np.broadcast_to((other_high - other_low)[None, :], above.shape)
    flat = np.where(above == 0, 0.5, np.where(above > 0, 2.0, -1.0))
    bounded = np.clip(above, -extent, 2 * extent)
    level: Array = np.divide(bounded, extent, out=flat, where=extent > 0)
    return level
