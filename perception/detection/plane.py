"""The table's plane: planes by random samples (RANSAC, Fischler and Bolles 1981), refined by least squares.

Several planes are taken out one after the other. The table is not simply the largest, which may be the floor or a
wall: it is the one that looks like a table to an upright camera and has most standing on it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

SAMPLE, MOST_REFINED = 10_000, 50_000
"""Points that planes are looked for among, and that the table's is fitted to."""

TRIES = 300
NEAR = 0.01
"""Metres within which a point lies on a plane at first, at one metre from the sensor; it grows with the square, as
noise does."""

FARTHEST = 2.5
"""Metres up to which noise is reckoned with: what seems farther may have been moved."""

MOST_PLANES = 5
LEAST_SHARE = 0.04
"""A plane that could be the table holds at least this share of the points."""

STANDING = (0.008, 0.35)
"""Metres above a plane between which things stand on it."""

TABLE_HEIGHT, LEAST_STANDING = 0.4, 0.002
"""Metres that a floor lies below a table at the least, and the share of all points that stand on what is no floor."""

ALONG = 0.95
"""The cosine between the normals of two planes that are as level is greater."""


@dataclass(frozen=True, eq=False)
class Plane:
    """The points p with normal · p = offset; the unit normal (3,) points to the side of the things."""

    normal: NDArray[np.float64]
    offset: float

    def heights(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Metres above the plane, of points (n, 3), shape (n,)."""
        result: NDArray[np.float64] = points @ self.normal - self.offset
        return result

    @property
    def across(self) -> NDArray[np.float64]:
        """Two unit vectors along the plane, at right angles, shape (2, 3)."""
        along: NDArray[np.float64] = np.linalg.svd(self.normal[None])[2][1:]
        return along

    def is_along(self, other: Plane) -> bool:
        """Whether both are as level, their normals to the same side."""
        return bool(self.normal @ other.normal > ALONG)

    def turned(self) -> Plane:
        """The same plane, with its normal to the other side."""
        return Plane(-self.normal, -self.offset)


@dataclass(frozen=True, eq=False)
class Outlook:
    """From where a cloud was seen. ``up`` and ``right`` (3,) are those of the image, None where that is not known.

    ``known`` is false for an eye that was only assumed, for want of the place where the sensor stood.
    """

    eye: NDArray[np.float64]
    up: NDArray[np.float64] | None = None
    right: NDArray[np.float64] | None = None
    upwards: NDArray[np.float64] | None = None  # against gravity, where it was told
    known: bool = True

    def could_be_table(self, normal: NDArray[np.float64]) -> bool:
        """Whether a plane with this normal, towards the eye, is level for a camera that is held upright."""
        if self.upwards is not None:
            return bool(normal @ self.upwards > 0.7)
        if self.up is None or self.right is None:
            return True
        return bool(normal @ self.up > -0.1 and abs(normal @ self.right) < 0.7)


def table_plane(points: NDArray[np.float64], outlook: Outlook, seed: int) -> Plane | None:
    """The plane of the table under points (n, 3), all finite; None where there is none."""
    rng = np.random.default_rng(seed)
    sample = points if len(points) <= SAMPLE else points[np.sort(rng.choice(len(points), SAMPLE, replace=False))]
    tolerance = tolerance_at(sample, outlook)
    found = _planes(sample, tolerance, outlook, rng)
    planes = [plane for plane in found if outlook.could_be_table(plane.normal)]
    if not planes:
        return None
    free = np.ones(len(sample), dtype=np.bool_)
    for plane in found:  # a wall is nothing that stands on the floor
        free &= np.abs(plane.heights(sample)) > tolerance
    levels = _without_floors([level_of(plane, sample, tolerance, sample[free]) for plane in planes], len(sample))
    # What stands on a table tells its upper side, should the sensor seem to be below: the origin may be a mere default.
    turned = [level.plane.turned() for level in levels]
    levels += [
        level_of(plane, sample, tolerance, sample[free]) for plane in turned if outlook.could_be_table(plane.normal)
    ]
    best = max(levels, key=lambda level: level.bearing).plane
    chosen = points[:: max(1, len(points) // MOST_REFINED)]
    return refined(best, chosen, tolerance_at(chosen, outlook))


@dataclass(frozen=True, eq=False)
class Level:
    """A plane, the points on it (k, 3), and how many stand on it."""

    plane: Plane
    points: NDArray[np.float64]
    standing: int

    @property
    def bearing(self) -> int:
        """How much is on it: its own area, and ten times that of what stands on it, as a number of points."""
        return len(self.points) + 10 * self.standing

    def bears(self, total: int) -> bool:
        """Whether enough of a ``total`` of points stand on it to be things."""
        return self.standing >= LEAST_STANDING * total

    def is_floor_below(self, other: Level) -> bool:
        """Whether it lies a table's height below another level one."""
        return self.plane.is_along(other.plane) and bool(np.median(self.plane.heights(other.points)) > TABLE_HEIGHT)


def level_of(
    plane: Plane, sample: NDArray[np.float64], tolerance: NDArray[np.float64], free: NDArray[np.float64]
) -> Level:
    """What of a sample (n, 3) is on a plane within a tolerance (n,), and what of the ``free`` points stands on it."""
    on = sample[np.abs(plane.heights(sample)) <= tolerance]
    return Level(plane, on, _standing(plane, on, free))


def _without_floors(levels: list[Level], total: int) -> list[Level]:
    """All but those that lie a table's height below one on which something stands, however large they are."""
    tables = [level for level in levels if level.bears(total)]
    return [level for level in levels if not any(level.is_floor_below(table) for table in tables)]


def tolerance_at(points: NDArray[np.float64], outlook: Outlook) -> NDArray[np.float64]:
    """Metres from a plane, (n,), within which points (n, 3) may be on it."""
    near: NDArray[np.float64] = NEAR * np.clip(((points - outlook.eye) ** 2).sum(axis=1), 0.25, FARTHEST**2)
    return near


def _planes(
    sample: NDArray[np.float64], tolerance: NDArray[np.float64], outlook: Outlook, rng: np.random.Generator
) -> list[Plane]:
    """The large ones, the one with most points first."""
    found = []
    left = np.ones(len(sample), dtype=np.bool_)
    for _ in range(MOST_PLANES):
        if left.sum() < max(3, LEAST_SHARE * len(sample)):
            break
        plane = _largest(sample[left], tolerance[left], rng)
        if plane is None:
            break
        plane = _towards(refined(plane, sample[left], tolerance[left]), outlook, sample)
        on = np.abs(plane.heights(sample)) <= 1.5 * tolerance
        if (on & left).sum() < max(3, LEAST_SHARE * len(sample)):
            break
        found.append(plane)
        left &= ~on
    return found


def _largest(points: NDArray[np.float64], tolerance: NDArray[np.float64], rng: np.random.Generator) -> Plane | None:
    """The plane through three of the points that most points are on; one far away counts for the area it stands for."""
    triples = points[rng.integers(len(points), size=(TRIES, 3))]
    normals = np.cross(triples[:, 1] - triples[:, 0], triples[:, 2] - triples[:, 0])
    length = np.linalg.norm(normals, axis=1)
    good = length > 1e-9
    if not good.any():
        return None
    normals = normals[good] / length[good, None]
    offsets = (normals * triples[good, 0]).sum(axis=1)
    held = np.array(
        [tolerance[np.abs(points @ n - d) <= tolerance].sum() for n, d in zip(normals, offsets, strict=True)]
    )
    best = int(np.argmax(held))
    return Plane(normals[best], float(offsets[best]))


def refined(plane: Plane, points: NDArray[np.float64], tolerance: NDArray[np.float64], rounds: int = 6) -> Plane:
    """The least-squares plane of the points near it, over and over, ever nearer: what stands on it has no say.

    Points are weighted by the inverse of their noise's variance. ``tolerance`` (n,) is in metres.
    """
    weight = 1 / tolerance**2
    for turn in range(rounds):
        on = np.abs(plane.heights(points)) <= tolerance * max(0.3, 0.75**turn)
        if on.sum() < 3:
            break
        w = weight[on] / weight[on].sum()
        middle = w @ points[on]
        apart = points[on] - middle
        vectors = np.linalg.eigh((apart * w[:, None]).T @ apart)[1]
        normal = vectors[:, 0] * np.sign(vectors[:, 0] @ plane.normal or 1.0)
        plane = Plane(normal, float(normal @ middle))
    return plane


def _towards(plane: Plane, outlook: Outlook, points: NDArray[np.float64]) -> Plane:
    """The plane with its normal to the side of the sensor; where that is in the plane, of the things on it."""
    side = float(plane.normal @ outlook.eye - plane.offset)
    if outlook.upwards is not None:
        side = float(plane.normal @ outlook.upwards)
    elif abs(side) < 0.05:
        heights = plane.heights(points)
        side = float((heights > STANDING[0]).sum() - (heights < -STANDING[0]).sum())
    return plane if side >= 0 else plane.turned()


def _standing(plane: Plane, on: NDArray[np.float64], free: NDArray[np.float64]) -> int:
    """How many of the ``free`` points are above the box around those that are ``on`` the plane, not far up."""
    if len(on) < 3:
        return 0
    across = plane.across
    low, high = np.percentile(on @ across.T, (1, 99), axis=0)
    heights, plan = plane.heights(free), free @ across.T
    above = (heights > STANDING[0]) & (heights < STANDING[1]) & ((plan >= low) & (plan <= high)).all(axis=1)
    return int(above.sum())
